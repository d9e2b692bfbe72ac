#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

namespace tenon::assembly {

/// Row space and null space of a matrix whose rows have been brought to unit length (a row's weight says nothing about
/// what it forbids).
struct RowSpace {
  Eigen::MatrixXd range;  ///< n×rank, orthonormal: rows = (·) rangeᵀ
  Eigen::MatrixXd null;   ///< n×(n − rank), orthonormal: rows · null = 0
  int rank = 0;
  double gap = 0.0;              ///< smallest kept pivot over the largest dropped (over machine epsilon if none is)
  std::vector<int> independent;  ///< rows kept, in pivot order
  std::vector<int> redundant;    ///< rows that say nothing new
};

/// Householder QR of the transpose with pivoting among the rows. `lengths` are the rows' lengths before they met the
/// basis they are written in: a row that the basis annihilates is then seen as zero, not as noise of length one.
/// Pivots up to max(rows, columns)·ε count as zero, and so do those up to 1000 times that when the next one is 1e6
/// times larger. Throws NumericalError, naming `what`, when there is no such gap: the rank cannot be decided.
RowSpace row_space(const Eigen::MatrixXd& rows, const Eigen::VectorXd& lengths, const std::string& what);

/// The rank alone, by the same decision.
int row_rank(const Eigen::MatrixXd& rows, const Eigen::VectorXd& lengths, const std::string& what);

/// R (n×n upper triangular) and the column permutation P with A P = Q R for A of full column rank, by Householder QR
/// with rows sorted by size and pivoting among the columns: stable row by row, so rows of 1e8 and of 1e-8 both count
/// (Cox and Higham 1998). With `apply`, also Qᵀ apply.
struct GradedQR {
  Eigen::MatrixXd R;
  Eigen::VectorXi P;
  Eigen::MatrixXd Qt_apply;  ///< rows beyond the first n are what the range of A does not reach
  Eigen::MatrixXd times_inverse(const Eigen::MatrixXd& X) const;  ///< X P R⁻¹
};
GradedQR graded_qr(const Eigen::MatrixXd& A, const Eigen::MatrixXd& apply = {});

}  // namespace tenon::assembly
