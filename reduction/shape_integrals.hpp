#pragma once

#include <Eigen/Core>
#include <span>
#include <vector>

#include "fem/structure.hpp"
#include "reduction/reduced_body.hpp"

namespace tenon::reduction {

/// Order of the six entries of a symmetric 3×3 matrix.
inline constexpr int symmetric_row[6] = {0, 1, 2, 0, 0, 1};
inline constexpr int symmetric_column[6] = {0, 1, 2, 1, 2, 2};

/// (xx, yy, zz, xy, xz, yz) as a matrix, and back.
inline Mat3 symmetric3(const Eigen::Ref<const fem::Vec6>& a) {
  return (Mat3() << a[0], a[3], a[4], a[3], a[1], a[5], a[4], a[5], a[2]).finished();
}
inline fem::Vec6 packed(const Mat3& A) { return {A(0, 0), A(1, 1), A(2, 2), A(0, 1), A(0, 2), A(1, 2)}; }

/// What the rotary inertia of lumped nodes adds to the velocity terms of (31), (37) of the spatial-operator paper,
///   Σ_j [ω_j × J_j ω_j + J_j (ω × θ_j η̇)], ω_j = ω + θ_j η̇, and its projections on θ_ji, summed over the nodes.
struct NodeGyroscopics {
  Mat3 J = Mat3::Zero();  ///< Σ J_j [kg m²], part of the body's J0
  Eigen::Matrix3Xd C0;    ///< 3×n: Σ J_j θ_ji, part of the body's C0
  Eigen::Matrix3Xd A;     ///< 3×3n: blocks A_i = Σ θ̃_ji J_j; A_i + A_iᵀ joins ∂J/∂η_i in b, not in M_m
  Eigen::MatrixXd T;      ///< 3n×n: rows 3i.., column k: t_ik = Σ θ_ji × J_j θ_jk
  Eigen::MatrixXd B;  ///< 3n×n: rows 3i.., column k: b_ik = Σ J_j (θ_ji × θ_jk); ½ (b_ik − t_ik + t_ki) joins c_ki
  Eigen::MatrixXd U;  ///< n²×n: row i n + k, column l: Σ θ_ji · (θ_jk × J_j θ_jl)
};

/// What deformation does to a body's mass matrix (NUMERICS 4b): with s0, J0, m in `ReducedBody::D` and [Sᵀ C0ᵀ] in
/// `ReducedBody::L`, all about the body's reference and in its axes,
///   s(η) = s0 + S η,   J(η) = J0 + Σ η_i (J1_i + ½ J2_ik η_k),   C(η)_i = C0_i + Σ η_k c_ki,
///   M_m(η) = [1 Sᵀ C(η)ᵀ; S m −s̃(η); C(η) s̃(η) J(η)] over (η, x_ref), linear part first; eq (23).
/// Shabana, Dynamics of Multibody Systems, §5.2 (inertia shape integrals); Wallrapp, Mech. Struct. Mach. 22 (1994) 283.
struct ShapeIntegrals {
  Eigen::MatrixXd J1;     ///< 6×n: ∂J/∂η_i at η = 0 [√kg m], as (xx, yy, zz, xy, xz, yz)
  Eigen::MatrixXd J2;     ///< 6n×n: rows 6i.., column k: ∂²J/∂η_i∂η_k, alike; symmetric in i, k
  Eigen::MatrixXd C1;     ///< 3n×n: rows 3i.., column k: c_ki = Σ m ψ_k × ψ_i; antisymmetric in i, k
  NodeGyroscopics nodes;  ///< empty: none

  int n() const { return static_cast<int>(J1.cols()); }
  bool has_nodes() const { return nodes.A.cols() > 0; }
};

/// A node with its rigid body.
struct LumpedNode {
  Vec3 position = Vec3::Zero();  ///< in the body frame [m]
  double mass = 0.0;             ///< [kg]
  Vec3 offset = Vec3::Zero();    ///< p, from the node to the centre of mass [m]
  Mat3 inertia = Mat3::Zero();   ///< J_j about the centre of mass [kg m²]
};

/// From lumped nodes: the sums of NUMERICS 4b. A node with an offset p is first carried to its centre of mass, where
/// its shape is ψ − p̃ θ; from there on exactly (23), (28), (31), (37) of the spatial-operator paper. J_j turns with its
/// node in b but not in M_m there, so d/dt ½ V_mᵀM_mV_m misses the power Σ J_j ω_j · (ω × θ_j η̇) when nodes have
/// inertia.
/// @param shapes  6N×n, [ψ; θ] node by node [1/√kg, 1/√kg m]
ShapeIntegrals shape_integrals(std::span<const LumpedNode> nodes, const Eigen::Ref<const Eigen::MatrixXd>& shapes,
                               const Vec3& reference);

/// From the mass matrix of a finite-element model: J(η) = R(η)ᵀ M R(η), C(η) = R(η)ᵀ M Π with the rotations about the
/// deformed body R(η)_c = R_c + E_c Π η, E_c = e_c × on every node's translations and rotations (a node's inertia turns
/// with it). Exact for M = M̂ ⊗ 1₃; an element that interpolates its directions differently (axial linear, transverse
/// cubic) errs by O((h/λ)²), h its length, λ the mode's wavelength. Mass hung on a rigid link of length r errs by r θ.
/// @param shapes  n_free×n, over the rows of `structure.M`
ShapeIntegrals shape_integrals(const fem::Structure& structure, const Eigen::Ref<const Eigen::MatrixXd>& shapes,
                               const Vec3& reference);

/// The integrals of the shapes ψ_k' = Σ_i V_ik (ψ_i − Φ_i,lin − Φ_i,ang × (x − x_Q)), θ_k' alike, the reference moved
/// to x_Q: `rebase` for what large motion adds. All of them are second moments of mass, which m, s0, J0, S, C0, J1, J2,
/// C1 and the tensors of the nodes hold, so nothing is lost when they come from lumped nodes; from a finite-element
/// mass matrix they keep the error they had.
/// @param body  before it is rebased, with integrals  @param Phi  6×n motion of the shapes at x_Q
ShapeIntegrals rebased(const ReducedBody& body, const Vec3& x_Q, const Mat6X& Phi, const Eigen::MatrixXd& V);

/// Sizes agree with the body's modes and numbers are finite; throws ModelError.
void check(const ShapeIntegrals& integrals, const ReducedBody& body);

}  // namespace tenon::reduction
