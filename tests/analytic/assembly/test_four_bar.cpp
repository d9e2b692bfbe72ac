// The four-bar mechanism of the TITOP paper, section 4, from its shipped scene.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <numbers>

#include "assembly/build.hpp"
#include "assembly/close_angles.hpp"
#include "assembly/port_algebra.hpp"
#include "assembly/sweep.hpp"
#include "fem/error.hpp"
#include "tests/reference/four_bar.hpp"

using namespace tenon;
using namespace tenon::assembly;

namespace {

constexpr double degree = std::numbers::pi / 180.0;
constexpr int drive = 0;

Network four_bar(BeamSource::Model model) {
  Scene scene = read_scene(std::filesystem::path(TENON_SOURCE_DIR) / "data" / "fourbar" / "scene.yaml");
  for (SceneBody& body : scene.bodies)
    if (auto* beam = std::get_if<BeamSource>(&body.source)) beam->model = model;
  return build_network(scene, plan(scene));
}

std::vector<SweepPoint> circle(const Network& network, bool hold, double to = 360.0) {
  return sweep(network, drive, {.from = 0.0, .to = to * degree, .steps = 13, .modes = 5, .hold = hold});
}

using Column = std::array<double, 5> reference::FourBar::*;

double worst(const std::vector<SweepPoint>& points, Column column, int rigid) {
  double error = 0.0;
  for (std::size_t k = 0; k < points.size(); ++k) {
    EXPECT_NEAR(points[k].angle, reference::four_bar[k].angle_deg * degree, 1e-12);
    EXPECT_EQ(points[k].rigid, rigid);
    for (int i = 0; i < 5; ++i)
      error = std::max(
          error,
          std::abs(points[k].omega[rigid + i] / (reference::four_bar[k].*column)[static_cast<std::size_t>(i)] - 1.0));
  }
  return error;
}

}  // namespace

// The printed digits of the reference end at 4e-8.
TEST(FourBar, QuinticBeamsGiveTheFrequenciesOfTheirOwnTheory) {
  const Network network = four_bar(BeamSource::Model::polynomial);
  const double clamped = worst(circle(network, true), &reference::FourBar::quintic_c, 0);
  const double free = worst(circle(network, false), &reference::FourBar::quintic_f, 1);
  fmt::print("quintic beams: clamped crank {:.1e}, free crank {:.1e}\n", clamped, free);
  EXPECT_LT(clamped, 1e-6);
  EXPECT_LT(free, 1e-6);
}

TEST(FourBar, FiniteElementBeamsGiveTheExactFrequencies) {
  const Network network = four_bar(BeamSource::Model::fe);
  const double clamped = worst(circle(network, true), &reference::FourBar::exact_c, 0);
  const double free = worst(circle(network, false), &reference::FourBar::exact_f, 1);
  fmt::print("finite-element beams: clamped crank {:.1e}, free crank {:.1e}\n", clamped, free);
  EXPECT_LT(clamped, 1e-5);
  EXPECT_LT(free, 1e-5);
}

// The other elbow at an angle is the mirror image of this one at the negative angle.
TEST(FourBar, TheOtherBranchMirrors) {
  Network network = four_bar(BeamSource::Model::polynomial), mirrored = network;
  for (Joint& joint : mirrored.joints) joint.angle = -joint.angle;
  const auto up = circle(network, true), down = circle(mirrored, true, -360.0);
  for (std::size_t k = 0; k < up.size(); ++k) {
    EXPECT_NEAR(std::remainder(up[k].angles[1] + down[k].angles[1], 2.0 * std::numbers::pi), 0.0, 1e-10);
    for (int i = 0; i < 5; ++i) EXPECT_NEAR(down[k].omega[i] / up[k].omega[i], 1.0, 1e-10);
  }
}

