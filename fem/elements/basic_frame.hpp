#pragma once

#include <array>

#include "fem/elements/element_matrices.hpp"
#include "fem/spatial.hpp"

namespace tenon::fem {

/// Carries an element matrix from the element's axes and corners to its nodes and the basic frame, T' A T.
/// Corner i hangs rigidly on node i: u_corner = u_node + θ × r_i, so T_i = τ(r_i) blkdiag(R', R') with
/// τ(r) = [1 −skew(r); 0 1]. Rigid motions pass through T exactly, hence a stiffness keeps its six zero modes.
/// @param local  6N×6N, symmetric, in the element's axes; only its node blocks j ≥ i are read
/// @param R      columns: the element's axes in the basic frame
/// @param arms   r_i, from node to corner, in the element's axes [m]
template <int N>
void to_basic_frame(const Eigen::Matrix<double, 6 * N, 6 * N>& local, const Mat3& R, const std::array<Vec3, N>& arms,
                    ElementMatrices::Matrix& out) {
  out.resize(6 * N, 6 * N);
  const Mat3 Rt = R.transpose();
  std::array<Mat3, N> S;  // −skew(r_i)
  bool straight = true;
  for (std::size_t i = 0; i < N; ++i) {
    S[i] = -skew(arms[i]);
    straight = straight && arms[i].isZero(0.0);
  }
  for (int i = 0; i < N; ++i)
    for (int j = i; j < N; ++j) {
      Mat6 A = local.template block<6, 6>(6 * i, 6 * j);
      if (!straight) {
        const Mat3 &S_i = S[static_cast<std::size_t>(i)], &S_j = S[static_cast<std::size_t>(j)];
        A.rightCols<3>() += A.leftCols<3>() * S_j;
        A.bottomRows<3>() += S_i.transpose() * A.topRows<3>();
      }
      for (int a = 0; a < 6; a += 3)
        for (int b = 0; b < 6; b += 3) {
          const Mat3 rotated = R * A.block<3, 3>(a, b) * Rt;
          out.block<3, 3>(6 * i + a, 6 * j + b) = rotated;
          if (j != i) out.block<3, 3>(6 * j + b, 6 * i + a) = rotated.transpose();
        }
    }
  for (int i = 0; i < N; ++i) {  // the diagonal blocks are symmetric up to round-off: make it exact
    Mat6 A = out.block<6, 6>(6 * i, 6 * i);
    out.block<6, 6>(6 * i, 6 * i) = 0.5 * (A + A.transpose());
  }
}

}  // namespace tenon::fem
