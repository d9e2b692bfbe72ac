#include "fem/elements/bush.hpp"

#include <fmt/format.h>

#include "fem/error.hpp"

namespace tenon::fem {
namespace {

void check(const Bush& bush, std::span<const Vec3> nodes) {
  static constexpr std::array<const char*, 6> direction{"x", "y", "z", "rx", "ry", "rz"};
  for (std::size_t i = 0; i < 6; ++i)
    if (!(bush.k[i] >= 0.0 && std::isfinite(bush.k[i])))
      throw ModelError(fmt::format("bush {}: its stiffness in {} is {:g}", bush.id, direction[i], bush.k[i]),
                       "Give a stiffness of at least zero");
  if (!((bush.axes.transpose() * bush.axes - Mat3::Identity()).norm() <= 1e-12))
    throw ModelError(fmt::format("bush {}: its axes are not at right angles", bush.id), "Give three unit vectors");
  for (const int node : {bush.node_a, bush.node_b < 0 ? bush.node_a : bush.node_b})
    if (!nodes[static_cast<std::size_t>(node)].allFinite())
      throw ModelError(fmt::format("bush {}: the place of a node is not known", bush.id),
                       "Give x y z of both nodes, or springs between single dofs");
}

}  // namespace

void bush_matrices(const Bush& bush, std::span<const Vec3> nodes, ElementMatrices& out) {
  check(bush, nodes);
  const Mat6 R = rotation6(bush.axes);
  const Mat6 C = R * Eigen::Map<const Vec6>(bush.k.data()).asDiagonal() * R.transpose();
  const int n = bush.node_b < 0 ? 6 : 12;
  Eigen::Matrix<double, 6, Eigen::Dynamic, Eigen::ColMajor, 6, 12> T(6, n);  // what P moves from a to b
  T.leftCols<6>() = -tau(bush.offset);
  if (bush.node_b >= 0) {
    const Vec3 point = nodes[static_cast<std::size_t>(bush.node_a)] + bush.offset;
    T.rightCols<6>() = tau(point - nodes[static_cast<std::size_t>(bush.node_b)]);
  }
  const Eigen::Matrix<double, 6, Eigen::Dynamic, Eigen::ColMajor, 6, 12> CT = C.lazyProduct(T);
  out.K = T.transpose().lazyProduct(CT);
  for (int j = 0; j < n; ++j)  // both triangles carry their own round-off
    for (int i = j + 1; i < n; ++i) out.K(i, j) = out.K(j, i);
  out.M.setZero(n, n);
}

}  // namespace tenon::fem
