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

/// Chebbi, Dubanchet, Perez Gonzalez, Alazard, "Linear dynamics of flexible multibody systems", Table 1 (G_f,pol) and
/// Tables 3–11: first two frequencies of the quintic beam [√(EI/(ρSl⁴))] with the last printed digit, and the channels
/// inverted (1 F_C, 2 T_C, 3 F_P, 4 T_P). Ends P, C. `r`: internal state constraints of appendix 2, with the one it
/// does not list (sliding-sliding: ṽ′(l) = 0).
struct QuinticTable {
  const char* name;
  char P, C;
  std::array<int, 4> inverted;  // 0: none
  int rigid, r;
  double first, second, digit_first, digit_second;
};
inline constexpr std::array<QuinticTable, 11> quintic_tables{{
    {"Table1ClampedFree", 'c', 'f', {0, 0, 0, 0}, 0, 0, 3.5160, 22.158, 1e-4, 1e-3},
    {"Table1FreeClamped", 'f', 'c', {1, 2, 3, 4}, 0, 0, 3.5160, 22.158, 1e-4, 1e-3},
    {"Table3FreeFree", 'f', 'f', {3, 4, 0, 0}, 2, 0, 22.564, 63.537, 1e-3, 1e-3},
    {"Table4ClampedClamped", 'c', 'c', {1, 2, 0, 0}, 0, 2, 22.45, 62.929, 1e-2, 1e-3},
    {"Table5PinnedFree", 'p', 'f', {4, 0, 0, 0}, 1, 0, 15.445, 51.206, 1e-3, 1e-3},
    {"Table6PinnedClamped", 'p', 'c', {1, 2, 4, 0}, 0, 1, 15.433, 50.724, 1e-3, 1e-3},
    {"Table7PinnedPinned", 'p', 'p', {1, 4, 0, 0}, 0, 0, 9.8725, 39.646, 1e-4, 1e-3},
    {"Table8SlidingFree", 's', 'f', {3, 0, 0, 0}, 1, 0, 5.5934, 30.734, 1e-4, 1e-3},
    {"Table9SlidingClamped", 's', 'c', {1, 2, 3, 0}, 0, 1, 5.5933, 30.561, 1e-4, 1e-3},
    {"Table10SlidingPinned", 's', 'p', {1, 3, 0, 0}, 0, 0, 2.4674, 22.272, 1e-4, 1e-3},
    {"Table11SlidingSliding", 's', 's', {2, 3, 0, 0}, 1, 1, 9.8697, 40.988, 1e-4, 1e-3},
}};

/// The inverse of the model G_f,n of n clamped-free modes, its free-clamped frequencies [√(EI/(ρSl⁴))]: computed by
/// channel inversion and by a null space outside this project, agreeing to 1e-10. The paper's Table 1 prints other
/// figures for n = 4, 8, 16, which its own formulas do not give.
struct ClampedFreeInverse {
  int modes;
  double first, second;
};
inline constexpr std::array<ClampedFreeInverse, 3> clamped_free_inverse{
    {{4, 4.38953, 28.0194}, {8, 3.90783, 24.5951}, {16, 3.70260, 23.2275}}};

/// (βl)² of a clamped beam with a tip mass m = ρAl: zeros of 1 + cos β cosh β + β (cos β sinh β − sin β cosh β).
inline constexpr std::array<double, 5> tip_mass_one{1.557298, 16.250085, 50.895843, 105.198276, 179.232020};

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
