#include "assembly/spanning_tree.hpp"

#include <fmt/format.h>

#include "fem/error.hpp"

namespace tenon::assembly {

namespace {

constexpr const char* cure = "Use the second-order route, which takes loops";

// The piece of the network each body belongs to, named by its placement root.
std::vector<int> piece_of(const Network& network, const Placement& placement) {
  std::vector<int> piece(network.bodies.size());
  for (const int k : placement.order) {
    const auto b = static_cast<std::size_t>(k);
    piece[b] = k;
    if (const int j = placement.tree_joint[b]; j >= 0) {
      const Joint& joint = network.joints[static_cast<std::size_t>(j)];
      const int inner = joint.parent.body == k ? joint.child.body : joint.parent.body;
      piece[b] = piece[static_cast<std::size_t>(inner)];
    }
  }
  return piece;
}

Branch hang(const Joint& joint, int j, int parent_branch, int parent_body) {
  const bool outward = joint.parent.body == parent_body;
  const PortRef &inner = outward ? joint.parent : joint.child, &outer = outward ? joint.child : joint.parent;
  return {outer.body, parent_branch, j, inner.port, outer.port, outward};
}

}  // namespace

std::vector<Branch> spanning_tree(const Network& network, const Placement& placement, const std::string& route) {
  if (!placement.closing_joints.empty()) {
    const Joint& joint = network.joints[static_cast<std::size_t>(placement.closing_joints.front())];
    throw ModelError(fmt::format("{} needs a tree, but joint '{}' ({} to {}) closes a loop", route, joint.name,
                                 name(network, joint.parent), name(network, joint.child)),
                     cure);
  }
  const std::vector<int> piece = piece_of(network, placement);
  std::vector<const PortRef*> ground(network.bodies.size(), nullptr);  // per piece
  for (const PortRef& ref : network.ground) {
    const PortRef*& first = ground[static_cast<std::size_t>(piece[static_cast<std::size_t>(ref.body)])];
    if (first && (first->body != ref.body || first->port != ref.port))
      throw ModelError(fmt::format("{} needs a tree, but grounding {} closes a loop through {}", route,
                                   name(network, ref), name(network, *first)),
                       cure);
    first = &ref;
  }

  std::vector<Branch> branches;
  for (const int k : placement.order) {
    if (placement.tree_joint[static_cast<std::size_t>(k)] >= 0) continue;
    Branch root;
    const PortRef* fixed = ground[static_cast<std::size_t>(k)];
    root.body = fixed ? fixed->body : k;
    root.outer_port = fixed ? fixed->port : -1;
    std::size_t next = branches.size();
    for (branches.push_back(root); next < branches.size(); ++next) {
      const Branch here = branches[next];
      for (std::size_t j = 0; j < network.joints.size(); ++j) {
        const Joint& joint = network.joints[j];
        const bool touches = joint.parent.body == here.body || joint.child.body == here.body;
        if (touches && static_cast<int>(j) != here.joint)
          branches.push_back(hang(joint, static_cast<int>(j), static_cast<int>(next), here.body));
      }
    }
  }
  return branches;
}

}  // namespace tenon::assembly
