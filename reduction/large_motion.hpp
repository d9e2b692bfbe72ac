#pragma once

#include "fem/structure.hpp"
#include "reduction/reduced_body.hpp"

namespace tenon::reduction {

/// Gives a body what large motion needs from its own node shapes, in whatever axes it stands: shape integrals, unless
/// it has them, and geometric stiffening. Nothing for a rigid body.
/// @param model      the one `structure` was assembled from, in the axes of the body
/// @throws ModelError what geometric_stiffness() throws
void add_large_motion(const fem::Model& model, const fem::Structure& structure, ReducedBody& body);

}  // namespace tenon::reduction
