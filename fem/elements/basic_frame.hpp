#pragma once

#include <array>

#include "fem/elements/element_matrices.hpp"
#include "fem/spatial.hpp"

namespace tenon::fem {

/// Carries an element matrix from the element's axes and corners to its nodes and the basic frame, T' A T.
/// Corner i hangs rigidly on node i: u_corner = u_node + θ × r_i, so T_i = τ(r_i) blkdiag(R', R') with
/// τ(r) = [1 −skew(r); 0 1]. Rigid motions pass through T exactly, hence a stiffness keeps its six zero modes.
/// @param A     6N×6N, symmetric, in the element's axes
/// @param R     columns: the element's axes in the basic frame
/// @param arms  r_i, from node to corner, in the element's axes [m]
template <int N>
void to_basic_frame(const Eigen::Matrix<double, 6 * N, 6 * N>& A, const Mat3& R, const std::array<Vec3, N>& arms,
                    ElementMatrices::Matrix& out) {
  using Square = Eigen::Matrix<double, 6 * N, 6 * N>;
  const Mat3 Rt = R.transpose();
  const auto times_T = [&](const Square& X, Square& XT) {
    for (int i = 0; i < N; ++i) {
      const Vec3& r = arms[static_cast<std::size_t>(i)];
      const auto u = X.template middleCols<3>(6 * i), theta = X.template middleCols<3>(6 * i + 3);
      XT.template middleCols<3>(6 * i).noalias() = u.lazyProduct(Rt);
      XT.template middleCols<3>(6 * i + 3).noalias() = theta.lazyProduct(Rt);
      if (r != Vec3::Zero()) {
        const Mat3 arm = -skew(r) * Rt;
        XT.template middleCols<3>(6 * i + 3).noalias() += u.lazyProduct(arm);
      }
    }
  };
  Square AT, TAT;
  times_T(A, AT);
  times_T(AT.transpose(), TAT);  // T' A = (A T)'
  out.resize(6 * N, 6 * N);
  for (int j = 0; j < 6 * N; ++j)
    for (int i = 0; i <= j; ++i) out(i, j) = out(j, i) = TAT(i, j);
}

}  // namespace tenon::fem
