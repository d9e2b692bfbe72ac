#pragma once

#include <array>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <unordered_map>
#include <vector>

#include "fem/mesh.hpp"

/// What a .msh file says, before it becomes a Mesh.
namespace tenon::fem::gmsh {

/// One of Gmsh's element types: vtk_order[i] is the place in Gmsh's node list of the cell's node i.
struct ElementType {
  int number = 0;
  CellType type = CellType::vertex;
  std::array<std::uint8_t, 27> vtk_order{};
};

/// By Gmsh's number; nullptr for types this project has no cell for (orders above two, polyhedra).
const ElementType* element_type(int number);

/// File's node numbers → indices. Memory stays proportional to the file, however large the numbers are.
class NodeNumbers {
 public:
  explicit NodeNumbers(std::size_t file_bytes) : dense_limit_(static_cast<std::int64_t>(file_bytes / 8)) {}
  /// False when the number is taken already.
  bool insert(std::int64_t number, int index);
  /// −1 when there is no such node.
  int find(std::int64_t number) const {
    if (number >= 0 && number < static_cast<std::int64_t>(dense_.size()))
      return dense_[static_cast<std::size_t>(number)];
    if (number < dense_limit_ || sparse_.empty()) return -1;
    const auto found = sparse_.find(number);
    return found == sparse_.end() ? -1 : found->second;
  }

 private:
  std::int64_t dense_limit_;
  std::vector<int> dense_;
  std::unordered_map<std::int64_t, int> sparse_;
};

/// Dimension and tag: of a physical group or of an entity of the geometry.
using DimTag = std::pair<int, int>;

/// In the place of a group list: the entity only divides the mesh for parallel runs, its cells are no part of the body.
inline constexpr int no_body = -1;

/// All cells of one type, in the order of the file.
struct Cells {
  CellType type = CellType::vertex;
  std::vector<int> nodes;  ///< indices, VTK's order
  std::vector<long> ids;
  std::vector<int> groups;  ///< index into Content::group_lists, one a cell
};

/// $NodeData or $ElementData: one step of one field.
struct Field {
  std::string name;
  bool on_nodes = true;
  int components = 1;
  std::vector<long> ids;
  std::vector<double> values;  ///< `components` an id
  std::size_t offset = 0;      ///< where the section starts, for messages
};

struct Content {
  explicit Content(std::size_t file_bytes) : numbers(file_bytes) {}

  double version = 0.0;
  bool binary = false;
  std::vector<Vec3> points;
  std::vector<long> point_ids;
  NodeNumbers numbers;
  std::vector<Cells> cells;  ///< one a type, in order of first appearance
  std::map<DimTag, std::string> physical_names;
  std::vector<std::vector<int>> group_lists{{}};  ///< distinct lists of physical tags; the first is empty
  std::optional<std::map<DimTag, int>> entities;  ///< entity → group list, once $Entities was read (4.x)
  std::vector<Field> fields;
  std::map<std::string, Loss> losses;

  /// The cells of a type, made when there are none yet.
  Cells& cells_of(CellType type);
  /// Index of a list of physical tags.
  int group_list(std::vector<int> tags);
  /// Counts something read past without effect.
  void lose(const std::string& name, long count, const std::string& note);

 private:
  std::array<int, 19> slots_ = [] {
    std::array<int, 19> none{};
    none.fill(-1);
    return none;
  }();
  std::map<std::vector<int>, int> list_index_{{{}, 0}};
};

/// Puts points, cells, sets and data together. MSH 2 writes a cell once for every physical group it is in: those are
/// merged (`merge_repeated`). Throws InputError when data names nodes or cells that are not there.
Mesh make_mesh(Content&& content, const std::string& source);

}  // namespace tenon::fem::gmsh
