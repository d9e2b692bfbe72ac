#pragma once

#include <Eigen/Core>
#include <functional>
#include <string>
#include <vector>

#include "reduction/factor.hpp"
#include "reduction/modes.hpp"

namespace tenon::reduction {

/// The part of span(candidates) that K does not resist, M-orthonormal (n×r, r may be 0). A motion counts as rigid when
/// every row of K r stays below `rounding` (Structure::rounding) of what cancels in it. Throws ModelError when such a
/// motion carries no mass either.
Eigen::MatrixXd null_motions(const fem::SparseMatrix& K, const fem::SparseMatrix& M, const Eigen::MatrixXd& candidates,
                             double rounding, const RowName& row_name = {});

/// Smallest λ that can be told from zero with the shape x: rounding errors of xᵀKx / xᵀMx.
double lambda_noise(const fem::SparseMatrix& K, const Eigen::VectorXd& x, double modal_mass);

/// Eigenvalues of either sign within this many lambda_noise may be zero.
inline constexpr double zero_noise = 1e5;

/// "node 45 rz", or "row 7" without a name.
std::string name_of(const RowName& row_name, int row);

/// Throws NumericalError: xᵀKx / xᵀMx = λ < 0, which no K of a body at rest has.
[[noreturn]] void refuse_negative(const RowName& row_name, const Eigen::VectorXd& x, double lambda);

/// A shift s ≥ 0 with K + sM positive definite, and its factor.
struct ShiftedFactor {
  double s = 0.0;
  fem::SparseMatrix A;  ///< K + sM, lower triangle
  Factor factor;
};

/// s = 0 where K is positive definite; else s of the size of the first flexible eigenvalue (between 1 and 30 of it),
/// found by a few block Lanczos steps from a shift below the least K_ii/M_ii: then λ = 1/μ − s keeps its digits and no
/// zero mode drowns the flexible ones. `rigid`: M-orthonormal basis of null(K) as far as known.
/// `ordered` is called, if given, when the ordering is known and the numbers are not: other work may begin beside.
/// Throws NumericalError naming the dof whose pivot fails when no shift helps, or that moves most where K is
/// indefinite.
ShiftedFactor choose_shift(const fem::SparseMatrix& K, const fem::SparseMatrix& M, const Eigen::MatrixXd& rigid,
                           const RowName& row_name = {}, const std::function<void(const Factor&)>& ordered = {});

/// A factored K is singular to working precision when some x = K⁻¹v has an energy within rounding of zero. Returns −1
/// when it is sound, else the row that moves most.
int free_row(const fem::SparseMatrix& K, const Factor& factor);

/// Rigid motions as orthonormal vectors of the shift-invert operator: L⁻¹P (K + sM) R, K R = 0.
Eigen::MatrixXd locked_motions(const Factor& factor, const fem::SparseMatrix& M, const Eigen::MatrixXd& rigid);

}  // namespace tenon::reduction
