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
  std::array<Mat3, N> S;  // skew(R r_i)
  std::array<bool, N> offset;
  for (std::size_t i = 0; i < N; ++i) {
    offset[i] = arms[i] != Vec3::Zero();
    S[i] = skew(R * arms[i]);
  }
  out.resize(6 * N, 6 * N);
  const auto turned = [&](int i, int j) -> Mat3 { return (R * A.template block<3, 3>(i, j)).eval() * R.transpose(); };
  for (int j = 0; j < N; ++j)
    for (int i = 0; i <= j; ++i) {
      Mat3 uu = turned(6 * i, 6 * j), ut = turned(6 * i, 6 * j + 3);
      Mat3 tu = turned(6 * i + 3, 6 * j), tt = turned(6 * i + 3, 6 * j + 3);
      if (offset[static_cast<std::size_t>(j)]) {
        ut.noalias() -= uu * S[static_cast<std::size_t>(j)];
        tt.noalias() -= tu * S[static_cast<std::size_t>(j)];
      }
      if (offset[static_cast<std::size_t>(i)]) {
        tu.noalias() += S[static_cast<std::size_t>(i)] * uu;
        tt.noalias() += S[static_cast<std::size_t>(i)] * ut;
      }
      const auto put = [&](int row, int column, const Mat3& X) {
        out.template block<3, 3>(row, column) = X;
        if (i != j) out.template block<3, 3>(column, row) = X.transpose();
      };
      put(6 * i, 6 * j, uu);
      put(6 * i, 6 * j + 3, ut);
      put(6 * i + 3, 6 * j, tu);
      put(6 * i + 3, 6 * j + 3, tt);
    }
  // on the diagonal both triangles carry their own round-off: one of them decides
  for (int j = 0; j < 6 * N; ++j)
    for (int i = j + 1; i < j - j % 6 + 6; ++i) out(i, j) = out(j, i);
}

}  // namespace tenon::fem
