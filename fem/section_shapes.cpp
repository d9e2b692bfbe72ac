#include "fem/section_shapes.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "fem/error.hpp"

namespace tenon::fem {
namespace {

constexpr double pi = std::numbers::pi;

void require(bool good, const std::string& what) {
  if (!good) throw ModelError(what, "Correct the sizes of the section");
}

/// Saint-Venant's torsion constant of a rectangle with sides a ≥ b (Timoshenko & Goodier, art. 109):
/// J = ab³/3 [1 − (192/π⁵)(b/a) Σ_{n odd} tanh(nπa/2b)/n⁵],
/// summed as Σ 1/n⁵ = 31 ζ(5)/32 less Σ (1 − tanh)/n⁵, whose terms fall by e^{−2π} or faster.
double torsion_constant(double a, double b) {
  constexpr double zeta5 = 1.0369277551433699263;
  double sum = 31.0 * zeta5 / 32.0;
  for (int n = 1; n <= 13; n += 2) sum -= 2.0 / (std::exp(n * pi * a / b) + 1.0) / std::pow(n, 5);
  return a * b * b * b / 3.0 * (1.0 - 192.0 / std::pow(pi, 5) * b / a * sum);
}

/// Cowper's coefficient of a thin-walled box for shear along `web`: flange and web are mid-line lengths of the sides
/// across and along the force; m = flange/web for one wall thickness, n = flange/web.
double box_shear(double flange, double web, double nu) {
  const double n = flange / web, m = n, m2 = m * m, m3 = m2 * m;
  return 10.0 * (1.0 + nu) * (1.0 + 3.0 * m) * (1.0 + 3.0 * m) /
         ((12.0 + 72.0 * m + 150.0 * m2 + 90.0 * m3) + nu * (11.0 + 66.0 * m + 135.0 * m2 + 90.0 * m3) +
          10.0 * n * n * ((3.0 + nu) * m + 3.0 * m2));
}

}  // namespace

BeamSection circle(double r, double nu) {
  require(r > 0.0, fmt::format("a circular section has radius {}", r));
  const double I = pi * std::pow(r, 4) / 4.0, kappa = 6.0 * (1.0 + nu) / (7.0 + 6.0 * nu);
  return {.name = "circle", .A = pi * r * r, .Iy = I, .Iz = I, .J = 2.0 * I, .kappa_y = kappa, .kappa_z = kappa};
}

BeamSection tube(double outer, double inner, double nu) {
  require(outer > inner && inner >= 0.0, fmt::format("a tube has outer radius {} and inner radius {}", outer, inner));
  const double area = pi * (outer - inner) * (outer + inner);
  const double I = area * (outer * outer + inner * inner) / 4.0;
  const double m2 = inner * inner / (outer * outer), s = (1.0 + m2) * (1.0 + m2);
  const double kappa = 6.0 * (1.0 + nu) * s / ((7.0 + 6.0 * nu) * s + (20.0 + 12.0 * nu) * m2);
  return {.name = "tube", .A = area, .Iy = I, .Iz = I, .J = 2.0 * I, .kappa_y = kappa, .kappa_z = kappa};
}

BeamSection rectangle(double b, double h, double nu) {
  require(b > 0.0 && h > 0.0, fmt::format("a rectangular section has sides {} and {}", b, h));
  const double kappa = 10.0 * (1.0 + nu) / (12.0 + 11.0 * nu);
  return {.name = "rectangle",
          .A = b * h,
          .Iy = b * h * h * h / 12.0,
          .Iz = h * b * b * b / 12.0,
          .J = torsion_constant(std::max(b, h), std::min(b, h)),
          .kappa_y = kappa,
          .kappa_z = kappa};
}

BeamSection box(double b, double h, double t, double nu) {
  require(t > 0.0 && 2.0 * t < std::min(b, h), fmt::format("a box has outer sides {} and {} and wall {}", b, h, t));
  const double bi = b - 2.0 * t, hi = h - 2.0 * t, bm = b - t, hm = h - t;
  return {.name = "box",
          .A = b * h - bi * hi,
          .Iy = (b * h * h * h - bi * hi * hi * hi) / 12.0,
          .Iz = (h * b * b * b - hi * bi * bi * bi) / 12.0,
          .J = 2.0 * t * bm * bm * hm * hm / (bm + hm),  // Bredt: 4 A_m² t / perimeter
          .kappa_y = box_shear(hm, bm, nu),
          .kappa_z = box_shear(bm, hm, nu)};
}

BeamSection rigid_in_shear(BeamSection section) {
  section.kappa_y = section.kappa_z = 0.0;
  return section;
}

}  // namespace tenon::fem
