#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>

#include "assembly/port_algebra.hpp"
#include "assembly/second_order.hpp"
#include "tests/reference/networks.hpp"

using namespace tenon;
using namespace tenon::assembly;

namespace {

constexpr double ratios[] = {1e-12, 1e-8, 1e-4, 1e-2, 1.0, 1e2, 1e4, 1e8, 1e12};

// first three of each kind, exact
std::vector<double> exact(double ratio) {
  std::vector<double> omega;
  for (const bool rotation : {false, true})
    for (int i = 1; i <= 3; ++i) omega.push_back(reference::hub_and_panels_root(ratio, rotation, i));
  std::sort(omega.begin(), omega.end());
  return omega;
}

}  // namespace

TEST(HubAndPanels, OracleHasThePublishedValues) {
  const double translation[] = {4.218713, 23.703280, 63.451933}, rotation[] = {4.899577, 22.310512, 61.794873};
  for (int i = 0; i < 3; ++i) {
    EXPECT_NEAR(reference::hub_and_panels_root(1.0, false, i + 1), translation[i], 5e-7);
    EXPECT_NEAR(reference::hub_and_panels_root(1.0, true, i + 1), rotation[i], 5e-7);
  }
  EXPECT_NEAR(reference::hub_and_panels_root(1e-12, false, 1), 5.593321, 5e-6);  // free beam, sliding root
  EXPECT_NEAR(reference::hub_and_panels_root(1e-12, true, 1), 15.418206, 5e-6);  // pinned-free
}

// With n clamped-free modes and the exact rigid mass, the driving inertia lacks Σ_{j>n} L_j² ω²/(ω_j² − ω²). With
// L_j² ≈ 4/β_j², ω_j = β_j² and β_j ≈ jπ that is 4 ω² Σ β_j⁻⁶ ≈ 4 ω²/(5π (nπ)⁵); the frequency moves by about as much,
// relatively.
double truncation(double omega, int n) {
  return 4.0 * omega * omega / (5.0 * std::numbers::pi * std::pow(n * std::numbers::pi, 5));
}

TEST(HubAndPanels, FrequenciesOverTwentyFourDecadesOfMass) {
  double worst = 0.0;
  for (const double ratio : ratios) {
    const SecondOrderSystem system = second_order(reference::hub_and_panels(ratio, 40));
    const SystemModes found = modes(system);
    EXPECT_EQ(found.rigid, 6) << ratio;
    EXPECT_EQ(system.redundant, 0);
    EXPECT_EQ(system.massless, 0);
    ASSERT_EQ(found.omega.size(), 6 + 80);
    const std::vector<double> expected = exact(ratio);
    for (std::size_t i = 0; i < expected.size(); ++i)
      worst = std::max(worst, std::abs(found.omega[6 + static_cast<int>(i)] / expected[i] - 1.0) /
                                  (2.0 * truncation(expected[i], 40) + 1e-12));
  }
  fmt::print("hub and panels, 40 modes, mass ratios 1e-12 .. 1e12: worst error {:.2f} of the bound, 1e-7 at the most\n",
             worst);
  EXPECT_LT(worst, 1.0);
}

// The hub as the root, or a panel as the root with the hub on it.
Network hub_second(double ratio) {
  Network net = reference::hub_and_panels(ratio, 40);
  std::swap(net.bodies[0], net.bodies[1]);
  for (Joint& joint : net.joints) {
    joint.parent.body = 1;
    if (joint.child.body == 1) joint.child.body = 0;
  }
  return net;
}

// Port algebra inverts the hub's channels together with the residual masses of the panels, so light hubs lean on those
// and heavy ones hide them: one part in 1e12 is above their round-off, and nothing has to be refused.
TEST(HubAndPanels, PortAlgebraOverTwentyFourDecadesOfMass) {
  double worst = 0.0, condition = 1.0;
  for (const bool second : {false, true})
    for (const double ratio : ratios) {
      const PortAlgebra ports = port_algebra(second ? hub_second(ratio) : reference::hub_and_panels(ratio, 40));
      const Eigen::VectorXd omega = frequencies(ports);
      ASSERT_EQ(omega.size(), 80) << ratio;
      const std::vector<double> expected = exact(ratio);
      for (std::size_t i = 0; i < expected.size(); ++i)
        worst = std::max(worst, std::abs(omega[static_cast<int>(i)] / expected[i] - 1.0));
      condition = std::max(condition, ports.worst_condition);
    }
  fmt::print("the same by port algebra: worst error {:.1e}, worst condition {:.1e}\n", worst, condition);
  EXPECT_LT(worst, 1e-6);
}

TEST(HubAndPanels, TruncationErrorFallsWithTheFifthPower) {
  double error[2];
  for (int k = 0; k < 2; ++k) {
    const SystemModes found = modes(second_order(reference::hub_and_panels(1e-12, k ? 20 : 10)));
    error[k] = std::abs(found.omega[6] / exact(1e-12)[0] - 1.0);
  }
  EXPECT_NEAR(std::log2(error[0] / error[1]), 5.0, 0.5);
}
