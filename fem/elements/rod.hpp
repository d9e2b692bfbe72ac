#pragma once

#include <span>

#include "fem/elements/element_matrices.hpp"
#include "fem/model.hpp"

namespace tenon::fem {

/// Stiffness and mass of a bar that bears axial force and torque alone, 12×12, exact for loads at its ends:
///   K = EA/L [X −X; −X X] on displacements, GJ/L [X −X; −X X] on rotations, X = x̂ x̂ᵀ.
/// Mass m = (ρA + nsm) L, per end and between the ends, along | across the axis:
///   consistent  1/3, 1/6   | 1/3, 1/6    linear shapes; axial frequencies from above, error (kL)²/24
///   high_order  5/12, 1/12 | 1/3, 1/6    lumped and consistent averaged: axial error O((kL)⁴); rigid mass exact
///   nastran     5/12, 1/12 | 1/2, 0      COUPMASS of CROD, no inertia in torsion
/// Torsion has the axial numbers with ρ (Iy + Iz) L in place of m. Lumped masses are point masses at the nodes.
/// @param nodes  positions of all nodes of the model [m]
/// @throws ModelError naming the element: no length, neither area nor torsion constant, moduli that are needed and not
///         positive, a negative constant or mass.
/// Source: Przemieniecki, Theory of Matrix Structural Analysis, 1968, §5.5, §11.3; MSC.Nastran, Basic Dynamic Analysis
/// User's Guide, chapter 2 (lumped and coupled mass of a rod).
void rod_matrices(const Rod& rod, const BeamSection& section, const Material& material, std::span<const Vec3> nodes,
                  ElementMatrices& out);

/// Geometric stiffness 12×12 of the axial force N = EA x̂·(u₂ − u₁)/L that the displacement u causes:
///   N/L [1−X, X−1; X−1, 1−X] on displacements, N (Iy + Iz)/(A L) [X −X; −X X] on rotations (Wagner).
/// A rigid rotation θ is answered by the end forces ±N θ × x̂.  @param u  12 displacements, basic frame
/// Source: Przemieniecki, chapter 15.
void rod_geometric_stiffness(const Rod& rod, const BeamSection& section, const Material& material,
                             std::span<const Vec3> nodes, const Eigen::Ref<const Eigen::VectorXd>& u,
                             ElementMatrices::Matrix& out);

}  // namespace tenon::fem
