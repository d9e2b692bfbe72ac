#pragma once

#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "fem/spatial.hpp"

namespace tenon::fem {

/// Cell kinds with meshio's names; node order is VTK's.
enum class CellType {
  vertex,
  line,
  line3,
  triangle,
  triangle6,
  quad,
  quad8,
  quad9,
  tetra,
  tetra10,
  hexahedron,
  hexahedron20,
  hexahedron27,
  wedge,
  wedge15,
  wedge18,
  pyramid,
  pyramid13,
  pyramid14
};

std::string_view name(CellType type);
int node_count(CellType type);
/// 0 vertex, 1 line, 2 surface, 3 solid.
int dimension(CellType type);

/// Cells of one kind, in the order of the file: `nodes` holds node_count(type) indices into Mesh::points a cell.
struct CellBlock {
  CellType type = CellType::vertex;
  std::vector<int> nodes;
  std::vector<long> ids;  ///< the file's own cell numbers, one a cell

  int size() const { return static_cast<int>(nodes.size()) / node_count(type); }
};

/// What a reader read past without effect, by name and count; `note` says what it would have meant.
struct Loss {
  std::string name;
  long count = 0;
  std::string note;
  bool changes_physics = false;  ///< stiffness or mass would silently change: an error unless the user allows it
};

/// Note of a loss: cells that no element here carries, solids above all.
inline constexpr const char* own_matrices =
    "no element of this program carries it; the K and M that the program that owns the part makes of it can be used "
    "instead (`matrices:` in a scene)";

/// meshio's data model. A set's cells are indices within each block: cell_sets[name][block].
struct Mesh {
  std::string source;           ///< file name, for messages
  std::string format;           ///< e.g. "gmsh 4.1 binary"
  std::vector<Vec3> points;     ///< in the file's length unit
  std::vector<long> point_ids;  ///< the file's own node numbers
  std::vector<CellBlock> cells;
  std::map<std::string, std::vector<int>> point_sets;
  std::map<std::string, std::vector<std::vector<int>>> cell_sets;
  std::map<std::string, std::pair<int, int>> field_data;          ///< name → (tag, dimension)
  std::map<std::string, Eigen::MatrixXd> point_data;              ///< one row a point
  std::map<std::string, std::vector<Eigen::MatrixXd>> cell_data;  ///< one array a block, one row a cell
  std::vector<Loss> losses;
};

/// Points of a named set: the point set of that name, else all points of the cells of the cell set of that name,
/// sorted. Throws InputError naming near misses when there is neither.
std::vector<int> points_of_set(const Mesh& mesh, const std::string& set);

/// Names of all sets, point sets first, each once.
std::vector<std::string> set_names(const Mesh& mesh);

/// The candidate nearest in spelling (edit distance at most a third of its length), or "" when none is near.
std::string near_miss(const std::string& word, const std::vector<std::string>& candidates);

}  // namespace tenon::fem
