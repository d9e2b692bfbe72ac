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
/// Stress that comes from the modes' own inertia or deformation is left out. Wallrapp, Mech. Struct. Mach. 22 (1994)
/// 327.
struct GeometricStiffness {
  Eigen::MatrixXd K_G;  ///< n²×(12 + 6 ports): column a is K_G,a column by column

  static constexpr int inertia_loads = 12;
};

/// Σ_a γ_a K_G,a, n×n, without heap allocation.
/// @param a         linear acceleration of the reference less gravity [m/s²]
/// @param alpha     angular acceleration [rad/s²]
/// @param omega     [rad/s]
/// @param wrenches  6 per port on the body, in the body frame; null: none
void geometric_stiffness(const GeometricStiffness& stiffening, const Vec3& a, const Vec3& alpha, const Vec3& omega,
                         const double* wrenches, Eigen::Ref<Eigen::MatrixXd> K_G);

/// Sizes agree with the body's modes and ports, numbers are finite; throws ModelError.
void check(const GeometricStiffness& stiffening, const ReducedBody& body);

}  // namespace tenon::reduction
