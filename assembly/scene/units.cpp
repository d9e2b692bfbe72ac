#include "assembly/scene/units.hpp"

#include <array>
#include <cmath>

#include "fem/matrix_part.hpp"

namespace tenon::assembly {
namespace {

template <class Quantity>
void take(Quantity& x, const Factor& to_si) {
  x = to_si * x;
}

/// Takes the numbers of an element to SI, factor by factor.
struct Convert {
  const Units& units;

  void operator()(fem::Beam& beam) const {
    for (fem::Vec3& offset : beam.offsets) take(offset, units.to_si(dimension::length));
  }
  void operator()(fem::Quad4& quad) const { take(quad.offset, units.to_si(dimension::length)); }
  void operator()(fem::Tria3& tria) const { take(tria.offset, units.to_si(dimension::length)); }
  void operator()(fem::PointMass& point) const {
    take(point.mass, units.to_si(dimension::mass));
    take(point.inertia, units.to_si(dimension::inertia));
    take(point.offset, units.to_si(dimension::length));
  }
  /// Force or torque over displacement or rotation: each rotation brings one length.
  void operator()(fem::Spring& spring) const {
    const int rotations = (spring.dof_a > 2 ? 1 : 0) + ((spring.node_b < 0 ? spring.dof_a : spring.dof_b) > 2 ? 1 : 0);
    take(spring.k, units.to_si({rotations - 1, 0, 0, 1}));
  }
  void operator()(fem::Rod&) const {}
  void operator()(fem::Bush& bush) const {
    take(bush.offset, units.to_si(dimension::length));
    for (std::size_t i = 0; i < 6; ++i) take(bush.k[i], units.to_si({i < 3 ? -1 : 1, 0, 0, 1}));
  }
};

/// Entries of K and M of work-conjugate dofs: each rotation brings one length.
std::shared_ptr<const fem::MatrixPart> to_si(const fem::MatrixPart& part, const Units& units) {
  auto result = std::make_shared<fem::MatrixPart>(part);
  const auto rotations = [&](Eigen::Index i) { return part.dofs[static_cast<std::size_t>(i)].direction > 2 ? 1 : 0; };
  const auto convert = [&](fem::SparseMatrix& A, int time) {
    const std::array<Factor, 3> factor{units.to_si({0, 1, time}), units.to_si({1, 1, time}), units.to_si({2, 1, time})};
    for (int j = 0; j < A.outerSize(); ++j)
      for (fem::SparseMatrix::InnerIterator it(A, j); it; ++it)
        it.valueRef() = factor[static_cast<std::size_t>(rotations(it.row()) + rotations(j))] * it.value();
  };
  convert(result->K, -2);
  convert(result->M, 0);
  return result;
}

}  // namespace

Factor Units::to_si(const Dimension& dimension) const {
  Dimension d = dimension;
  if (force == 0.0) d = {d.length + d.force, d.mass + d.force, d.time - 2 * d.force, 0};
  const double factor = std::pow(length, d.length) * std::pow(mass, d.mass) * std::pow(time, d.time) *
                        (d.force == 0 ? 1.0 : std::pow(force, d.force));
  constexpr double round_off = 1e-14;  // of powers and products
  const auto whole = [](double x) { return std::abs(x - std::round(x)) < round_off * x; };
  if (factor < 1.0 && whole(1.0 / factor)) return {1.0, std::round(1.0 / factor)};
  return {whole(factor) ? std::round(factor) : factor, 1.0};
}

fem::Model to_si(fem::Model model, const Units& units) {
  const Factor length = units.to_si(dimension::length), pressure = units.to_si(dimension::pressure);
  for (fem::Vec3& node : model.nodes) take(node, length);
  for (fem::Material& material : model.materials) {
    take(material.E, pressure);
    take(material.G, pressure);
    take(material.rho, units.to_si(dimension::density));
  }
  for (fem::BeamSection& section : model.beam_sections) {
    take(section.A, units.to_si(dimension::area));
    for (double* moment : {&section.Iy, &section.Iz, &section.Iyz, &section.J})
      take(*moment, units.to_si(dimension::second_moment));
    take(section.nsm, units.to_si(dimension::mass_per_length));
    for (double* place : {&section.shear_y, &section.shear_z, &section.nsm_y, &section.nsm_z}) take(*place, length);
  }
  for (fem::ShellSection& section : model.shell_sections) {
    take(section.thickness, length);
    take(section.nsm, units.to_si(dimension::mass_per_area));
    for (fem::Ply& ply : section.plies) {
      take(ply.thickness, length);
      for (double* modulus : {&ply.E1, &ply.E2, &ply.G12, &ply.G13, &ply.G23}) take(*modulus, pressure);
      take(ply.rho, units.to_si(dimension::density));
    }
  }
  for (fem::Element& element : model.elements) std::visit(Convert{units}, element);
  for (auto& part : model.matrix_parts) part = to_si(*part, units);
  // Σ c u = 0 holds in SI with translations' coefficients divided by the unit of length.
  for (fem::LinearConstraint& constraint : model.constraints)
    for (fem::LinearConstraint::Term& term : constraint.terms)
      if (term.dof.direction < 3) term.coefficient /= units.length;
  return model;
}

}  // namespace tenon::assembly
