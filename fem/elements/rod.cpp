#include "fem/elements/rod.hpp"

#include <fmt/format.h>

#include "fem/error.hpp"

namespace tenon::fem {
namespace {

[[noreturn]] void refuse(const Rod& rod, const std::string& what, const std::string& cure) {
  throw ModelError(fmt::format("rod element {}: {}", rod.id, what), cure);
}

void check(const Rod& rod, const BeamSection& s, const Material& m) {
  const auto not_negative = [&](const char* what, double value) {
    if (!(value >= 0.0 && std::isfinite(value)))
      refuse(rod, fmt::format("{} is {:g}", what, value), "Correct its sign");
  };
  not_negative("its area", s.A);
  not_negative("its torsion constant", s.J);
  not_negative("its polar second moment", s.Iy + s.Iz);
  not_negative("its non-structural mass", s.nsm);
  not_negative("the density of its material", m.rho);
  if (s.A == 0.0 && s.J == 0.0)
    refuse(rod, fmt::format("section '{}' has neither area nor torsion constant", s.name), "Give one of them");
  if (s.A > 0.0 && !(m.E > 0.0))
    refuse(rod, fmt::format("Young's modulus of material '{}' is {:g} Pa", m.name, m.E), "Give a positive one");
  if (s.J > 0.0 && !(m.G > 0.0))
    refuse(rod, fmt::format("the shear modulus of material '{}' is {:g} Pa", m.name, m.G),
           "Give a positive one, or J = 0");
}

struct Axis {
  Mat3 X;  ///< x̂ x̂ᵀ
  Vec3 x;
  double length;
};

Axis axis_of(const Rod& rod, std::span<const Vec3> nodes) {
  const Vec3 &a = nodes[static_cast<std::size_t>(rod.nodes[0])], &b = nodes[static_cast<std::size_t>(rod.nodes[1])];
  const double length = (b - a).norm();
  if (!(length > 1e-12 * (a.norm() + b.norm())))
    refuse(rod, fmt::format("both ends lie at ({:g}, {:g}, {:g})", a.x(), a.y(), a.z()),
           "Correct its nodes; springs without length are bushes");
  const Vec3 x = (b - a) / length;
  return {x * x.transpose(), x, length};
}

/// += [D, C; C, D] on displacements (first = 0) or rotations (3).
void add_blocks(ElementMatrices::Matrix& A, int first, const Mat3& D, const Mat3& C) {
  A.block<3, 3>(first, first) += D;
  A.block<3, 3>(first + 6, first + 6) += D;
  A.block<3, 3>(first, first + 6) += C;
  A.block<3, 3>(first + 6, first) += C;
}

}  // namespace

void rod_matrices(const Rod& rod, const BeamSection& section, const Material& material, std::span<const Vec3> nodes,
                  ElementMatrices& out) {
  check(rod, section, material);
  const auto [X, x, L] = axis_of(rod, nodes);
  const Mat3 axial = (material.E * section.A / L) * X;
  out.K.setZero(12, 12);
  out.M.setZero(12, 12);
  add_blocks(out.K, 0, axial, -axial);
  if (section.J > 0.0) {
    const Mat3 torsion = (material.G * section.J / L) * X;
    add_blocks(out.K, 3, torsion, -torsion);
  }
  const double m = (material.rho * section.A + section.nsm) * L;
  const bool linear = rod.mass == BeamMass::consistent, nastran = rod.mass == BeamMass::nastran;
  const double d = linear ? 1.0 / 3.0 : 5.0 / 12.0, c = linear ? 1.0 / 6.0 : 1.0 / 12.0;  // along
  const double D = nastran ? 0.5 : 1.0 / 3.0, C = nastran ? 0.0 : 1.0 / 6.0;              // across
  const Mat3 across = Mat3::Identity() - X;
  add_blocks(out.M, 0, m * (d * X + D * across), m * (c * X + C * across));
  const double polar = nastran ? 0.0 : material.rho * (section.Iy + section.Iz) * L;
  if (polar > 0.0) add_blocks(out.M, 3, polar * d * X, polar * c * X);
}

void rod_geometric_stiffness(const Rod& rod, const BeamSection& section, const Material& material,
                             std::span<const Vec3> nodes, const Eigen::Ref<const Eigen::VectorXd>& u,
                             ElementMatrices::Matrix& out) {
  check(rod, section, material);
  const auto [X, x, L] = axis_of(rod, nodes);
  const double strain = x.dot(u.segment<3>(6) - u.segment<3>(0)) / L;
  const double N = material.E * section.A * strain;
  const Mat3 across = (N / L) * (Mat3::Identity() - X);
  out.setZero(12, 12);
  add_blocks(out, 0, across, -across);
  if (section.A > 0.0) {
    const Mat3 wagner = (N * (section.Iy + section.Iz) / (section.A * L)) * X;
    add_blocks(out, 3, wagner, -wagner);
  }
}

}  // namespace tenon::fem
