#pragma once

#include <array>
#include <map>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "fem/formats/vtk/values.hpp"
#include "fem/mesh.hpp"

namespace tenon::fem::vtk {

/// A Mesh of VTK's arrays, piece after piece, each [points, cells, data]: one block of cells a type, nodes in a Mesh's
/// order; points and cells numbered from 0. Its functions throw ArrayFault.
class Grid {
 public:
  explicit Grid(Mesh& mesh) : mesh_(mesh) { places_.fill(-1); }

  /// `x` holds n points [x, y, z].
  void add_points(const Values& x, std::size_t n);
  /// n cells of the last points: the nodes of cell c stand in `nodes` before ends[c].
  void add_cells(const Values& nodes, const Values& ends, const Values& types, std::size_t n);
  /// Data of the last n points or cells.
  void add_data(bool of_cells, const std::string& name, const Values& values, std::size_t n);
  /// A set of the last points or cells, by their places among them; sets of one name are joined.
  void add_set(bool of_cells, const std::string& name, const Values& members);
  /// Hands the data to the mesh. Whole numbers, one a cell, make cell sets, up to 256 values an array; what a piece
  /// lacks is NaN. Throws InputError for a mesh without points or cells.
  void finish();

 private:
  void make_sets(const std::string& name, const Eigen::MatrixXd& values);

  Mesh& mesh_;
  std::size_t first_point_ = 0, first_cell_ = 0;        ///< of the last points and cells
  std::array<int, 19> places_{};                        ///< CellType → block
  std::vector<std::pair<int, int>> cells_;              ///< file's cell → block, cell
  std::map<std::string, std::vector<double>> rows_[2];  ///< point and cell data, row by row
  std::map<std::string, std::size_t> widths_[2];        ///< components
  std::set<std::string> whole_;                         ///< cell data of whole numbers
};

}  // namespace tenon::fem::vtk
