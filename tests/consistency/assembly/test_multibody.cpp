#include <gtest/gtest.h>

#include <iostream>

#include "assembly/recursion/closure.hpp"
#include "assembly/recursion/linearise.hpp"
#include "assembly/second_order.hpp"
#include "fem/error.hpp"
#include "random_multibody.hpp"

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

// Loops of which one carries a drive are left out: finite motion takes drives in the tree alone.
bool driven_loop(const Network& network) {
  for (const int j : place(network).closing_joints) {
    const Joint& joint = network.joints[static_cast<std::size_t>(j)];
    if (joint.stiffness + joint.damping + joint.inertia > 0.0) return true;
  }
  return false;
}

TEST(Multibody, LinearisedAtRestIsTheLinearSystem) {
  double worst_frequency = 0.0, worst_response = 0.0;
  int compared = 0, loops = 0;
  for (unsigned seed = 1; seed <= 150; ++seed) {
    RandomNetwork random(seed);
    Network network = random.scene();
    if (driven_loop(network)) continue;
    NetworkMultibody mb;
    try {
      mb = make_multibody(network);
    } catch (const ModelError&) {
      continue;  // another spanning tree puts a drive into the closing joint
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
      worst_frequency = std::max(worst_frequency, std::abs(std::sqrt(lambda[k]) / expected.omega[k] - 1.0) *
                                                      std::min(1.0, lambda[k] * 1e4 / lambda.tail(1)[0]));

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
  std::cout << compared << " scenes, " << loops << " with loops: frequencies " << worst_frequency << ", responses "
            << worst_response << "\n";
  EXPECT_GT(compared, 60);
  EXPECT_GT(loops, 15);
  EXPECT_LT(worst_frequency, 1e-9);
  EXPECT_LT(worst_response, 1e-8);
}

// Closures of every kind between random bodies: rates are differences of gaps, accelerations are those of the dense
// saddle-point system.
TEST(Multibody, ClosureRowsAreRatesAndCloseTheLoops) {
  double worst_rate = 0.0, worst_gamma = 0.0, worst_kkt = 0.0, worst_gap = 0.0;
  int closed = 0;
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
    worst_rate = std::max(worst_rate, (rows.J_t.transpose() * state.v - rows.rate).norm() / speed * h * h * 1e4);
    worst_gamma =
        std::max(worst_gamma, ((after.rate - before.rate) / (2 * h) - rows.gamma).norm() / std::pow(speed, 4));

    articulate(mb, sweeps);
    const VectorXd f = random.vector(mb.nv, 1.0);
    VectorXd v_dot(mb.nv), lambda(rows.rows()), bias(mb.nv);
    forward_dynamics(mb, sweeps, f, v_dot);
    const ClosureInertia inertia = closure_inertia(mb, sweeps, rows);
    close(rows, inertia, v_dot, lambda);
    if (inertia.redundant.cols() > 0) continue;
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
    set_state(mb, near.q, near.v, sweeps);
    closure_rows(mb, sweeps, near.q, near.v, rows);
    worst_gap = std::max({worst_gap, rows.gap.norm() / rows.length, rows.rate.norm() / (1.0 + near.v.norm())});
  }
  std::cout << closed << " systems: rates " << worst_rate << ", gamma " << worst_gamma << ", accelerations against KKT "
            << worst_kkt << ", gap and rate after projection " << worst_gap << "\n";
  EXPECT_GT(closed, 60);
  EXPECT_LT(worst_rate, 2.0 * 1e-8);
  EXPECT_LT(worst_gamma, 2.0 * 1e-8);
  EXPECT_LT(worst_kkt, 1e-8);
  EXPECT_LT(worst_gap, 1e-9);
}

}  // namespace
}  // namespace tenon::assembly
