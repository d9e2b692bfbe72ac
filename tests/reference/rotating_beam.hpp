#pragma once

#include <array>

namespace tenon::reference {

/// Uniform Euler-Bernoulli cantilever that spins about an axis through its root, across its axis; hub radius 0, no
/// rotary inertia. λ = Ω√(ρAL⁴/EI), flap frequencies in √(EI/ρAL⁴), out of the plane of rotation; chord² = flap² − λ².
/// First modes: Wright, Smith, Thresher, Wang, J. Appl. Mech. 49 (1982) 197, table for no hub; more digits and the
/// second and third by Ritz with 14 Legendre polynomials. −1: not given.
struct RotatingBeam {
  double lambda;
  std::array<double, 3> flap;
};
inline constexpr std::array<RotatingBeam, 7> rotating_beams{{{0.0, {3.516015, 22.03449, -1.0}},
                                                             {1.0, {3.681647, -1.0, -1.0}},
                                                             {2.0, {4.137320, -1.0, -1.0}},
                                                             {4.0, {5.585001, -1.0, -1.0}},
                                                             {6.0, {7.36037, 26.80908, 66.68391}},
                                                             {8.0, {9.256838, -1.0, -1.0}},
                                                             {12.0, {13.17015, 37.60311, 79.61448}}}};

/// Standing clamped-free column under its own weight, q L³/EI: the least x with J_{-1/3}((2/3)√x) = 0 (Greenhill 1881).
inline constexpr double greenhill = 7.837347438943;

}  // namespace tenon::reference
