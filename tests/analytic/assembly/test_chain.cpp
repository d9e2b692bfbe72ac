// The chain of fig. 4 of the TITOP paper: spacecraft, flexible boom, flexible antenna, and a revolute joint between the
// last two, from free to clamped.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include "assembly/port_algebra.hpp"
#include "assembly/second_order.hpp"
#include "titop/attach.hpp"
#include "titop/beam.hpp"

using namespace tenon;
using namespace tenon::assembly;
using fem::Mat3;
using fem::Vec3;

namespace {

// All bodies flexible: the spacecraft is a beam with a heavy hub at its root.
Network chain(JointKind kind) {
  const titop::BeamProperties boom{
      .length = 3.0, .E = 70e9, .G = 27e9, .rho = 2700.0, .A = 4e-4, .Iy = 6e-8, .Iz = 4e-8, .J = 8e-8, .Ip = 1e-7};
  titop::BeamProperties dish = boom;
  dish.length = 1.2;
  dish.Iz = 1e-8;
  Network net;
  ReducedBody spacecraft = titop::beam_body("spacecraft", boom, {.zeta = 0.0});
  net.bodies.push_back(
      titop::attach_mass(spacecraft, 0, 120.0, Vec3(0.0, 0.1, -0.2), Vec3(30.0, 40.0, 50.0).asDiagonal()));
  net.bodies.push_back(titop::beam_body("boom", boom));
  net.bodies.push_back(titop::beam_body("antenna", dish));
  Joint root;
  root.name = "root";
  root.parent = {0, 0};
  root.child = {1, 0};
  root.kind = JointKind::weld;
  Joint tip;
  tip.name = "tip";
  tip.parent = {1, 1};
  tip.child = {2, 0};
  tip.kind = kind;
  tip.axis = Vec3(0.0, 1.0, 1.0).normalized();
  net.joints = {root, tip};
  net.bodies[1].ports[0].axes = Eigen::AngleAxisd(1.9, Vec3::UnitZ()).toRotationMatrix();
  net.inputs = {{"wheel", PortRef{0, 0}, 5, {}}};
  net.outputs = {{"attitude", Quantity::acceleration, PortRef{0, 0}, 5, {}}};
  return net;
}

double worst(const Eigen::VectorXd& a, const Eigen::VectorXd& b) {
  return ((a - b).array() / b.array()).abs().maxCoeff();
}

}  // namespace

TEST(Chain, HasTheSixRigidMotionsOfTheWholeAndTheOneOfTheJoint) {
  EXPECT_EQ(modes(second_order(chain(JointKind::revolute))).rigid, 7);
  EXPECT_EQ(modes(second_order(chain(JointKind::weld))).rigid, 6);
}

// ω − ω_weld falls as 1/k until the stiff mode of the joint has left the others behind; no digit is lost up to 1e16.
TEST(Chain, StiffJointBecomesAWeld) {
  const SystemModes weld = modes(second_order(chain(JointKind::weld)));
  const Eigen::Index low = 8;
  const Eigen::VectorXd exact = weld.omega.segment(6, low);
  Network net = chain(JointKind::revolute);
  double last = 1.0, at_last = 0.0, ports_worst = 0.0;
  for (int power = 0; power <= 16; power += 2) {
    net.joints[1].stiffness = std::pow(10.0, power);
    const SystemModes found = modes(second_order(net));
    ASSERT_EQ(found.rigid, 6);
    at_last = worst(found.omega.segment(6, low), exact);
    EXPECT_LT(at_last, std::max(1.01 * last, 1e-12)) << power;
    last = at_last;
    if (power <= 8)
      ports_worst = std::max(ports_worst, worst(frequencies(port_algebra(net)).head(low), found.omega.segment(6, low)));
  }
  fmt::print("joint of 1e16 N m/rad against a weld {:.1e}; port algebra against second order {:.1e}\n", at_last,
             ports_worst);
  EXPECT_LT(at_last, 1e-10);
  EXPECT_LT(ports_worst, 1e-9);
}

TEST(Chain, BothRoutesGiveTheSameTransferFromWheelToAttitude) {
  for (const JointKind kind : {JointKind::weld, JointKind::revolute}) {
    const Network net = chain(kind);
    const SecondOrderSystem second = second_order(net);
    const PortAlgebra ports = port_algebra(net);
    for (const double omega : {0.5, 7.0, 60.0, 900.0}) {
      const std::complex<double> a = response(second, omega)(0, 0), b = response(ports.ss, omega)(0, 0);
      EXPECT_LT(std::abs(a - b), 1e-8 * std::abs(a)) << omega;
    }
  }
}
