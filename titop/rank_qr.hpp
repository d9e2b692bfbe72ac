#pragma once

#include <Eigen/QR>
#include <algorithm>
#include <cmath>

namespace tenon::titop {

/// QᵀA = [R; 0] with `rank` rows of R: QR with column pivoting, pivots up to `tolerance` (absolute) taken as zero.
struct RankQr {
  Eigen::MatrixXd Q;  ///< square, orthogonal
  Eigen::Index rank = 0;
  double least_kept = 0.0, largest_dropped = 0.0;  ///< pivots on either side; 0: there is none

  RankQr(const Eigen::MatrixXd& A, double tolerance) : Q(Eigen::MatrixXd::Identity(A.rows(), A.rows())) {
    if (A.size() == 0) return;
    const Eigen::ColPivHouseholderQR<Eigen::MatrixXd> qr(A);
    Q = qr.householderQ();
    const Eigen::Index pivots = std::min(A.rows(), A.cols());
    while (rank < pivots && std::abs(qr.matrixQR()(rank, rank)) > tolerance) {
      least_kept = std::abs(qr.matrixQR()(rank, rank));
      ++rank;
    }
    if (rank < pivots) largest_dropped = std::abs(qr.matrixQR()(rank, rank));
  }
};

}  // namespace tenon::titop
