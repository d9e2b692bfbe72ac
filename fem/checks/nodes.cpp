#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <numeric>

#include "fem/checks/cells.hpp"

namespace tenon::fem::checks {
namespace {

std::string node_name(const Cells& cells, int node) {
  return fmt::format("node {}", cells.ids[static_cast<std::size_t>(node)]);
}

/// Trees of nodes with path halving; a part is named by its root.
class Parts {
 public:
  explicit Parts(std::size_t n) : parent_(n) { std::iota(parent_.begin(), parent_.end(), 0); }
  int root(int i) {
    while (parent_[static_cast<std::size_t>(i)] != i) {
      int& up = parent_[static_cast<std::size_t>(i)];
      up = parent_[static_cast<std::size_t>(up)];
      i = up;
    }
    return i;
  }
  void join(int a, int b) {
    a = root(a);
    b = root(b);
    parent_[static_cast<std::size_t>(std::max(a, b))] = std::min(a, b);
  }

 private:
  std::vector<int> parent_;
};

}  // namespace

std::vector<std::array<int, 2>> coincident_pairs(std::span<const Vec3> points, double distance) {
  // No grid of any mesh is perpendicular to this direction: only neighbours meet in a window of |d·(x − y)| ≤ distance.
  const Vec3 d = Vec3(1.0, std::numbers::sqrt2, std::numbers::sqrt3).normalized();
  std::vector<std::pair<double, int>> along(points.size());
  for (std::size_t i = 0; i < points.size(); ++i) along[i] = {d.dot(points[i]), static_cast<int>(i)};
  std::sort(along.begin(), along.end());
  std::vector<std::array<int, 2>> pairs;
  for (std::size_t p = 0; p < along.size(); ++p)
    for (std::size_t q = p + 1; q < along.size() && along[q].first - along[p].first <= distance; ++q) {
      const int i = along[p].second, j = along[q].second;
      if ((points[static_cast<std::size_t>(i)] - points[static_cast<std::size_t>(j)]).norm() > distance) continue;
      pairs.push_back({std::min(i, j), std::max(i, j)});
      break;  // of three at one place two pairs are enough
    }
  return pairs;
}

void check_nodes(const Cells& cells, const CheckLimits& limits, std::vector<Finding>& findings) {
  Places free;
  std::vector<Vec3> places;
  std::vector<int> node_of;
  for (std::size_t i = 0; i < cells.points.size(); ++i) {
    if (cells.made[i] != 0) continue;
    if (cells.used[i] == 0) {
      free.add(0.0, node_name(cells, static_cast<int>(i)));
      continue;
    }
    places.push_back(cells.points[i]);
    node_of.push_back(static_cast<int>(i));
  }
  free.report(findings,
              {.severity = Severity::note,
               .check = "free_nodes",
               .what = "nodes that no element and no link names",
               .cure = "Nothing to do, unless they were to carry something"},
              limits.listed);

  const double distance = limits.coincident * cells.diagonal;
  std::vector<std::array<int, 2>> ties = cells.ties;
  for (auto& [a, b] : ties)
    if (a > b) std::swap(a, b);
  std::sort(ties.begin(), ties.end());
  Places apart, tied;
  for (const auto& [p, q] : coincident_pairs(places, distance)) {
    const int a = node_of[static_cast<std::size_t>(p)], b = node_of[static_cast<std::size_t>(q)];
    const std::array<int, 2> pair{std::min(a, b), std::max(a, b)};
    (std::binary_search(ties.begin(), ties.end(), pair) ? tied : apart)
        .add(0.0, fmt::format("nodes {} and {}", cells.ids[static_cast<std::size_t>(pair[0])],
                              cells.ids[static_cast<std::size_t>(pair[1])]));
  }
  apart.report(findings,
               {.severity = Severity::warning,
                .check = "coincident_nodes",
                .what = "pairs of nodes at one place that nothing ties to each other directly; they are kept apart",
                .limit = distance,
                .cure = "Join them in the mesh or by a rigid link where the part is to be whole there"},
               limits.listed);
  tied.report(findings,
              {.severity = Severity::note,
               .check = "coincident_tied_nodes",
               .what = "pairs of nodes at one place, tied by an element or a link",
               .limit = distance,
               .cure = ""},
              limits.listed);
}

void check_parts(const Cells& cells, const CheckLimits& limits, std::vector<Finding>& findings) {
  Parts parts(cells.points.size());
  for (const auto& [a, b] : cells.ties) parts.join(a, b);
  std::map<int, long> size;  // root → nodes
  for (std::size_t i = 0; i < cells.points.size(); ++i)
    if (cells.used[i] != 0) ++size[parts.root(static_cast<int>(i))];
  if (size.size() < 2) return;
  Places islands;
  for (const auto& [root, nodes] : size)
    islands.add(static_cast<double>(nodes), fmt::format("{} ({})", node_name(cells, root), counted(nodes, "node")));
  islands.report(findings,
                 {.severity = Severity::error,
                  .check = "parts",
                  .what = "parts that no element and no link connects, each by its first node",
                  .value = static_cast<double>(size.size()),
                  .limit = 1.0,
                  .cure = "Join them (coincident nodes are not merged), or make each a body of its own"},
                 limits.listed);
}

void check_duplicates(const Cells& cells, const CheckLimits& limits, std::vector<Finding>& findings) {
  struct Key {
    int kind, size;
    std::array<int, 4> nodes;
    std::array<int, 2> property;
    std::size_t cell;
    auto operator<=>(const Key&) const = default;
    bool same_place(const Key& o) const { return kind == o.kind && size == o.size && nodes == o.nodes; }
  };
  std::vector<Key> keys;
  for (std::size_t c = 0; c < cells.cells.size(); ++c) {
    const Cell& cell = cells.cells[c];
    if (cell.size < 2) continue;
    Key key{cell.kind, cell.size, cell.corners, cell.property, c};
    std::sort(key.nodes.begin(), key.nodes.begin() + cell.size);
    keys.push_back(key);
  }
  std::sort(keys.begin(), keys.end());
  Places same, other;
  for (std::size_t k = 1; k < keys.size(); ++k) {
    if (!keys[k].same_place(keys[k - 1])) continue;
    const Cell &a = cells.cells[keys[k - 1].cell], &b = cells.cells[keys[k].cell];
    (a.property == b.property ? same : other).add(0.0, fmt::format("elements {} and {}", a.id, b.id));
  }
  same.report(findings,
              {.severity = Severity::error,
               .check = "duplicate_elements",
               .what = "pairs of elements on the same nodes with the same properties: mass and stiffness count twice",
               .cure = "Take one of each pair out of the file"},
              limits.listed);
  other.report(findings,
               {.severity = Severity::warning,
                .check = "elements_on_same_nodes",
                .what = "pairs of elements on the same nodes with different properties",
                .cure = "Nothing to do where one lies on the other on purpose"},
               limits.listed);
}

}  // namespace tenon::fem::checks
