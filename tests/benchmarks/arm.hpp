#pragma once

#include "assembly/recursion/multibody.hpp"
#include "fem/structure.hpp"
#include "reduction/reduce.hpp"

namespace tenon::bench {

/// An arm of finite-element beams of 0.2 m with ten modes each, which shift mass and move their ports, on hinges with
/// dampers under gravity.
inline assembly::Multibody arm(int links, assembly::Deformation deformation) {
  fem::Model model;
  constexpr int elements = 8;
  for (int k = 0; k <= elements; ++k) {
    model.nodes.emplace_back(0.2 * k / elements, 0.0, 0.0);
    model.node_ids.push_back(k + 1);
  }
  model.materials = {{.name = "steel", .E = 2e11, .G = 7.7e10, .nu = 0.3, .rho = 7800.0}};
  model.beam_sections = {{.name = "bar", .A = 9e-4, .Iy = 6.75e-8, .Iz = 6.75e-8, .J = 1.14e-7}};
  for (int k = 0; k < elements; ++k) {
    fem::Beam beam;
    beam.nodes = {k, k + 1};
    beam.orientation = fem::Vec3::UnitY();
    model.elements.emplace_back(beam);
  }
  model.ports = {{"root", 0, fem::Mat3::Identity()}, {"tip", elements, fem::Mat3::Identity()}};
  const auto link = std::make_shared<const reduction::ReducedBody>(
      reduction::reduce(fem::assemble(model), "root",
                        {.basis = reduction::Basis::clamped_free, .modes = 10, .zeta = 0.005, .nonlinear = true}));
  assembly::Multibody mb = serial_chain(link, links, deformation);
  mb.gravity = fem::Vec3(0.0, -9.81, 0.0);
  for (assembly::HingedBody& b : mb.bodies) b.damping.setOnes();
  return mb;
}

}  // namespace tenon::bench
