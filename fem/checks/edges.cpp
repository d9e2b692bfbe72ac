#include <fmt/format.h>

#include <algorithm>

#include "fem/checks/cells.hpp"

namespace tenon::fem::checks {
namespace {

/// A side of a shell; `forward` when the shell runs from the lower node to the higher.
struct Side {
  std::array<int, 2> nodes;
  std::size_t cell;
  bool forward;
  auto operator<=>(const Side&) const = default;
};

std::vector<Side> sides_of(const Cells& cells) {
  std::vector<Side> sides;
  for (std::size_t c = 0; c < cells.cells.size(); ++c) {
    const Cell& cell = cells.cells[c];
    for (int i = 0; cell.size > 2 && i < cell.size; ++i) {
      const int a = cell.corners[static_cast<std::size_t>(i)],
                b = cell.corners[static_cast<std::size_t>((i + 1) % cell.size)];
      if (a != b) sides.push_back({{std::min(a, b), std::max(a, b)}, c, a < b});
    }
  }
  std::sort(sides.begin(), sides.end());
  return sides;
}

}  // namespace

void check_edges(const Cells& cells, const CheckLimits& limits, std::vector<Finding>& findings) {
  const std::vector<Side> sides = sides_of(cells);
  const auto edge_name = [&](const Side& side) {
    return fmt::format("nodes {}-{} of element {}", cells.ids[static_cast<std::size_t>(side.nodes[0])],
                       cells.ids[static_cast<std::size_t>(side.nodes[1])], cells.cells[side.cell].id);
  };
  Places free, turned, junctions, seams;
  std::vector<const Side*> open;
  for (std::size_t k = 0, next = 0; k < sides.size(); k = next) {
    while (next < sides.size() && sides[next].nodes == sides[k].nodes) ++next;
    if (next - k == 1) {
      free.add(0.0, edge_name(sides[k]));
      open.push_back(&sides[k]);
    } else if (next - k > 2) {
      junctions.add(static_cast<double>(next - k), edge_name(sides[k]));
    } else if (sides[k].forward == sides[k + 1].forward) {
      turned.add(0.0,
                 fmt::format("elements {} and {}", cells.cells[sides[k].cell].id, cells.cells[sides[k + 1].cell].id));
    }
  }
  // A free edge that lies on another one with other nodes: a seam that was not sewn. Middles meet there.
  std::vector<Vec3> middles;
  for (const Side* side : open)
    middles.push_back(0.5 * (cells.points[static_cast<std::size_t>(side->nodes[0])] +
                             cells.points[static_cast<std::size_t>(side->nodes[1])]));
  const auto length = [&](const Side& side) {
    return (cells.points[static_cast<std::size_t>(side.nodes[1])] -
            cells.points[static_cast<std::size_t>(side.nodes[0])])
        .norm();
  };
  const double distance = limits.coincident * cells.diagonal;
  for (const auto& [a, b] : coincident_pairs(middles, distance)) {
    const Side &one = *open[static_cast<std::size_t>(a)], &other = *open[static_cast<std::size_t>(b)];
    const Vec3 &p = cells.points[static_cast<std::size_t>(one.nodes[0])],
               &q = cells.points[static_cast<std::size_t>(other.nodes[0])],
               &r = cells.points[static_cast<std::size_t>(other.nodes[1])];
    if (std::min((p - q).norm(), (p - r).norm()) <= 2.0 * distance && length(one) > 2.0 * distance)
      seams.add(0.0, fmt::format("{} and {}", edge_name(one), edge_name(other)));
  }
  free.report(
      findings,
      {.severity = Severity::note, .check = "free_edges", .what = "sides that belong to one shell alone", .cure = ""},
      limits.listed);
  seams.report(findings,
               {.severity = Severity::warning,
                .check = "open_seams",
                .what = "pairs of free edges at one place: the shells touch there but are not joined",
                .limit = distance,
                .cure = "Give both sides the same nodes where the part is to be whole"},
               limits.listed);
  junctions.report(
      findings,
      {.severity = Severity::note, .check = "junctions", .what = "edges where more than two shells meet", .cure = ""},
      limits.listed);
  turned.report(findings,
                {.severity = Severity::warning,
                 .check = "normals",
                 .what = "pairs of neighbouring shells whose normals point to opposite sides",
                 .cure = "Turn one of each pair around, where offsets, layers or pressure tell its sides apart"},
                limits.listed);
}

}  // namespace tenon::fem::checks
