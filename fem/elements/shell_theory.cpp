#include "fem/elements/shell_theory.hpp"

#include <fmt/format.h>

#include <Eigen/LU>
#include <cmath>

#include "fem/elements/laminate.hpp"
#include "fem/error.hpp"

namespace tenon::fem {
namespace {

ShellTheory laminated(const ShellSection& section) {
  const LaminateStiffness l = laminate(section);
  const double mass = l.mass + section.nsm, first = l.first_moment;
  const bool coupled = l.B.cwiseAbs().maxCoeff() > 1e-14 * l.thickness * l.A.cwiseAbs().maxCoeff();
  const Mat3 B = coupled ? l.B : Mat3(Mat3::Zero());
  return {.membrane = l.A,
          .coupling = B,
          .bending = l.D,
          .shear = l.shear,
          .bending_free = coupled ? Mat3(l.D - B * l.A.inverse() * B) : l.D,
          .in_plane_shear = (l.A(0, 0) + l.A(1, 1) - 2.0 * l.A(0, 1) + 4.0 * l.A(2, 2)) / 8.0,
          .nu = l.A(0, 1) / std::sqrt(l.A(0, 0) * l.A(1, 1)),
          .thickness = l.thickness,
          .mass = mass,
          .rotary = mass > 0.0 ? l.second_moment - first * first / mass : 0.0,
          .mass_height = mass > 0.0 ? first / mass : 0.0,
          .coupled = coupled,
          .isotropic = false};
}

}  // namespace

ShellTheory shell_theory(const ShellSection& section, const Material& m, std::string_view kind, long id) {
  if (!section.plies.empty()) {
    if (!(section.nsm >= 0.0))
      throw ModelError(fmt::format("{} element {}: non-structural mass {} kg/m²", kind, id, section.nsm),
                       "Give masses >= 0");
    return laminated(section);
  }
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
  const Mat3 D = section.bending_ratio * t3_12 * C;
  return {.membrane = t * C,
          .coupling = Mat3::Zero(),
          .bending = D,
          .shear = section.shear_ratio * m.G * t * Eigen::Matrix2d::Identity(),
          .bending_free = D,
          .in_plane_shear = m.G * t,
          .nu = m.nu,
          .thickness = t,
          .mass = m.rho * t + section.nsm,
          .rotary = m.rho * t3_12,
          .mass_height = 0.0};
}

ShellTheory shell_theory(const ShellSection& section, const Material& material, const Vec3& material_axis,
                         const Vec3& side, const Mat3& R, std::string_view kind, long id) {
  ShellTheory theory = shell_theory(section, material, kind, id);
  if (theory.isotropic) return theory;
  const Vec3 direction = R.transpose() * (material_axis.isZero(0.0) ? side : material_axis);
  const double in_plane = std::hypot(direction.x(), direction.y());
  if (!(in_plane > 1e-6 * direction.norm()))
    throw ModelError(
        fmt::format("{} element {}: the direction of the laminate '{}' is normal to it", kind, id, section.name),
        "Give a direction that has a projection on the element");
  const double angle = std::atan2(direction.y(), direction.x());
  const Mat3 T = strain_rotation(angle);
  const Eigen::Matrix2d turn = shear_rotation(angle);
  for (Mat3* of : {&theory.membrane, &theory.coupling, &theory.bending, &theory.bending_free})
    *of = Mat3(T.transpose() * *of * T);
  theory.shear = Eigen::Matrix2d(turn.transpose() * theory.shear * turn);
  return theory;
}

PlateEdge plate_edge(const ShellTheory& theory, double dx, double dy) {
  const double l2 = dx * dx + dy * dy;
  double rigid = 1.0, shear = 0.0;  // 1/(1+φ) and φ/(1+φ)
  if (!theory.shear_rigid()) {
    const Vec3 t(dx * dx / l2, dy * dy / l2, 2.0 * dx * dy / l2);  // κ of a unit curvature along the edge
    const Eigen::Vector2d e(dx, dy);
    const double phi = 12.0 * t.dot(theory.bending_free * t) / e.dot(theory.shear * e);  // (2)
    rigid = 1.0 / (1.0 + phi);
    shear = phi * rigid;
  }
  const double dbeta = -1.5 / l2 * rigid;  // (3), c = dx / l
  return {.dx = dx, .dy = dy, .shear = shear, .c_dbeta = dbeta * dx, .s_dbeta = dbeta * dy};
}

Vec3 edge_bending(const PlateEdge& e, const Vec3& i, const Vec3& j) {
  Eigen::Vector2d beta(0.5 * (i[2] + j[2]), -0.5 * (i[1] + j[1]));   // β_x = θy, β_y = −θx
  const double g = j[0] - i[0] + e.dx * beta.x() + e.dy * beta.y();  // (1)
  beta += 2.0 / 3.0 * g * Eigen::Vector2d(e.c_dbeta, e.s_dbeta);     // the mean of 4ξ(1−ξ)
  return {beta.x() * e.dy, -beta.y() * e.dx, beta.y() * e.dy - beta.x() * e.dx};
}

}  // namespace tenon::fem
