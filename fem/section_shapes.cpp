#include "fem/section_shapes.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <initializer_list>
#include <numbers>
#include <utility>

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

/// Cowper's coefficient of a thin-walled box: m = flange area / web area, n = flange length / web length, by mid-lines;
/// webs stand along the force.
double box_shear(double m, double n, double nu) {
  const double m2 = m * m, m3 = m2 * m;
  return 10.0 * (1.0 + nu) * (1.0 + 3.0 * m) * (1.0 + 3.0 * m) /
         ((12.0 + 72.0 * m + 150.0 * m2 + 90.0 * m3) + nu * (11.0 + 66.0 * m + 135.0 * m2 + 90.0 * m3) +
          10.0 * n * n * ((3.0 + nu) * m + 3.0 * m2));
}

/// A wall of an open section: sizes along y and z, centre.
struct Wall {
  double b = 0.0, h = 0.0, y = 0.0, z = 0.0;
};

struct ShearCentre {
  double y = 0.0, z = 0.0;
};

/// Constants about the common centroid; `shear` in the walls' coordinates.
BeamSection of_walls(const char* name, std::initializer_list<Wall> walls, ShearCentre shear) {
  BeamSection s{.name = name};
  double first_y = 0.0, first_z = 0.0, along_y = 0.0, along_z = 0.0;
  for (const Wall& w : walls) {
    const double area = w.b * w.h, a = std::max(w.b, w.h), t = std::min(w.b, w.h);
    s.A += area;
    first_y += area * w.y;
    first_z += area * w.z;
    s.J += a * t * t * t / 3.0;
    (w.b > w.h ? along_y : along_z) += area;
  }
  const double cy = first_y / s.A, cz = first_z / s.A;
  for (const Wall& w : walls) {
    const double area = w.b * w.h, y = w.y - cy, z = w.z - cz;
    s.Iy += area * (w.h * w.h / 12.0 + z * z);
    s.Iz += area * (w.b * w.b / 12.0 + y * y);
    s.Iyz += area * y * z;
  }
  if (std::abs(s.Iyz) < 1e-14 * std::sqrt(s.Iy * s.Iz)) s.Iyz = 0.0;
  s.kappa_y = 5.0 / 6.0 * along_y / s.A;
  s.kappa_z = along_z / s.A;
  const auto off = [&](double place, double centroid) {
    return std::abs(place - centroid) < 1e-14 * std::sqrt(s.A) ? 0.0 : place - centroid;
  };
  s.shear_y = off(shear.y, cy);
  s.shear_z = off(shear.z, cz);
  return s;
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

BeamSection box(double b, double h, double t, double nu) { return box(b, h, t, t, nu); }

BeamSection box(double b, double h, double t_flange, double t_web, double nu) {
  require(t_flange > 0.0 && 2.0 * t_flange < h && t_web > 0.0 && 2.0 * t_web < b,
          t_flange == t_web
              ? fmt::format("a box has outer sides {} and {} and wall {}", b, h, t_web)
              : fmt::format("a box has outer sides {} and {}, flanges {} and webs {}", b, h, t_flange, t_web));
  const double bi = b - 2.0 * t_web, hi = h - 2.0 * t_flange, bm = b - t_web, hm = h - t_flange;
  const double m = bm * t_flange / (hm * t_web), n = bm / hm;
  return {.name = "box",
          .A = b * h - bi * hi,
          .Iy = (b * h * h * h - bi * hi * hi * hi) / 12.0,
          .Iz = (h * b * b * b - hi * bi * bi * bi) / 12.0,
          .J = 2.0 * bm * bm * hm * hm / (bm / t_flange + hm / t_web),  // Bredt: 4 A_m² / ∮ ds/t
          .kappa_y = box_shear(1.0 / m, 1.0 / n, nu),
          .kappa_z = box_shear(m, n, nu)};
}

BeamSection i_section(double h, double b, double t, double b_top, double t_top, double t_web) {
  require(t > 0.0 && t_top > 0.0 && t + t_top < h && t_web > 0.0 && t_web <= std::min(b, b_top),
          fmt::format("an I has height {}, flanges {} x {} and {} x {}, web {}", h, b, t, b_top, t_top, t_web));
  // the shear centre divides the flanges' middle lines' distance by their second moments
  const double I = t * b * b * b, I_top = t_top * b_top * b_top * b_top, distance = h - 0.5 * (t + t_top);
  const double web = h - t - t_top;
  return of_walls("I", {{b, t, 0.0, 0.5 * t}, {b_top, t_top, 0.0, h - 0.5 * t_top}, {t_web, web, 0.0, t + 0.5 * web}},
                  {0.0, 0.5 * t + distance * I_top / (I + I_top)});
}

BeamSection tee(double b, double h, double t, double t_web) {
  require(t > 0.0 && t < h && t_web > 0.0 && t_web <= b,
          fmt::format("a T has flange {} x {}, height {} and web {}", b, t, h, t_web));
  const double web = h - t;
  return of_walls("T", {{b, t, 0.0, h - 0.5 * t}, {t_web, web, 0.0, 0.5 * web}}, {0.0, h - 0.5 * t});
}

BeamSection channel(double b, double h, double t, double t_web) {
  require(t > 0.0 && 2.0 * t < h && t_web > 0.0 && t_web < b,
          fmt::format("a channel has flanges {} x {}, height {} and web {}", b, t, h, t_web));
  const double flange = b - t_web, middle = 0.5 * (b + t_web), web = h;
  const double b_m = b - 0.5 * t_web, h_m = h - t;  // of middle lines
  const double e = 3.0 * b_m * b_m * t / (6.0 * b_m * t + h_m * t_web);
  return of_walls("channel",
                  {{flange, t, middle, 0.5 * t}, {flange, t, middle, h - 0.5 * t}, {t_web, web, 0.5 * t_web, 0.5 * h}},
                  {0.5 * t_web - e, 0.5 * h});
}

BeamSection angle_section(double b, double h, double t, double t_web) {
  require(t > 0.0 && t < h && t_web > 0.0 && t_web < b,
          fmt::format("an angle has legs {} x {} and {} x {}", b, t, h, t_web));
  const double leg = h - t;
  return of_walls("L", {{b, t, 0.5 * b, 0.5 * t}, {t_web, leg, 0.5 * t_web, t + 0.5 * leg}}, {0.5 * t_web, 0.5 * t});
}

BeamSection swapped_axes(BeamSection s) {
  std::swap(s.Iy, s.Iz);
  std::swap(s.kappa_y, s.kappa_z);
  std::swap(s.shear_y, s.shear_z);
  std::swap(s.nsm_y, s.nsm_z);
  return s;
}

BeamSection rigid_in_shear(BeamSection section) {
  section.kappa_y = section.kappa_z = 0.0;
  return section;
}

}  // namespace tenon::fem
