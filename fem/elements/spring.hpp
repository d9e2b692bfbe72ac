#pragma once

#include "fem/elements/element_matrices.hpp"
#include "fem/model.hpp"

namespace tenon::fem {

/// k b bᵀ, b·u the elongation: over the dof of each end, or its three displacements or rotations where the end has an
/// axis of its own; 1 to 6 rows, node a first. Throws ModelError for negative k.
void spring_matrices(const Spring& spring, ElementMatrices& out);

}  // namespace tenon::fem
