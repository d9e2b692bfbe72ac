#pragma once

#include "fem/elements/element_matrices.hpp"
#include "fem/model.hpp"

namespace tenon::fem {

/// k [1 −1; −1 1] between two dofs, or k at one dof (1×1) for a spring to ground. Throws ModelError for negative k.
void spring_matrices(const Spring& spring, ElementMatrices& out);

}  // namespace tenon::fem
