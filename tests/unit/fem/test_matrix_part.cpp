#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <Eigen/Geometry>

#include "fem/matrix_part.hpp"
#include "tests/refusal.hpp"

using namespace tenon;
using namespace tenon::fem;
using testing::HasSubstr;
using tests::refusal;

namespace {

/// A frame of six beams askew, without links.
Model frame() {
  Model model;
  model.source = "frame";
  const std::vector<Vec3> nodes{{0, 0, 0}, {1, 0.2, 0}, {1.1, 1, 0.3}, {0, 0.9, 0.5}, {0.4, 0.3, 1.2}, {0.2, 1.5, 0.1}};
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    model.nodes.push_back(nodes[i]);
    model.node_ids.push_back(10 + static_cast<long>(i));
  }
  model.materials.push_back({"steel", 2.1e11, 8.0e10, 0.3, 7800.0});
  model.beam_sections.push_back({"rod", 1e-3, 2e-7, 3e-7, 0.0, 4e-7, 0.0, 0.0, 0.5});
  for (const auto& [a, b] : {std::pair{0, 1}, {1, 2}, {2, 3}, {3, 4}, {4, 0}, {1, 4}})
    model.elements.emplace_back(Beam{.nodes = {a, b}, .orientation = Vec3(0.3, 0.5, 0.9)});
  return model;
}

/// The same with its matrices in place of its elements.
Model as_matrices(const Model& model) {
  const Structure s = assemble(model);
  Model given = model;
  given.elements.clear();
  given.matrix_parts.push_back(std::make_shared<const MatrixPart>(MatrixPart{s.dofs.free, s.K, s.M}));
  return given;
}

void join(Model& model) {
  model.rigid_links.push_back({.independent = 5, .dependents = {2, 3}, .id = 1});
  model.elements.emplace_back(PointMass{5, 4.0, Vec3(1, 2, 3).asDiagonal(), Vec3(0.1, 0, 0), 50});
  model.nodes.emplace_back(0.5, 0.1, 0.6);
  model.node_ids.push_back(99);
  model.average_links.push_back(
      {.reference = 6, .nodes = {{.node = 0}, {.node = 1, .weight = 2.0}, {.node = 4}}, .id = 2});
  model.constraints.push_back({{{{0, 0}, 1.0}, {{1, 1}, -0.5}}, 3});
  model.supports.push_back({{4, 2}});
  model.ports.push_back({"hub", 6});
}

double apart(const SparseMatrix& a, const SparseMatrix& b) { return (a - b).norm() / a.norm(); }

}  // namespace

TEST(MatrixPart, TakesThePlaceOfTheElementsUnderEveryKindOfConstraint) {
  Model elements = frame(), matrices = as_matrices(elements);
  join(elements);
  join(matrices);
  const Structure a = assemble(elements), b = assemble(matrices);
  ASSERT_EQ(a.dofs.names, b.dofs.names);
  EXPECT_LT(apart(a.K, b.K), 1e-14);
  EXPECT_LT(apart(a.M, b.M), 1e-14);
  const MassProperties p = mass_properties(a), q = mass_properties(b);
  EXPECT_NEAR(p.mass, q.mass, 1e-13 * p.mass);
  EXPECT_LT((p.centre - q.centre).norm(), 1e-13);
}

TEST(MatrixPart, LeavesTheMatricesAsTheyAreWhereNothingIsJoined) {
  const Structure a = assemble(frame()), b = assemble(as_matrices(frame()));
  EXPECT_EQ((a.K - b.K).norm(), 0.0);  // the same bits
  EXPECT_EQ((a.M - b.M).norm(), 0.0);
}

TEST(MatrixPart, TurnsWithItsBody) {
  const Mat3 R = Eigen::AngleAxisd(0.7, Vec3(1, 2, -1).normalized()).toRotationMatrix();
  Model turned = frame();
  for (Vec3& x : turned.nodes) x = R * x;
  for (Element& e : turned.elements) std::get<Beam>(e).orientation = R * std::get<Beam>(e).orientation;
  Model given = as_matrices(frame());
  given.nodes = turned.nodes;
  given.matrix_parts.front() = moved(*given.matrix_parts.front(), R, 0, std::vector<char>(given.nodes.size(), 0));
  const Structure a = assemble(turned), b = assemble(given);
  ASSERT_EQ(a.dofs.names, b.dofs.names);
  EXPECT_LT(apart(a.K, b.K), 1e-13);
  EXPECT_LT(apart(a.M, b.M), 1e-13);
}

