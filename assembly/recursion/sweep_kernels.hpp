#pragma once

/// Inner loops of the recursions. Columns of six are padded to eight and columns over modes to a multiple of eight, so
/// that each fills whole vector registers; the padding stays zero. R is 3×3 by columns, 6-vectors are linear first.
namespace tenon::assembly {

inline constexpr int pad = 8;
/// Length of a column over n modes.
constexpr int padded(int n) { return (n + pad - 1) / pad * pad; }

/// Memory that a kernel asks for while it works, so many cache lines with each mode: all at once would stall it.
struct Ahead {
  const double* from = nullptr;
  int lines = 0;
};

/// A revolute hinge between nodes that do not deform.
struct PlainHinge {
  const double *inner_axes, *outer_axes;  ///< 3×3 each: the hinge frame in the parent's and in the body's axes
  const double *to_node, *own_node;       ///< from the references of the parent and of the body, 3
  const double* h;                        ///< 6
};
/// Pose (R, then r), twist and inertial rate of it without χ̇.
struct BodyMotion {
  double *world, *V, *alpha_bias;
};

struct SweepKernels {
  /// P_ff += Π_tᵀ Γ Π_t (lower half), P_rf += φ Γ Π_t: a child's inertia onto its parent's n modes.
  /// @param Gamma  8×6, about node t  @param Pi  6×n  @param Pi_T  padded×6, its transpose  @param l  node t, 3
  /// @param P_ff  padded×n  @param P_rf  8×n
  void (*add_child_modes)(int n, const double* Gamma, const double* Pi, const double* Pi_T, const double* l,
                          double* P_ff, double* P_rf);
  /// D_f = L Lᵀ in place (strict lower half; 1/L_jj in `inverse`), X = μ L⁻ᵀ in place, P_R −= X Xᵀ, eq (63) with
  /// g μᵀ = X Xᵀ. Returns the first mode whose pivot falls to `least` of its diagonal or below, −1 when none does.
  int (*eliminate_modes)(int n, double least, double* D, double* inverse, double* X, double* P_R, Ahead ahead);
  /// y ← L⁻¹ y, z += X y (8): ε_f into what the hinge feels.
  void (*lower_sweep)(int n, const double* L, const double* inverse, const double* X, double* y, double* z,
                      Ahead ahead);
  /// y ← L⁻ᵀ (y − Xᵀ α): η̈ = ν_f − g* α_R.
  void (*upper_sweep)(int n, const double* L, const double* inverse, const double* X, const double* alpha, double* y,
                      Ahead ahead);
  /// z_f += Π_tᵀ f over n modes.
  void (*add_mode_forces)(int n, const double* Pi_T, const double* f, double* z_f);

  /// P (8×6) ← M_rr, whose columns stand `height` apart.
  void (*copy_inertia)(const double* M_rr, int height, double* P);
  /// U = P_R h of one hinge axis and P_a = P_R a (8 each). Returns D = h*P_R h + `extra`.
  double (*take_out_axis)(const double* P_R, const double* h, const double* a, double extra, double* U, double* P_a);
  /// P_to += X* (P − U U*/D) X: a symmetric inertia about the origin of frame F, in its axes, onto that about T, in T's
  /// (8×6 each, of P the lower triangle is read). U may be null.
  /// @param R  F's axes in T's  @param l  F's origin from T, in T's axes
  void (*carry_inertia)(const double* P, const double* U, double inverse_D, const double* R, const double* l,
                        double* P_to);
  /// z_R = z + P_a, ε = T − h·z_R, z_R⁺ = z_R + G ε, carried: z_to += X* z_R⁺. Returns ε.
  double (*carry_force)(const double* z, const double* P_a, const double* h, const double* G, double T, const double* R,
                        const double* l, double* z_to);
  /// α⁺ = X α_from, β̇ = ν − G·α⁺, α = α⁺ + h β̇ + a. Returns β̇.
  double (*carry_rate)(const double* alpha_from, const double* R, const double* l, const double* h, const double* G,
                       double nu, const double* a, double* alpha);
  /// Pose X of a body over the parent's node, its motion and a_mR from its parent's, eqs (45), (25), across a hinge
  /// turned to (cos θ, sin θ) at the rate β.
  void (*hang)(const PlainHinge& hinge, double cosine, double sine, double beta, const BodyMotion& parent, double* X,
               double* a, const BodyMotion& body);
  /// b_m of a rigid body with mass matrix M (6×6), eq (37).
  void (*rigid_load)(const double* M, const double* V, double* b);
};

/// The fastest this processor has (AVX-512, AVX2 with FMA, or plain).
const SweepKernels& sweep_kernels();

}  // namespace tenon::assembly
