#pragma once

#include <Eigen/Core>

#include "fem/structure.hpp"
#include "reduction/reduced_body.hpp"

namespace tenon::reduction {

/// Geometric stiffening K_m → K_m + Σ_a γ_a K_G,a, K_G,a = Πᵀ K_σ(stress of unit load a) Π, the body held at its
/// reference (NUMERICS 4b). Loads a, in this order:
///   0–2    linear acceleration of the reference less gravity, x y z: load −M R_t
///   3–5    angular acceleration: load −M R_rot
///   6–11   ω_x², ω_y², ω_z², ω_xω_y, ω_xω_z, ω_yω_z: load −M ω × (ω × l)
///   12 + 6p + d   wrench component d (linear first) at port p; zero at the port the body hangs by
/// Stress that comes from the modes' own inertia or deformation is left out. Wallrapp and Schwertassek, IJNME 32
/// (1991) 1833.
struct GeometricStiffness {
  Eigen::MatrixXd K;  ///< (n+3)²×(12 + 6 ports): column a is [Π R]ᵀ K_σ [Π R] column by column, R the rigid
                      ///< rotations about the reference; its leading n×n part is K_G,a
  Mat6 spin = Mat6::Zero();  ///< columns: resultants at the reference of loads 6–11 [N, N m]

  static constexpr int inertia_loads = 12;
};

/// Σ_a γ_a K_G,a, n×n, without heap allocation.
/// @param a         linear acceleration of the reference less gravity [m/s²]
/// @param alpha     angular acceleration [rad/s²]
/// @param omega     [rad/s]
/// @param wrenches  6 per port on the body, in the body frame; null: none
void geometric_stiffness(const GeometricStiffness& stiffening, const Vec3& a, const Vec3& alpha, const Vec3& omega,
                         const double* wrenches, Eigen::Ref<Eigen::MatrixXd> K_G);

/// From the elements' stress: static responses of the body, held at its reference, to the unit loads; then K_σ of each
/// (`fem::geometric_stiffness`), projected on the body's node shapes. One factorisation and a solve per load.
/// @param model      the one `structure` was assembled from
/// @param structure  the one `body` was reduced from
/// @param body       cantilever, with its node shapes; a rigid body gives an empty result
/// @throws ModelError when they do not belong together or a part can move without strain
GeometricStiffness geometric_stiffness(const fem::Model& model, const fem::Structure& structure,
                                       const ReducedBody& body);

/// The same of the body hung by another of its ports, its shapes (Π − R Φ_Q) V: exact, for stresses of bodies held
/// elsewhere differ by a wrench at the new port, and K_σ of rigid motions is kept with the shapes'.
/// @param body  before it is rebased, with stiffening  @param V  n×n
GeometricStiffness rebased_stiffness(const ReducedBody& body, int port, const Eigen::MatrixXd& V);

/// Sizes agree with the body's modes and ports, numbers are finite; throws ModelError.
void check(const GeometricStiffness& stiffening, const ReducedBody& body);

}  // namespace tenon::reduction