TEST(MatrixPart, OfSolidsHasNoRotationsAndIsJoinedBySets) {
  Model cube;  // four masses in a tetrahedron of springs, as solids have them: translations only
  cube.source = "solid";
  cube.nodes = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  cube.node_ids = {1, 2, 3, 4};
  MatrixPart part;
  Eigen::MatrixXd K = Eigen::MatrixXd::Zero(12, 12);
  for (int a = 0; a < 4; ++a)
    for (int b = 0; b < a; ++b) {
      const Vec3 e = (cube.nodes[static_cast<std::size_t>(a)] - cube.nodes[static_cast<std::size_t>(b)]).normalized();
      Eigen::VectorXd row = Eigen::VectorXd::Zero(12);
      row.segment<3>(3 * a) = e;
      row.segment<3>(3 * b) = -e;
      K += 1e6 * row * row.transpose();
    }
  for (int node = 0; node < 4; ++node)
    for (int d = 0; d < 3; ++d) part.dofs.push_back({node, d});
  part.K = Eigen::MatrixXd(K.triangularView<Eigen::Lower>()).sparseView();
  part.M = Eigen::MatrixXd(2.5 * Eigen::MatrixXd::Identity(12, 12)).sparseView();
  cube.matrix_parts.push_back(std::make_shared<const MatrixPart>(part));
  EXPECT_EQ(assemble(cube).n(), 12);

  Model by_node = cube;
  by_node.ports.push_back({"corner", 1});
  EXPECT_THAT(refusal([&] { assemble(by_node); }),
              HasSubstr("port 'corner' lies on node 2, which has neither stiffness nor mass in rx, ry, rz. Join the "
                        "port to a `set`"));

  for (const bool average : {false, true}) {
    Model by_set = cube;
    by_set.nodes.emplace_back(0.3, 0.3, 0.0);
    by_set.node_ids.push_back(-1);
    if (average)
      by_set.average_links.push_back({.reference = 4, .nodes = {{.node = 0}, {.node = 1}, {.node = 2}}, .id = 1});
    else
      by_set.rigid_links.push_back({.independent = 4, .dependents = {0, 1, 2}, .id = 1});
    by_set.ports.push_back({"base", 4});
    const Structure s = assemble(by_set);
    EXPECT_EQ(s.n(), average ? 12 : 9);  // six of twelve given up for the port's six; nine for them
    EXPECT_NEAR(mass_properties(s).mass, 10.0, 1e-13);
    EXPECT_LT((mass_properties(s).centre - Vec3(0.25, 0.25, 0.25)).norm(), 1e-14);
    const Eigen::MatrixXd R = rigid_motions(s, Vec3::Zero());
    EXPECT_LT((s.K.selfadjointView<Eigen::Lower>() * R).norm(), 1e-9 * s.K.norm());
  }
}

TEST(MatrixPart, KeepsScalarDofsOutOfRigidMotions) {
  Model model;
  model.nodes = {Vec3::Zero(), Vec3::Zero()};
  model.node_ids = {1, 101};
  model.scalar_points = {1};
  MatrixPart part{{{0, 0}, {1, 0}}, SparseMatrix(2, 2), SparseMatrix(2, 2)};
  part.K.insert(1, 1) = 9.0;
  part.M.insert(0, 0) = 2.0;
  part.M.insert(1, 0) = 0.5;
  part.M.insert(1, 1) = 1.0;
  model.matrix_parts.push_back(std::make_shared<const MatrixPart>(part));
  const Structure s = assemble(model);
  ASSERT_EQ(s.n(), 2);
  const Eigen::MatrixXd R = rigid_motions(s, Vec3::Zero());
  EXPECT_EQ(R(0, 0), 1.0);
  EXPECT_EQ(R.row(1).norm(), 0.0);
}

TEST(MatrixPart, RefusesWhatItCannotAnswer) {
  const Model good = as_matrices(frame());
  const Structure s = assemble(good);
  EXPECT_THAT(refusal([&] { geometric_mass_properties(good); }), HasSubstr("matrices have no volumes"));
  EXPECT_THAT(refusal([&] { geometric_stiffness(good, s, Eigen::VectorXd::Zero(s.n())); }),
              HasSubstr("matrices alone do not tell the stress"));
  const auto with = [&](auto change) {
    Model model = good;
    MatrixPart part = *good.matrix_parts.front();
    change(part);
    model.matrix_parts.front() = std::make_shared<const MatrixPart>(part);
    return refusal([&] { assemble(model); });
  };
  EXPECT_THAT(with([](MatrixPart& p) { p.dofs.pop_back(); }), HasSubstr("for 29 labelled rows"));
  EXPECT_THAT(with([](MatrixPart& p) { p.dofs[3] = p.dofs[2]; }),
              HasSubstr("two rows of the matrices belong to node 10 uz"));
  EXPECT_THAT(with([](MatrixPart& p) { p.dofs[3].node = 77; }), HasSubstr("node index 77"));
  Model unplaced = good;
  unplaced.nodes[2] = Vec3::Constant(NAN);
  EXPECT_THAT(refusal([&] { rigid_motions(assemble(unplaced), Vec3::Zero()); }),
              HasSubstr("the place of node 12 ux is not known"));
  unplaced.rigid_links.push_back({.independent = 0, .dependents = {2}, .id = 1});
  EXPECT_THAT(refusal([&] { assemble(unplaced); }), HasSubstr("frame: the place of node 12 is not known"));
}
