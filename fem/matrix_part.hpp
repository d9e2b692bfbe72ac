#pragma once

#include <memory>
#include <vector>

#include "fem/structure.hpp"

namespace tenon::fem {

/// A part of a model that stands as matrices: K and M of another program over dofs of the model's nodes. Nodes of
/// solids have translations only; modal coordinates are scalar points (direction 0).
struct MatrixPart {
  std::vector<Dof> dofs;   ///< the dof behind each row, none twice
  SparseMatrix K;          ///< [N/m], n×n, symmetric, lower triangle
  SparseMatrix M;          ///< [kg], n×n, symmetric, lower triangle
  double rounding = 1e-9;  ///< what the digits of K leave where rigid motions cost no force (fem/rigid_forces.hpp)
};

/// Throws ModelError for parts whose matrices, rows and nodes do not fit each other, and for dofs that stand twice.
void require_consistent_parts(const Model& model);

/// Marks the dofs (6·node + direction) in which an entry of the part's K or M is not zero.
void mark_used(const MatrixPart& part, std::vector<char>& used);

/// Tᵀ A T over the free dofs, lower triangle, A being the part's K or M. Entries between free dofs are taken as they
/// are; sparse products are formed of the others alone.
SparseMatrix over_free_dofs(const MatrixPart& part, const SparseMatrix& A, const DofMap& map);

/// The same part in a larger model: nodes counted from `first_node` on, displacements turned by R (Q A Qᵀ, a node's
/// three translations or rotations complete). `scalar[node]` of the part's own model: not turned.
std::shared_ptr<const MatrixPart> moved(const MatrixPart& part, const Mat3& R, int first_node,
                                        const std::vector<char>& scalar);

}  // namespace tenon::fem
