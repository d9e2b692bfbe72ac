#include "fem/checks/cells.hpp"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>

#include "fem/matrix_part.hpp"

namespace tenon::fem::checks {
namespace {

double diagonal_of(const Cells& cells) {
  Eigen::AlignedBox3d box;
  for (std::size_t i = 0; i < cells.points.size(); ++i)
    if (cells.made[i] == 0) box.extend(cells.points[i]);
  return box.isEmpty() ? 0.0 : box.diagonal().norm();
}

int corner_count(CellType type) {
  switch (dimension(type)) {
    case 0:
      return 1;
    case 1:
      return 2;
    case 2:
      return name(type).starts_with("triangle") ? 3 : 4;
    default:
      return 0;
  }
}

void tie(Cells& cells, int a, int b) {
  cells.used[static_cast<std::size_t>(a)] = cells.used[static_cast<std::size_t>(b)] = 1;
  if (a != b) cells.ties.push_back({a, b});
}

/// Whatever an element is, its nodes are tied to one another; those with sides are cells to look at.
template <class E>
void add_element(Cells& cells, const E& e, int kind) {
  Cell cell{.id = e.id, .kind = kind};
  if constexpr (requires { e.nodes; }) {
    const auto count = e.nodes.size();
    for (std::size_t i = 0; i < count; ++i) tie(cells, e.nodes[0], e.nodes[i]);
    cell.size = static_cast<int>(std::min<std::size_t>(count, 4));
    for (std::size_t i = 0; i < static_cast<std::size_t>(cell.size); ++i) cell.corners[i] = e.nodes[i];
    if constexpr (requires { e.section + e.material; }) cell.property = {e.section, e.material};
    cells.cells.push_back(cell);
  } else if constexpr (requires { e.node_a; }) {
    tie(cells, e.node_a, e.node_b >= 0 ? e.node_b : e.node_a);
  } else if constexpr (requires { e.node; }) {
    tie(cells, e.node, e.node);
  }
}

}  // namespace

Cells cells_of(const Mesh& mesh) {
  Cells result;
  result.points = mesh.points;
  result.ids = mesh.point_ids;
  result.used.assign(mesh.points.size(), 0);
  result.made.assign(mesh.points.size(), 0);
  for (const CellBlock& block : mesh.cells) {
    const int n = node_count(block.type), corners = corner_count(block.type);
    for (int k = 0; k < block.size(); ++k) {
      const int* nodes = block.nodes.data() + static_cast<std::ptrdiff_t>(k) * n;
      for (int i = 0; i < n; ++i) tie(result, nodes[0], nodes[i]);
      Cell cell{.size = corners, .id = block.ids[static_cast<std::size_t>(k)], .kind = static_cast<int>(block.type)};
      std::copy_n(nodes, corners, cell.corners.begin());
      if (corners > 0) result.cells.push_back(cell);
    }
  }
  result.diagonal = diagonal_of(result);
  return result;
}

Cells cells_of(const Model& model) {
  Cells result;
  result.points = model.nodes;
  result.ids = model.node_ids;
  result.used.assign(model.nodes.size(), 0);
  result.made.assign(model.nodes.size(), 0);
  for (std::size_t i = 0; i < model.nodes.size(); ++i) result.made[i] = model.node_ids[i] < 0 ? 1 : 0;
  for (std::size_t i = 0; i < model.nodes.size(); ++i)
    if (!model.nodes[i].allFinite()) result.made[i] = 1;  // of matrices whose files tell no place
  for (const int node : model.scalar_points) result.made[static_cast<std::size_t>(node)] = 1;
  for (const Element& element : model.elements)
    std::visit([&](const auto& e) { add_element(result, e, static_cast<int>(element.index())); }, element);
  for (const RigidLink& link : model.rigid_links)
    for (const int node : link.dependents) tie(result, link.independent, node);
  for (const AverageLink& link : model.average_links)
    for (const AverageLink::Group& group : link.nodes) tie(result, link.reference, group.node);
  for (const LinearConstraint& constraint : model.constraints)
    for (const LinearConstraint::Term& term : constraint.terms)
      tie(result, constraint.terms.front().dof.node, term.dof.node);
  for (const auto& part : model.matrix_parts)
    for (int j = 0; j < part->K.outerSize(); ++j)
      for (SparseMatrix::InnerIterator it(part->K, j); it; ++it)
        if (it.value() != 0.0)
          tie(result, part->dofs[static_cast<std::size_t>(j)].node,
              part->dofs[static_cast<std::size_t>(it.row())].node);
  result.diagonal = diagonal_of(result);
  return result;
}

double Places::worst() const {
  double worst = -std::numeric_limits<double>::infinity();
  for (const Place& place : list_) worst = std::max(worst, place.badness);
  return worst;
}

void Places::report(std::vector<Finding>& findings, Finding finding, int listed) {
  if (list_.empty()) return;
  const auto shown = static_cast<std::ptrdiff_t>(std::min(list_.size(), static_cast<std::size_t>(listed)));
  std::stable_sort(list_.begin(), list_.end(), [](const Place& a, const Place& b) { return a.badness > b.badness; });
  finding.count = static_cast<long>(list_.size());
  for (auto place = list_.begin(); place != list_.begin() + shown; ++place) finding.where.push_back(place->where);
  findings.push_back(std::move(finding));
}

std::string counted(long n, const char* thing) { return fmt::format("{} {}{}", n, thing, n == 1 ? "" : "s"); }

}  // namespace tenon::fem::checks
