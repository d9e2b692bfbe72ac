#pragma once

#include <vector>

#include "fem/structure.hpp"

namespace tenon::fem {

/// Turns supports, rigid links, averaging links and linear constraints into u_full = T u_free, exactly: every equation
/// is a row Σ c u = 0, rows are reduced one after the other by the ones before (sparse Gauss-Jordan), so chains and
/// cycles of links resolve themselves. An RBE2 or MPC row gives up its dependent dof where it still can, else its
/// largest coefficient; port dofs are never given up. Rows that say nothing new are counted as redundant. `used[i]`
/// tells whether an element touches full dof i (6·node + direction); dofs neither used nor named in a constraint are
/// left out. What deserves a look stands in DofMap::notes. Throws ModelError when a row leaves only port dofs (a port
/// tied to ground or to another port).
DofMap eliminate_constraints(const Model& model, const std::vector<char>& used);

/// The 6×(3..6 per node) rows of an averaging link: u_ref = A u, the weighted least-squares rigid motion of its nodes.
/// Columns follow the set bits of each group's directions. Throws ModelError when the nodes do not determine a rigid
/// motion.
Mat6X averaging_matrix(const Model& model, const AverageLink& link);

}  // namespace tenon::fem
