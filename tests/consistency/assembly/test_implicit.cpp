#include <fmt/format.h>
#include <gtest/gtest.h>

#include <iostream>

#include "assembly/integration/implicit.hpp"
#include "dense_operators.hpp"
#include "random_multibody.hpp"
#include "tests/unit/reduction/lumped_body.hpp"
#include "titop/beam.hpp"

// Implicit steps by implicit articulated bodies: against dense algebra, with stiffness far beyond what a step resolves,
// and over long runs.
namespace tenon::assembly {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;
using testing::RandomMultibody;

// Stiffness and damping of modes and of plain hinge coordinates, dense.
struct Passive {
  MatrixXd C, K;
};
Passive passive(const Multibody& mb) {
  Passive p{MatrixXd::Zero(mb.nv, mb.nv), MatrixXd::Zero(mb.nv, mb.nv)};
  for (std::size_t k = 0; k < mb.bodies.size(); ++k) {
    const HingedBody& b = mb.bodies[k];
    const Eigen::Index n = b.modes(), r = b.dofs(), first = mb.v_offset[k];
    p.K.diagonal().segment(first, n) = b.body->omega.cwiseAbs2();
    p.K.diagonal().segment(first + n, r) = b.stiffness;
    p.C.block(first, first, n, n) = reduction::damping(*b.body);
    p.C.diagonal().segment(first + n, r) = b.damping;
  }
  return p;
}

// (M + γh C + βh² K)⁻¹ by one sweep against a dense factorisation, stiffness 1 and 1e6 times as large. What is compared
// is algebra: round-off times the condition, which equilibration takes the stiffness out of.
TEST(Implicit, ArticulatedBodiesSolveWhatDenseAlgebraSolves) {
  double worst = 0.0;
  for (unsigned seed = 1; seed <= 100; ++seed) {
    RandomMultibody random(seed);
    Multibody mb = random.system(10, Deformation::dropped);
    if (mb.nv == 0) continue;
    const MotionState state = random.state(mb);
    for (const double factor : {1.0, 1e6}) {
      for (HingedBody& b : mb.bodies) {
        ReducedBody stiff = *b.body;
        stiff.omega *= std::sqrt(factor);
        b.body = std::make_shared<const ReducedBody>(stiff);
        b.stiffness *= factor;
      }
      Sweeps sweeps = make_sweeps(mb);
      set_state(mb, state.q, state.v, sweeps);
      const double h = 0.01, damping = 0.55 * h, stiffness = 0.28 * h * h;
      const Passive p = passive(mb);
      const MatrixXd A = testing::dense_operators(mb, sweeps).mass() + damping * p.C + stiffness * p.K;
      articulate(mb, sweeps, {damping, stiffness});
      const VectorXd f = random.vector(mb.nv, 1.0);
      VectorXd x(mb.nv);
      solve(mb, sweeps, f, x);
      const VectorXd d = A.diagonal().cwiseSqrt().cwiseInverse();  // equilibrated: unit diagonal
      const MatrixXd E = d.asDiagonal() * A * d.asDiagonal();
      const VectorXd y = E.ldlt().solve(d.cwiseProduct(f)), ours = d.cwiseInverse().cwiseProduct(x);
      worst = std::max(worst, (ours - y).norm() / y.norm());
    }
  }
  std::cout << "largest difference " << worst << "\n";
  EXPECT_LT(worst, 1e-9);
}

// A step's own equations, formed densely: M(q₁) χ̇₁ + 𝓒 = T at the end of a generalised-α step.
TEST(Implicit, StepSatisfiesTheEquationsOfMotionWithStiffnessTimesAMillion) {
  double worst = 0.0;
  for (unsigned seed = 1; seed <= 30; ++seed) {
    RandomMultibody random(seed);
    Multibody mb = random.system(8, Deformation::dropped);
    if (mb.nv == 0) continue;
    for (HingedBody& b : mb.bodies) {
      ReducedBody stiff = *b.body;
      stiff.omega *= 1e3;
      b.body = std::make_shared<const ReducedBody>(stiff);
    }
    Dynamics dynamics = make_dynamics(mb);
    ImplicitWork work = make_implicit_work(dynamics);
    ImplicitState state{random.state(mb, 0.0), VectorXd::Zero(mb.nv), VectorXd::Zero(mb.nv)};
    state.motion.v *= 0.2;
    accelerations(dynamics, 0.0, state.motion, state.v_dot);
    state.a = state.v_dot;
    generalized_alpha_step(dynamics, 0.0, 1e-3, {.tolerance = 1e-14}, work, state);
    set_forces(dynamics, 1e-3, state.motion);
    const MatrixXd M = testing::dense_operators(mb, dynamics.sweeps).mass();
    VectorXd bias(mb.nv);
    inverse_dynamics(mb, dynamics.sweeps, VectorXd::Zero(mb.nv), bias);
    const VectorXd size = (M.cwiseAbs() * state.v_dot.cwiseAbs() + bias.cwiseAbs() + dynamics.T.cwiseAbs());
    worst = std::max(worst, (M * state.v_dot + bias - dynamics.T).norm() / size.norm());
  }
  std::cout << "largest residual " << worst << " of its terms\n";
  EXPECT_LT(worst, 1e-9);
}

// An arm of 50 flexible links of 0.2 m with ten modes each, on joints held by springs and dampers, pushed by its root:
// steps 1e4 times too long for its fastest mode.
TEST(Implicit, LongArmIsStableFarBeyondItsFastestMode) {
  const auto link = std::make_shared<const ReducedBody>(titop::beam_body("link", {.length = 0.2,
                                                                                  .E = 200e9,
                                                                                  .G = 77e9,
                                                                                  .rho = 7800.0,
                                                                                  .A = 9e-4,
                                                                                  .Iy = 6.75e-8,
                                                                                  .Iz = 6.75e-8,
                                                                                  .J = 1.14e-7,
                                                                                  .Ip = 1.35e-7}));
  ASSERT_EQ(link->n(), 10);
  Multibody mb = serial_chain(link, 50, Deformation::dropped);
  for (HingedBody& b : mb.bodies) {
    b.stiffness = VectorXd::Constant(1, 2e4);
    b.damping = VectorXd::Constant(1, 2e3);
  }
  const double fastest = link->omega.maxCoeff(), h = 1e4 / fastest;
  Dynamics dynamics = make_dynamics(
      mb, [&](double t, const MotionState&, Sweeps&, VectorXd& T) { T[10] += t < 20.0 * h ? 500.0 : 0.0; });
  ImplicitWork work = make_implicit_work(dynamics);
  ImplicitState state{rest_state(mb), VectorXd::Zero(mb.nv), VectorXd::Zero(mb.nv)};
  int most = 0;
  double turned = 0.0, pushed = 0.0;
  const auto energy_now = [&] {
    set_state(mb, state.motion.q, state.motion.v, dynamics.sweeps);
    return energy(mb, dynamics.sweeps, state.motion.q, state.motion.v).total();
  };
  for (int k = 0; k < 400; ++k) {
    generalized_alpha_step(dynamics, k * h, h, {}, work, state);
    most = std::max(most, work.iterations);
    ASSERT_TRUE(state.motion.q.allFinite());
    for (const int at : mb.q_offset) turned = std::max(turned, std::abs(state.motion.q[at + link->n()]));
    if (k <= 20) pushed = std::max(pushed, energy_now());
  }
  const double rest = energy_now();
  std::cout << "step " << h << " s, at most " << most << " iterations, largest angle " << turned << " rad, energy "
            << pushed << " J under the push and " << rest << " J at last\n";
  EXPECT_LE(most, 6);
  EXPECT_GT(turned, 1e-3);
  EXPECT_LT(rest, 0.5 * pushed);  // nothing feeds it after the push, and dampers take
}

// A free satellite: a hub, and appendages on springs of every attitude-carrying and plain hinge.
Multibody satellite() {
  Multibody mb;
  const auto box = [](const std::string& name, double mass, const Vec3& size) {
    const Vec3 J = mass / 12.0 * (size.squaredNorm() * Vec3::Ones() - size.cwiseAbs2());
    return std::make_shared<const ReducedBody>(reduction::rigid_body(
        name, mass, 0.5 * Vec3(0.0, size.y(), 0.0), J.asDiagonal(),
        {{"root", Vec3::Zero(), Mat3::Identity(), {}}, {"end", {0.1, size.y(), 0.2}, Mat3::Identity(), {}}}));
  };
  const auto add = [&](const char* name, const std::shared_ptr<const ReducedBody>& body, int parent, int port,
                       HingeKind kind, double stiffness) {
    HingedBody b;
    b.name = name;
    b.body = body;
    b.parent = parent;
    b.inner_port = port;
    b.outer_port = 0;
    b.kind = kind;
    b.stiffness = VectorXd::Constant(b.dofs(), stiffness);
    mb.bodies.push_back(b);
  };
  add("hub", box("hub", 50.0, {1.0, 1.2, 0.8}), -1, -1, HingeKind::free, 0.0);
  add("panel", box("panel", 8.0, {0.8, 2.0, 0.05}), 0, 1, HingeKind::revolute, 30.0);
  add("tip", box("tip", 3.0, {0.4, 1.0, 0.05}), 1, 1, HingeKind::universal, 10.0);
  add("dish", box("dish", 5.0, {1.0, 0.3, 1.0}), 0, 0, HingeKind::spherical, 20.0);
  index(mb);
  return mb;
}

// What a run of the midpoint kept, as shares.
struct Kept {
  double momentum = 0.0, energy = 0.0;
};
Kept run_midpoint(const Multibody& mb, const MotionState& start, double h, int steps) {
  Dynamics dynamics = make_dynamics(mb);
  ImplicitWork work = make_implicit_work(dynamics);
  ImplicitState state{start, VectorXd::Zero(mb.nv), {}};
  accelerations(dynamics, 0.0, start, state.v_dot);
  Sweeps sweeps = make_sweeps(mb);
  set_state(mb, start.q, start.v, sweeps);
  const Vec6 before = momentum(mb, sweeps, start.v);
  const double energy_before = energy(mb, sweeps, start.q, start.v).total();
  Kept kept;
  long iterations = 0;
  for (int k = 1; k <= steps; ++k) {
    midpoint_step(dynamics, k * h, h, {}, work, state);
    iterations += work.iterations;
    if (k % 50 != 0) continue;
    set_state(mb, state.motion.q, state.motion.v, sweeps);
    const Vec6 change = momentum(mb, sweeps, state.motion.v) - before;
    kept.momentum = std::max({kept.momentum, change.head<3>().norm() / before.head<3>().norm(),
                              change.tail<3>().norm() / before.tail<3>().norm()});
    const double e = energy(mb, sweeps, state.motion.q, state.motion.v).total();
    kept.energy = std::max(kept.energy, std::abs(e / energy_before - 1.0));
  }
  std::cout << steps << " steps: momentum " << kept.momentum << ", energy " << kept.energy << ", iterations a step "
            << static_cast<double>(iterations) / steps << "\n";
  return kept;
}

TEST(Implicit, MidpointKeepsWhatASatelliteOnSpringsKeeps) {
  const Multibody mb = satellite();
  MotionState start = rest_state(mb);
  start.v.head<6>() << 0.3, -0.1, 0.2, 0.1, 0.8, 0.4;  // spins, and its appendages swing out and back
  const Kept kept = run_midpoint(mb, start, 2e-3, 100000);
  EXPECT_LT(kept.momentum, 1e-9);
  EXPECT_LT(kept.energy, 1e-7);
}

// A free body whose mass follows its deformation: nodes of mass on six shapes, stretched and spinning.
TEST(Implicit, MidpointKeepsWhatAFreeFlexibleBodyKeeps) {
  tests::LumpedBody lumped = tests::random_lumped(7, 12, 6, false, false);
  lumped.body.omega = VectorXd::LinSpaced(6, 3.0, 40.0);
  Multibody mb;
  HingedBody b;
  b.name = "body";
  b.body = std::make_shared<const ReducedBody>(lumped.body);
  b.kind = HingeKind::free;
  mb.bodies.push_back(b);
  index(mb);
  MotionState start = rest_state(mb);
  start.q.head<6>() << 0.1, -0.05, 0.02, 0.01, 0.0, -0.01;
  start.v << 0.05, 0.1, 0.0, -0.1, 0.05, 0.0, 0.3, -0.1, 0.2, 0.2, 0.5, 0.3;
  const Kept kept = run_midpoint(mb, start, 1e-3, 100000);
  EXPECT_LT(kept.momentum, 1e-9);
  EXPECT_LT(kept.energy, 1e-7);
}

}  // namespace
}  // namespace tenon::assembly
