#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <span>

#include "fem/error.hpp"
#include "fem/formats/gmsh/content.hpp"

namespace tenon::fem::gmsh {
namespace {

/// A cell that stands for the same type and nodes as an earlier one of its block.
struct Repeat {
  int cell = 0;
  int first = 0;
};

/// The nodes of a cell, sorted.
std::span<const int> sorted_nodes(const Cells& cells, int cell, std::array<int, 27>& buffer) {
  const auto width = static_cast<std::size_t>(node_count(cells.type));
  std::copy_n(cells.nodes.begin() + static_cast<std::ptrdiff_t>(static_cast<std::size_t>(cell) * width), width,
              buffer.begin());
  std::sort(buffer.begin(), buffer.begin() + static_cast<std::ptrdiff_t>(width));
  return {buffer.data(), width};
}

std::uint64_t hash(std::span<const int> nodes) {
  std::uint64_t h = 0;
  for (const int node : nodes) {  // a step of splitmix64 for each node
    h += static_cast<std::uint64_t>(node) + 0x9e3779b97f4a7c15U;
    h = (h ^ (h >> 30)) * 0xbf58476d1ce4e5b9U;
    h = (h ^ (h >> 27)) * 0x94d049bb133111ebU;
    h ^= h >> 31;
  }
  return h;
}

/// Cells on the same nodes as an earlier cell, by ascending number; hashes first, nodes where hashes agree.
std::vector<Repeat> repeats(const Cells& cells) {
  const int n = static_cast<int>(cells.ids.size());
  std::array<int, 27> a{}, b{};
  std::vector<std::pair<std::uint64_t, int>> keys(cells.ids.size());
  for (int c = 0; c < n; ++c) keys[static_cast<std::size_t>(c)] = {hash(sorted_nodes(cells, c, a)), c};
  std::sort(keys.begin(), keys.end());
  std::vector<Repeat> found;
  for (std::size_t first = 0, i = 1; i < keys.size(); ++i) {
    if (keys[i].first != keys[first].first) {
      first = i;
    } else if (std::ranges::equal(sorted_nodes(cells, keys[first].second, a), sorted_nodes(cells, keys[i].second, b))) {
      found.push_back({keys[i].second, keys[first].second});
    }
  }
  std::sort(found.begin(), found.end(), [](const Repeat& x, const Repeat& y) { return x.cell < y.cell; });
  return found;
}

/// Counts what cells on the nodes of another cell mean. In a file that repeats a cell for each of its groups, a cell
/// given twice in one group may also have been meant as two: which one, the file cannot say.
void report(const std::vector<Repeat>& repeated, const Cells& cells, bool one_copy_per_group, Content& content) {
  if (repeated.empty()) return;
  const auto group = [&](int cell) { return cells.groups[static_cast<std::size_t>(cell)]; };
  const auto n = static_cast<long>(repeated.size());
  const auto twice =
      one_copy_per_group && dimension(cells.type) > 0
          ? std::ranges::count_if(repeated, [&](const Repeat& r) { return group(r.cell) == group(r.first); })
          : 0;
  if (!one_copy_per_group)
    content.lose("cells on the nodes of another cell", n, "kept as cells of their own: stiffness and mass add up");
  if (one_copy_per_group && n > twice)
    content.lose("repeated cells", n - twice,
                 "the file repeats a cell for each physical group; merged into one cell in all");
  if (twice > 0) {
    const char* const name = "cells given twice in one group";
    content.lose(name, twice,
                 "merged into one; save as version 4.1, which keeps two cells apart from two copies of one");
    content.losses.at(name).changes_physics = true;
  }
}

/// Where each cell of the file went: its index in the mesh's block.
std::vector<int> merged_places(std::size_t n, const std::vector<Repeat>& repeated) {
  std::vector<int> place(n);
  auto next = repeated.begin();
  int kept = 0;
  for (std::size_t c = 0; c < n; ++c) {
    if (next != repeated.end() && static_cast<std::size_t>(next->cell) == c)
      place[c] = place[static_cast<std::size_t>((next++)->first)];
    else
      place[c] = kept++;
  }
  return place;
}

/// Drops the repeated cells.
void drop(Cells& cells, const std::vector<Repeat>& repeated) {
  if (repeated.empty()) return;
  const auto width = static_cast<std::size_t>(node_count(cells.type));
  std::size_t kept = 0;
  auto next = repeated.begin();
  for (std::size_t c = 0; c < cells.ids.size(); ++c) {
    if (next != repeated.end() && static_cast<std::size_t>(next->cell) == c) {
      ++next;
      continue;
    }
    std::copy_n(cells.nodes.begin() + static_cast<std::ptrdiff_t>(c * width), width,
                cells.nodes.begin() + static_cast<std::ptrdiff_t>(kept * width));
    cells.ids[kept++] = cells.ids[c];
  }
  cells.nodes.resize(kept * width);
  cells.ids.resize(kept);
}

/// The name a group goes by; groups without one are called after their dimension and tag.
std::string group_name(const Content& content, const DimTag& group) {
  if (const auto named = content.physical_names.find(group); named != content.physical_names.end())
    return named->second;
  constexpr std::array<const char*, 4> dimensions{"point", "curve", "surface", "volume"};
  return fmt::format("{}_{}", dimensions[static_cast<std::size_t>(group.first)], group.second);
}

/// cell_sets by name, point_sets for names of physical points alone, field_data.
void add_sets(Mesh& mesh, const Content& content, const std::vector<std::vector<int>>& places) {
  std::map<DimTag, std::vector<std::vector<int>>> members;
  for (std::size_t b = 0; b < content.cells.size(); ++b) {
    const Cells& cells = content.cells[b];
    for (std::size_t c = 0; c < cells.groups.size(); ++c)
      for (const int tag : content.group_lists[static_cast<std::size_t>(cells.groups[c])]) {
        auto& blocks = members[{dimension(cells.type), tag}];
        blocks.resize(content.cells.size());
        blocks[b].push_back(places[b][c]);
      }
  }
  std::map<std::string, int> highest;  // dimension of each name
  for (auto& [group, blocks] : members) {
    const std::string name = group_name(content, group);
    auto& set = mesh.cell_sets[name];
    set.resize(content.cells.size());
    for (std::size_t b = 0; b < blocks.size(); ++b) {
      set[b].insert(set[b].end(), blocks[b].begin(), blocks[b].end());
      std::sort(set[b].begin(), set[b].end());
      set[b].erase(std::unique(set[b].begin(), set[b].end()), set[b].end());
    }
    mesh.field_data[name] = {group.second, group.first};
    highest[name] = group.first;  // groups come by ascending dimension
  }
  for (const auto& [name, dimension] : highest)
    if (dimension == 0) mesh.point_sets[name] = points_of_set(mesh, name);
  for (const auto& [group, name] : content.physical_names)
    if (!members.contains(group))
      mesh.losses.push_back({fmt::format("physical group '{}'", name), 1, "no cell of the file is in it"});
}

std::string free_name(const auto& taken, const std::string& name) {
  std::string candidate = name;
  for (int step = 2; taken.contains(candidate); ++step) candidate = fmt::format("{} (step {})", name, step);
  return candidate;
}

/// NaN where the file gives no value.
Eigen::MatrixXd no_values(std::size_t rows, int columns) {
  return Eigen::MatrixXd::Constant(static_cast<Eigen::Index>(rows), columns, std::numeric_limits<double>::quiet_NaN());
}

Eigen::RowVectorXd values_of(const Field& field, std::size_t i) {
  return Eigen::Map<const Eigen::RowVectorXd>(field.values.data() + i * static_cast<std::size_t>(field.components),
                                              field.components);
}

[[noreturn]] void fail_unknown(const Mesh& mesh, const Field& field, long id) {
  throw InputError(
      {mesh.source},
      fmt::format("${}Data '{}' (at byte offset {}) gives a value for {} {}, which the file does not define",
                  field.on_nodes ? "Node" : "Element", field.name, field.offset, field.on_nodes ? "node" : "element",
                  id),
      "Write mesh and data together");
}

void add_point_data(Mesh& mesh, const Content& content, const Field& field) {
  Eigen::MatrixXd data = no_values(mesh.points.size(), field.components);
  for (std::size_t i = 0; i < field.ids.size(); ++i) {
    const int point = content.numbers.find(field.ids[i]);
    if (point < 0) fail_unknown(mesh, field, field.ids[i]);
    data.row(point) = values_of(field, i);
  }
  mesh.point_data[free_name(mesh.point_data, field.name)] = std::move(data);
}

using CellPlaces = std::unordered_map<long, std::pair<std::size_t, int>>;  ///< file's number → block, cell

void add_cell_data(Mesh& mesh, const CellPlaces& where, const Field& field) {
  std::vector<Eigen::MatrixXd> data;
  for (const CellBlock& block : mesh.cells) data.push_back(no_values(block.ids.size(), field.components));
  for (std::size_t i = 0; i < field.ids.size(); ++i) {
    const auto place = where.find(field.ids[i]);
    if (place == where.end()) fail_unknown(mesh, field, field.ids[i]);
    data[place->second.first].row(place->second.second) = values_of(field, i);
  }
  mesh.cell_data[free_name(mesh.cell_data, field.name)] = std::move(data);
}

}  // namespace

Mesh make_mesh(Content&& content, const std::string& source) {
  Mesh mesh;
  mesh.source = source;
  mesh.format = fmt::format("gmsh {:.1f} {}", content.version, content.binary ? "binary" : "ascii");
  mesh.points = std::move(content.points);
  mesh.point_ids = std::move(content.point_ids);

  const bool has_cell_data = std::ranges::any_of(content.fields, [](const Field& f) { return !f.on_nodes; });
  const bool one_copy_per_group = content.version < 4.0;
  std::vector<std::vector<int>> places(content.cells.size());
  CellPlaces where;
  for (std::size_t b = 0; b < content.cells.size(); ++b) {
    Cells& cells = content.cells[b];
    std::vector<Repeat> repeated = repeats(cells);
    report(repeated, cells, one_copy_per_group, content);
    if (!one_copy_per_group) repeated.clear();
    places[b] = merged_places(cells.ids.size(), repeated);
    if (has_cell_data)
      for (std::size_t c = 0; c < cells.ids.size(); ++c) where[cells.ids[c]] = {b, places[b][c]};
    drop(cells, repeated);
    mesh.cells.push_back({cells.type, std::move(cells.nodes), std::move(cells.ids)});
  }
  add_sets(mesh, content, places);
  for (const Field& field : content.fields)
    field.on_nodes ? add_point_data(mesh, content, field) : add_cell_data(mesh, where, field);
  for (const auto& [name, loss] : content.losses) mesh.losses.push_back(loss);
  return mesh;
}

}  // namespace tenon::fem::gmsh
