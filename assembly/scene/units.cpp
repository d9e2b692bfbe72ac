#include "assembly/scene/units.hpp"

#include <cmath>

namespace tenon::assembly {
namespace {

/// Takes the numbers of an element to SI, factor by factor.
struct Convert {
  const Units& units;

  void operator()(fem::Beam& beam) const {
    for (fem::Vec3& offset : beam.offsets) offset *= units.length;
  }
  void operator()(fem::Quad4&) const {}
  void operator()(fem::Tria3&) const {}
  void operator()(fem::PointMass& point) const {
    point.mass *= units.mass;
    point.inertia *= units.to_si(dimension::inertia);
    point.offset *= units.length;
  }
  /// Force or torque over displacement or rotation: each rotation brings one length.
  void operator()(fem::Spring& spring) const {
    const int rotations = (spring.dof_a > 2 ? 1 : 0) + ((spring.node_b < 0 ? spring.dof_a : spring.dof_b) > 2 ? 1 : 0);
    spring.k *= units.to_si({rotations, 1, -2});
  }
};

}  // namespace

double Units::to_si(const Dimension& d) const {
  return std::pow(length, d.length) * std::pow(mass, d.mass) * std::pow(time, d.time);
}

fem::Model to_si(fem::Model model, const Units& units) {
  for (fem::Vec3& node : model.nodes) node *= units.length;
  for (fem::Material& material : model.materials) {
    material.E *= units.to_si(dimension::pressure);
    material.G *= units.to_si(dimension::pressure);
    material.rho *= units.to_si(dimension::density);
  }
  for (fem::BeamSection& section : model.beam_sections) {
    section.A *= units.to_si(dimension::area);
    for (double* moment : {&section.Iy, &section.Iz, &section.Iyz, &section.J})
      *moment *= units.to_si(dimension::second_moment);
    section.nsm *= units.to_si(dimension::mass_per_length);
  }
  for (fem::ShellSection& section : model.shell_sections) {
    section.thickness *= units.length;
    section.nsm *= units.to_si(dimension::mass_per_area);
  }
  for (fem::Element& element : model.elements) std::visit(Convert{units}, element);
  // Σ c u = 0 holds in SI with translations' coefficients divided by the unit of length.
  for (fem::LinearConstraint& constraint : model.constraints)
    for (fem::LinearConstraint::Term& term : constraint.terms)
      if (term.dof.direction < 3) term.coefficient /= units.length;
  return model;
}

}  // namespace tenon::assembly
