#include "fem/model.hpp"

#include <fmt/format.h>

namespace tenon::fem {

std::string name(const Model& model, const Dof& dof) {
  static constexpr std::array<const char*, 6> directions{"ux", "uy", "uz", "rx", "ry", "rz"};
  const auto node = static_cast<std::size_t>(dof.node);
  const char* direction = directions[static_cast<std::size_t>(dof.direction)];
  for (const Port& port : model.ports)
    if (port.node == dof.node && model.node_ids[node] < 0) return fmt::format("port {} {}", port.name, direction);
  return fmt::format("node {} {}", model.node_ids[node], direction);
}

}  // namespace tenon::fem
