#pragma once

#include "titop/boundary.hpp"

namespace tenon::titop {

/// The motions that a boundary leaves: x_ref = X ξ + R ρ, η = N ξ. ρ are rigid motions (eq (18) of the TITOP paper and
/// its augmented models), ξ the deformations without those that fixed ports forbid, the internal state constraints of
/// its appendix 2: with E the free directions of x_ref, F the fixed rows of the other ports and Z a basis of the left
/// null space of τ_F E, they are Zᵀ Φ_F η = 0.
struct ConstraintBasis {
  Eigen::MatrixXd N;  ///< n×(n − r), orthonormal columns
  Eigen::MatrixXd X;  ///< 6×(n − r) rigid motion that goes with a deformation, free of momentum: Rᵀ(DX + LᵀN) = 0
  Eigen::MatrixXd R;  ///< 6×rigid, mass-normalised: RᵀDR = 1
  int removed = 0;    ///< r, constraints on η: 2r states less
  int redundant = 0;  ///< fixed directions that say nothing new
};

/// Ranks are decided on lengths divided by `size_of(body)`, with a gap: singular values between 1e-12 and 1e-8 of unit
/// rows are a NumericalError, and so is a rigid motion without inertia. Throws ModelError when the boundary does not
/// fit the body.
ConstraintBasis constraint_basis(const reduction::ReducedBody& body, const Boundary& boundary);

/// A length a [m] that makes rotations and displacements comparable: the farthest port from the reference, else the
/// radius of gyration, else 1.
double size_of(const reduction::ReducedBody& body);

}  // namespace tenon::titop
