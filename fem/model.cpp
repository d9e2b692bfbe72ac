#include "fem/model.hpp"

#include <fmt/format.h>

#include "fem/error.hpp"

namespace tenon::fem {

std::string name(const Model& model, const Dof& dof) {
  static constexpr std::array<const char*, 6> directions{"ux", "uy", "uz", "rx", "ry", "rz"};
  const auto node = static_cast<std::size_t>(dof.node);
  const char* direction = directions[static_cast<std::size_t>(dof.direction)];
  for (const Port& port : model.ports)
    if (port.node == dof.node && model.node_ids[node] < 0) return fmt::format("port {} {}", port.name, direction);
  return fmt::format("node {} {}", model.node_ids[node], direction);
}

const Vec3& position(const Model& model, int node) {
  const Vec3& x = model.nodes[static_cast<std::size_t>(node)];
  if (!x.allFinite())
    throw ModelError(fmt::format("{}: the place of node {} is not known", model.source,
                                 model.node_ids[static_cast<std::size_t>(node)]),
                     "Links, ports and rigid motions need it: give x y z of the node beside the matrices");
  return x;
}

}  // namespace tenon::fem
