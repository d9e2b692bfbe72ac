#pragma once

namespace tenon::titop {

/// Mode i = 1, 2, ... of the uniform clamped-free Euler-Bernoulli beam over 0 ≤ ξ = x/l ≤ 1, eq (13) of the TITOP paper
/// scaled to ∫φ² dξ = 1 and φ(1) = 2:
///   φ(ξ) = s [−cos βξ + σ sin βξ + c e^{−βξ} + s c e^{−β(1−ξ)}],  s = (−1)^{i+1},
/// which neither overflows nor cancels for any i. On the roots of cos β cosh β = −1 the ratio of (13) is
/// σ = tanh(β/2)^s, and c = (1 + σ)/2 = 1/(1 + s e^{−β}).
struct ClampedFreeMode {
  double beta;   ///< β_i l; the frequency is β² √(EI/(ρA l⁴))
  double sigma;  ///< σ
  double c;      ///< weight of both exponentials
  double s;      ///< ±1

  double value(double xi) const;  ///< φ(ξ)
  double slope(double xi) const;  ///< dφ/dξ

  // closed forms of ERRATA, exact for the mode
  double mean() const { return s * 2.0 * sigma / beta; }     ///< ∫φ dξ
  double moment() const { return s * 2.0 / (beta * beta); }  ///< ∫ξφ dξ
  double tip() const { return 2.0; }                         ///< φ(1)
  double tip_slope() const { return 2.0 * beta * sigma; }    ///< φ′(1)
};

/// The i-th mode, i ≥ 1; β to round-off.
ClampedFreeMode clamped_free_mode(int i);

}  // namespace tenon::titop
