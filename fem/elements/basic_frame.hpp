#pragma once

#include <array>

#include "fem/elements/element_matrices.hpp"
#include "fem/spatial.hpp"

namespace tenon::fem {

/// A T with T = blkdiag(T_i), T_i = τ(r_i) blkdiag(R', R') and τ(r) = [1 −skew(r); 0 1]; whole columns at a time.
/// @param S  skew(R r_i)
template <int N>
Eigen::Matrix<double, 6 * N, 6 * N> times_basic_frame(const Eigen::Matrix<double, 6 * N, 6 * N>& A, const Mat3& R,
                                                      const std::array<Mat3, N>& S) {
  Eigen::Matrix<double, 6 * N, 6 * N> X;
  for (int k = 0; k < 6 * N; k += 3)
    for (int j = 0; j < 3; ++j) X.col(k + j) = R(j, 0) * A.col(k) + R(j, 1) * A.col(k + 1) + R(j, 2) * A.col(k + 2);
  for (int i = 0; i < N; ++i) {
    const Mat3& s = S[static_cast<std::size_t>(i)];
    if (s == Mat3::Zero()) continue;
    for (int j = 0; j < 3; ++j)
      X.col(6 * i + 3 + j) -= s(0, j) * X.col(6 * i) + s(1, j) * X.col(6 * i + 1) + s(2, j) * X.col(6 * i + 2);
  }
  return X;
}

/// Carries an element matrix from the element's axes and corners to its nodes and the basic frame, T' A T.
/// Corner i hangs rigidly on node i: u_corner = u_node + θ × r_i. Rigid motions pass through T exactly, hence a
/// stiffness keeps its six zero modes.
/// @param A     6N×6N, symmetric, in the element's axes
/// @param R     columns: the element's axes in the basic frame
/// @param arms  r_i, from node to corner, in the element's axes [m]
template <int N>
void to_basic_frame(const Eigen::Matrix<double, 6 * N, 6 * N>& A, const Mat3& R, const std::array<Vec3, N>& arms,
                    ElementMatrices::Matrix& out) {
  std::array<Mat3, N> S;
  for (std::size_t i = 0; i < N; ++i) S[i] = skew(R * arms[i]);
  const Eigen::Matrix<double, 6 * N, 6 * N> left =
      times_basic_frame<N>(A, R, S).transpose();  // T' A, A being symmetric
  out = times_basic_frame<N>(left, R, S);
  for (int j = 0; j < 6 * N; ++j)  // each triangle carries its own round-off: one of them decides
    for (int i = j + 1; i < 6 * N; ++i) out(i, j) = out(j, i);
}

}  // namespace tenon::fem
