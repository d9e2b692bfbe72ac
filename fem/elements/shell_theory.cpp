#include "fem/elements/shell_theory.hpp"

#include <fmt/format.h>

#include "fem/error.hpp"

namespace tenon::fem {

ShellTheory shell_theory(const ShellSection& section, const Material& m, std::string_view kind, long id) {
  const double t = section.thickness;
  const auto refuse = [&](const std::string& what, const std::string& cure) {
    throw ModelError(fmt::format("{} element {}: {}", kind, id, what), cure);
  };
  if (!(t > 0.0)) refuse(fmt::format("the thickness of section '{}' is {} m", section.name, t), "Give a positive one");
  if (!(m.E > 0.0 && m.G > 0.0 && m.nu > -1.0 && m.nu <= 0.5))
    refuse(fmt::format("material '{}' has E {} Pa, G {} Pa, ν {}", m.name, m.E, m.G, m.nu),
           "A shell needs E > 0, G > 0 and -1 < ν <= 1/2");
  if (!(section.bending_ratio >= 0.0 && section.shear_ratio >= 0.0))
    refuse(fmt::format("section '{}' has the bending ratio {} and the shear ratio {}", section.name,
                       section.bending_ratio, section.shear_ratio),
           "Give ratios >= 0 (shear ratio 0: rigid in shear)");
  if (!(m.rho >= 0.0 && section.nsm >= 0.0))
    refuse(fmt::format("negative mass (density {}, non-structural {} kg/m²)", m.rho, section.nsm), "Give masses >= 0");

  const double plane = m.E / (1.0 - m.nu * m.nu);
  Mat3 C;
  C << plane, m.nu * plane, 0.0, m.nu * plane, plane, 0.0, 0.0, 0.0, m.G;
  const double t3_12 = t * t * t / 12.0;
  return {.membrane = t * C,
          .bending = section.bending_ratio * t3_12 * C,
          .shear = section.shear_ratio * m.G * t,
          .in_plane_shear = m.G * t,
          .nu = m.nu,
          .mass = m.rho * t + section.nsm,
          .rotary = m.rho * t3_12};
}

PlateEdge plate_edge(const ShellTheory& theory, double dx, double dy) {
  const double l2 = dx * dx + dy * dy;
  double rigid = 1.0, shear = 0.0;  // 1/(1+φ) and φ/(1+φ)
  if (theory.shear > 0.0) {
    const double phi = 12.0 * theory.bending(0, 0) / (theory.shear * l2);  // (2)
    rigid = 1.0 / (1.0 + phi);
    shear = phi * rigid;
  }
  const double dbeta = -1.5 / l2 * rigid;  // (3), c = dx / l
  return {.dx = dx, .dy = dy, .shear = shear, .c_dbeta = dbeta * dx, .s_dbeta = dbeta * dy};
}

}  // namespace tenon::fem
