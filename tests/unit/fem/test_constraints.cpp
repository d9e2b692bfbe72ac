#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <random>

#include "fem/constraints.hpp"
#include "fem/error.hpp"

using namespace tenon;
using namespace tenon::fem;

namespace {

Model nodes_at(const std::vector<Vec3>& x) {
  Model model;
  model.source = "test";
  model.nodes = x;
  for (std::size_t i = 0; i < x.size(); ++i) model.node_ids.push_back(static_cast<long>(i) + 1);
  return model;
}

DofMap eliminate_all_used(const Model& model) {
  return eliminate_constraints(model, std::vector<char>(6 * model.nodes.size(), 1));
}

/// Rigid motion of all nodes (6N×6) about a point.
Eigen::MatrixXd rigid(const Model& model, const Vec3& about) {
  Eigen::MatrixXd R(6 * static_cast<Eigen::Index>(model.nodes.size()), 6);
  for (std::size_t i = 0; i < model.nodes.size(); ++i)
    R.middleRows<6>(6 * static_cast<Eigen::Index>(i)) = tau(model.nodes[i] - about);
  return R;
}

/// Restriction of a full vector to the free dofs.
Eigen::MatrixXd at_free(const DofMap& map, const Eigen::MatrixXd& full) {
  Eigen::MatrixXd u(map.n_free(), full.cols());
  for (int i = 0; i < map.n_free(); ++i) {
    const Dof& dof = map.free[static_cast<std::size_t>(i)];
    u.row(i) = full.row(6 * dof.node + dof.direction);
  }
  return u;
}

}  // namespace

TEST(Constraints, WithoutAnyEveryUsedDofIsFree) {
  const Model model = nodes_at({Vec3::Zero(), Vec3::UnitX()});
  const DofMap map = eliminate_all_used(model);
  EXPECT_EQ(map.n_free(), 12);
  EXPECT_EQ(map.names[7], "node 2 uy");
  EXPECT_EQ(map.row({1, 1}), 7);
}

TEST(Constraints, RigidLinkFollowsTheIndependentNode) {
  Model model = nodes_at({Vec3(0.1, 0.2, 0.3), Vec3(2.0, -1.0, 0.5), Vec3(-1.0, 4.0, 2.0)});
  model.rigid_links.push_back({0, {1, 2}, all_six, Mat3::Identity(), 7});
  const DofMap map = eliminate_all_used(model);
  ASSERT_EQ(map.n_free(), 6);
  EXPECT_LT((map.expand(Mat6::Identity()) - rigid(model, model.nodes[0])).norm(), 1e-14);
}

TEST(Constraints, ChainOfLinksGivenInAnyOrderResolves) {
  Model model = nodes_at({Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(1, 1, 0), Vec3(1, 1, 1)});
  model.rigid_links.push_back({2, {3}, all_six, Mat3::Identity(), 1});  // 3 follows 2 follows 1 follows 0
  model.rigid_links.push_back({1, {2}, all_six, Mat3::Identity(), 2});
  model.rigid_links.push_back({0, {1}, all_six, Mat3::Identity(), 3});
  const DofMap map = eliminate_all_used(model);
  ASSERT_EQ(map.n_free(), 6);
  EXPECT_LT((map.expand(Mat6::Identity()) - rigid(model, model.nodes[0])).norm(), 1e-14);
  EXPECT_EQ(map.redundant_constraints, 0);
}

TEST(Constraints, AClosedRingOfRigidLinksIsRedundantOnce) {
  Model model = nodes_at({Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(0, 1, 0)});
  for (int i = 0; i < 3; ++i) model.rigid_links.push_back({i, {(i + 1) % 3}, all_six, Mat3::Identity(), i});
  const DofMap map = eliminate_all_used(model);
  EXPECT_EQ(map.n_free(), 6);
  EXPECT_EQ(map.redundant_constraints, 6);
  // whatever node was kept, the map reproduces every rigid motion
  const Eigen::MatrixXd R = rigid(model, Vec3(0.3, -0.2, 0.9));
  EXPECT_LT((map.expand(at_free(map, R)) - R).norm(), 1e-13);
}

TEST(Constraints, PartialLinkInTurnedAxesBindsOnlyItsDirections) {
  Model model = nodes_at({Vec3::Zero(), Vec3(1.0, 2.0, 0.0)});
  const Mat3 axes = Eigen::AngleAxisd(0.7, Vec3(1, 2, 3).normalized()).toRotationMatrix();
  model.rigid_links.push_back({0, {1}, 0b000010, axes, 4});
  const DofMap map = eliminate_all_used(model);
  ASSERT_EQ(map.n_free(), 11);
  std::mt19937 random(3);
  std::normal_distribution<double> normal;
  const Eigen::MatrixXd u = map.expand(Eigen::VectorXd::NullaryExpr(11, [&] { return normal(random); }));
  const Vec3 follows = u.block<3, 1>(0, 0) + Vec3(u.block<3, 1>(3, 0)).cross(model.nodes[1]);
  EXPECT_NEAR(axes.col(1).dot(Vec3(u.block<3, 1>(6, 0)) - follows), 0.0, 1e-14);
}

