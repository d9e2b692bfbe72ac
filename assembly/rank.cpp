#include "assembly/rank.hpp"

#include <fmt/format.h>

#include <Eigen/QR>
#include <algorithm>
#include <limits>
#include <numeric>

#include "fem/error.hpp"

namespace tenon::assembly {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

namespace {

using PivotedQR = Eigen::ColPivHouseholderQR<MatrixXd>;

constexpr double epsilon = std::numeric_limits<double>::epsilon();

PivotedQR among_unit_rows(const MatrixXd& rows, const VectorXd& lengths) {
  const VectorXd weight = lengths.unaryExpr([](double l) { return l > 0.0 ? 1.0 / l : 0.0; });
  return PivotedQR((weight.asDiagonal() * rows).transpose());
}

// Number of pivots that are not zero. Pivots that may be round-off of a few more operations are, when a clear gap lies
// above them; without one the rank is refused.
int decide_rank(const VectorXd& pivots, Eigen::Index largest_size, const std::string& what) {
  constexpr double doubt = 1e3, gap = 1e6;
  const double zero = static_cast<double>(largest_size) * epsilon;
  int rank = 0, sure = 0;
  while (rank < pivots.size() && pivots[rank] > zero) ++rank;
  while (sure < rank && pivots[sure] >= doubt * zero) ++sure;
  if (sure < rank && sure > 0 && pivots[sure - 1] < gap * pivots[sure])
    throw NumericalError(
        fmt::format("the rank of {} cannot be decided: one direction is neither free nor held, pivot", what),
        pivots[rank - 1], "Make parallel axes and coincident ports agree to the last digit, or clearly different");
  return sure;
}

}  // namespace

RowSpace row_space(const MatrixXd& rows, const VectorXd& lengths, const std::string& what) {
  const Index m = rows.rows(), n = rows.cols();
  RowSpace space;
  space.null = MatrixXd::Identity(n, n);
  space.range.resize(n, 0);
  space.gap = 1.0 / epsilon;
  for (int i = 0; i < m; ++i) space.redundant.push_back(i);
  if (m == 0 || n == 0) return space;

  const PivotedQR qr = among_unit_rows(rows, lengths);
  const VectorXd pivots = qr.matrixQR().diagonal().cwiseAbs();
  space.rank = decide_rank(pivots, std::max(m, n), what);
  const double dropped = space.rank < pivots.size() ? pivots[space.rank] : 0.0;
  if (space.rank > 0) space.gap = pivots[space.rank - 1] / std::max(dropped, epsilon);
  const MatrixXd Q = qr.householderQ();
  space.range = Q.leftCols(space.rank);
  space.null = Q.rightCols(n - space.rank);
  const auto& order = qr.colsPermutation().indices();
  space.redundant.clear();
  for (int i = 0; i < m; ++i) (i < space.rank ? space.independent : space.redundant).push_back(order[i]);
  std::sort(space.redundant.begin(), space.redundant.end());
  return space;
}

int row_rank(const MatrixXd& rows, const VectorXd& lengths, const std::string& what) {
  if (rows.size() == 0) return 0;
  return decide_rank(among_unit_rows(rows, lengths).matrixQR().diagonal().cwiseAbs(),
                     std::max(rows.rows(), rows.cols()), what);
}

GradedQR graded_qr(const MatrixXd& A, const MatrixXd& apply) {
  std::vector<Index> order(static_cast<std::size_t>(A.rows()));
  std::iota(order.begin(), order.end(), Index{0});
  const VectorXd size = A.cols() ? VectorXd(A.cwiseAbs().rowwise().maxCoeff()) : VectorXd::Zero(A.rows());
  std::stable_sort(order.begin(), order.end(), [&](Index a, Index b) { return size[a] > size[b]; });
  const Index n = A.cols();
  GradedQR result;
  if (n == 0) {
    result.Qt_apply = apply;
    return result;
  }
  const Eigen::ColPivHouseholderQR<MatrixXd> qr(A(order, Eigen::all));
  result.R = qr.matrixR().topLeftCorner(n, n).triangularView<Eigen::Upper>();
  result.P = qr.colsPermutation().indices();
  if (apply.rows() == A.rows()) {
    result.Qt_apply = apply(order, Eigen::all);
    result.Qt_apply.applyOnTheLeft(qr.householderQ().adjoint());
  }
  return result;
}

MatrixXd GradedQR::times_inverse(const MatrixXd& X) const {
  if (P.size() == 0) return X;
  MatrixXd Y = X(Eigen::all, std::vector<int>(P.data(), P.data() + P.size()));
  R.triangularView<Eigen::Upper>().solveInPlace<Eigen::OnTheRight>(Y);
  return Y;
}

}  // namespace tenon::assembly
