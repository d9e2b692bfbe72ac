#pragma once

#include <span>

#include "fem/elements/element_matrices.hpp"
#include "fem/model.hpp"

namespace tenon::fem {

/// Stiffness of springs that act at a point P between nodes A and B, 12×12, or 6×6 from A to ground. What P does as a
/// part of either node is τ(P−A) u_a and τ(P−B) u_b; with C = blkdiag(R, R) diag(k) blkdiag(R, R)ᵀ, R = `axes`,
///   K = [τ_aᵀ C τ_a, −τ_aᵀ C τ_b; −τ_bᵀ C τ_a, τ_bᵀ C τ_b].
/// Rigid motions u = τ(A−O) w, τ(B−O) w meet in τ(P−O) w at P: K R = 0 wherever nodes and P lie. No mass.
/// @param nodes  positions of all nodes of the model [m]
/// @throws ModelError naming the element: a stiffness that is negative or not finite, axes not orthonormal, a node
///         without a place.
void bush_matrices(const Bush& bush, std::span<const Vec3> nodes, ElementMatrices& out);

}  // namespace tenon::fem