TEST(Constraints, AveragingLinkReproducesRigidMotionsAndLoadsEquilibrium) {
  Model model = nodes_at({Vec3(0.2, 0.1, 0.4), Vec3(1, 0, 0), Vec3(0, 1, 0), Vec3(0, 0, 1), Vec3(-1, -1, 0.3)});
  AverageLink link{0, all_six, {}, 9};
  for (int i = 1; i < 5; ++i) link.nodes.push_back({i, 0.5 * i, 0b000111});
  const Mat6X A = averaging_matrix(model, link);
  const Eigen::MatrixXd R = rigid(model, Vec3(2, 2, 2));
  Eigen::MatrixXd at_nodes(12, 6);
  for (int i = 1; i < 5; ++i) at_nodes.middleRows<3>(3 * (i - 1)) = R.middleRows<3>(6 * i);
  EXPECT_LT((A * at_nodes - R.topRows<6>()).norm(), 1e-12);
}

TEST(Constraints, AveragingLinkToCollinearNodesIsRefused) {
  Model model = nodes_at({Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(2, 0, 0), Vec3(3, 0, 0)});
  model.average_links.push_back({0, all_six, {{1, 1.0, 0b111}, {2, 1.0, 0b111}, {3, 1.0, 0b111}}, 5});
  EXPECT_THAT([&] { (void)eliminate_all_used(model); },
              testing::ThrowsMessage<ModelError>(testing::HasSubstr("averaging link 5 at node 1")));
}

TEST(Constraints, APortKeepsItsDofsWhenItAverages) {
  Model model = nodes_at({Vec3(0.5, 0.5, 0), Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(1, 1, 0), Vec3(0, 1, 0)});
  model.average_links.push_back({0, all_six, {{1, 1, 0b111}, {2, 1, 0b111}, {3, 1, 0b111}, {4, 1, 0b111}}, 1});
  model.ports.push_back({"p", 0});
  const DofMap map = eliminate_all_used(model);
  EXPECT_EQ(map.n_free(), 24);  // 30 dofs less six rows
  for (int d = 0; d < 6; ++d) EXPECT_GE(map.row({0, d}), 0);
  const Eigen::MatrixXd R = rigid(model, Vec3::Zero());
  EXPECT_LT((map.expand(at_free(map, R)).topRows<6>() - R.topRows<6>()).norm(), 1e-13);
}

TEST(Constraints, APortTiedToGroundIsRefusedByName) {
  Model model = nodes_at({Vec3::Zero(), Vec3::UnitX()});
  for (int d = 0; d < 6; ++d) model.supports.push_back({{1, d}});
  model.rigid_links.push_back({0, {1}, all_six, Mat3::Identity(), 3});
  model.ports.push_back({"root", 0});
  EXPECT_THAT([&] { (void)eliminate_all_used(model); },
              testing::ThrowsMessage<ModelError>(
                  testing::AllOf(testing::HasSubstr("rigid link 3"), testing::HasSubstr("node 1"))));
}

TEST(Constraints, SupportsTakeDofsOutAndPassThroughLinks) {
  Model model = nodes_at({Vec3::Zero(), Vec3::UnitX()});
  for (int d = 0; d < 6; ++d) model.supports.push_back({{0, d}});
  model.rigid_links.push_back({0, {1}, all_six, Mat3::Identity(), 3});
  EXPECT_EQ(eliminate_all_used(model).n_free(), 0);
}

TEST(Constraints, AScalarPointCarriesAnAngle) {
  Model model = nodes_at({Vec3::Zero(), Vec3::Zero(), Vec3::Zero()});
  model.scalar_points.push_back(2);
  const Vec3 axis(0.6, 0.0, 0.8);
  for (int d = 0; d < 6; ++d) {
    LinearConstraint row{{{{1, d}, 1.0}, {{0, d}, -1.0}}, d};
    if (d >= 3) row.terms.push_back({{2, 0}, -axis(d - 3)});
    model.constraints.push_back(row);
  }
  std::vector<char> used(18, 1);
  std::fill(used.begin() + 12, used.end(), 0);
  const DofMap map = eliminate_constraints(model, used);
  ASSERT_EQ(map.n_free(), 7);
  Eigen::VectorXd u = Eigen::VectorXd::Zero(7);
  u(6) = 2.0;  // the angle alone
  EXPECT_LT((map.expand_node(1, u).bottomRows<3>() - 2.0 * axis).norm(), 1e-15);
}

TEST(Constraints, CoefficientsThatAreNotNumbersAreRefused) {
  for (const double bad : {std::nan(""), std::numeric_limits<double>::infinity()}) {
    Model model = nodes_at({Vec3::Zero(), Vec3::UnitX(), Vec3::UnitY()});
    model.constraints.push_back({{{{0, 0}, 1.0}, {{1, 0}, bad}}, 8});
    EXPECT_THAT([&] { eliminate_all_used(model); },
                testing::ThrowsMessage<ModelError>(testing::HasSubstr(
                    "test: the linear constraint 8 has a coefficient that is not finite, at node 2 ux")));
    model.constraints.clear();
    model.average_links.push_back({0, all_six, {{1, bad, 0b111}, {2, 1.0, 0b111}}, 9});
    EXPECT_THROW(eliminate_all_used(model), ModelError);
  }
}
