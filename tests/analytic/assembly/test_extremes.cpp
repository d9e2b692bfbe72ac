#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "assembly/disjoint.hpp"
#include "assembly/second_order.hpp"
#include "fem/error.hpp"
#include "tests/reference/networks.hpp"

using namespace tenon;
using namespace tenon::assembly;
using Eigen::MatrixXd;

namespace {

// The quintic beam alone, grounded at P and, if wanted, at C.
Network grounded_beam(bool both) {
  Network net;
  net.bodies = {reference::polynomial_beam("beam")};
  net.ground = {{0, 0}};
  if (both) net.ground.push_back({0, 1});
  return net;
}

// Hub and two beams whose roots turn about z with a spring.
Network sprung_panels(double k) {
  Network net = reference::hub_and_panels(1.0, 8);
  for (Joint& joint : net.joints) {
    joint.kind = k > 0.0 ? JointKind::revolute : JointKind::weld;
    joint.stiffness = k;
  }
  return net;
}

}  // namespace

// ω² = k (1/J1 + 1/J2): the flexible mode keeps its digits whatever hangs on what.
TEST(Extremes, TwoInertiasOverTwentyFourDecades) {
  double worst = 0.0;
  for (const double ratio : {1e-12, 1e-8, 1e-4, 1.0, 1e4, 1e8, 1e12})
    for (const double k : {1e-8, 1.0, 1e8, 1e16}) {
      const SystemModes found = modes(second_order(reference::two_inertias(1.0, ratio, k)));
      ASSERT_EQ(found.rigid, 6);
      ASSERT_EQ(found.omega.size(), 7);
      const double expected = std::sqrt(k * (1.0 + 1.0 / ratio));
      worst = std::max(worst, std::abs(found.omega[6] / expected - 1.0));
    }
  fmt::print("two inertias: worst relative error {:.1e}\n", worst);
  EXPECT_LT(worst, 1e-10);  // ε √ratio
}

// Relative rotation under a drive torque: θ = T / (k − ω²J + jωf) with J = J1 J2/(J1 + J2).
TEST(Extremes, ResponseOfTheJointOverTwentyFourDecades) {
  double worst = 0.0;
  for (const double ratio : {1e-12, 1e-6, 1.0, 1e6, 1e12})
    for (const double k : {0.0, 1.0, 1e8, 1e16}) {
      Network net = reference::two_inertias(1.0, ratio, k);
      net.joints[0].damping = 0.3;
      net.inputs = {{"torque", {}, 0, 0}};
      net.outputs = {{"angle", Quantity::position, {}, 0, 0}};
      const SecondOrderSystem system = second_order(net);
      ASSERT_EQ(system.rigid, k > 0.0 ? 6 : 7);
      const titop::StateSpace ss = state_space(net, system);
      const double J = ratio / (1.0 + ratio), omega = 0.7;
      const std::complex<double> expected = 1.0 / std::complex<double>(k - omega * omega * J, omega * 0.3);
      worst = std::max(worst, std::abs(response(system, omega)(0, 0) / expected - 1.0));
      worst = std::max(worst, std::abs(response(ss, omega)(0, 0) / expected - 1.0));
    }
  fmt::print("drive torque to relative angle: worst relative error {:.1e}\n", worst);
  EXPECT_LT(worst, 1e-9);
}

// Stiff springs converge to the weld: first order in 1/k until round-off takes over.
TEST(Extremes, StiffJointsConvergeToTheWeld) {
  const SystemModes weld = modes(second_order(sprung_panels(0.0)));
  ASSERT_EQ(weld.rigid, 6);
  double before = 1e300;
  for (double k = 1.0; k < 3e16; k *= 10.0) {
    const SystemModes found = modes(second_order(sprung_panels(k)));
    ASSERT_EQ(found.rigid, 6) << k;
    ASSERT_EQ(found.omega.size(), weld.omega.size() + 2);
    double error = 0.0;
    for (int i = 6; i < 12; ++i) error = std::max(error, std::abs(found.omega[i] / weld.omega[i] - 1.0));
    EXPECT_TRUE(k < 1e3 || error < 200.0 / k + 1e-13) << "k " << k << " error " << error;
    EXPECT_LT(error, std::max(before, 1e-13)) << k;
    before = error;
  }
}

