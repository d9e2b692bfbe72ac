#include <gtest/gtest.h>

#include <cmath>
#include <iostream>
#include <numbers>

#include "assembly/recursion/lowest_modes.hpp"
#include "fem/error.hpp"

// 10,000 masses on springs in a row, fixed at one end: ω_j = 2 √(k/m) sin((2j − 1)π / (2(2N + 1))).
namespace tenon::assembly {
namespace {

using Eigen::VectorXd;

constexpr int bodies = 10000;
constexpr double mass = 2.0, spring = 5.0;

Multibody chain(int count = bodies) {
  const auto body = std::make_shared<const ReducedBody>(reduction::rigid_body(
      "mass", mass, Vec3::Zero(), 0.01 * Mat3::Identity(),
      {{"in", Vec3::Zero(), Mat3::Identity(), {}}, {"out", Vec3::UnitZ(), Mat3::Identity(), {}}}));
  Multibody system;
  for (int k = 0; k < count; ++k) {
    HingedBody b;
    b.name = "mass";
    b.body = body;
    b.parent = k - 1;
    b.inner_port = 1;
    b.outer_port = 0;
    b.kind = HingeKind::prismatic;
    b.stiffness = VectorXd::Constant(1, spring);
    system.bodies.push_back(b);
  }
  index(system);
  return system;
}

// 𝓜⁻¹ of the chain is the second difference over m, of condition (4N/π)² = 1.6e8: of 16 digits a solve keeps 8.
TEST(LongChain, InverseDynamicsOfForwardDynamicsReturnsTheForces) {
  const Multibody system = chain();
  Sweeps sweeps = make_sweeps(system);
  const MotionState rest = rest_state(system);
  set_state(system, rest.q, rest.v, sweeps);
  articulate(system, sweeps);
  const VectorXd forces =
      VectorXd::NullaryExpr(bodies, [](Eigen::Index i) { return std::sin(0.1 * static_cast<double>(i) + 1.0); });
  VectorXd acceleration(bodies), back(bodies);
  forward_dynamics(system, sweeps, forces, acceleration);
  inverse_dynamics(system, sweeps, acceleration, back);
  const double error = (back - forces).cwiseAbs().maxCoeff();
  std::cout << "forces come back within " << error << "\n";
  EXPECT_LT(error, 1e-6);
}

TEST(LongChain, LowestFrequenciesAreThoseOfTheFormula) {
  const LowestModes modes = lowest_modes(chain(), 3);
  double worst = 0.0;
  for (int j = 1; j <= 3; ++j) {
    const double expected =
        2.0 * std::sqrt(spring / mass) * std::sin((2 * j - 1) * std::numbers::pi / (2.0 * (2.0 * bodies + 1.0)));
    worst = std::max(worst, std::abs(modes.omega[j - 1] / expected - 1.0));
  }
  std::cout << "three lowest frequencies within " << worst << "\n";
  EXPECT_LT(worst, 1e-8);
}

TEST(LongChain, ModesThatLanczosCannotGiveAreRefused) {
  EXPECT_THROW(lowest_modes(chain(2), 0), ModelError);
  EXPECT_THROW(lowest_modes(chain(1), 1), ModelError);
  EXPECT_EQ(lowest_modes(chain(2), 5).omega.size(), 1);  // all but one
}

TEST(LongChain, AHingeWithoutSpringIsRefused) {
  Multibody system = chain();
  system.bodies[17].stiffness.setZero();
  system.bodies[17].name = "loose";
  try {
    lowest_modes(system, 3);
    FAIL();
  } catch (const ModelError& error) {
    EXPECT_NE(std::string(error.what()).find("'loose'"), std::string::npos) << error.what();
  }
}

}  // namespace
}  // namespace tenon::assembly
