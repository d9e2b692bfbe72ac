#pragma once

#include "fem/elements/element_matrices.hpp"
#include "fem/model.hpp"

namespace tenon::fem {

/// Mass matrix of a lumped mass with offset and inertia about its node, 6×6 (K = 0): the rigid mass matrix of
/// spatial.hpp.
/// @throws ModelError naming the element: negative or non-finite mass, inertia that is not symmetric and positive
///         semi-definite.
void point_mass_matrices(const PointMass& point, ElementMatrices& out);

}  // namespace tenon::fem
