#pragma once

#include <Eigen/Core>

#include "fem/structure.hpp"

/// Products with symmetric matrices of which the lower triangle is stored.
namespace tenon::reduction {

/// A X.
Eigen::MatrixXd symmetric_product(const fem::SparseMatrix& A, const Eigen::Ref<const Eigen::MatrixXd>& X);

/// All of A.
inline Eigen::MatrixXd dense_matrix(const fem::SparseMatrix& A) {
  const Eigen::MatrixXd lower = A;
  return lower.selfadjointView<Eigen::Lower>();
}

/// |A| |x|: how large the terms are that cancel in A x, the scale of its rounding errors.
Eigen::VectorXd absolute_product(const fem::SparseMatrix& A, const Eigen::Ref<const Eigen::VectorXd>& x);

/// K + s M on the union of both patterns (lower triangles), explicit zeros and the whole diagonal kept, so that one
/// analysis serves every s.
fem::SparseMatrix shifted(const fem::SparseMatrix& K, const fem::SparseMatrix& M, double s);

/// The rows and columns `keep` (ascending) of A: lower triangle of a principal submatrix.
fem::SparseMatrix principal(const fem::SparseMatrix& A, const std::vector<int>& keep);

}  // namespace tenon::reduction
