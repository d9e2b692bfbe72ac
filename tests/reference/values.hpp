#pragma once

#include <array>

/// Values to test against, each with its source. None of them comes from this project's own output.
namespace tenon::reference {

/// End conditions: c clamped, f free, p pinned, s sliding; roots βL of the Euler-Bernoulli beam (zeros of its
/// characteristic equation, e.g. cos β cosh β = ±1, tan β = tanh β), rigid-body modes not counted.
struct EndConditions {
  char left, right;
  int rigid;
  std::array<double, 3> roots;
};
inline constexpr double pi = 3.14159265358979323846;
inline constexpr std::array<EndConditions, 10> euler_bernoulli_roots{{
    {'c', 'f', 0, {1.875104068712, 4.694091132974, 7.854757438238}},
    {'c', 'c', 0, {4.730040744863, 7.853204624096, 10.995607838002}},
    {'f', 'f', 2, {4.730040744863, 7.853204624096, 10.995607838002}},
    {'c', 'p', 0, {3.926602312048, 7.068582745629, 10.210176122813}},
    {'f', 'p', 1, {3.926602312048, 7.068582745629, 10.210176122813}},
    {'p', 'p', 0, {pi, 2 * pi, 3 * pi}},
    {'s', 's', 1, {pi, 2 * pi, 3 * pi}},
    {'p', 's', 0, {pi / 2, 3 * pi / 2, 5 * pi / 2}},
    {'c', 's', 0, {2.365020372431, 5.497803919001, 8.639379828700}},
    {'f', 's', 1, {2.365020372431, 5.497803919001, 8.639379828700}},
}};

/// NAFEMS Selected Benchmarks for Natural Frequency Analysis (Abbassian, Dawswell, Knowles 1987), test FV2 [Hz].
inline constexpr std::array<double, 16> fv2{11.3362, 17.7094, 17.7094, 17.7094, 17.7094, 17.7094, 17.7094, 17.7094,
                                            45.3450, 57.3897, 57.3897, 57.3897, 57.3897, 57.3897, 57.3897, 57.3897};
/// NAFEMS FV4 [Hz].
inline constexpr std::array<double, 6> fv4{1.723, 1.727, 7.413, 9.972, 18.155, 26.957};
/// SDLS03 (Guide de validation des progiciels de calcul de structures, SFM 1990): (π/2)(m²/a² + n²/b²) √(D/ρh) [Hz].
inline constexpr std::array<double, 6> sdls03{35.626, 68.512, 109.620, 123.322, 142.506, 197.315};
/// SDLS106 (the same guide), 2.0 m × 1.5 m: the same closed form [Hz].
inline constexpr std::array<double, 5> sdls106{17.128, 35.626, 50.014, 66.457, 68.512};
/// NAFEMS FV12 with modes 7–9 as converged Kirchhoff solutions (the printed 4.233 and 7.416 are few-term Ritz bounds)
/// [Hz].
inline constexpr std::array<double, 8> fv12{1.62165, 2.35950, 2.92228, 4.19024, 4.19024, 7.35600, 7.35600, 7.66821};
/// NAFEMS FV16 as converged Kirchhoff solutions (the printed values are few-term Ritz upper bounds) [Hz].
inline constexpr std::array<double, 6> fv16{0.41795, 1.02430, 2.56294, 3.27493, 3.72749, 6.52473};

}  // namespace tenon::reference
