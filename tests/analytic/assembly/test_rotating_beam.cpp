// A uniform cantilever turning steadily about an axis through its root, as a body of the recursions: linearised about
// the spin its modes are those of the equation of the rotating beam (Hodges and Rutkowski, AIAA J. 19 (1981) 1459;
// values to all digits by an independent Ritz computation with polynomials). Chord and flap: chord² = flap² − λ².
#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>
#include <iostream>

#include "assembly/recursion/linearise.hpp"
#include "assembly/recursion/stiffening.hpp"
#include "reduction/geometric_stiffness.hpp"
#include "reduction/reduce.hpp"
#include "tests/unit/reduction/beams.hpp"

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
  const fem::Model model = tests::beam(data, {{"root", 0}, {"tip", data.elements}});
  const fem::Structure structure = fem::assemble(model);
  reduction::ReducedBody body = reduction::reduce(structure, "root", {.modes = 24, .nonlinear = true});
  body.name = "blade";
  if (stiffening)
    body.stiffening =
        std::make_shared<const reduction::GeometricStiffness>(reduction::geometric_stiffness(model, structure, body));
  HingedBody blade;
  blade.name = body.name;
  blade.body = std::make_shared<const ReducedBody>(body);
  blade.outer_port = 0;
  blade.kind = HingeKind::revolute;
  Multibody system;
  system.bodies = {blade};
  index(system);
  return system;
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
  struct Row {
    double lambda, flap1, flap2;  // flap2: 0 where the source lists only the first
  };
  const std::vector<Row> rows{{0.0, 3.516015, 22.03449}, {1.0, 3.681647, 0.0},     {2.0, 4.137320, 0.0},
                              {4.0, 5.585001, 0.0},      {6.0, 7.36037, 26.80908}, {8.0, 9.256838, 0.0},
                              {12.0, 13.17015, 37.60311}};
  const tests::BeamData data = slender();
  const Multibody system = spinning(data, true);
  const double unit = data.bending(data.section.Iy);
  double worst = 0.0;
  for (const Row& row : rows) {
    const VectorXd omega = frequencies(system, row.lambda * unit) / unit;
    const double chord1 = std::sqrt(row.flap1 * row.flap1 - row.lambda * row.lambda);
    worst = std::max({worst, std::abs(omega[0] / chord1 - 1.0), std::abs(omega[1] / row.flap1 - 1.0)});
    if (row.flap2 == 0.0) continue;
    const double chord2 = std::sqrt(row.flap2 * row.flap2 - row.lambda * row.lambda);
    worst = std::max({worst, std::abs(omega[2] / chord2 - 1.0), std::abs(omega[3] / row.flap2 - 1.0)});
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

}  // namespace
}  // namespace tenon::assembly
