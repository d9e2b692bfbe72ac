#include "assembly/scene/mesh_nodes.hpp"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <numeric>

#include "fem/matrix_part.hpp"

namespace tenon::assembly {
namespace {

constexpr double coincidence = 1e-6;  // "at" a node: within this part of the model's size

/// Marks every node that an element, a link or a constraint touches.
struct MarkUsed {
  std::vector<bool>& used;

  void mark(int node) const {
    if (node >= 0) used[static_cast<std::size_t>(node)] = true;
  }
  template <class E>
  requires requires(const E& e) { e.nodes; }
  void operator()(const E& element) const {
    for (const int node : element.nodes) mark(node);
  }
  void operator()(const fem::PointMass& point) const { mark(point.node); }
  template <class E>
  requires requires(const E& e) { e.node_b; }
  void operator()(const E& spring) const {
    mark(spring.node_a);
    mark(spring.node_b);
  }
};

std::vector<bool> used_nodes(const fem::Model& model) {
  std::vector<bool> used(model.nodes.size(), false);
  const MarkUsed visit{used};
  for (const fem::Element& element : model.elements) std::visit(visit, element);
  for (const auto& part : model.matrix_parts)
    for (const fem::Dof& dof : part->dofs) visit.mark(dof.node);
  for (const fem::RigidLink& link : model.rigid_links) {
    visit.mark(link.independent);
    for (const int node : link.dependents) visit.mark(node);
  }
  for (const fem::AverageLink& link : model.average_links) {
    visit.mark(link.reference);
    for (const auto& group : link.nodes) visit.mark(group.node);
  }
  for (const fem::LinearConstraint& constraint : model.constraints)
    for (const auto& term : constraint.terms) visit.mark(term.dof.node);
  return used;
}

}  // namespace

MeshNodes::MeshNodes(const fem::Mesh& mesh, const fem::Model& model)
    : mesh_(mesh), model_(model), used_(used_nodes(model)), placed_(used_) {
  for (const int point : model.scalar_points) placed_[static_cast<std::size_t>(point)] = false;
  Eigen::AlignedBox3d box;
  for (std::size_t k = 0; k < model.nodes.size(); ++k) {
    placed_[k] = placed_[k] && model.nodes[k].allFinite();
    if (placed_[k]) box.extend(model.nodes[k]);
    if (k < model.node_ids.size()) by_id_.emplace(model.node_ids[k], static_cast<int>(k));
  }
  if (!box.isEmpty()) size_ = box.diagonal().norm();
}

std::string MeshNodes::number(int node) const {
  return std::to_string(model_.node_ids[static_cast<std::size_t>(node)]);
}

std::vector<int> MeshNodes::of_set(const std::string& set, const Place& place) const {
  std::vector<int> nodes;
  if (set == "everywhere") {
    nodes.resize(used_.size());
    std::iota(nodes.begin(), nodes.end(), 0);
  } else {
    try {
      nodes = fem::points_of_set(mesh_, set);
    } catch (const InputError& fault) {
      throw InputError(place, fault.what(), "Sets are named where the mesh is made (physical groups in Gmsh)");
    }
  }
  std::erase_if(nodes, [&](int node) { return !used_[static_cast<std::size_t>(node)]; });
  if (nodes.empty())
    throw InputError(place, fmt::format("no element uses a node of set '{}'", set),
                     "Choose a set of the structure, or give its cells a section");
  return nodes;
}

int MeshNodes::nearest(const Vec3& point) const {
  int best = -1;
  double best_distance = 0.0;
  for (std::size_t k = 0; k < model_.nodes.size(); ++k) {
    if (!placed_[k]) continue;
    const double distance = (model_.nodes[k] - point).squaredNorm();
    if (best < 0 || distance < best_distance) {
      best = static_cast<int>(k);
      best_distance = distance;
    }
  }
  return best;
}

int MeshNodes::single(const NodeSelector& where) const {
  switch (where.kind) {
    case NodeSelector::Kind::node: {
      const auto found = by_id_.find(where.node);
      if (found == by_id_.end())
        throw InputError(where.place, fmt::format("there is no node {} in {}", where.node, mesh_.source),
                         "Use a node number of the file, or `nearest: [x, y, z]`");
      if (!used_[static_cast<std::size_t>(found->second)])
        throw InputError(where.place, fmt::format("no element uses node {}", where.node),
                         "Choose a node of the structure");
      return found->second;
    }
    case NodeSelector::Kind::set: {
      const std::vector<int> nodes = of_set(where.name, where.place);
      if (nodes.size() != 1)
        throw InputError(where.place, fmt::format("set '{}' has {} nodes, expected one", where.name, nodes.size()),
                         "Name a set of one node, or make the set a port and say `port: name`");
      return nodes.front();
    }
    default:
      break;
  }
  const int node = nearest(where.point);
  if (node < 0) throw InputError(where.place, "the model has no nodes in use", "Give its cells sections");
  const double gap = (model_.nodes[static_cast<std::size_t>(node)] - where.point).norm();
  if (where.kind == NodeSelector::Kind::at && gap > coincidence * size_)
    throw InputError(where.place,
                     fmt::format("there is no node at ({:g}, {:g}, {:g}) m; node {} is nearest, {:.4g} m away",
                                 where.point.x(), where.point.y(), where.point.z(), number(node), gap),
                     "Write `nearest` to take it");
  return node;
}

}  // namespace tenon::assembly
