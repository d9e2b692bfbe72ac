// A uniform cantilever turning steadily about an axis through its root, as a body of the recursions: linearised about
// the spin its modes are those of the equation of the rotating beam (Hodges and Rutkowski, AIAA J. 19 (1981) 1459;
// values to all digits by an independent Ritz computation with polynomials). Chord and flap: chord² = flap² − λ².
#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>
#include <iostream>
#include <numbers>

#include "assembly/integration/dynamics.hpp"
#include "assembly/recursion/linearise.hpp"
#include "assembly/recursion/stiffening.hpp"
#include "tests/analytic/assembly/rotating_blade.hpp"
#include "tests/reference/rotating_beam.hpp"

namespace tenon::assembly {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

// A beam so slender that its stretch under λ = 12 is below 1e-6; κ = 0, no rotary inertia: Euler-Bernoulli.
tests::BeamData slender() {
  tests::BeamData data;
  data.length = 10.0;
  data.elements = 160;  // the tension of an element is constant: error 0.4 (L/160)², below 2e-5
  data.section.Iy = data.section.Iz = 3e-10;
  data.section.J = 6e-10;
  return data;
}

Multibody spinning(const tests::BeamData& data, bool stiffening) {
  return testing::rotating_blade(data, 24, stiffening);
}

// Frequencies about the steady spin, the turn itself prescribed.
VectorXd frequencies(const Multibody& system, double spin) {
  MotionState state = rest_state(system);
  const Index n = system.bodies[0].modes();
  state.v[n] = spin;
  const LinearMotion linear = linearise(system, state, VectorXd::Zero(system.nv));
  const MatrixXd M = linear.M.topLeftCorner(n, n), C = linear.C.topLeftCorner(n, n), K = linear.K.topLeftCorner(n, n);
  MatrixXd A = MatrixXd::Zero(2 * n, 2 * n);
  A.topRightCorner(n, n).setIdentity();
  A.bottomLeftCorner(n, n) = -M.llt().solve(K);
  A.bottomRightCorner(n, n) = -M.llt().solve(C);
  VectorXd omega = Eigen::EigenSolver<MatrixXd>(A, false).eigenvalues().imag();
  std::sort(omega.data(), omega.data() + omega.size());
  return omega.tail(n);
}

TEST(RotatingBeam, FlapAndChordFollowTheSpin) {
  const tests::BeamData data = slender();
  const Multibody system = spinning(data, true);
  const double unit = data.bending(data.section.Iy);
  double worst = 0.0;
  for (const auto& [lambda, flap] : reference::rotating_beams) {
    const VectorXd omega = frequencies(system, lambda * unit) / unit;
    for (std::size_t mode = 0; mode < 2 && flap[mode] > 0.0; ++mode) {
      const double chord = std::sqrt(flap[mode] * flap[mode] - lambda * lambda);
      const auto at = static_cast<Index>(2 * mode);
      worst = std::max({worst, std::abs(omega[at] / chord - 1.0), std::abs(omega[at + 1] / flap[mode] - 1.0)});
    }
  }
  std::cout << "flap and chord of the rotating cantilever within " << worst << "\n";
  EXPECT_LT(worst, 1e-4);
}

// Without stiffening the chord mode loses λ² and falls to zero at λ = 3.516: what the spin ratio warns of.
TEST(RotatingBeam, WithoutStiffeningTheSpinSoftensAndIsSeen) {
  const tests::BeamData data = slender();
  const Multibody system = spinning(data, false);
  const double unit = data.bending(data.section.Iy), spin = 2.0 * unit;
  const VectorXd omega = frequencies(system, spin) / unit;
  EXPECT_NEAR(omega[0], std::sqrt(3.516015 * 3.516015 - 4.0), 1e-3);
  EXPECT_NEAR(omega[1], 3.516015, 1e-3);
  MotionState state = rest_state(system);
  state.v[system.bodies[0].modes()] = spin;
  Sweeps sweeps = make_sweeps(system);
  set_state(system, state.q, state.v, sweeps);
  const SpinRatio ratio = spin_ratio(system, sweeps);
  EXPECT_EQ(ratio.body, 0);
  EXPECT_NEAR(ratio.ratio, 2.0 / 3.516015, 1e-3);
}

// Afloat, gravity falls with the beam and stresses nothing; spun about its middle its root is drawn towards it by
// Ω²L/2.
TEST(RotatingBeam, AfloatItIsLoadedByWhatItsOwnMotionLeaves) {
  tests::BeamData data = slender();
  data.elements = 20;
  Multibody system = spinning(data, true);
  const ReducedBody& body = *system.bodies[0].body;
  const Index n = body.n();
  const auto K_G = [&](double spin) {
    MotionState state = rest_state(system);
    state.v.tail<1>()[0] = spin;
    Sweeps sweeps = make_sweeps(system);
    set_state(system, state.q, state.v, sweeps);
    return MatrixXd(sweeps.bodies[0].K_G);  // a copy: it stands in the sweeps' store
  };
  const auto expected = [&](const Vec3& a, double spin) {
    MatrixXd K(n, n);
    reduction::geometric_stiffness(*body.stiffening, a, Vec3::Zero(), spin * Vec3::UnitZ(), nullptr, K);
    return K;
  };
  const double spin = 3.0;
  system.gravity = {-5.0, 2.0, -9.81};
  const MatrixXd hung = expected(-system.gravity, 0.0), held = expected(-system.gravity, spin);
  EXPECT_LT((K_G(0.0) - hung).norm(), 1e-12 * hung.norm());
  EXPECT_LT((K_G(spin) - held).norm(), 1e-12 * held.norm());

  testing::set_afloat(system);
  EXPECT_LT(K_G(0.0).norm(), 1e-9 * hung.norm());  // round-off of the solve for its acceleration
  const MatrixXd free = expected(0.5 * spin * spin * data.length * Vec3::UnitX(), spin);
  EXPECT_LT((K_G(spin) - free).norm(), 1e-9 * held.norm());

  Closure pin;  // pinned to the ground after all: held again
  pin.name = "pin";
  pin.inner = {-1, -1};
  pin.outer = {0, 0};
  pin.kind = HingeKind::spherical;
  system.closures = {pin};
  EXPECT_LT((K_G(0.0) - hung).norm(), 1e-12 * hung.norm());
}

// Held at its root and pushed at its tip it buckles at π²EI/4L² (Euler). Afloat and pushed at its root by what lends it
// the acceleration a, it is stressed as one that stands in gravity a.
TEST(RotatingBeam, ForcesAtPortsStressIt) {
  tests::BeamData data = slender();
  data.elements = 40;
  Multibody system = spinning(data, true);
  const ReducedBody& body = *system.bodies[0].body;
  const Index n = body.n();
  const auto K_G = [&](int port, double push) {
    MotionState state = rest_state(system);
    state.q.head(n).setConstant(1e-9);
    Sweeps sweeps = make_sweeps(system);
    const BodySweep& beam = sweeps.bodies[0];
    set_state(system, state.q, state.v, sweeps);
    apply_wrench(system, state.q, 0, port, Vec6::Unit(0) * push, sweeps);
    const VectorXd before = beam.b.head(n);
    restiffen(system, state.q, sweeps);
    const VectorXd expected = beam.K_G * state.q.head(n);
    EXPECT_LT((beam.b.head(n) - before - expected).norm(), 1e-12 * expected.norm() + 1e-15 * before.norm());
    return MatrixXd(beam.K_G);
  };
  const MatrixXd K = body.omega.cwiseAbs2().asDiagonal(), pushed = K_G(1, -1.0);
  const Eigen::GeneralizedSelfAdjointEigenSolver<MatrixXd> buckling(-pushed, K, Eigen::EigenvaluesOnly);
  const double L = data.length, EI = data.material.E * data.section.Iy;
  const double Euler = std::numbers::pi * std::numbers::pi * EI / (4.0 * L * L);
  EXPECT_NEAR(1.0 / buckling.eigenvalues().maxCoeff() / Euler, 1.0, 1e-3);  // Ritz with its own modes
  const Loads push = [&](double, const MotionState& s, Sweeps& sweeps, VectorXd&) {
    apply_wrench(system, s.q, 0, 1, -Vec6::Unit(0), sweeps);
  };
  Dynamics dynamics = make_dynamics(system, push);  // and as the loads of a motion
  set_forces(dynamics, 0.0, rest_state(system));
  EXPECT_LT((dynamics.sweeps.bodies[0].K_G - pushed).norm(), 1e-6 * pushed.norm());

  testing::set_afloat(system);
  MatrixXd expected(n, n);
  const double a = 7.0;
  reduction::geometric_stiffness(*body.stiffening, a * Vec3::UnitX(), Vec3::Zero(), Vec3::Zero(), nullptr, expected);
  EXPECT_LT((K_G(0, a * data.mass_total()) - expected).norm(), 1e-6 * expected.norm());  // its modes stand at 1e-9
}

}  // namespace
}  // namespace tenon::assembly
