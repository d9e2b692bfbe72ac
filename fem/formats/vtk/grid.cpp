#include "fem/formats/vtk/grid.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <limits>

#include "fem/error.hpp"

namespace tenon::fem::vtk {
namespace {

/// A VTK cell as a cell of a Mesh, whose node i is VTK's node order[i]; an empty order is VTK's own.
struct Kind {
  int number = 0;
  CellType type = CellType::vertex;
  std::array<std::uint8_t, 8> order{};
};

/// Source: vtkCellType.h; pixel (8) and voxel (11) count along the axes.
constexpr std::array<Kind, 20> kinds{{{1, CellType::vertex},
                                      {3, CellType::line},
                                      {21, CellType::line3},
                                      {5, CellType::triangle},
                                      {22, CellType::triangle6},
                                      {9, CellType::quad},
                                      {23, CellType::quad8},
                                      {28, CellType::quad9},
                                      {10, CellType::tetra},
                                      {24, CellType::tetra10},
                                      {12, CellType::hexahedron},
                                      {25, CellType::hexahedron20},
                                      {29, CellType::hexahedron27},
                                      {13, CellType::wedge, {0, 2, 1, 3, 5, 4}},
                                      {26, CellType::wedge15},
                                      {32, CellType::wedge18},
                                      {14, CellType::pyramid},
                                      {27, CellType::pyramid13},
                                      {8, CellType::quad, {0, 1, 3, 2}},
                                      {11, CellType::hexahedron, {0, 1, 3, 2, 4, 5, 7, 6}}}};

[[noreturn]] void fail(const std::string& what, const std::string& cure = "Write it again") {
  throw ArrayFault{what, cure};
}

}  // namespace

void Grid::add_points(const Values& x, std::size_t n) {
  first_point_ = mesh_.points.size();
  first_cell_ = cells_.size();
  if (x.size() != 3 * n) fail(fmt::format("found {} coordinates for {} points", x.size(), n));
  if (first_point_ + n > static_cast<std::size_t>(std::numeric_limits<int>::max())) fail("has more than 2^31 points");
  for (std::size_t i = 0; i < n; ++i) {
    mesh_.points.emplace_back(x.at(3 * i), x.at(3 * i + 1), x.at(3 * i + 2));
    mesh_.point_ids.push_back(static_cast<long>(first_point_ + i));
    if (!mesh_.points.back().allFinite()) fail(fmt::format("point {} is not finite", first_point_ + i));
  }
}

void Grid::add_cells(const Values& nodes, const Values& ends, const Values& types, std::size_t n) {
  const std::size_t n_points = mesh_.points.size() - first_point_;
  if (nodes.real || ends.real || types.real) fail("found cells made of reals, expected whole numbers");
  if (ends.size() != n || types.size() != n)
    fail(fmt::format("found {} offsets and {} types for {} cells", ends.size(), types.size(), n));
  std::int64_t start = 0;
  for (std::size_t c = 0; c < n; ++c) {
    const auto kind = std::ranges::find(kinds, types.whole[c], &Kind::number);
    if (kind == kinds.end())
      fail(fmt::format("cell {} has VTK's type {}, which is not read", cells_.size(), types.whole[c]),
           "Convert it to lines, triangles, quadrilaterals or solids of first or second order");
    const int width = node_count(kind->type);
    if (ends.whole[c] < 0 || ends.whole[c] > std::ssize(nodes.whole) || ends.whole[c] - start != width)
      fail(fmt::format("cell {} ends at {} after {}, expected {} nodes of a {}", cells_.size(), ends.whole[c], start,
                       width, name(kind->type)));
    int& place = places_[static_cast<std::size_t>(kind->type)];
    if (place < 0) {
      place = static_cast<int>(mesh_.cells.size());
      mesh_.cells.push_back({kind->type, {}, {}});
    }
    CellBlock& block = mesh_.cells[static_cast<std::size_t>(place)];
    for (int i = 0; i < width; ++i) {
      const int from = kind->order[1] + kind->order[2] == 0 ? i : kind->order[static_cast<std::size_t>(i)];
      const std::int64_t node = nodes.whole[static_cast<std::size_t>(start + from)];
      if (node < 0 || node >= static_cast<std::int64_t>(n_points))
        fail(fmt::format("cell {} names point {} of {}", cells_.size(), node, n_points));
      block.nodes.push_back(static_cast<int>(first_point_) + static_cast<int>(node));
    }
    block.ids.push_back(static_cast<long>(cells_.size()));
    cells_.emplace_back(place, block.size() - 1);
    start = ends.whole[c];
  }
  if (start != std::ssize(nodes.whole))
    fail(fmt::format("the {} cells take {} of {} nodes in their list", n, start, nodes.size()));
}

void Grid::add_data(bool of_cells, const std::string& name, const Values& values, std::size_t n) {
  const std::size_t first = of_cells ? first_cell_ : first_point_;
  const std::size_t width = n == 0 ? 1 : values.size() / n;
  if (width * n != values.size() || (n > 0 && width == 0))
    fail(
        fmt::format("the array '{}' holds {} values for {} {}", name, values.size(), n, of_cells ? "cells" : "points"));
  if (of_cells && name == "vtkGhostType" && std::ranges::any_of(values.whole, [](auto v) { return v != 0; }))
    fail("some cells are ghosts: copies of cells of another piece, whose stiffness would count twice",
         "Save the pieces without ghost cells");
  if (n == 0) return;
  const auto [known, fresh] = widths_[of_cells].try_emplace(name, width);
  if (known->second != width)
    fail(fmt::format("the array '{}' has {} components, {} in an earlier piece", name, width, known->second));
  auto& rows = rows_[of_cells][name];
  if (rows.size() > first * width) fail(fmt::format("found a second array '{}' in this piece", name));
  rows.resize(first * width, std::numeric_limits<double>::quiet_NaN());
  for (std::size_t i = 0; i < values.size(); ++i) rows.push_back(values.at(i));
  if (of_cells && !values.real && width == 1 && fresh) whole_.insert(name);
  if (values.real) whole_.erase(name);
}

void Grid::add_set(bool of_cells, const std::string& name, const Values& members) {
  const std::size_t first = of_cells ? first_cell_ : first_point_,
                    n = (of_cells ? cells_.size() : mesh_.points.size()) - first;
  if (members.real && members.size() > 0) fail(fmt::format("the set '{}' holds reals, expected whole numbers", name));
  for (const std::int64_t member : members.whole) {
    if (member < 0 || member >= static_cast<std::int64_t>(n))
      fail(fmt::format("the set '{}' names {} of {} {}", name, member, n, of_cells ? "cells" : "points"));
    const std::size_t place = first + static_cast<std::size_t>(member);
    if (!of_cells) {
      mesh_.point_sets[name].push_back(static_cast<int>(place));
      continue;
    }
    auto& blocks = mesh_.cell_sets[name];
    blocks.resize(mesh_.cells.size());
    blocks[static_cast<std::size_t>(cells_[place].first)].push_back(cells_[place].second);
  }
}

void Grid::make_sets(const std::string& name, const Eigen::MatrixXd& values) {
  std::set<std::int64_t> distinct;
  for (const double v : values.reshaped())
    if (v == v && distinct.size() <= 256) distinct.insert(static_cast<std::int64_t>(v));
  if (distinct.size() > 256) {
    mesh_.losses.push_back({fmt::format("sets of '{}'", name), 1, "more than 256 values; it is cell data alone"});
    return;
  }
  const auto set_of = [&](std::int64_t v) { return fmt::format("{}_{}", name, v); };
  for (const std::int64_t v : distinct)
    if (mesh_.cell_sets.contains(set_of(v))) {
      mesh_.losses.push_back(
          {fmt::format("sets of '{}'", name), 1, fmt::format("'{}' is another set; it is cell data alone", set_of(v))});
      return;
    }
  for (const std::int64_t v : distinct) mesh_.cell_sets[set_of(v)].resize(mesh_.cells.size());
  for (std::size_t c = 0; c < cells_.size(); ++c) {
    const double v = values(static_cast<Eigen::Index>(c), 0);
    if (v != v) continue;
    auto& set = mesh_.cell_sets[set_of(static_cast<std::int64_t>(v))];
    set[static_cast<std::size_t>(cells_[c].first)].push_back(cells_[c].second);
  }
}

void Grid::finish() {
  using Rows = Eigen::Map<const Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>>;
  if (mesh_.points.empty() || mesh_.cells.empty())
    throw InputError({mesh_.source}, "has no points or no cells", "Save the mesh again");
  for (auto& [name, blocks] : mesh_.cell_sets) blocks.resize(mesh_.cells.size());
  for (const bool of_cells : {false, true})
    for (auto& [name, rows] : rows_[of_cells]) {
      const std::size_t width = widths_[of_cells][name], n = of_cells ? cells_.size() : mesh_.points.size();
      rows.resize(n * width, std::numeric_limits<double>::quiet_NaN());
      const Eigen::MatrixXd all = Rows(rows.data(), static_cast<Eigen::Index>(n), static_cast<Eigen::Index>(width));
      if (!of_cells) {
        mesh_.point_data[name] = all;
        continue;
      }
      auto& data = mesh_.cell_data[name];
      for (const CellBlock& block : mesh_.cells) data.emplace_back(block.size(), all.cols());
      for (std::size_t c = 0; c < cells_.size(); ++c)
        data[static_cast<std::size_t>(cells_[c].first)].row(cells_[c].second) = all.row(static_cast<Eigen::Index>(c));
      if (whole_.contains(name)) make_sets(name, all);
    }
  const auto in_order = [](std::vector<int>& set) {  // sets of one name join, a member may be named twice
    std::ranges::sort(set);
    set.erase(std::unique(set.begin(), set.end()), set.end());
  };
  for (auto& [name, set] : mesh_.point_sets) in_order(set);
  for (auto& [name, blocks] : mesh_.cell_sets) std::ranges::for_each(blocks, in_order);
}

}  // namespace tenon::fem::vtk
