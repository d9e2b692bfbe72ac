#pragma once

#include <Eigen/Core>

#include "fem/spatial.hpp"

/// Mass and stiffness by their roots, M = WᵀW: what is never squared keeps twice the digits.
namespace tenon::reduction {

/// A = U diag(sigma) Vᵀ of a matrix with at least as many rows as columns: U m×n, sigma descending, V n×n.
struct ThinSvd {
  Eigen::MatrixXd U;
  Eigen::VectorXd sigma;
  Eigen::MatrixXd V;
};

/// Up to 160 columns by Jacobi rotations, which keep small singular values of graded matrices better; beyond, where
/// they cost several times as much, by divide and conquer (LAPACK dgesdd), error ε σ₁. Throws NumericalError when that
/// does not converge.
ThinSvd thin_svd(const Eigen::MatrixXd& A);

/// The same by divide and conquer, whatever the size.
ThinSvd divide_and_conquer_svd(Eigen::MatrixXd A);

/// S (6×6) with SᵀS = D for a symmetric positive semi-definite D; directions below 1e-12 of diag(`scale`) are exact
/// zeros. Scaled by diag(scale), so heavy translations do not hide light rotations.
fem::Mat6 mass_root(const fem::Mat6& D, const fem::Vec6& scale);

}  // namespace tenon::reduction
