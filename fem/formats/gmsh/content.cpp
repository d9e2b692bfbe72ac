#include "fem/formats/gmsh/content.hpp"

#include <algorithm>
#include <numeric>

namespace tenon::fem::gmsh {
namespace {

constexpr std::array<std::uint8_t, 27> same_order() {
  std::array<std::uint8_t, 27> order{};
  std::iota(order.begin(), order.end(), std::uint8_t{0});
  return order;
}

/// Corner nodes keep their places; `tail` gives Gmsh's places of the nodes from `first` on.
template <std::size_t n>
constexpr std::array<std::uint8_t, 27> reordered(std::size_t first, const std::array<std::uint8_t, n>& tail) {
  std::array<std::uint8_t, 27> order = same_order();
  for (std::size_t i = 0; i < n; ++i) order[first + i] = tail[i];
  return order;
}

// Gmsh numbers the edges of a solid by their lower corners, VTK face by face; node orders as in the reference manuals
// of both ("Node ordering", "vtkQuadraticHexahedron" and its siblings).
constexpr std::array<std::uint8_t, 12> hexahedron_edges{8, 11, 13, 9, 16, 18, 19, 17, 10, 12, 14, 15};
constexpr std::array<std::uint8_t, 7> hexahedron_faces{22, 23, 21, 24, 20, 25, 26};
constexpr std::array<std::uint8_t, 9> wedge_edges{6, 9, 7, 12, 14, 13, 8, 10, 11};
constexpr std::array<std::uint8_t, 3> wedge_faces{15, 17, 16};
constexpr std::array<std::uint8_t, 8> pyramid_edges{5, 8, 10, 6, 7, 9, 11, 12};
constexpr std::array<std::uint8_t, 6> tetra_edges{4, 5, 6, 7, 9, 8};

constexpr std::array<std::uint8_t, 27> hexahedron27_order() {
  std::array<std::uint8_t, 27> order = reordered(8, hexahedron_edges);
  for (std::size_t i = 0; i < hexahedron_faces.size(); ++i) order[20 + i] = hexahedron_faces[i];
  return order;
}

constexpr std::array<std::uint8_t, 27> wedge18_order() {
  std::array<std::uint8_t, 27> order = reordered(6, wedge_edges);
  for (std::size_t i = 0; i < wedge_faces.size(); ++i) order[15 + i] = wedge_faces[i];
  return order;
}

constexpr std::array<ElementType, 19> element_types{{{1, CellType::line, same_order()},
                                                     {2, CellType::triangle, same_order()},
                                                     {3, CellType::quad, same_order()},
                                                     {4, CellType::tetra, same_order()},
                                                     {5, CellType::hexahedron, same_order()},
                                                     {6, CellType::wedge, same_order()},
                                                     {7, CellType::pyramid, same_order()},
                                                     {8, CellType::line3, same_order()},
                                                     {9, CellType::triangle6, same_order()},
                                                     {10, CellType::quad9, same_order()},
                                                     {11, CellType::tetra10, reordered(4, tetra_edges)},
                                                     {12, CellType::hexahedron27, hexahedron27_order()},
                                                     {13, CellType::wedge18, wedge18_order()},
                                                     {14, CellType::pyramid14, reordered(5, pyramid_edges)},
                                                     {15, CellType::vertex, same_order()},
                                                     {16, CellType::quad8, same_order()},
                                                     {17, CellType::hexahedron20, reordered(8, hexahedron_edges)},
                                                     {18, CellType::wedge15, reordered(6, wedge_edges)},
                                                     {19, CellType::pyramid13, reordered(5, pyramid_edges)}}};

}  // namespace

const ElementType* element_type(int number) {
  return number >= 1 && number <= static_cast<int>(element_types.size())
             ? &element_types[static_cast<std::size_t>(number - 1)]
             : nullptr;
}

bool NodeNumbers::insert(std::int64_t number, int index) {
  if (number >= 0 && number < dense_limit_) {
    const auto place = static_cast<std::size_t>(number);
    if (place >= dense_.size()) {
      const std::size_t grown = std::max(place + 1, dense_.size() * 2);
      dense_.resize(std::min(grown, static_cast<std::size_t>(dense_limit_)), -1);
    }
    if (dense_[place] >= 0) return false;
    dense_[place] = index;
    return true;
  }
  return sparse_.emplace(number, index).second;
}

Cells& Content::cells_of(CellType type) {
  int& slot = slots_[static_cast<std::size_t>(type)];
  if (slot < 0) {
    slot = static_cast<int>(cells.size());
    cells.push_back({type, {}, {}, {}});
  }
  return cells[static_cast<std::size_t>(slot)];
}

int Content::group_list(std::vector<int> tags) {
  std::sort(tags.begin(), tags.end());
  tags.erase(std::unique(tags.begin(), tags.end()), tags.end());
  const auto [entry, added] = list_index_.emplace(tags, static_cast<int>(group_lists.size()));
  if (added) group_lists.push_back(std::move(tags));
  return entry->second;
}

void Content::lose(const std::string& name, long count, const std::string& note) {
  Loss& loss = losses.try_emplace(name, Loss{name, 0, note, false}).first->second;
  loss.count += count;
}

}  // namespace tenon::fem::gmsh
