#pragma once

/// Inner loops of the recursions over the modes of one body. Columns of six are padded to eight and columns over modes
/// to a multiple of eight, so that each fills whole vector registers; the padding stays zero.
namespace tenon::assembly {

inline constexpr int pad = 8;
/// Length of a column over n modes.
constexpr int padded(int n) { return (n + pad - 1) / pad * pad; }

struct SweepKernels {
  /// P_ff += Π_tᵀ Γ Π_t (lower half), P_rf += φ Γ Π_t: a child's inertia onto its parent's n modes.
  /// @param Gamma  8×6, about node t  @param Pi  8×n  @param Pi_T  padded×6, its transpose  @param l  node t, 3
  /// @param P_ff  padded×n  @param P_rf  8×n
  void (*add_child_modes)(int n, const double* Gamma, const double* Pi, const double* Pi_T, const double* l,
                          double* P_ff, double* P_rf);
  /// D_f = L Lᵀ in place (strict lower half; 1/L_jj in `inverse`), X = μ L⁻ᵀ in place, P_R −= X Xᵀ, eq (63) with
  /// g μᵀ = X Xᵀ. Returns the first mode whose pivot falls to `least` of its diagonal or below, −1 when none does.
  int (*eliminate_modes)(int n, double least, double* D, double* inverse, double* X, double* P_R);
  /// y ← L⁻¹ y, z += X y (8): ε_f into what the hinge feels.
  void (*lower_sweep)(int n, const double* L, const double* inverse, const double* X, double* y, double* z);
  /// y ← L⁻ᵀ (y − Xᵀ α): η̈ = ν_f − g* α_R.
  void (*upper_sweep)(int n, const double* L, const double* inverse, const double* X, const double* alpha, double* y);
  /// z_f += Π_tᵀ f over n modes.
  void (*add_mode_forces)(int n, const double* Pi_T, const double* f, double* z_f);

  /// P_to += X* P X: a symmetric inertia about the origin of frame F, in its axes, onto that about T, in T's (6×6
  /// each).
  /// @param R  3×3, F's axes in T's  @param r  F's origin from T, in T's axes
  void (*carry_inertia)(const double* P, const double* R, const double* r, double* P_to);
  /// h*P_R h + `extra` of one hinge axis; G = P_R h/D, P⁺ = P_R − G D G*.
  double (*take_out_axis)(const double* P_R, const double* h, double extra, double* G, double* P_plus);
  /// z_R += P_R a, ε = T − h·z_R, z_R⁺ = z_R + G ε. Returns ε.
  double (*hinge_sweep)(const double* P_R, const double* a, const double* h, const double* G, double T, double* z);
};

/// The fastest this processor has (AVX-512, AVX2 with FMA, or plain).
const SweepKernels& sweep_kernels();

}  // namespace tenon::assembly
