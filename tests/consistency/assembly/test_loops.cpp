// Closed loops: the null-space route against Lagrange multipliers, eq (4) of the TITOP paper, in dense form.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <Eigen/LU>
#include <Eigen/QR>

#include "assembly/disjoint.hpp"
#include "assembly/port_algebra.hpp"
#include "assembly/second_order.hpp"
#include "fem/error.hpp"
#include "random_network.hpp"
#include "tests/reference/networks.hpp"

using namespace tenon::assembly;
using Eigen::MatrixXcd;
using Eigen::MatrixXd;
using Eigen::VectorXd;
using tenon::assembly::testing::RandomNetwork;
using tenon::reference::rigid_bar;
using tenon::reference::weld;

namespace {

constexpr int loops = 12;

// Two flexible bodies joined at two ports: the second body's second port is put where the first body's is.
Network two_body_loop(unsigned seed) {
  RandomNetwork random(seed);
  Network net;
  while (net.bodies.size() < 2) {
    ReducedBody body = random.body("b" + std::to_string(net.bodies.size()));
    if (body.n() >= 6) net.bodies.push_back(body);  // enough to give way all round the loop
  }
  net.joints = {random.joint("first", {0, 0}, {1, 0}), random.joint("second", {0, 1}, {1, 1})};
  for (Joint& joint : net.joints) {
    joint.parent.body = 0;
    joint.child.body = 1;
  }
  Network open = net;
  open.joints.pop_back();
  const Placement p = place(open);
  const tenon::reduction::BodyPort& from = net.bodies[0].ports[1];
  tenon::reduction::BodyPort& to = net.bodies[1].ports[1];
  const Mat3 turn = Eigen::AngleAxisd(net.joints[1].angle, net.joints[1].axis).toRotationMatrix();
  to.axes = p.R[1].transpose() * p.R[0] * from.axes * turn;
  to.position = p.R[1].transpose() * (p.origin[0] + p.R[0] * from.position - p.origin[1]);
  if (seed % 2) net.ground = {{0, net.bodies[0].parent}};
  net.inputs = {{"force", PortRef{0, 1}, 1, {}}, {"torque", PortRef{1, 1}, 4, {}}};
  net.outputs = {{"a", Quantity::acceleration, PortRef{1, 1}, 0, {}},
                 {"v", Quantity::velocity, PortRef{0, 1}, 3, {}},
                 {"x", Quantity::position, PortRef{1, 0}, 2, {}}};
  return net;
}

// [K + jωC − ω²M, Gᵀ; G, 0]
MatrixXcd multiplier_matrix(const DisjointSystem& d, double omega) {
  const Eigen::Index n = d.M.rows(), m = d.G.rows();
  MatrixXcd A = MatrixXcd::Zero(n + m, n + m);
  A.topLeftCorner(n, n) = d.K - omega * omega * d.M + std::complex<double>(0.0, omega) * d.C;
  A.topRightCorner(n, m) = d.G.transpose();
  A.bottomLeftCorner(m, n) = d.G;
  return A;
}

// Largest residual of (K − ω²M) q + Gᵀ ν = 0, G q = 0 over all modes, ν by least squares, relative to K q and ω²M q.
// With as many modes as coordinates less rows, independent, it is zero for the multiplier pencil's modes alone.
double multiplier_residual(const DisjointSystem& d, const SecondOrderSystem& s, const SystemModes& found) {
  const Eigen::ColPivHouseholderQR<MatrixXd> multipliers(d.G.transpose());
  double worst = 0.0;
  for (Eigen::Index i = 0; i < found.omega.size(); ++i) {
    const VectorXd q = s.N * found.shapes.col(i), Kq = d.K * q, Mq = found.omega[i] * found.omega[i] * d.M * q;
    const VectorXd force = Kq - Mq, nu = multipliers.solve(-force);
    const double size = std::max({Kq.norm(), Mq.norm(), q.norm()});
    worst = std::max({worst, (force + d.G.transpose() * nu).norm() / size, (d.G * q).norm() / q.norm()});
  }
  return worst;
}

}  // namespace

