// What joints transmit, against statics and rigid dynamics written down by hand.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "assembly/reactions.hpp"
#include "tests/reference/networks.hpp"

using namespace tenon;
using namespace tenon::assembly;
using tenon::reference::rigid_bar;
using tenon::reference::weld;

namespace {

double of(const Reactions& r, const std::string& name) {
  for (std::size_t k = 0; k < r.names.size(); ++k)
    if (r.names[k] == name) return r.value(static_cast<Eigen::Index>(k), 0).real();
  ADD_FAILURE() << "no row " << name;
  return 0.0;
}

}  // namespace

// Two bars in a row held at the root, a unit force across the far tip: force −1 and moment by the arm.
TEST(Reactions, StaticsOfACantilever) {
  Network net;
  net.bodies = {rigid_bar("inner"), rigid_bar("outer")};
  net.joints = {weld("translation_stage", {0, 1}, {1, 0})};  // a name is no direction
  net.ground = {{0, 0}};
  net.inputs = {{"push", PortRef{1, 1}, 1, {}}};
  const Reactions r = reactions(net, second_order(net), 0.0);
  EXPECT_NEAR(of(r, "joint 'translation_stage', translation y"), -1.0, 1e-12);
  EXPECT_NEAR(of(r, "joint 'translation_stage', rotation z"), -1.0, 1e-12);  // arm 1 m
  EXPECT_NEAR(of(r, "ground of inner.p, translation y"), -1.0, 1e-12);
  EXPECT_NEAR(of(r, "ground of inner.p, rotation z"), -2.0, 1e-12);  // arm 2 m
  EXPECT_THAT(r.determinate, ::testing::Each(true));
  EXPECT_EQ(r.units,
            (std::vector<std::string>{"N", "N", "N", "N m", "N m", "N m", "N", "N", "N", "N m", "N m", "N m"}));
}

// A free chain pushed at one end through its centre: each joint passes the force of the mass beyond it.
TEST(Reactions, InertiaBeyondAJoint) {
  Network net;
  net.bodies = {rigid_bar("a"), rigid_bar("b"), rigid_bar("c")};
  net.joints = {weld("ab", {0, 1}, {1, 0}), weld("bc", {1, 1}, {2, 0})};
  net.inputs = {{"push", PortRef{0, 0}, 0, {}}};
  const Reactions r = reactions(net, second_order(net), 3.0);
  EXPECT_NEAR(of(r, "joint 'ab', translation x"), 2.0 / 3.0, 1e-12);
  EXPECT_NEAR(of(r, "joint 'bc', translation x"), 1.0 / 3.0, 1e-12);
}

// Two bars side by side, welded at both ends: only the sum over both welds is determined; least norm shares it equally.
TEST(Reactions, RedundantLoopIsSaidToBeIndeterminate) {
  Network net;
  net.bodies = {rigid_bar("a"), rigid_bar("b")};
  net.joints = {weld("first", {0, 0}, {1, 0}), weld("second", {0, 1}, {1, 1})};
  net.inputs = {{"push", PortRef{0, 0}, 0, {}}};
  const Reactions r = reactions(net, second_order(net), 1.0);
  EXPECT_NEAR(of(r, "joint 'first', translation x") + of(r, "joint 'second', translation x"), 0.5, 1e-12);
  EXPECT_NEAR(of(r, "joint 'first', translation x"), 0.25, 1e-12);
  EXPECT_THAT(r.determinate, ::testing::Each(false));
}
