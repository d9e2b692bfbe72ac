#pragma once

#include <Eigen/Core>

#include "reduction/reduced_body.hpp"
#include "reduction/shape_integrals.hpp"

namespace tenon::reduction {

/// How much of a body's nonlinearity is kept.
enum class Nonlinearity {
  full,      ///< M_m(η), b_m(η, η̇, ω)
  ruthless,  ///< M_m(0), b_m(0, 0, ω): deformation dropped, eqs (75)–(78) of the spatial-operator paper
  rigid      ///< no modes at all
};

/// M_m and b_m of one body, f_m = M_m α_m + b_m + K_m η (eq (36)), over (η, x_ref), x_ref linear part first; α_m = (η̈,
/// inertial acceleration of the reference), all components in the body frame. With J_i = J1_i + J2_ik η_k:
///   b_f,i = −½ ωᵀ J_i ω + 2 ω · Σ_k η̇_k c_ki
///   b_v   = ω × (ω × s) + 2 ω × S η̇
///   b_w   = Σ_i η̇_i J_i ω + ω × (J ω + C η̇)
/// and the terms of `NodeGyroscopics` when there are any. Without them b_m follows from M_m(η) by the equations of
/// Boltzmann and Hamel, so that d/dt ½ V_mᵀM_mV_m is the power of f_m − K_m η exactly; that is also why b_m has no v.
///
/// `ruthless` keeps the centrifugal load −½ ωᵀ J1_i ω on the modes, which depends on neither η nor η̇. Without
/// integrals both `full` and `ruthless` give M_m(0) and b_f = 0. `rigid`: M is 6×6, b has 6 rows, η is not read.
///
/// No heap allocation. @param eta, eta_dot  n values  @param omega  ω of the reference [rad/s]
/// @param M  (n+6)×(n+6), both triangles written  @param b  n+6
void body_terms(const ReducedBody& body, const ShapeIntegrals* integrals, Nonlinearity nonlinearity, const double* eta,
                const double* eta_dot, const Vec3& omega, Eigen::Ref<Eigen::MatrixXd> M, Eigen::Ref<Eigen::VectorXd> b);

/// The b of `ruthless` alone, whose M stays M_m(0): b_f,i = −½ ωᵀ J1_i ω − ωᵀ A_i ω (0 without integrals),
/// b_v = ω × (ω × s0), b_w = ω × J0 ω. No heap allocation. @param b  n+6, or 6 for a rigid body
void ruthless_gyroscopics(const ReducedBody& body, const ShapeIntegrals* integrals, const Vec3& omega,
                          Eigen::Ref<Eigen::VectorXd> b);

}  // namespace tenon::reduction
