#pragma once

#include <span>

#include "fem/elements/element_matrices.hpp"
#include "fem/model.hpp"

namespace tenon::fem {

/// Stiffness and mass of a two-node Timoshenko beam, 12×12: exact for loads at its ends, any section (I_yz ≠ 0),
/// rigid end offsets, released ends; mass by `beam.mass` (see BeamMass). κ = 0 is rigid in shear (Euler-Bernoulli).
/// I_yz = ∫ y z dA in the section's axes: x along the beam, y in the plane of the orientation vector.
/// @param nodes  positions of all nodes of the model [m]
/// @throws ModelError naming the element: zero length, orientation along the axis, E, A ≤ 0, a negative or
///         impossible second moment, no shear modulus where one is needed, negative mass, a mechanism by releases.
/// Source: Przemieniecki, Theory of Matrix Structural Analysis, 1968, §5.6, §11.4 (one plane); here both planes at
/// once.
void beam_matrices(const Beam& beam, const BeamSection& section, const Material& material, std::span<const Vec3> nodes,
                   ElementMatrices& out);

/// Geometric stiffness 12×12 of the axial force N that the displacement u causes, with the shapes of `beam_matrices`:
///   N ∫ v' v'ᵀ dx over both bending planes and N (Iy + Iz)/A ∫ φ'² dx in torsion (Wagner).
/// Shear forces and moments are left out, and so is the second-order rotation of the offsets. A rigid rotation θ is
/// answered by the end forces ±N x̂ turned with it, ±N θ × x̂.
/// @param u  the element's 12 displacements, basic frame  @throws ModelError as above
/// Source: Przemieniecki, Theory of Matrix Structural Analysis, chapter 15 (one plane, κ = 0).
void beam_geometric_stiffness(const Beam& beam, const BeamSection& section, const Material& material,
                              std::span<const Vec3> nodes, const Eigen::Ref<const Eigen::VectorXd>& u,
                              ElementMatrices::Matrix& out);

}  // namespace tenon::fem
