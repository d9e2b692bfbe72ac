#include "assembly/network.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <numbers>

#include "assembly/second_order.hpp"
#include "assembly/spanning_tree.hpp"
#include "fem/error.hpp"
#include "tests/reference/networks.hpp"

using namespace tenon;
using namespace tenon::assembly;
using ::testing::HasSubstr;

namespace {

ReducedBody bar(const std::string& name, double length) {
  return reduction::rigid_body(name, 1.0, {0.5 * length, 0, 0}, fem::Vec3(0.01, 0.1, 0.1).asDiagonal(),
                               {reference::port("a"), reference::port("b", {length, 0, 0})});
}

Joint hinge(const std::string& name, PortRef parent, PortRef child, double angle) {
  Joint j;
  j.name = name;
  j.parent = parent;
  j.child = child;
  j.kind = JointKind::revolute;
  j.angle = angle;
  return j;
}

// A parallelogram: base 2, sides 1, hinges about z.
Network parallelogram(double error = 0.0) {
  const double half = std::numbers::pi / 2.0, tilt = 0.3;
  Network net;
  net.bodies = {bar("base", 2.0), bar("crank", 1.0), bar("coupler", 2.0 + error), bar("follower", 1.0)};
  net.joints = {hinge("A", {0, 0}, {1, 0}, half + tilt), hinge("B", {1, 1}, {2, 0}, -half - tilt),
                hinge("C", {2, 1}, {3, 1}, half + tilt), hinge("D", {3, 0}, {0, 1}, -half - tilt)};
  net.ground = {{0, 0}};
  return net;
}

template <typename Action>
std::string message(Action action) {
  try {
    action();
  } catch (const ModelError& e) {
    return e.what();
  }
  return "no error";
}

}  // namespace

TEST(Placement, FollowsTheJoints) {
  Network net;
  net.bodies = {bar("one", 2.0), bar("two", 1.0), bar("three", 1.0)};
  net.joints = {hinge("j1", {0, 1}, {1, 0}, std::numbers::pi / 2.0), hinge("j2", {2, 0}, {1, 1}, 0.0)};
  const Placement p = place(net);
  EXPECT_LT((p.origin[1] - Vec3(2, 0, 0)).norm(), 1e-15);
  EXPECT_LT((p.R[1] * Vec3::UnitX() - Vec3::UnitY()).norm(), 1e-15);
  EXPECT_LT((p.origin[2] - Vec3(2, 1, 0)).norm(), 1e-15);  // reached against its joint's direction
  EXPECT_LT((p.R[2] - p.R[1]).norm(), 1e-15);
  EXPECT_EQ(p.order, (std::vector<int>{0, 1, 2}));
  EXPECT_EQ(p.tree_joint, (std::vector<int>{-1, 0, 1}));
}

TEST(Placement, BodiesWithoutJointsStartTheirOwnTree) {
  Network net;
  net.bodies = {bar("one", 1.0), bar("two", 1.0)};
  EXPECT_EQ(place(net).tree_joint, (std::vector<int>{-1, -1}));
  EXPECT_EQ(second_order(net).rigid, 12);
}

TEST(Placement, ClosesLoops) {
  const Placement p = place(parallelogram());
  EXPECT_EQ(p.closing_joints.size(), 1u);
}

// Two bodies free in space, joined where alone either has a port, off its origin: all ports are one point, whose box is
// rounding. T = ½ I₁ θ₁² + ½ I₂ θ₂² + ½ μ |θ₁ r₁ − θ₂ r₂|² about the mass centres, V = ½ k (θ₁ − θ₂)².
TEST(Placement, BodiesOfOnePortEachAreAsLargeAsTheirInertias) {
  const Vec3 r1(-0.57, -0.17, 0.0), r2(-0.01, -0.37, 0.0);  // from the mass centres to the hinge
  const double m1 = 9.0, I1 = 6.0, m2 = 2.0, I2 = 1.0, k = 100.0, mu = m1 * m2 / (m1 + m2);
  const double a = I1 + mu * r1.squaredNorm(), b = I2 + mu * r2.squaredNorm(), c = -mu * r1.dot(r2);
  for (const double far : {0.0, 1e3}) {
    const Vec3 to_port(0.1 + far, 0.2, 0.3);
    Network net;
    net.bodies = {
        reduction::rigid_body("one", m1, to_port - r1, I1 * Mat3::Identity(), {reference::port("p", to_port)}),
        reduction::rigid_body("two", m2, Vec3(0.3, 0, 0) - r2, I2 * Mat3::Identity(),
                              {reference::port("q", {0.3, 0, 0})})};
    net.joints = {hinge("j", {0, 0}, {1, 0}, 0.0)};
    net.joints[0].stiffness = k;
    const SystemModes found = modes(second_order(net));
    ASSERT_EQ(found.omega.size(), 7);
    EXPECT_EQ(found.rigid, 6);
    EXPECT_NEAR(found.omega[6], std::sqrt(k * (a + b + 2.0 * c) / (a * b - c * c)), 1e-9 * found.omega[6]);
  }
}

