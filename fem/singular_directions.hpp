#pragma once

#include <string>
#include <vector>

#include "fem/structure.hpp"

namespace tenon::fem {

/// A direction in which a node's own 3×3 block of K, of its translations or its rotations, has next to no stiffness:
/// moving that node alone costs nothing.
struct SingularDirection {
  int node = 0;
  bool rotation = false;
  Vec3 direction;      ///< unit, in the basic frame
  double ratio = 0.0;  ///< vᵀ K_node v over the block's trace
};

/// Those below `limit`, node by node. Directions that are no rows of K count as stiff.
std::vector<SingularDirection> singular_directions(const Structure& structure, double limit);

/// "node 7 uz", "node 7 ry"; "node 7 translation along (0.6, 0.8, 0)"; "port tip rx" of a node that a port has made.
std::string name(const Structure& structure, const SingularDirection& direction);

/// Holds them, as Nastran's AUTOSPC does, but exactly: where a direction is no axis Nastran holds the axis nearest to
/// it, which stiffens. Nodes of ports are left free. @returns what was held: supports along axes, else constraints
std::vector<std::string> hold_singular_directions(Model& model, const Structure& structure, double limit);

}  // namespace tenon::fem
