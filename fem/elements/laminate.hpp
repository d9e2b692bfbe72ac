#pragma once

#include "fem/model.hpp"

/// Classical lamination theory with transverse shear.
namespace tenon::fem {

/// [N; M] = [A B; B D] [ε; κ], Q = shear γ, about the middle surface, engineering shear strains, in the section's axes.
///   A, B, D = Σ ∫ Q̄ (1, z, z²) dz, Q̄ the ply's plane-stress stiffness turned by its angle      (Reddy, Mechanics of
///   Laminated Composite Plates and Shells (2004), 3.3.40)
/// Shear, per direction i, from the equilibrium of cylindrical bending (Whitney, J. Appl. Mech. 40 (1973) 302):
///   f(z) = −∫ Q̄_ii (ζ − z_n) dζ / ∫ Q̄_ii (ζ − z_n)² dζ,   1/S_ii = ∫ f²/Ḡ_ii dz,   z_n the neutral axis        (1)
/// S_12 = √(k_1 k_2) Σ Ḡ_12 t with k_i = S_ii / Σ Ḡ_ii t. One isotropic ply has k = 5/6.
struct LaminateStiffness {
  Mat3 A;                 ///< [N/m]
  Mat3 B;                 ///< [N]
  Mat3 D;                 ///< [N m]
  Eigen::Matrix2d shear;  ///< [N/m]; zero stands for rigid
  double thickness;       ///< [m]
  double mass;            ///< Σρt, without non-structural mass [kg/m²]
  double first_moment;    ///< Σ∫ρz dz [kg/m]
  double second_moment;   ///< Σ∫ρz² dz [kg]
};

/// @throws ModelError naming the ply: thickness, E or G12 ≤ 0, ν₁₂² ≥ E₁/E₂, one of G13, G23 zero alone, negative mass
LaminateStiffness laminate(const ShellSection& section);

/// T of ε' = T ε for axes turned by `angle` about the normal, engineering shear; stiffnesses turn as Tᵀ Q T.
Mat3 strain_rotation(double angle);
/// The same for the two transverse shears.
Eigen::Matrix2d shear_rotation(double angle);

}  // namespace tenon::fem
