#pragma once

#include "assembly/recursion/multibody.hpp"
#include "reduction/geometric_stiffness.hpp"
#include "reduction/reduce.hpp"
#include "tests/unit/reduction/beams.hpp"

namespace tenon::assembly::testing {

/// A straight beam of finite elements, reduced, that turns about z through its port `root`; its other port is `tip`.
inline Multibody rotating_blade(const tests::BeamData& data, int modes, bool stiffening) {
  const fem::Model model = tests::beam(data, {{"root", 0}, {"tip", data.elements}});
  const fem::Structure structure = fem::assemble(model);
  reduction::ReducedBody body = reduction::reduce(structure, "root", {.modes = modes, .nonlinear = true});
  body.name = "blade";
  if (stiffening)
    body.stiffening =
        std::make_shared<const reduction::GeometricStiffness>(reduction::geometric_stiffness(model, structure, body));
  HingedBody blade;
  blade.name = body.name;
  blade.body = std::make_shared<const ReducedBody>(std::move(body));
  blade.outer_port = 0;
  blade.kind = HingeKind::revolute;
  Multibody system;
  system.bodies = {blade};
  index(system);
  return system;
}

/// The same one, held by nothing.
inline void set_afloat(Multibody& blade) {
  HingedBody& b = blade.bodies[0];
  b.kind = HingeKind::free;
  b.stiffness = b.damping = b.inertia = Eigen::VectorXd();
  index(blade);
}

}  // namespace tenon::assembly::testing
