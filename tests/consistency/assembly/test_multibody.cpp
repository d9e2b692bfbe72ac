#include <gtest/gtest.h>

#include <algorithm>
#include <iostream>
#include <numbers>
#include <numeric>

#include "assembly/integration/dynamics.hpp"
#include "assembly/recursion/closure.hpp"
#include "assembly/recursion/linearise.hpp"
#include "assembly/second_order.hpp"
#include "fem/error.hpp"
#include "random_multibody.hpp"
#include "tests/reference/networks.hpp"
#include "tests/refusal.hpp"

// Networks as systems with finite motion: linearised at rest they are the linear system of the same scene, and their
// closed loops obey what dense algebra says.
namespace tenon::assembly {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;
using testing::RandomMultibody;
using testing::RandomNetwork;

MatrixXd null_space(const MatrixXd& J, Index nv) {
  if (J.rows() == 0) return MatrixXd::Identity(nv, nv);
  const Eigen::JacobiSVD<MatrixXd> svd(J, Eigen::ComputeFullV);
  const VectorXd& s = svd.singularValues();
  Index rank = 0;
  while (rank < s.size() && s[rank] > 1e-11 * s[0]) ++rank;
  return svd.matrixV().rightCols(nv - rank);
}

bool driven(const Joint& joint) { return joint.stiffness + joint.damping + joint.inertia > 0.0; }

// Whether joints that carry drives close a loop among themselves: finite motion takes drives in the tree alone.
bool driven_loop(const Network& network) {
  std::vector<int> piece(network.bodies.size());
  std::iota(piece.begin(), piece.end(), 0);
  for (const Joint& joint : network.joints) {
    const int a = piece[static_cast<std::size_t>(joint.parent.body)],
              b = piece[static_cast<std::size_t>(joint.child.body)];
    if (driven(joint) && a == b) return true;
    if (driven(joint)) std::replace(piece.begin(), piece.end(), a, b);
  }
  return false;
}

// Four equal bars in a square, hinged about z, the first one grounded.
Network four_bars() {
  Network net;
  for (const char* name : {"base", "right", "top", "left"}) net.bodies.push_back(reference::rigid_bar(name));
  for (int k = 0; k < 4; ++k) {
    Joint joint;
    joint.name = "hinge" + std::to_string(k);
    joint.parent = {k, 1};
    joint.child = {(k + 1) % 4, 0};
    joint.kind = JointKind::revolute;
    joint.axis = Vec3::UnitZ();
    joint.angle = 0.5 * std::numbers::pi;
    net.joints.push_back(joint);
  }
  net.ground = {{0, 0}};
  return net;
}

// Wherever it stands in the loop and in the list, the joint without a drive closes it.
TEST(Multibody, DrivesGoIntoTheTree) {
  for (std::size_t first = 0; first < 4; ++first)
    for (std::size_t plain = 0; plain < 4; ++plain)
      for (const bool by_input : {false, true}) {
        Network net = four_bars();
        std::rotate(net.joints.begin(), net.joints.begin() + static_cast<long>(first), net.joints.end());
        for (std::size_t j = 0; j < 4; ++j) {
          if (j == plain) continue;
          if (by_input)
            net.inputs.push_back({"drive", {}, 0, static_cast<int>(j)});
          else
            net.joints[j].stiffness = 10.0;
        }
        const NetworkMultibody mb = make_multibody(net);
        EXPECT_EQ(mb.system.closures.size(), 1u);
        EXPECT_EQ(mb.closure[plain], 0) << first << " " << plain;
        EXPECT_EQ(std::count(mb.hinge.begin(), mb.hinge.end(), -1), 1);
      }
  Network net = four_bars();
  for (Joint& joint : net.joints) joint.damping = 0.1;
  const std::string refusal = tests::refusal([&] { make_multibody(net); });
  EXPECT_NE(refusal.find("as every joint of the loop does"), std::string::npos) << refusal;
}

TEST(Multibody, LinearisedAtRestIsTheLinearSystem) {
  double worst_frequency = 0.0, worst_response = 0.0;
  int compared = 0, loops = 0, refused = 0, undecided = 0;
  for (unsigned seed = 1; seed <= 150; ++seed) {
    RandomNetwork random(seed);
    Network network = random.scene();
    if (driven_loop(network)) {
      const std::string refusal = tests::refusal([&] { make_multibody(network); });
      EXPECT_NE(refusal.find("carries a drive"), std::string::npos) << "seed " << seed << ": " << refusal;
      ++refused;
      continue;
    }
    const NetworkMultibody mb = make_multibody(network);
    const std::string doubt = tests::refusal([&] { modes(second_order(network)); });
    if (!doubt.empty()) {
      EXPECT_NE(doubt.find("cannot be decided"), std::string::npos) << doubt;
      ++undecided;  // a loop stands where it locks: nothing to compare with
      continue;
    }
    ++compared;
    loops += mb.system.closures.empty() ? 0 : 1;
    const LinearMotion linear = linearise(mb.system, rest_state(mb.system), VectorXd::Zero(mb.system.nv));
    const MatrixXd N = null_space(linear.J, mb.system.nv);
    const SecondOrderSystem reference = second_order(network);
    const SystemModes expected = modes(reference);
    const MatrixXd M = N.transpose() * linear.M * N, K = N.transpose() * linear.K * N;
    ASSERT_EQ(M.rows(), expected.omega.size()) << "seed " << seed;
    if (M.rows() == 0) continue;
    const VectorXd lambda =
        Eigen::GeneralizedSelfAdjointEigenSolver<MatrixXd>(K, M, Eigen::EigenvaluesOnly).eigenvalues();
    for (Index k = expected.rigid; k < lambda.size(); ++k)
      worst_frequency = std::max(worst_frequency, std::abs(std::sqrt(lambda[k]) / expected.omega[k] - 1.0));

    // response of the first input's own acceleration: a force at a port
    const double omega = 1.3 * expected.omega.tail(1)[0] / 7.0 + 0.1;
    Sweeps sweeps = make_sweeps(mb.system);
    const MotionState rest = rest_state(mb.system);
    set_state(mb.system, rest.q, rest.v, sweeps);
    const std::complex<double> s(0.0, omega);
    const MatrixXd C = N.transpose() * linear.C * N;
    const Eigen::MatrixXcd dynamic = s * s * M.cast<std::complex<double>>() + s * C + K.cast<std::complex<double>>();
    const Eigen::MatrixXcd H = response(reference, omega);
    for (std::size_t i = 0; i < network.inputs.size(); ++i) {
      const Input& in = network.inputs[i];
      if (!in.joint || mb.hinge[static_cast<std::size_t>(*in.joint)] < 0) continue;
      const auto body = static_cast<std::size_t>(mb.hinge[static_cast<std::size_t>(*in.joint)]);
      VectorXd b = VectorXd::Zero(mb.system.nv);
      const Index at = mb.system.v_offset[body] + mb.system.bodies[body].modes();
      b[at] = 1.0;
      const double open = linear.M.ldlt().solve(b)[at];  // a loop may lock the hinge: then both are round-off of this
      const Eigen::VectorXcd x = N * dynamic.partialPivLu().solve(Eigen::VectorXcd(N.transpose() * b));
      for (std::size_t o = 0; o < network.outputs.size(); ++o)
        if (network.outputs[o].joint == in.joint) {
          const std::complex<double> expected_gain = H(static_cast<Index>(o), static_cast<Index>(i));
          worst_response = std::max(worst_response,
                                    std::abs(s * s * x[at] - expected_gain) / std::max(open, std::abs(expected_gain)));
        }
    }
  }
  std::cout << compared << " scenes, " << loops << " with loops, " << refused << " refused, " << undecided
            << " undecided: frequencies " << worst_frequency << ", responses " << worst_response << "\n";
  EXPECT_GT(compared, 60);
  EXPECT_GT(loops, 15);
  EXPECT_GT(refused, 0);
  EXPECT_LT(undecided, 5);
  EXPECT_LT(worst_frequency, 1e-9);
  EXPECT_LT(worst_response, 1e-8);
}

// Closures of every kind between random bodies: rates are differences of gaps, accelerations are those of the dense
// saddle-point system.
TEST(Multibody, ClosureRowsAreRatesAndCloseTheLoops) {
  double worst_rate = 0.0, worst_J = 0.0, worst_gamma = 0.0, worst_kkt = 0.0, worst_gap = 0.0;
  int closed = 0, projected = 0;
  for (unsigned seed = 1; seed <= 150; ++seed) {
    RandomMultibody random(seed);
    Multibody mb = random.system(6, Deformation::full);
    const int last = static_cast<int>(mb.bodies.size()) - 1;
    for (int c = 0; c < 2; ++c) {
      Closure closure;
      closure.kind = static_cast<HingeKind>(random.random.integer(0, 6));
      closure.inner = {random.random.integer(-1, last), 0};
      closure.outer = {random.random.integer(0, last), 1};
      if (closure.inner.body == closure.outer.body) continue;
      closure.inner_position = random.random.vector(1.0);
      closure.inner_axes = random.random.rotation();
      closure.outer_axes = random.random.rotation();
      mb.closures.push_back(closure);
    }
    if (mb.closures.empty() || mb.nv == 0) continue;
    const MotionState state = random.state(mb, 0.1);
    Sweeps sweeps = make_sweeps(mb);
    ClosureRows rows = make_closure_rows(mb), before = rows, after = rows;
    const double h = 1e-4;
    VectorXd q = state.q;
    move(mb, -h * state.v, q);
    set_state(mb, q, state.v, sweeps);
    closure_rows(mb, sweeps, q, state.v, before);
    q = state.q;
    move(mb, h * state.v, q);
    set_state(mb, q, state.v, sweeps);
    closure_rows(mb, sweeps, q, state.v, after);
    set_state(mb, state.q, state.v, sweeps);
    closure_rows(mb, sweeps, state.q, state.v, rows);
    const double speed = 1.0 + rows.rate.norm() + sweeps.bodies.back().V.norm();
    worst_rate = std::max(worst_rate, ((after.gap - before.gap) / (2 * h) - rows.rate).norm() / std::pow(speed, 3));
    worst_J = std::max(worst_J, (rows.J_t.transpose() * state.v - rows.rate).norm() / speed);
    worst_gamma =
        std::max(worst_gamma, ((after.rate - before.rate) / (2 * h) - rows.gamma).norm() / std::pow(speed, 4));

    articulate(mb, sweeps);
    const VectorXd f = random.vector(mb.nv, 1.0);
    VectorXd v_dot(mb.nv), lambda(rows.rows()), bias(mb.nv);
    forward_dynamics(mb, sweeps, f, v_dot);
    ClosureInertia inertia = closure_inertia(mb, sweeps, rows);
    close(rows, inertia, v_dot, lambda);
    if (inertia.redundant > 0) continue;
    inverse_dynamics(mb, sweeps, VectorXd::Zero(mb.nv), bias);
    MatrixXd mass;
    composite_mass_matrix(mb, sweeps, mass);
    const Index m = rows.rows();
    MatrixXd saddle = MatrixXd::Zero(mb.nv + m, mb.nv + m);
    saddle.topLeftCorner(mb.nv, mb.nv) = mass;
    saddle.topRightCorner(mb.nv, m) = -rows.J_t;
    saddle.bottomLeftCorner(m, mb.nv) = rows.J_t.transpose();
    VectorXd right(mb.nv + m);
    right << f - bias, -rows.gamma;
    const VectorXd expected = saddle.fullPivLu().solve(right);
    worst_kkt = std::max(worst_kkt, (expected.head(mb.nv) - v_dot).norm() / expected.head(mb.nv).norm());
    ++closed;

    MotionState near = state;
    try {
      project(mb, sweeps, rows, near);
    } catch (const NumericalError&) {
      continue;  // a random loop need not be closable
    }
    ++projected;
    set_state(mb, near.q, near.v, sweeps);
    closure_rows(mb, sweeps, near.q, near.v, rows);
    worst_gap = std::max({worst_gap, rows.gap.norm() / rows.length, rows.rate.norm() / (1.0 + near.v.norm())});
  }
  std::cout << closed << " systems: rates " << worst_rate << ", J " << worst_J << ", gamma " << worst_gamma
            << ", accelerations against KKT " << worst_kkt << ", gap and rate after projection of " << projected << " "
            << worst_gap << "\n";
  EXPECT_GT(closed, 60);
  EXPECT_GT(projected, 20);  // most random loops cannot be closed
  EXPECT_LT(worst_J, 1e-12);
  EXPECT_LT(worst_rate, 2.0 * 1e-8);
  EXPECT_LT(worst_gamma, 2.0 * 1e-8);
  EXPECT_LT(worst_kkt, 1e-10);
  EXPECT_LT(worst_gap, 1e-9);
}

// A free box, held by a hinge to the ground.
Multibody held_box(HingeKind kind) {
  Multibody mb;
  HingedBody box;
  box.name = "box";
  box.body = std::make_shared<const ReducedBody>(
      reduction::rigid_body("box", 2.0, {0.1, 0.2, 0.3}, Vec3(1.0, 2.0, 1.5).asDiagonal().toDenseMatrix(),
                            {{"pin", {0.4, -0.3, 0.2}, Mat3::Identity(), {}}}));
  box.kind = HingeKind::free;
  mb.bodies = {box};
  Closure gate;
  gate.name = "gate";
  gate.inner = {-1, -1};
  gate.outer = {0, 0};
  gate.kind = kind;
  mb.closures = {gate};
  index(mb);
  return mb;
}

// Half a turn about x or y opposes the axes of a hinge, one about z those that a weld or a slide holds: the rows a·b =
// 0 vanish there as well, and a start near it is drawn to it.
TEST(Multibody, AHingeTurnedOverDoesNotCloseALoop) {
  for (const HingeKind kind : {HingeKind::weld, HingeKind::revolute, HingeKind::prismatic, HingeKind::cylindrical,
                               HingeKind::universal, HingeKind::spherical, HingeKind::planar})
    for (int axis = 0; axis < 3; ++axis) {
      const bool tilts = kind == HingeKind::universal || kind == HingeKind::spherical;
      const bool turns = kind != HingeKind::weld && kind != HingeKind::prismatic;
      const bool wrong = !tilts && (axis < 2 || !turns);
      Multibody mb = held_box(kind);
      Sweeps sweeps = make_sweeps(mb);
      ClosureRows rows = make_closure_rows(mb);
      VectorXd turn = VectorXd::Zero(6);
      for (const double angle : {0.1, std::numbers::pi - 0.1}) {
        MotionState state = rest_state(mb);
        turn[3 + axis] = angle;
        move(mb, turn, state.q);
        const std::string refusal = tests::refusal([&] { project(mb, sweeps, rows, state); });
        EXPECT_EQ(refusal.find("closure 'gate'") != std::string::npos, wrong && angle > 1.0) << name(kind) << refusal;
        Dynamics dynamics = make_dynamics(mb);
        if (!wrong || angle < 1.0) {
          EXPECT_EQ(tests::refusal([&] { check_state(dynamics, state); }), "") << name(kind);
          continue;
        }
        state = rest_state(mb);  // there to round-off: the body turned about its reference, moved so that the pin fits
        turn[3 + axis] = std::numbers::pi;
        move(mb, turn, state.q);
        set_state(mb, state.q, state.v, sweeps);
        closure_rows(mb, sweeps, state.q, state.v, rows);
        const RigidMotion& at = sweeps.bodies[0].world;
        state.q.head<3>() -= at.r + at.R * (mb.bodies[0].body->ports[0].position - mb.bodies[0].body->reference);
        const std::string start = tests::refusal([&] { check_state(dynamics, state); });
        EXPECT_NE(start.find("closure 'gate'"), std::string::npos) << name(kind) << start;
      }
    }
}

TEST(Multibody, ClosuresThatMakeNoSenseAreRefused) {
  const auto refusal = [](auto change) {
    Multibody mb = held_box(HingeKind::revolute);
    change(mb.closures[0]);
    const std::string rows = tests::refusal([&] { make_closure_rows(mb); });
    EXPECT_EQ(rows, tests::refusal([&] { index(mb); }));
    return rows;
  };
  const auto named = [](const std::string& what) { return what.find("closure 'gate'") != std::string::npos; };
  EXPECT_EQ(refusal([](Closure&) {}), "");
  EXPECT_TRUE(named(refusal([](Closure& c) { c.outer.body = 1; })));
  EXPECT_TRUE(named(refusal([](Closure& c) { c.outer.body = -1; })));
  EXPECT_TRUE(named(refusal([](Closure& c) { c.outer.port = 1; })));
  EXPECT_TRUE(named(refusal([](Closure& c) { c.inner.body = -2; })));
  EXPECT_TRUE(named(refusal([](Closure& c) { c.inner = {0, 7}; })));
  EXPECT_TRUE(named(refusal([](Closure& c) { c.outer_axes(0, 0) = 2.0; })));
  EXPECT_TRUE(named(refusal([](Closure& c) { c.inner_axes = -Mat3::Identity(); })));
  EXPECT_TRUE(named(refusal([](Closure& c) { c.inner_axes(1, 2) = std::nan(""); })));
  EXPECT_TRUE(named(refusal([](Closure& c) { c.inner_position.x() = std::nan(""); })));
  EXPECT_TRUE(named(refusal([](Closure& c) { c.kind = HingeKind::free; })));
}

TEST(Multibody, FramesAndGravityThatAreNoneAreRefused) {
  const auto refusal = [](auto change) {
    Multibody mb = held_box(HingeKind::revolute);
    change(mb);
    return tests::refusal([&] { index(mb); });
  };
  EXPECT_NE(refusal([](Multibody& mb) { mb.bodies[0].outer_axes *= 2.0; }).find("body 'box'"), std::string::npos);
  EXPECT_NE(refusal([](Multibody& mb) { mb.bodies[0].inner_axes(0, 1) = std::nan(""); }).find("'box'"),
            std::string::npos);
  EXPECT_NE(refusal([](Multibody& mb) { mb.bodies[0].inner_position.y() = HUGE_VAL; }).find("'box'"),
            std::string::npos);
  EXPECT_NE(refusal([](Multibody& mb) { mb.gravity.z() = std::nan(""); }).find("gravity"), std::string::npos);
}

TEST(Multibody, WithoutClosuresNothingIsMoved) {
  Multibody mb = held_box(HingeKind::revolute);
  mb.closures.clear();
  Sweeps sweeps = make_sweeps(mb);
  ClosureRows rows = make_closure_rows(mb);
  MotionState state = rest_state(mb);
  state.v.setOnes();
  EXPECT_EQ(project(mb, sweeps, rows, state), 0.0);
  EXPECT_EQ(state.v, VectorXd::Ones(6));
  EXPECT_EQ(closure_inertia(mb, sweeps, rows).X.cols(), 0);
}

}  // namespace
}  // namespace tenon::assembly
