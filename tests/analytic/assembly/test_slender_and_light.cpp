// Beams through a scene at the extremes: slenderness 1e1 .. 1e6, a tip that carries next to nothing.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "assembly/build.hpp"
#include "assembly/port_algebra.hpp"
#include "assembly/second_order.hpp"
#include "fem/error.hpp"
#include "tests/reference/networks.hpp"
#include "tests/support/temporary_folder.hpp"

using namespace tenon;
using namespace tenon::assembly;

namespace {

Network built(const std::string& text) {
  const TemporaryFolder folder;
  const Scene scene = read_scene(folder.write("scene.yaml", text));
  return build_network(scene, plan(scene));
}

// A steel cantilever of 2 m with a solid round section; `to` is its tip.
std::string cantilever(double slenderness, const std::string& to, const std::string& options) {
  return fmt::format(
      "units: SI\nbodies:\n  b: {{beam: {{from: [0, 0, 0], to: {}, section: {{circle: {:.17g}, shear: "
      "euler-bernoulli}}, material: steel{}}}}}\nground: [b.P]\n",
      to, 1.0 / slenderness, options);
}

double first_bending(double slenderness) {
  return std::pow(1.875104068711961, 2) * std::sqrt(200e9 / 7850.0) * (1.0 / slenderness) / 2.0 / 4.0;
}

}  // namespace

// Along an axis and askew, by both routes. 32 elements are (βh)⁴/1440 = 8e-9 high in consistent mass and less in the
// high-order mass of scenes; the quintic 1.5e-6; clamped-free modes exact.
TEST(Slenderness, OfBeamsInAScene) {
  for (const auto& [model, own] :
       {std::pair("fe", 1e-8), {"titop-polynomial", 1.6e-6}, {"titop-clamped-free", 1e-13}}) {
    double worst = 0.0;
    for (const char* to : {"[2, 0, 0]", "[0.8571428571428571, 1.7142857142857142, 0.5714285714285714]"})
      for (const double s : {1e1, 1e2, 1e3, 1e4, 1e5, 1e6}) {
        const Network net = built(cantilever(s, to, fmt::format(", model: {}", model)));
        const SystemModes found = modes(second_order(net));
        const Eigen::VectorXd ports = frequencies(port_algebra(net));
        for (const double omega : {found.omega[0], found.omega[1], ports[0], ports[1]})  // both planes
          worst = std::max(worst, std::abs(omega / first_bending(s) - 1.0));
      }
    fmt::print("{}: slenderness 1e1 .. 1e6, worst error {:.1e}\n", model, worst);
    EXPECT_LT(worst, own) << model;
  }
}

namespace {

// (βl)² of a clamped beam with a tip mass μ ρAl: 1 + cos β cosh β + μ β (cos β sinh β − sin β cosh β), by cosh β.
double tip_mass_root(double mu, int i) {
  const auto f = [mu](double b) {
    return 1.0 / std::cosh(b) + std::cos(b) + mu * b * (std::cos(b) * std::tanh(b) - std::sin(b));
  };
  // between the clamped-pinned root below (zero for the first) and the clamped-free root
  double a = i == 1 ? 1e-3 : (i - 0.75) * std::numbers::pi - 1e-2, b = reference::clamped_free_root(i) + 1e-9;
  for (int step = 0; step < 200; ++step) {
    const double m = 0.5 * (a + b);
    (f(a) * f(m) <= 0.0 ? b : a) = m;
  }
  return std::pow(0.5 * (a + b), 2);
}

// A unit beam grounded at P with a mass μ at C: lumped there, or a body on a revolute joint through its centre with a
// polar inertia as small.
Network light_tip(double mu, bool hinged) {
  Network net;
  net.bodies = {reference::clamped_free_beam("beam", 64)};
  net.ground = {{0, 0}};
  if (!hinged) {
    net.masses = {{"tip", {0, 1}, mu, Mat3::Zero()}};
    return net;
  }
  net.bodies.push_back(reduction::rigid_body("tip", mu, {0, 0, 0}, mu * Mat3::Identity(), {reference::port("p")}));
  net.joints = {{.name = "hinge", .parent = {0, 1}, .child = {1, 0}, .kind = JointKind::revolute}};
  return net;
}

}  // namespace

// Down to nothing the tip is right by both routes. The modes left out take a flexibility 4/(3π⁴n³) with them, and with
// it ω_i half the square of the force on the tip over ω_i: √2 β³ at most (a pin), 2 μ β⁴ at most (the free tip moves
// 2).
TEST(LightTip, IsRightDownToNothing) {
  double worst = 0.0, plain = 0.0;
  for (const bool hinged : {false, true})
    for (double mu = 1.0; mu > 0.5e-16; mu /= 10.0) {
      const Network net = light_tip(mu, hinged);
      const SystemModes found = modes(second_order(net));
      EXPECT_EQ(found.rigid, hinged ? 1 : 0) << mu;
      const Eigen::VectorXd ports = frequencies(port_algebra(net));
      ASSERT_EQ(ports.size(), 64) << mu;
      for (int i = 1; i <= 3; ++i) {
        const double exact = tip_mass_root(mu, i);
        const double flexibility = 4.0 / (3.0 * std::pow(std::numbers::pi, 4) * std::pow(64.0, 3));
        const double left_out = flexibility * std::min(exact, 2.0 * mu * mu * exact * exact);
        for (const double omega : {found.omega[found.rigid + i - 1], ports[i - 1]}) {
          const double error = std::abs(omega / exact - 1.0);
          plain = std::max(plain, error);
          worst = std::max(worst, error / (1.1 * left_out + 1e-11));
        }
      }
    }
  fmt::print("tip mass 1 .. 1e-16: worst error {:.1e}, {:.2f} of the bound\n", plain, worst);
  EXPECT_LT(worst, 1.0);
}

// Hung by its free end: the beam's residual mass at P is all that a lumped mass μ there adds to. An exact basis of the
// cantilever seen from C has none of its own (its modes carry all mass but 1/n); right or refused, never wrong.
TEST(LightTip, AtTheParentPortIsRightOrRefused) {
  int refused = 0;
  double worst = 0.0;
  for (double mu = 1.0; mu > 0.5e-16; mu /= 10.0) {
    Network net;
    net.bodies = {reference::clamped_free_beam("beam", 64)};
    net.bodies.push_back(reduction::rigid_body("tip", mu, {0, 0, 0}, mu * Mat3::Identity(), {reference::port("p")}));
    net.joints = {reference::weld("weld", {1, 0}, {0, 1})};  // the light body is the root, free
    const SystemModes found = modes(second_order(net));
    ASSERT_EQ(found.rigid, 6);
    try {
      const Eigen::VectorXd ports = frequencies(port_algebra(net));
      ASSERT_EQ(ports.size(), found.omega.size() - 6) << mu;
      for (int i = 0; i < 3; ++i) worst = std::max(worst, std::abs(ports[i] / found.omega[6 + i] - 1.0));
    } catch (const NumericalError& refusal) {
      ++refused;
      EXPECT_THAT(refusal.what(), ::testing::HasSubstr("second-order route"));
    }
  }
  fmt::print("light root: {} of 17 refused, the others {:.1e} apart\n", refused, worst);
  EXPECT_LT(worst, 1e-9);
}