TEST(Loops, AgreeWithLagrangeMultipliers) {
  double worst_residual = 0.0, worst_response = 0.0;
  for (unsigned seed = 100; seed < 100 + loops; ++seed) {
    SCOPED_TRACE(fmt::format("loop {}", seed));
    const Network net = two_body_loop(seed);
    const DisjointSystem d = disjoint(net);
    const SecondOrderSystem s = second_order(net);
    ASSERT_EQ(s.redundant, 0);
    const SystemModes found = modes(s);
    ASSERT_EQ(found.omega.size(), d.M.rows() - d.G.rows());
    ASSERT_EQ(found.rigid, net.ground.empty() ? 6 : 0);
    worst_residual = std::max(worst_residual, multiplier_residual(d, s, found));
    for (const double omega : {0.3, 3.0, 30.0}) {
      MatrixXd rows = d.position_rows;
      const std::complex<double> j(0.0, omega);
      MatrixXcd load = MatrixXcd::Zero(d.M.rows() + d.G.rows(), d.B.cols());
      load.topRows(d.M.rows()) = d.B.cast<std::complex<double>>();
      const MatrixXcd q = multiplier_matrix(d, omega).fullPivLu().solve(load).topRows(d.M.rows());
      MatrixXcd H = rows * q;
      H.row(0) *= j * j;
      H.row(1) *= j;
      worst_response = std::max(worst_response, (H - response(s, omega)).norm() / H.norm());
      worst_response = std::max(worst_response, (H - response(state_space(net, s), omega)).norm() / H.norm());
    }
  }
  fmt::print("{} loops against multipliers: modal residual {:.1e}, responses {:.1e}\n", loops, worst_residual,
             worst_response);
  EXPECT_LT(worst_residual, 1e-10);
  EXPECT_LT(worst_response, 1e-9);
}

// A flexible bar beside a rigid one, welded at both ends: its tip gives way along x and y alone, so of the six rows
// that close the loop four say nothing new.
TEST(Loops, RedundantClosureIsRefusedByName) {
  Network net;
  net.bodies = {rigid_bar("a"), rigid_bar("b")};
  ReducedBody& soft = net.bodies[1];
  soft.omega = Eigen::Vector2d(10.0, 20.0);
  soft.zeta = Eigen::Vector2d(0.0, 0.0);
  soft.L = MatrixXd::Zero(2, 6);
  soft.ports[0].Phi = MatrixXd::Zero(6, 2);
  soft.ports[1].Phi = MatrixXd::Zero(6, 2);
  soft.ports[1].Phi(0, 0) = soft.ports[1].Phi(1, 1) = soft.ports[1].Phi(5, 1) = 1.0;
  net.joints = {weld("first", {0, 0}, {1, 0}), weld("second", {0, 1}, {1, 1})};
  EXPECT_EQ(second_order(net).redundant, 4);
  EXPECT_EQ(modes(second_order(net)).rigid, 6);
  try {
    port_algebra(net);
    FAIL() << "port algebra inverted redundant rows";
  } catch (const tenon::NumericalError& e) {
    EXPECT_THAT(e.what(), ::testing::HasSubstr("joint 'second'"));
    EXPECT_THAT(e.what(), ::testing::HasSubstr("second-order route"));
  }
}

