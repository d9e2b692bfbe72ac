#pragma once

#include "fem/model.hpp"

/// Section constants of common shapes, closed forms. Lengths in metres; ν for the shear coefficients of Cowper (1966).
/// y is the direction of the orientation vector: `b` runs along y, `h` along z. All throw ModelError for sizes that
/// make no section.
namespace tenon::fem {

/// Solid circle of radius r. κ = 6(1+ν)/(7+6ν), J = πr⁴/2.
BeamSection circle(double r, double nu);

/// Circular tube of outer and inner radius. With m = r_i/r_o: κ = 6(1+ν)(1+m²)²/[(7+6ν)(1+m²)² + (20+12ν)m²].
BeamSection tube(double outer, double inner, double nu);

/// Solid rectangle. κ = 10(1+ν)/(12+11ν); J by Saint-Venant's series, to round-off.
BeamSection rectangle(double b, double h, double nu);

/// Rectangular box of outer sizes b, h and uniform wall t. J by Bredt's formula, κ by Cowper's thin-walled box: both
/// thin-wall approximations, O(t/b).
BeamSection box(double b, double h, double t, double nu);

/// The same section, rigid in shear: κ → ∞ (Euler-Bernoulli).
BeamSection rigid_in_shear(BeamSection section);

}  // namespace tenon::fem
