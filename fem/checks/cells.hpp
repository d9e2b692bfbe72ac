#pragma once

#include <array>
#include <functional>
#include <span>
#include <string>
#include <vector>

#include "fem/model_check.hpp"

/// What the checks of a mesh and of a model share: nodes, cells by their corners, and what else ties nodes together.
namespace tenon::fem::checks {

/// A point, line or shell by its corners; solids only count for what they connect (size 0, see Ties).
struct Cell {
  std::array<int, 4> corners{};
  int size = 0;  ///< 1 point, 2 line, 3 triangle, 4 quad
  long id = 0;
  int kind = 0;                   ///< cells of two kinds are no duplicates of each other
  std::array<int, 2> property{};  ///< section, material
};

struct Cells {
  std::vector<Vec3> points;
  std::vector<long> ids;  ///< < 0: made here, not of the file
  std::vector<Cell> cells;
  std::vector<std::array<int, 2>> ties;  ///< pairs of nodes that move together or act on each other
  std::vector<char> used;                ///< nodes that an element or a link names
  std::vector<char> made;                ///< nodes that are no place of the mesh (scalar points, nodes of ports)
  double diagonal = 0.0;                 ///< of the box of all points [m]
};

Cells cells_of(const Mesh& mesh);
Cells cells_of(const Model& model);

/// Places of one check gathered; the finding names the worst of them.
class Places {
 public:
  /// `badness`: the larger the worse.
  void add(double badness, std::string where) { list_.push_back({badness, std::move(where)}); }
  bool empty() const { return list_.empty(); }
  double worst() const;
  /// Adds the finding when there is any place.
  void report(std::vector<Finding>& findings, Finding finding, int listed);

 private:
  struct Place {
    double badness;
    std::string where;
  };
  std::vector<Place> list_;
};

/// "2 nodes", "1 node".
std::string counted(long n, const char* thing);

void check_nodes(const Cells& cells, const CheckLimits& limits, std::vector<Finding>& findings);
void check_parts(const Cells& cells, const CheckLimits& limits, std::vector<Finding>& findings);
void check_duplicates(const Cells& cells, const CheckLimits& limits, std::vector<Finding>& findings);
void check_shapes(const Cells& cells, const CheckLimits& limits, std::vector<Finding>& findings);
void check_supports(const Model& model, const CheckLimits& limits, std::vector<Finding>& findings);
void check_masses(const Model& model, const CheckLimits& limits, std::vector<Finding>& findings);
void check_curvature(const Model& model, const CheckLimits& limits, std::vector<Finding>& findings);
void check_edges(const Cells& cells, const CheckLimits& limits, std::vector<Finding>& findings);

/// Pairs (a, b), a < b, no further apart than `distance`; n at one place make n − 1 pairs. O(n log n).
std::vector<std::array<int, 2>> coincident_pairs(std::span<const Vec3> points, double distance);

}  // namespace tenon::fem::checks
