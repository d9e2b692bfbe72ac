#pragma once

#include <vector>

#include "fem/model.hpp"

namespace tenon::fem {

/// Rotations of nodes that only rods hold, in directions that none of them turns about: they have neither stiffness nor
/// mass, and no element of K tells which combination of rx, ry, rz it is when the rods are askew. One equation
/// v·θ = 0 for each such unit vector v; none where v is an axis, which assembly drops by itself. Nothing of K and M
/// changes by them.
std::vector<LinearConstraint> loose_rotations(const Model& model);

}  // namespace tenon::fem
