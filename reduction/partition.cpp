#include "reduction/partition.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "fem/error.hpp"
#include "fem/mesh.hpp"
#include "reduction/sparse.hpp"

namespace tenon::reduction {

namespace {

constexpr double held_to_ground = 1e-8;  // of |K||r|, row by row; rounding leaves 1e-10 and less

std::string some_names(const fem::Structure& structure, const std::vector<int>& rows) {
  std::vector<std::string> names;
  for (std::size_t k = 0; k < std::min<std::size_t>(rows.size(), 5); ++k) {
    const auto row = static_cast<std::size_t>(rows[k]);
    names.push_back(row < structure.dofs.names.size() ? structure.dofs.names[row] : fmt::format("row {}", row));
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
  const auto n = static_cast<std::size_t>(structure.n());
  std::vector<std::vector<int>> above(n);  // row-wise entries of the strictly lower triangle, transposed
  for (int j = 0; j < structure.n(); ++j)
    for (fem::SparseMatrix::InnerIterator it(structure.K, j); it; ++it)
      if (it.row() != j && it.value() != 0.0) above[static_cast<std::size_t>(it.row())].push_back(j);
  std::vector<char> reached(n, 0);
  std::vector<int> front = parts.held;
  for (const int row : front) reached[static_cast<std::size_t>(row)] = 1;
  const auto reach = [&](int row) {
    if (reached[static_cast<std::size_t>(row)]) return;
    reached[static_cast<std::size_t>(row)] = 1;
    front.push_back(row);
  };
  while (!front.empty()) {
    const int j = front.back();
    front.pop_back();
    for (fem::SparseMatrix::InnerIterator it(structure.K, j); it; ++it)
      if (it.value() != 0.0) reach(static_cast<int>(it.row()));
    for (const int i : above[static_cast<std::size_t>(j)]) reach(i);
  }
  std::vector<int> loose;
  for (std::size_t row = 0; row < n; ++row)
    if (!reached[row]) loose.push_back(static_cast<int>(row));
  if (loose.empty()) return;
  throw ModelError(
      fmt::format("{} of {} dofs have no stiffness path to parent port '{}': {}", loose.size(), n,
                  structure.ports[static_cast<std::size_t>(parts.parent)].name, some_names(structure, loose)),
      "Join this part to the rest (merge coincident nodes, add a rigid link), or take it out of the body");
}

void require_free_body(const fem::Structure& structure, const Eigen::MatrixXd& R) {
  std::vector<int> rows;
  for (Eigen::Index c = 0; c < R.cols(); ++c) {
    const Eigen::VectorXd force = symmetric_product(structure.K, R.col(c)),
                          scale = absolute_product(structure.K, R.col(c));
    const double floor = held_to_ground * 1e-6 * scale.maxCoeff();
    for (Eigen::Index i = 0; i < force.size(); ++i)
      if (std::abs(force[i]) > held_to_ground * scale[i] + floor) rows.push_back(static_cast<int>(i));
  }
  std::sort(rows.begin(), rows.end());
  rows.erase(std::unique(rows.begin(), rows.end()), rows.end());
  if (rows.empty()) return;
  throw ModelError(
      fmt::format("the structure resists a rigid motion at {}: it is held to the ground", some_names(structure, rows)),
      "A body that is to be joined must be free: remove its supports and springs to ground, and ground a "
      "port in the scene instead");
}

}  // namespace tenon::reduction
