#include "fem/mesh.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <numeric>

#include "fem/error.hpp"

namespace tenon::fem {
namespace {

struct CellTraits {
  std::string_view name;
  int nodes;
  int dimension;
};

constexpr std::array<CellTraits, 19> traits{{{"vertex", 1, 0},
                                             {"line", 2, 1},
                                             {"line3", 3, 1},
                                             {"triangle", 3, 2},
                                             {"triangle6", 6, 2},
                                             {"quad", 4, 2},
                                             {"quad8", 8, 2},
                                             {"quad9", 9, 2},
                                             {"tetra", 4, 3},
                                             {"tetra10", 10, 3},
                                             {"hexahedron", 8, 3},
                                             {"hexahedron20", 20, 3},
                                             {"hexahedron27", 27, 3},
                                             {"wedge", 6, 3},
                                             {"wedge15", 15, 3},
                                             {"wedge18", 18, 3},
                                             {"pyramid", 5, 3},
                                             {"pyramid13", 13, 3},
                                             {"pyramid14", 14, 3}}};

const CellTraits& of(CellType type) { return traits[static_cast<std::size_t>(type)]; }

/// Levenshtein distance of two words.
std::size_t edit_distance(const std::string& a, const std::string& b) {
  std::vector<std::size_t> row(b.size() + 1);
  std::iota(row.begin(), row.end(), std::size_t{0});
  for (std::size_t i = 1; i <= a.size(); ++i) {
    std::size_t diagonal = row[0];
    row[0] = i;
    for (std::size_t j = 1; j <= b.size(); ++j) {
      const std::size_t substitution = diagonal + (a[i - 1] == b[j - 1] ? 0 : 1);
      diagonal = row[j];
      row[j] = std::min({row[j] + 1, row[j - 1] + 1, substitution});
    }
  }
  return row[b.size()];
}

}  // namespace

std::string_view name(CellType type) { return of(type).name; }
int node_count(CellType type) { return of(type).nodes; }
int dimension(CellType type) { return of(type).dimension; }

std::vector<std::string> set_names(const Mesh& mesh) {
  std::vector<std::string> names;
  for (const auto& [set, points] : mesh.point_sets) names.push_back(set);
  for (const auto& [set, cells] : mesh.cell_sets)
    if (!mesh.point_sets.contains(set)) names.push_back(set);
  return names;
}

std::vector<int> points_of_set(const Mesh& mesh, const std::string& set) {
  std::vector<int> points;
  if (const auto found = mesh.point_sets.find(set); found != mesh.point_sets.end()) {
    points = found->second;
  } else if (const auto cells = mesh.cell_sets.find(set); cells != mesh.cell_sets.end()) {
    for (std::size_t b = 0; b < cells->second.size(); ++b) {
      const int width = node_count(mesh.cells[b].type);
      for (const int cell : cells->second[b])
        for (int i = 0; i < width; ++i)
          points.push_back(mesh.cells[b].nodes[static_cast<std::size_t>(cell * width + i)]);
    }
  } else {
    const std::vector<std::string> names = set_names(mesh);
    const std::string near = near_miss(set, names);
    throw InputError({mesh.source}, fmt::format("there is no set '{}'", set),
                     !near.empty()   ? fmt::format("Did you mean '{}'?", near)
                     : names.empty() ? std::string("The file names no sets; name one (a physical group in Gmsh)")
                                     : fmt::format("Its sets are: {}", fmt::join(names, ", ")));
  }
  std::sort(points.begin(), points.end());
  points.erase(std::unique(points.begin(), points.end()), points.end());
  return points;
}

std::string near_miss(const std::string& word, const std::vector<std::string>& candidates) {
  std::string best;
  std::size_t best_distance = std::max<std::size_t>(1, word.size() / 3) + 1;
  for (const std::string& candidate : candidates)
    if (const std::size_t d = edit_distance(word, candidate); d < best_distance) {
      best_distance = d;
      best = candidate;
    }
  return best;
}

}  // namespace tenon::fem
