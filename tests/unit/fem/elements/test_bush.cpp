#include "fem/elements/bush.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <Eigen/Geometry>

#include "fem/elements/spring.hpp"
#include "fem/error.hpp"
#include "fem/structure.hpp"
#include "tests/unit/fem/elements/small_assembly.hpp"

using namespace tenon;
using namespace tenon::fem;
using namespace tenon::fem::testing;
using ::testing::HasSubstr;

namespace {

const std::vector<Vec3> apart{Vec3(1.0, 2.0, -0.5), Vec3(1.9, 2.7, 0.4)};

Bush odd_bush() {
  Bush bush{.node_a = 0, .node_b = 1, .k = {1e6, 2e6, 3e6, 4e4, 5e4, 6e4}, .id = 8};
  bush.axes = Eigen::AngleAxisd(0.7, Vec3(1.0, -2.0, 0.5).normalized()).toRotationMatrix();
  bush.offset = Vec3(0.3, -0.2, 0.9);
  return bush;
}

std::string refusal(const Bush& bush, const std::vector<Vec3>& nodes) {
  ElementMatrices e;
  try {
    bush_matrices(bush, nodes, e);
  } catch (const ModelError& error) {
    return error.what();
  }
  return "nothing was refused";
}

}  // namespace

TEST(Bush, RigidMotionsCostNothingWhereverNodesAndPointLie) {
  for (const Vec3& b : {apart[1], apart[0], Vec3(apart[0] + Vec3(1e3, 0.0, 0.0))}) {
    const std::vector<Vec3> nodes{apart[0], b};
    ElementMatrices e;
    bush_matrices(odd_bush(), nodes, e);
    const Eigen::MatrixXd R = rigid_motions(nodes), KR = e.K * R;
    for (int i = 0; i < 12; ++i)  // each row against √(K_ii K_jj) |R_j|, the bound of its terms
      for (int j = 0; j < 6; ++j) {
        const double size = std::sqrt(e.K(i, i)) * e.K.diagonal().cwiseSqrt().dot(R.col(j).cwiseAbs());
        EXPECT_LT(std::abs(KR(i, j)), 1e-14 * size) << i << ' ' << j << ' ' << b.transpose();
      }
    EXPECT_EQ(e.K, e.K.transpose());
  }
  ElementMatrices e;
  bush_matrices(odd_bush(), apart, e);
  EXPECT_EQ(zero_modes(e.K, 0.3, 1e-12), 6);
}

TEST(Bush, ForceAtThePointAndItsMomentsAtTheNodes) {
  const Bush bush = odd_bush();
  ElementMatrices e;
  bush_matrices(bush, apart, e);
  for (int d = 0; d < 6; ++d) {  // b moves so that its point moves along the bush's own direction d
    Vec6 at_point = Vec6::Zero();
    at_point.segment<3>(d / 3 * 3) = bush.axes.col(d % 3);
    const Vec3 point = apart[0] + bush.offset;
    Eigen::VectorXd u = Eigen::VectorXd::Zero(12);
    u.tail<6>() = at_point;
    if (d > 2) u.segment<3>(6) = at_point.tail<3>().cross(apart[1] - point);
    const Eigen::VectorXd force = e.K * u;
    const Vec6 wrench = bush.k[static_cast<std::size_t>(d)] * at_point;
    for (const int node : {0, 1}) {
      const double sign = node == 0 ? -1.0 : 1.0;
      const Vec3 arm = point - apart[static_cast<std::size_t>(node)];
      EXPECT_LT((force.segment<3>(6 * node) - sign * wrench.head<3>()).norm(), 1e-13 * 3e6);
      EXPECT_LT((force.segment<3>(6 * node + 3) - sign * (wrench.tail<3>() + arm.cross(wrench.head<3>()))).norm(),
                1e-13 * 3e6);
    }
  }
}

// Rounding would leave a mass on a leaning spring a stiffness of its rotations, without any mass to turn.
TEST(Bush, AlongItsLineItTurnsNothing) {
  Bush bush{.node_a = 0, .node_b = 1, .k = {1e6, 0.0, 0.0, 0.0, 0.0, 0.0}, .id = 8};
  const Vec3 line = apart[1] - apart[0];
  bush.axes.col(0) = line.normalized();
  bush.axes.col(1) = bush.axes.col(0).unitOrthogonal();
  bush.axes.col(2) = bush.axes.col(0).cross(bush.axes.col(1));
  bush.offset = 0.5 * line;
  ElementMatrices e;
  bush_matrices(bush, apart, e);
  for (const int first : {3, 9}) EXPECT_EQ(e.K.middleRows(first, 3).cwiseAbs().maxCoeff(), 0.0);
  EXPECT_NEAR(bush.axes.col(0).dot(e.K.topLeftCorner(3, 3) * bush.axes.col(0)), 1e6, 1e-8);
}

TEST(Bush, ToGroundIsTheOneEndsBlock) {
  Bush bush = odd_bush();
  ElementMatrices both, ground;
  bush_matrices(bush, apart, both);
  bush.node_b = -1;
  bush_matrices(bush, apart, ground);
  ASSERT_EQ(ground.K.rows(), 6);
  EXPECT_LT((ground.K - both.K.topLeftCorner<6, 6>()).norm(), 1e-15 * both.K.norm());
}

TEST(Bush, FaultsAreNamed) {
  Bush bush = odd_bush();
  bush.k[4] = -1.0;
  EXPECT_THAT(refusal(bush, apart), HasSubstr("bush 8: its stiffness in ry is -1"));
  bush = odd_bush();
  bush.axes.col(0) *= 2.0;
  EXPECT_THAT(refusal(bush, apart), HasSubstr("bush 8: its axes are not at right angles"));
  EXPECT_THAT(refusal(odd_bush(), {apart[0], Vec3::Constant(std::nan(""))}), HasSubstr("place of a node is not known"));
}

TEST(SpringElement, AlongAnAxisOfItsOwn) {
  const Vec3 n = Vec3(1.0, 2.0, -2.0) / 3.0;
  ElementMatrices e;
  spring_matrices({.node_a = 0, .dof_a = 1, .node_b = 1, .dof_b = 2, .k = 9e3, .axis_a = n}, e);
  ASSERT_EQ(e.K.rows(), 4);  // three of a, one of b
  Eigen::Vector4d b(n.x(), n.y(), n.z(), -1.0);
  EXPECT_LT((e.K - 9e3 * b * b.transpose()).norm(), 1e-15 * 9e3);
  spring_matrices({.node_a = 0, .dof_a = 4, .k = 5.0}, e);
  ASSERT_EQ(e.K.rows(), 1);
  EXPECT_EQ(e.K(0, 0), 5.0);
}

TEST(SpringElement, ASkewSpringThroughTheAssembler) {
  Model model;
  model.source = "spring";
  model.nodes = {Vec3::Zero()};
  model.node_ids = {1};
  const Vec3 n = Vec3(1.0, 2.0, -2.0) / 3.0;
  model.elements.emplace_back(Spring{.node_a = 0, .dof_a = 4, .k = 7.0, .axis_a = n});
  model.elements.emplace_back(PointMass{.node = 0, .mass = 2.0, .inertia = Mat3::Identity()});
  const Structure s = assemble(model);
  ASSERT_EQ(s.n(), 6);
  const Eigen::MatrixXd K = Eigen::MatrixXd(s.K).selfadjointView<Eigen::Lower>();
  EXPECT_LT((K.bottomRightCorner<3, 3>() - 7.0 * n * n.transpose()).norm(), 1e-15);
  EXPECT_EQ(K.topLeftCorner(3, 6).norm(), 0.0);
}
