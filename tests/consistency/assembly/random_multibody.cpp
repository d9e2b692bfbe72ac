#include "tests/consistency/assembly/random_multibody.hpp"

namespace tenon::assembly::testing {

ReducedBody RandomMultibody::lumped(const std::string& name) {
  const int modes = random.integer(0, 12), nodes = modes / 3 + random.integer(3, 5);  // 3 nodes > modes + 6
  tests::LumpedBody lumped =
      tests::random_lumped(static_cast<unsigned>(random.integer(1, 1 << 20)), nodes, modes, false, random.chance(0.5));
  lumped.body.name = name;
  for (int j = 0; j < 3; ++j)
    lumped.body.ports.push_back({"n" + std::to_string(j), lumped.nodes[static_cast<std::size_t>(j)].position,
                                 random.rotation(), lumped.shapes.middleRows<6>(6 * j)});
  return lumped.body;
}

Multibody RandomMultibody::system(int most, Deformation deformation, bool lumped_nodes) {
  Multibody mb;
  const int count = random.integer(1, most);
  const bool chain = random.chance(0.5);
  mb.gravity = random.vector(10.0);
  for (int k = 0; k < count; ++k) {
    HingedBody b;
    const std::string name = "body" + std::to_string(k);
    const ReducedBody body = lumped_nodes ? lumped(name) : random.body(name, random.chance(0.4), 12);
    const auto ports = static_cast<int>(body.ports.size());
    b.name = body.name;
    b.body = std::make_shared<const ReducedBody>(body);
    b.deformation = deformation;
    b.kind = static_cast<HingeKind>(random.integer(0, 7));
    b.parent = k == 0 ? -1 : chain ? k - 1 : random.integer(-1, k - 1);
    b.reversed = random.chance(0.3);
    b.inner_axes = random.rotation();
    b.outer_axes = random.rotation();
    b.inner_position = random.vector(1.0);
    b.outer_port = random.integer(body.kind == ReducedBody::Kind::free_free ? -1 : 0, ports - 1);
    if (b.parent >= 0)
      b.inner_port =
          random.integer(0, static_cast<int>(mb.bodies[static_cast<std::size_t>(b.parent)].body->ports.size()) - 1);
    b.stiffness = Eigen::VectorXd::NullaryExpr(b.dofs(), [&] { return random.log_uniform(1.0, 1e3); });
    b.damping = Eigen::VectorXd::NullaryExpr(b.dofs(), [&] { return random.log_uniform(0.01, 1.0); });
    b.inertia = Eigen::VectorXd::NullaryExpr(b.dofs(), [&] { return random.chance(0.3) ? 0.2 : 0.0; });
    mb.bodies.push_back(std::move(b));
  }
  index(mb);
  return mb;
}

MotionState RandomMultibody::state(const Multibody& mb, double deflection) {
  MotionState s = rest_state(mb);
  Eigen::VectorXd delta = vector(mb.nv, 2.0);
  s.v = vector(mb.nv, 1.0);
  for (std::size_t k = 0; k < mb.bodies.size(); ++k) delta.segment(mb.v_offset[k], mb.bodies[k].modes()) *= deflection;
  move(mb, delta, s.q);
  return s;
}

}  // namespace tenon::assembly::testing
