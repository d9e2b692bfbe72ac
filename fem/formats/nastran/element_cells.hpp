#pragma once

#include <array>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "fem/mesh.hpp"

namespace tenon::fem::nastran {

/// The mesh's blocks of cells while they grow, one a cell type, with their sets.
class ElementCells {
 public:
  static constexpr std::array<CellType, 6> types{CellType::line,   CellType::quad,  CellType::triangle,
                                                 CellType::vertex, CellType::quad8, CellType::triangle6};

  /// @param block  of `types`  @param id  of the element  @param set  the name of its property, empty: none
  template <class Nodes>
  void add(std::size_t block, const Nodes& nodes, long id, const std::string& set) {
    if (!set.empty()) sets_[set][block].push_back(static_cast<int>(blocks_[block].ids.size()));
    blocks_[block].nodes.insert(blocks_[block].nodes.end(), nodes.begin(), nodes.end());
    blocks_[block].ids.push_back(id);
  }

  void finish(Mesh& mesh) {
    for (std::size_t b = 0; b < blocks_.size(); ++b) {
      if (blocks_[b].ids.empty()) continue;
      blocks_[b].type = types[b];
      mesh.cells.push_back(std::move(blocks_[b]));
      for (auto& [name, cells] : sets_) mesh.cell_sets[name].push_back(std::move(cells[b]));
    }
  }

 private:
  std::array<CellBlock, types.size()> blocks_;
  std::map<std::string, std::array<std::vector<int>, types.size()>> sets_;
};

}  // namespace tenon::fem::nastran