TEST(Placement, OpenLoopIsRefusedWithItsGap) {
  const std::string what = message([] { place(parallelogram(0.01)); });
  EXPECT_THAT(what, HasSubstr("gap 0.01 m"));
  EXPECT_THAT(what, HasSubstr("does not close"));
}

TEST(Placement, WrongClosingAngleIsRefused) {
  Network net = parallelogram();
  net.joints[2].angle += 1e-5;
  EXPECT_THAT(message([&] { place(net); }), HasSubstr("does not close"));
}

void tree_of(const Network& net) { spanning_tree(net, place(net), "this route"); }

// One degree of freedom; every planar hinge after the tree repeats "stay in the plane": 26 rows, rank 23.
TEST(Loop, RigidParallelogramHasOneMotionAndThreeRedundantRows) {
  const SecondOrderSystem s = second_order(parallelogram());
  EXPECT_EQ(s.rigid, 1);
  EXPECT_EQ(s.M.rows(), 1);
  EXPECT_EQ(s.redundant, 3);
  EXPECT_EQ(s.rank, 23);
  EXPECT_GT(s.rank_gap, 1e10);
  ASSERT_EQ(s.redundant_rows.size(), 3u);
  for (const std::string& row : s.redundant_rows) EXPECT_THAT(row, HasSubstr("joint '"));
}

TEST(Loop, TreeIsRefusedNamingTheJoint) {
  EXPECT_THAT(message([] { tree_of(parallelogram()); }), HasSubstr("closes a loop"));
  EXPECT_THAT(message([] { tree_of(parallelogram()); }), HasSubstr("joint '"));
}

TEST(Loop, SecondGroundOfAPieceIsRefusedByTrees) {
  Network net;
  net.bodies = {bar("one", 1.0)};
  net.ground = {{0, 0}, {0, 1}};
  EXPECT_THAT(message([&] { tree_of(net); }), HasSubstr("one.b"));
  EXPECT_EQ(second_order(net).redundant, 6);  // a rigid bar held at both ends
}

TEST(NetworkCheck, NamesWhatIsWrong) {
  const auto broken = [](auto change) {
    Network net = parallelogram();
    change(net);
    return message([&] { check(net); });
  };
  EXPECT_THAT(broken([](Network& n) { n.joints[1].child.body = 9; }), HasSubstr("joint 'B'"));
  EXPECT_THAT(broken([](Network& n) { n.joints[1].child.port = 2; }), HasSubstr("body 'coupler'"));
  EXPECT_THAT(broken([](Network& n) { n.joints[0].child = {0, 1}; }), HasSubstr("to itself"));
  EXPECT_THAT(broken([](Network& n) { n.joints[0].stiffness = -1.0; }), HasSubstr("joint 'A'"));
  EXPECT_THAT(broken([](Network& n) { n.joints[0].axis = Vec3::Zero(); }), HasSubstr("axis"));
  EXPECT_THAT(broken([](Network& n) {
                n.joints[0].kind = JointKind::weld;
                n.joints[0].inertia = 1.0;
              }),
              HasSubstr("is a weld"));
  EXPECT_THAT(broken([](Network& n) { n.masses = {{"lamp", {0, 0}, -1.0, Mat3::Zero()}}; }), HasSubstr("'lamp'"));
  EXPECT_THAT(broken([](Network& n) { n.inputs = {{"push", {}, 0, {}}}; }), HasSubstr("input 'push'"));
  EXPECT_THAT(broken([](Network& n) { n.bodies.clear(); }), HasSubstr("body"));
}
