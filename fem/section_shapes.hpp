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

/// The same with flanges (along y) and webs (along z) of different thickness.
BeamSection box(double b, double h, double t_flange, double t_web, double nu);

/// Open sections of thin walls: A, I about the centroid exact for the rectangles they are made of, J = Σ a t³/3, κ the
/// share of the walls along the force (5/6 of it where the force bends flanges across), the shear centre by the walls'
/// middle lines: all three are thin-wall approximations, O(t/b). Webs stand along z, flanges along y.
/// Source: Young & Budynas, Roark's Formulas for Stress and Strain, 7th ed., tables 9.2, 10.2; Timoshenko, Strength of
/// Materials I, §53.

/// I of height h, flanges b × t (at −z) and b_top × t_top, web t_web.
BeamSection i_section(double h, double b, double t, double b_top, double t_top, double t_web);

/// T: one flange b × t on top of a web, overall height h.
BeamSection tee(double b, double h, double t, double t_web);

/// Channel open towards +y: flanges b × t to both sides of a web t_web, overall height h; b from the web's back.
BeamSection channel(double b, double h, double t, double t_web);

/// Angle with its corner at −y, −z: leg b × t along y and leg h × t_web along z, overall lengths.
BeamSection angle_section(double b, double h, double t, double t_web);

/// The mirror image in the line y = z: what stood along z stands along y.
BeamSection swapped_axes(BeamSection section);

/// The same section, rigid in shear: κ → ∞ (Euler-Bernoulli).
BeamSection rigid_in_shear(BeamSection section);

}  // namespace tenon::fem
