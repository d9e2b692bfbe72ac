#include "fem/elements/laminate.hpp"

#include <fmt/format.h>

#include <array>
#include <cmath>

#include "fem/error.hpp"

namespace tenon::fem {
namespace {

using Mat2 = Eigen::Matrix2d;

void check(const Ply& p, const std::string& section, std::size_t number) {
  const auto refuse = [&](const std::string& what, const std::string& cure) {
    throw ModelError(fmt::format("section '{}', ply {}: {}", section, number, what), cure);
  };
  if (!(p.thickness > 0.0)) refuse(fmt::format("its thickness is {} m", p.thickness), "Give a positive one");
  if (!(p.E1 > 0.0 && p.E2 > 0.0 && p.G12 > 0.0))
    refuse(fmt::format("E1 {} Pa, E2 {} Pa, G12 {} Pa", p.E1, p.E2, p.G12), "A ply needs all three above zero");
  if (!(p.nu12 * p.nu12 * p.E2 < p.E1))
    refuse(fmt::format("ν12 is {}, where |ν12| < √(E1/E2) = {:.4g} must hold", p.nu12, std::sqrt(p.E1 / p.E2)),
           "Is it ν21? ν12 = ν21 E1/E2");
  if (!((p.G13 > 0.0 && p.G23 > 0.0) || (p.G13 == 0.0 && p.G23 == 0.0)))
    refuse(fmt::format("G13 {} Pa, G23 {} Pa", p.G13, p.G23), "Give both above zero, or neither: rigid in shear");
  if (!(p.rho >= 0.0)) refuse(fmt::format("its density is {} kg/m³", p.rho), "Give one >= 0");
  if (!std::isfinite(p.thickness + p.angle + p.E1 + p.E2 + p.G12 + p.G13 + p.G23 + p.rho))
    refuse("a value of it is not finite", "Correct it");
}

/// Plane-stress stiffness in the section's axes.
Mat3 in_plane(const Ply& p) {
  const double whole = 1.0 - p.nu12 * p.nu12 * p.E2 / p.E1;
  Mat3 Q = Mat3::Zero();
  Q(0, 0) = p.E1 / whole;
  Q(1, 1) = p.E2 / whole;
  Q(0, 1) = Q(1, 0) = p.nu12 * p.E2 / whole;
  Q(2, 2) = p.G12;
  const Mat3 T = strain_rotation(p.angle);
  return T.transpose() * Q * T;
}

Mat2 transverse(const Ply& p) {
  const Mat2 R = shear_rotation(p.angle);
  return R.transpose() * Eigen::Vector2d(p.G13, p.G23).asDiagonal() * R;
}

/// 1/S_ii of (1) in laminate.hpp; f² is quartic in a ply, three Gauss points are exact.
double shear_compliance(const ShellSection& section, double thickness, int i) {
  double Q0 = 0.0, Q1 = 0.0, Q2 = 0.0, z = -0.5 * thickness;
  for (const Ply& p : section.plies) {
    const double Q = in_plane(p)(i, i), top = z + p.thickness;
    Q0 += Q * p.thickness;
    Q1 += Q * (top * top - z * z) / 2.0;
    Q2 += Q * (top * top * top - z * z * z) / 3.0;
    z = top;
  }
  const double neutral = Q1 / Q0, stiffness = Q2 - Q1 * neutral;
  constexpr std::array<double, 3> at{-0.7745966692414834, 0.0, 0.7745966692414834},
      weight{5.0 / 18.0, 8.0 / 18.0, 5.0 / 18.0};
  double compliance = 0.0, below = 0.0;  // f at the ply's lower face
  z = -0.5 * thickness;
  for (const Ply& p : section.plies) {
    const double Q = in_plane(p)(i, i), G = transverse(p)(i, i), low = z - neutral;
    const auto f = [&](double up) { return below - Q / stiffness * up * (low + 0.5 * up); };
    if (G > 0.0)
      for (std::size_t g = 0; g < 3; ++g) {
        const double value = f(0.5 * (1.0 + at[g]) * p.thickness);
        compliance += weight[g] * p.thickness * value * value / G;
      }
    below = f(p.thickness);
    z += p.thickness;
  }
  return compliance;
}

}  // namespace

Mat3 strain_rotation(double angle) {
  const double c = std::cos(angle), s = std::sin(angle);
  return (Mat3() << c * c, s * s, c * s, s * s, c * c, -c * s, -2.0 * c * s, 2.0 * c * s, c * c - s * s).finished();
}

Eigen::Matrix2d shear_rotation(double angle) {
  const double c = std::cos(angle), s = std::sin(angle);
  return (Mat2() << c, s, -s, c).finished();
}

LaminateStiffness laminate(const ShellSection& section) {
  LaminateStiffness l{Mat3::Zero(), Mat3::Zero(), Mat3::Zero(), Mat2::Zero(), 0.0, 0.0, 0.0, 0.0};
  for (std::size_t k = 0; k < section.plies.size(); ++k) {
    check(section.plies[k], section.name, k + 1);
    l.thickness += section.plies[k].thickness;
  }
  double z = -0.5 * l.thickness;
  bool some_rigid = false;
  Mat2 uncorrected = Mat2::Zero();
  for (const Ply& p : section.plies) {
    const double t = p.thickness, middle = z + 0.5 * t, second = t * (middle * middle + t * t / 12.0);
    const Mat3 Q = in_plane(p);
    l.A += t * Q;
    l.B += t * middle * Q;
    l.D += second * Q;
    uncorrected += t * transverse(p);
    some_rigid = some_rigid || p.G13 == 0.0;
    l.mass += p.rho * t;
    l.first_moment += p.rho * t * middle;
    l.second_moment += p.rho * second;
    z += t;
  }
  const double along = shear_compliance(section, l.thickness, 0), across = shear_compliance(section, l.thickness, 1);
  if (along > 0.0 && across > 0.0) {
    l.shear(0, 0) = 1.0 / along;
    l.shear(1, 1) = 1.0 / across;
    if (!some_rigid)
      l.shear(0, 1) = l.shear(1, 0) =
          uncorrected(0, 1) * std::sqrt(l.shear(0, 0) * l.shear(1, 1) / (uncorrected(0, 0) * uncorrected(1, 1)));
  }
  return l;
}

}  // namespace tenon::fem
