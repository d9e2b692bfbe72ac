#include <gtest/gtest.h>

#include <atomic>
#include <cstdlib>

#include "assembly/integration/implicit.hpp"
#include "reduction/geometric_stiffness.hpp"
#include "tests/benchmarks/chain.hpp"
#include "tests/unit/reduction/lumped_body.hpp"

// Counts what the recursions take from the heap: every allocation of this program passes through here.
namespace {
std::atomic<long> allocations{0};
}
extern "C" void* __libc_malloc(std::size_t size);  // NOLINT: glibc's own
extern "C" void* malloc(std::size_t size) {
  ++allocations;
  return __libc_malloc(size);
}

namespace tenon::assembly {
namespace {

using Eigen::VectorXd;

TEST(Allocations, RecursionsTakeNothingFromTheHeap) {
  const long before_vector = allocations;
  { const VectorXd seen(100); }
  ASSERT_GT(allocations, before_vector) << "the counter sees Eigen's allocations";
  for (const int modes : {0, 1, 5, 10}) {
    Multibody mb = bench::chain(20, modes);
    Closure c;  // the tip on a rail
    c.inner = {-1, -1};
    c.outer = {19, 1};
    c.kind = HingeKind::planar;
    mb.closures = {c};
    for (const Deformation deformation : {Deformation::dropped, Deformation::full}) {
      for (HingedBody& b : mb.bodies) b.deformation = deformation;
      const MotionState s = bench::bent(mb);
      Sweeps sweeps = make_sweeps(mb);
      ClosureRows rows = make_closure_rows(mb);
      VectorXd T = VectorXd::Zero(mb.nv), v_dot(mb.nv);
      const auto all = [&] {
        set_state(mb, s.q, s.v, sweeps);
        passive_forces(mb, s.q, s.v, T);
        closure_rows(mb, sweeps, s.q, s.v, rows);
        inverse_dynamics(mb, sweeps, s.v, v_dot);
        articulate(mb, sweeps, {1e-3, 1e-6});
        solve(mb, sweeps, T, v_dot);
        articulate(mb, sweeps);
        forward_dynamics(mb, sweeps, T, v_dot);
      };
      all();
      const long before = allocations;
      all();
      EXPECT_EQ(allocations - before, 0) << modes << " modes a body";
    }
  }
}

// Nodes of mass on four shapes, with all that a body can carry: integrals of its shapes and geometric stiffening.
std::shared_ptr<const ReducedBody> lumped() {
  tests::LumpedBody made = tests::random_lumped(3, 6, 4, false, false);
  made.body.omega = VectorXd::LinSpaced(4, 20.0, 80.0);
  for (int j = 0; j < 2; ++j)
    made.body.ports.push_back({"n" + std::to_string(j), made.nodes[static_cast<std::size_t>(j)].position,
                               fem::Mat3::Identity(), made.shapes.middleRows<6>(6 * j)});
  reduction::GeometricStiffness stiffening;
  stiffening.K = Eigen::MatrixXd::Constant(49, 12 + 18, 1e-3);
  made.body.stiffening = std::make_shared<const reduction::GeometricStiffness>(stiffening);
  return std::make_shared<const ReducedBody>(made.body);
}

// A tree of such bodies on hinges of one to six degrees of freedom, each also the other way round.
Multibody tree() {
  Multibody mb;
  mb.gravity = {0.0, 0.0, -9.81};
  const auto body = lumped();
  int parent = -1;
  for (const HingeKind kind : {HingeKind::free, HingeKind::spherical, HingeKind::universal, HingeKind::planar,
                               HingeKind::cylindrical, HingeKind::prismatic, HingeKind::revolute})
    for (const bool reversed : {false, true}) {
      HingedBody b;
      b.name = name(kind);
      b.body = body;
      b.kind = kind;
      b.reversed = reversed;
      b.parent = parent;
      b.inner_port = parent < 0 ? -1 : 1;
      b.outer_port = parent < 0 ? -1 : 2;
      b.stiffness = VectorXd::Constant(b.dofs(), parent < 0 ? 0.0 : 50.0);
      parent = static_cast<int>(mb.bodies.size());
      mb.bodies.push_back(b);
    }
  index(mb);
  return mb;
}

// Three such bodies whose tip is held in a plane, twice: three rows are redundant.
Multibody loop() {
  Multibody mb = tree();
  mb.bodies.resize(3);
  mb.bodies[0].kind = HingeKind::weld;
  for (HingeVector* values : {&mb.bodies[0].stiffness, &mb.bodies[0].damping, &mb.bodies[0].inertia})
    *values = VectorXd();
  index(mb);
  Closure rail;
  rail.name = "rail";
  rail.inner = {-1, -1};
  rail.outer = {2, 1};
  rail.kind = HingeKind::planar;
  mb.closures = {rail, rail};
  const MotionState rest = rest_state(mb);
  Sweeps sweeps = make_sweeps(mb);
  set_state(mb, rest.q, rest.v, sweeps);
  const RigidMotion& tip = sweeps.bodies[2].world;
  for (Closure& c : mb.closures) {
    c.inner_axes = tip.R;
    c.inner_position = tip.r + tip.R * (mb.bodies[2].body->ports[1].position - mb.bodies[2].body->reference);
  }
  return mb;
}

TEST(Allocations, StepsTakeNothingFromTheHeap) {
  for (const bool closed : {false, true}) {
    const Multibody mb = closed ? loop() : tree();
    for (const bool alpha : {true, false}) {
      Dynamics dynamics = make_dynamics(mb);
      ASSERT_TRUE(dynamics.sweeps.stiffening);
      ImplicitWork work = make_implicit_work(dynamics);
      ImplicitState state{rest_state(mb), VectorXd::Zero(mb.nv), VectorXd::Zero(mb.nv)};
      state.motion.v.setConstant(0.1);
      if (closed) project(mb, dynamics.sweeps, dynamics.rows, state.motion);
      accelerations(dynamics, 0.0, state.motion, state.v_dot);
      state.a = state.v_dot;
      long before = allocations;
      accelerations(dynamics, 0.0, state.motion, state.v_dot);
      EXPECT_EQ(allocations - before, 0) << (closed ? "loop" : "tree");
      const auto step = alpha ? generalized_alpha_step : midpoint_step;
      step(dynamics, 0.0, 1e-3, {}, work, state);
      before = allocations;
      step(dynamics, 1e-3, 1e-3, {}, work, state);
      EXPECT_EQ(allocations - before, 0) << (closed ? "loop" : "tree") << (alpha ? ", alpha" : ", midpoint");
      EXPECT_EQ(work.inertia.redundant, closed ? 3 : 0);
    }
  }
}

}  // namespace
}  // namespace tenon::assembly
