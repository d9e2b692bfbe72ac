#include "reduction/partition.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <numeric>
#include <set>

#include "fem/error.hpp"
#include "fem/mesh.hpp"
#include "fem/rigid_forces.hpp"
#include "reduction/modes.hpp"
#include "reduction/sparse.hpp"

namespace tenon::reduction {

namespace {

std::string some_names(const fem::Structure& structure, const std::vector<int>& rows) {
  std::vector<std::string> names;
  for (std::size_t k = 0; k < std::min<std::size_t>(rows.size(), 5); ++k) {
    names.push_back(row_name(structure)(rows[k]));
  }
  return fmt::format("{}{}", fmt::join(names, ", "), rows.size() > 5 ? ", ..." : "");
}

}  // namespace

Partition partition(const fem::Structure& structure, const std::string& parent, bool children_free) {
  Partition parts;
  parts.parent = -1;
  std::vector<std::string> names;
  std::vector<char> taken(static_cast<std::size_t>(structure.n()), 0);
  for (std::size_t k = 0; k < structure.ports.size(); ++k) {
    const fem::Port& port = structure.ports[k];
    names.push_back(port.name);
    if (port.name == parent) parts.parent = static_cast<int>(k);
    std::array<int, 6> rows{};
    for (int d = 0; d < 6; ++d) rows[static_cast<std::size_t>(d)] = structure.dofs.row({port.node, d});
    parts.ports.push_back(rows);
  }
  if (parts.parent < 0) {
    const std::string near = fem::near_miss(parent, names);
    throw ModelError(fmt::format("the structure has no port '{}' to hang by", parent),
                     !near.empty()   ? fmt::format("Did you mean '{}'?", near)
                     : names.empty() ? std::string("Give it ports first")
                                     : fmt::format("Its ports are: {}", fmt::join(names, ", ")));
  }
  for (std::size_t k = 0; k < parts.ports.size(); ++k)
    for (const int row : parts.ports[k]) {
      if (row < 0) continue;
      if (taken[static_cast<std::size_t>(row)])
        throw ModelError(fmt::format("port '{}' lies on the node of another port", names[k]),
                         "Give each port a node of its own, or join both bodies at one port");
      taken[static_cast<std::size_t>(row)] = 1;
      const bool is_parent = static_cast<int>(k) == parts.parent;
      if (is_parent) parts.held.push_back(row);
      if (!is_parent && !children_free) parts.children.push_back(row);
      if (!is_parent && children_free) taken[static_cast<std::size_t>(row)] = 0;
    }
  if (parts.held.empty())
    throw ModelError(fmt::format("the node of parent port '{}' has neither stiffness nor mass", parent),
                     "Place the port on a node that belongs to the structure");
  for (int row = 0; row < structure.n(); ++row)
    if (!taken[static_cast<std::size_t>(row)]) parts.interior.push_back(row);
  return parts;
}

void require_stiffness_path(const fem::Structure& structure, const Partition& parts) {
  const int n = structure.n();
  std::vector<int> leader(static_cast<std::size_t>(n));  // of the piece that a row belongs to, by way of others
  std::iota(leader.begin(), leader.end(), 0);
  const auto piece = [&leader](int row) {
    auto at = static_cast<std::size_t>(row);
    while (leader[at] != static_cast<int>(at)) {
      const int next = leader[static_cast<std::size_t>(leader[at])];
      leader[at] = next;
      at = static_cast<std::size_t>(next);
    }
    return static_cast<int>(at);
  };
  const auto join = [&](int i, int j) { leader[static_cast<std::size_t>(piece(i))] = piece(j); };
  for (int j = 0; j < n; ++j)
    for (fem::SparseMatrix::InnerIterator it(structure.K, j); it; ++it)
      if (it.value() != 0.0) join(static_cast<int>(it.row()), j);
  for (const int row : parts.held) join(row, parts.held.front());
  // a modal coordinate of a part that was reduced before is held by its own stiffness
  const std::set<int> scalar(structure.scalar_points.begin(), structure.scalar_points.end());
  if (!scalar.empty()) {
    const Eigen::VectorXd k = structure.K.diagonal();
    for (int row = 0; row < n; ++row)
      if (k(row) > 0.0 && scalar.contains(structure.dofs.free[static_cast<std::size_t>(row)].node))
        join(row, parts.held.front());
  }
  std::vector<int> loose;
  for (int row = 0; row < n; ++row)
    if (piece(row) != piece(parts.held.front())) loose.push_back(row);
  if (loose.empty()) return;
  throw ModelError(
      fmt::format("{} of {} dofs have no stiffness path to parent port '{}': {}", loose.size(), n,
                  structure.ports[static_cast<std::size_t>(parts.parent)].name, some_names(structure, loose)),
      "Join this part to the rest (merge coincident nodes, add a rigid link), or take it out of the body");
}

double require_free_body(const fem::Structure& structure, const Eigen::MatrixXd& R) {
  const fem::RigidForces forces = fem::rigid_forces(structure.K, R);
  std::vector<int> rows;
  for (Eigen::Index i = 0; i < forces.force.rows(); ++i)
    if (!(forces.ratio(i) <= structure.rounding)) rows.push_back(static_cast<int>(i));
  if (rows.empty()) return forces.worst().ratio;
  throw ModelError(
      fmt::format("the structure resists a rigid motion at {}: it is held to the ground", some_names(structure, rows)),
      "A body that is to be joined must be free: remove its supports and springs to ground, and ground a "
      "port in the scene instead");
}

}  // namespace tenon::reduction