// u → the crank's acceleration by port algebra, of order 30 as the paper says, against the second-order assembly.
TEST(FourBar, PortAlgebraClosesTheLoop) {
  Network network = four_bar(BeamSource::Model::polynomial);
  double frequency = 0.0, transfer = 0.0;
  for (const double angle : {0.0, 45.0, 90.0, 200.0, 300.0}) {
    network.joints[drive].angle = angle * degree;
    network = close_angles(network);
    const SecondOrderSystem second = second_order(network);
    const SystemModes found = modes(second);
    const PortAlgebra ports = port_algebra(network);
    ASSERT_EQ(ports.ss.order(), 30);
    const Eigen::VectorXd omega = frequencies(ports);
    ASSERT_EQ(omega.size(), 15);
    frequency = std::max(frequency, ((omega - found.omega.tail(15)).array() / omega.array()).abs().maxCoeff());
    for (const double at : {10.0, 200.0, 500.0, 1000.0, 2000.0}) {
      const std::complex<double> a = response(second, at)(0, 0), b = response(ports.ss, at)(0, 0);
      transfer = std::max(transfer, std::abs(a - b) / std::abs(a));
    }
  }
  fmt::print("port algebra against second order: frequencies {:.1e}, transfer {:.1e}\n", frequency, transfer);
  EXPECT_LT(frequency, 1e-9);
  EXPECT_LT(transfer, 1e-8);
}

// Grounded, the rows across the plane are zero-padding, and the loop closes as above. Afloat, all links move across it
// together: these rows are redundant, their reactions indeterminate.
TEST(FourBar, AfloatItsRowsAcrossThePlaneAreRedundant) {
  Network network = four_bar(BeamSource::Model::polynomial);
  network.ground.clear();
  const SecondOrderSystem second = second_order(network);
  EXPECT_EQ(second.redundant, 3);
  EXPECT_EQ(second.rigid, 7);
  try {
    port_algebra(network);
    FAIL() << "closed a loop with redundant rows";
  } catch (const NumericalError& fault) {
    for (const char* word : {"'joint 'b', translation z'", "second rotation across the axis", "second-order route"})
      EXPECT_NE(std::string(fault.what()).find(word), std::string::npos) << fault.what();
  }
}

// Held in a plane, a beam of finite elements keeps the mass and all inertias of its section: ρ(Iy + Iz) l about itself.
TEST(FourBar, PlanarBeamsKeepTheirMassMatrix) {
  const ReducedBody crank = four_bar(BeamSource::Model::fe).bodies[1];
  const double rho = 2714.0, A = 1.0774e-4, l = 0.108, m = rho * A * l;
  EXPECT_NEAR(crank.D(0, 0), m, 1e-12 * m);
  EXPECT_NEAR(crank.D(5, 5), m * l * l / 3.0, 1e-9 * m * l * l);
  EXPECT_NEAR(crank.D(4, 4), m * l * l / 3.0, 1e-9 * m * l * l);
  EXPECT_NEAR(crank.D(3, 3), rho * (1e-9 + 1.6157746478873239e-10) * l, 1e-9 * rho * 1.16e-9 * l);
  EXPECT_EQ(crank.ports[1].Phi.row(2).norm() + crank.ports[1].Phi.middleRows<2>(3).norm(), 0.0);
}

TEST(FourBar, AnAngleThatNoLoopDecidesIsRefused) {
  Network network = four_bar(BeamSource::Model::polynomial);
  network.joints.pop_back();  // open: a chain
  try {
    close_angles(network);
    FAIL() << "left an angle undecided";
  } catch (const ModelError& fault) {
    EXPECT_NE(std::string(fault.what()).find("joint 'a' is in no loop"), std::string::npos) << fault.what();
  }
}

TEST(FourBar, ALoopThatCannotCloseIsNamed) {
  Network network = four_bar(BeamSource::Model::polynomial);
  network.bodies[3].ports[1].position.x() = 0.05;  // too short a follower
  try {
    circle(network, true);
    FAIL() << "closed what cannot close";
  } catch (const ModelError& fault) {
    EXPECT_NE(std::string(fault.what()).find("of joint 'drive'"), std::string::npos) << fault.what();
    EXPECT_NE(std::string(fault.what()).find("finds no configuration"), std::string::npos) << fault.what();
  }
}