// Two rigid bars welded at both ends are one body: its six closing rows are redundant in all directions that the bars
// move in together. The second-order route is right: a unit force on 4 kg.
TEST(Loops, RigidLoopIsRefusedByName) {
  Network net;
  const Mat3 tilt = Eigen::AngleAxisd(0.7, Vec3(1.0, 2.0, -0.5).normalized()).toRotationMatrix();
  net.bodies = {rigid_bar("a", tilt), rigid_bar("b", tilt)};
  net.joints = {weld("first", {0, 0}, {1, 0}), weld("second", {0, 1}, {1, 1})};
  net.inputs = {{"push", PortRef{0, 0}, 0, {}}};
  net.outputs = {{"x", Quantity::acceleration, PortRef{0, 0}, 0, {}}};
  const SecondOrderSystem second = second_order(net);
  EXPECT_EQ(second.redundant, 6);
  const Vec3 arm = tilt * Vec3(-0.5, 0.0, 0.0);  // about the centre: J = 2·0.2, diag in any axes
  const double exact = 0.25 + (arm.cross(Vec3::UnitX())).squaredNorm() / 0.4;
  EXPECT_NEAR(response(second, 1.0)(0, 0).real(), exact, 1e-14);
  try {
    port_algebra(net);
    FAIL() << "port algebra closed a rigid loop";
  } catch (const tenon::NumericalError& e) {
    EXPECT_THAT(e.what(), ::testing::HasSubstr("closure rows are redundant"));
    EXPECT_THAT(e.what(), ::testing::HasSubstr("'joint 'second', rotation z'"));
    EXPECT_THAT(e.what(), ::testing::HasSubstr("second-order route"));
  }
}

// Where neither side can move, a row is zero-padding and says nothing: a rigid bar held at both ends.
TEST(Loops, RowsWithoutContentAreLeftOut) {
  Network net;
  net.bodies = {rigid_bar("a"), rigid_bar("b")};
  net.joints = {weld("first", {0, 1}, {1, 0})};
  net.ground = {{0, 0}, {1, 1}};
  net.inputs = {{"push", PortRef{0, 1}, 0, {}}};
  net.outputs = {{"x", Quantity::acceleration, PortRef{0, 1}, 0, {}}};
  EXPECT_EQ(second_order(net).redundant, 6);
  const PortAlgebra ports = port_algebra(net);
  EXPECT_EQ(ports.ss.order(), 0);
  EXPECT_EQ(ports.ss.D(0, 0), 0.0);
}

TEST(PortAlgebra, PositionOutputsPointToTheOtherRoute) {
  RandomNetwork random(7);
  Network net = random.tree(false);
  net.outputs[0].quantity = Quantity::position;
  EXPECT_THROW(port_algebra(net), tenon::ModelError);
}

// A rod has no inertia about its own axis; tilted in its frame, round-off is left of the zero, and refused all the
// same.
TEST(PortAlgebra, JointAboutAnAxisWithoutInertiaIsRefusedByName) {
  for (const double tilt : {0.0, 0.3, 1.1, 2.0}) {
    const Mat3 R = Eigen::AngleAxisd(tilt, Vec3(1.0, 2.0, -1.0).normalized()).toRotationMatrix();
    const Mat3 rod = R * Vec3(0.0, 1.0, 1.0).asDiagonal() * R.transpose();
    Network net;
    net.bodies = {
        tenon::reduction::rigid_body("hub", 1.0, Vec3::Zero(), Mat3::Identity(),
                                     {{"p", Vec3::Zero(), Mat3::Identity(), {}}}),
        tenon::reduction::rigid_body("rod", 1.0, Vec3::Zero(), rod, {{"p", Vec3::Zero(), Mat3::Identity(), {}}})};
    Joint joint;
    joint.name = "roll";
    joint.parent = {0, 0};
    joint.child = {1, 0};
    joint.kind = JointKind::revolute;
    joint.axis = R * Vec3::UnitX();
    net.joints = {joint};
    try {
      port_algebra(net);
      ADD_FAILURE() << "inverted a channel without inertia, tilt " << tilt;
    } catch (const tenon::NumericalError& e) {
      EXPECT_THAT(e.what(), ::testing::HasSubstr("rod about the axis of joint 'roll'"));
      EXPECT_THAT(e.what(), ::testing::HasSubstr("second-order route"));
    }
  }
}
