#include "fem/model.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "fem/error.hpp"

namespace tenon::fem {

namespace {

std::string name_of_link(const Model& model, const char* kind, long id, int node) {
  return id < 0 ? fmt::format("{} of {}", kind, name(model, node)) : fmt::format("{} {}", kind, id);
}

}  // namespace

std::string name(const Model& model, int node) {
  const long id = model.node_ids[static_cast<std::size_t>(node)];
  const auto port = std::ranges::find(model.ports, node, &Port::node);
  return id < 0 && port != model.ports.end() ? fmt::format("port {}", port->name) : fmt::format("node {}", id);
}

std::string name(const Model& model, const Dof& dof) {
  static constexpr std::array<const char*, 6> directions{"ux", "uy", "uz", "rx", "ry", "rz"};
  return fmt::format("{} {}", name(model, dof.node), directions[static_cast<std::size_t>(dof.direction)]);
}

std::string link_name(const Model& model, const RigidLink& link) {
  return name_of_link(model, "rigid link", link.id, link.independent);
}

std::string link_name(const Model& model, const AverageLink& link) {
  return name_of_link(model, "averaging link", link.id, link.reference);
}

const Vec3& position(const Model& model, int node) {
  const Vec3& x = model.nodes[static_cast<std::size_t>(node)];
  if (!x.allFinite())
    throw ModelError(fmt::format("{}: the place of {} is not known", model.source, name(model, node)),
                     "Links, ports and rigid motions need it: give x y z of the node beside the matrices");
  return x;
}

}  // namespace tenon::fem
