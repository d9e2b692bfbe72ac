#pragma once

#include <array>
#include <string>
#include <vector>

#include "fem/structure.hpp"

namespace tenon::reduction {

/// Names of the six directions.
inline constexpr std::array<const char*, 6> directions{"ux", "uy", "uz", "rx", "ry", "rz"};

/// Which rows of K and M belong to which port.
struct Partition {
  int parent = 0;                         ///< index of the parent port
  std::vector<std::array<int, 6>> ports;  ///< row of each direction, −1 where the node has no such dof
  std::vector<int> held;                  ///< rows of the parent port
  std::vector<int> children;              ///< rows of all other ports, in port order (empty when they are left free)
  std::vector<int> interior;              ///< all other rows, ascending
};

/// Splits the rows of a structure; with `children_free` the other ports' rows count as interior.
/// Throws ModelError for an unknown parent port, a parent port without dofs, or two ports at one node.
Partition partition(const fem::Structure& structure, const std::string& parent, bool children_free);

/// Throws ModelError naming dofs when some rows have no stiffness path (K_ij ≠ 0) to the parent port.
void require_stiffness_path(const fem::Structure& structure, const Partition& parts);

/// Throws ModelError naming dofs when the structure resists a rigid motion (columns of R): it is held to the ground.
/// @returns what rounding leaves of forces, of what cancels in the worst row
double require_free_body(const fem::Structure& structure, const Eigen::MatrixXd& R);

}  // namespace tenon::reduction
