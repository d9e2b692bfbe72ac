#include "fem/elements/bush.hpp"

#include <fmt/format.h>

#include <algorithm>

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
  const int n = bush.node_b < 0 ? 6 : 12;
  using Motion = Eigen::Matrix<double, 6, Eigen::Dynamic, Eigen::ColMajor, 6, 12>;
  Motion T(6, n);  // what P moves from a to b
  T.leftCols<6>() = -tau(bush.offset);
  double arm = bush.offset.norm();
  if (bush.node_b >= 0) {
    const Vec3 point = nodes[static_cast<std::size_t>(bush.node_a)] + bush.offset;
    const Vec3 from_b = point - nodes[static_cast<std::size_t>(bush.node_b)];
    T.rightCols<6>() = tau(from_b);
    arm = std::max(arm, from_b.norm());
  }
  Motion local = rotation6(bush.axes).transpose().lazyProduct(T);
  // a force along the line to P has no moment: what rounding leaves of one would be a stiffness of rotations
  for (int i = 0; i < 3; ++i)
    for (int first = 3; first < n; first += 6)
      if (local.row(i).segment<3>(first).norm() < 1e-14 * arm) local.row(i).segment<3>(first).setZero();
  const Motion forces = Eigen::Map<const Vec6>(bush.k.data()).asDiagonal() * local;
  out.K = local.transpose().lazyProduct(forces);
  for (int j = 0; j < n; ++j)  // both triangles carry their own round-off
    for (int i = j + 1; i < n; ++i) out.K(i, j) = out.K(j, i);
  out.M.setZero(n, n);
}

}  // namespace tenon::fem