TEST(Extremes, GroundedQuinticBeamHasThePaperFrequencies) {
  const SecondOrderSystem clamped_free = second_order(grounded_beam(false)),
                          clamped = second_order(grounded_beam(true));
  EXPECT_EQ(clamped_free.rigid, 0);
  EXPECT_NEAR(modes(clamped_free).omega[0], 3.5160, 5e-5);
  EXPECT_NEAR(modes(clamped_free).omega[1], 22.158, 5e-4);
  // the other directions of the beam are rigid: grounding them twice says nothing new
  EXPECT_EQ(clamped.redundant, 4);
  EXPECT_EQ(clamped.rigid, 0);
  ASSERT_EQ(modes(clamped).omega.size(), 2);
  EXPECT_NEAR(modes(clamped).omega[0], 22.45, 5e-3);
  EXPECT_NEAR(modes(clamped).omega[1], 62.929, 5e-4);
  EXPECT_THAT(clamped.redundant_rows, ::testing::Each(::testing::HasSubstr("ground of beam.")));
}

TEST(Extremes, MotionWithoutMassAndStiffnessIsRefusedByName) {
  Network net = reference::two_inertias(1.0, 0.0, 0.0);  // the second body cannot resist turning about z
  try {
    second_order(net);
    FAIL() << "accepted a massless rigid motion";
  } catch (const ModelError& e) {
    EXPECT_THAT(e.what(), ::testing::HasSubstr("'two'"));
    EXPECT_THAT(e.what(), ::testing::Not(::testing::HasSubstr("'one'")));
  }
}

TEST(Extremes, MasslessBodyOnASpringFollowsStatically) {
  Network net = reference::two_inertias(2.0, 0.0, 5.0);
  net.ground = {{0, 0}};
  net.inputs = {{"torque", PortRef{1, 0}, 5, {}}};
  net.outputs = {{"angle", Quantity::position, PortRef{1, 0}, 5, {}}};
  const SecondOrderSystem system = second_order(net);
  EXPECT_EQ(system.massless, 1);
  EXPECT_EQ(modes(system).omega.size(), 0);
  EXPECT_NEAR(response(system, 3.0)(0, 0).real(), 1.0 / 5.0, 1e-15);
  EXPECT_NEAR(response(state_space(net, system), 3.0)(0, 0).real(), 1.0 / 5.0, 1e-15);
  net.outputs[0].quantity = Quantity::acceleration;
  EXPECT_THROW(state_space(net, second_order(net)), ModelError);
}

TEST(Extremes, StaticResponseOfAFreeNetworkIsRefused) {
  EXPECT_THROW(response(second_order(reference::two_inertias(1.0, 1.0, 1.0)), 0.0), ModelError);
}

// The reduced matrices are exact diagonals; the basis makes them true, and modes are orthonormal in the full masses.
TEST(Extremes, BasisNormalisesMassAndStiffness) {
  const Network net = sprung_panels(40.0);
  const SecondOrderSystem s = second_order(net);
  const DisjointSystem parts = disjoint(net);
  EXPECT_LT((s.G * s.N).norm(), 1e-13 * s.N.norm());
  EXPECT_LT((s.N.transpose() * parts.M * s.N - s.M).norm(), 1e-12 * s.M.norm());
  EXPECT_LT((s.N.transpose() * parts.K * s.N - s.K).norm(), 1e-12 * s.K.norm());
  EXPECT_LT((parts.mass_root.transpose() * parts.mass_root - parts.M).norm(), 1e-13 * parts.M.norm());
  const SystemModes m = modes(s);
  const MatrixXd shapes = s.N * m.shapes;
  const MatrixXd one = shapes.transpose() * parts.M * shapes;
  EXPECT_LT((one - MatrixXd::Identity(one.rows(), one.cols())).norm(), 1e-10);
}
