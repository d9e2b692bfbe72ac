#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>
#include <cmath>

#include "assembly/build.hpp"
#include "assembly/full_model.hpp"
#include "fem/structure.hpp"
#include "tests/support/temporary_folder.hpp"

namespace tenon::assembly {
namespace {

using testing::HasSubstr;

/// A mesh of two lines in mm: 1 (0,0,0) to 2 (1000,0,0), and 3 at 2's place to 4 (1000,500,0).
class RodsAndSprings : public testing::Test {
 protected:
  RodsAndSprings() {
    folder.write("bars.inp",
                 "*NODE\n1,0.,0.,0.\n2,1000.,0.,0.\n3,1000.,0.,0.\n4,1000.,500.,0.\n*ELEMENT,TYPE=T3D2,ELSET=boom\n"
                 "7,1,2\n*ELEMENT,TYPE=T3D2,ELSET=arm\n8,3,4\n*NSET,NSET=root\n1\n");
  }
  fem::Model build(const std::string& rest, const std::string& boom = "{rod: {A: 200, J: 5000}}") {
    const Scene scene = read_scene(folder.write(
        "scene.yaml",
        "units: mm-t-s\nbodies:\n  frame:\n    fe: bars.inp\n    material: {E: 70e3, nu: 0.33, rho: 2.7e-9}\n    "
        "sections: {boom: " +
            boom + ", arm: {rod: 100, nsm: 1e-6}}\n    ports: {foot: {node: 1}, tip: {node: 4}}\n" + rest));
    return build_model(scene.bodies.at(0));
  }
  std::string refusal(const std::string& rest, const std::string& boom = "{rod: 200}") {
    try {
      build(rest, boom);
    } catch (const InputError& error) {
      return error.what();
    }
    return "nothing was refused";
  }
  TemporaryFolder folder;
};

TEST_F(RodsAndSprings, LinesBecomeRods) {
  const fem::Model model = build("    springs: {joint: {from: {node: 2}, to: {node: 3}, k: [1, 1, 1]}}\n");
  const auto& boom = std::get<fem::Rod>(model.elements.at(0));
  const fem::BeamSection& s = model.beam_sections.at(static_cast<std::size_t>(boom.section));
  EXPECT_NEAR(s.A, 2e-4, 1e-18);
  EXPECT_NEAR(s.J, 5e-9, 1e-23);
  EXPECT_EQ(boom.id, 7);
  // 2.7 t/m³ of 1 m × 200 mm² and 0.5 m × 100 mm², and 1e-6 t/mm of 0.5 m
  EXPECT_NEAR(fem::mass_properties(fem::assemble(model)).mass, 2700.0 * (2e-4 + 0.5e-4) + 1.0 * 0.5, 1e-14);
}

TEST_F(RodsAndSprings, SpringsActAtOnePointInTheirOwnAxes) {
  const fem::Model model = build(
      "    springs:\n      mount: {from: {port: foot}, to: {port: tip}, k: [1, 2, 3], kr: [4e6, 5e6, 6e6], at: [500, "
      "0, "
      "0], rotate: {axis: z, angle: 90 deg}}\n      ground: {from: {at: [0, 0, 0]}, k: [7, 0, 0]}\n");
  const auto& mount = std::get<fem::Bush>(model.elements.at(2));
  EXPECT_NEAR(mount.k[0], 1e3, 1e-12);  // N/mm
  EXPECT_NEAR(mount.k[5], 6e3, 1e-12);  // N mm
  EXPECT_LT((mount.offset - Vec3(0.5, 0.0, 0.0)).norm(), 1e-15);
  EXPECT_LT((mount.axes.col(0) - Vec3::UnitY()).norm(), 1e-15);
  const auto& ground = std::get<fem::Bush>(model.elements.at(3));
  EXPECT_EQ(ground.node_b, -1);
  EXPECT_EQ(ground.offset, Vec3::Zero());
}

// Two coincident nodes on a spring: a bar on a wall by k alone, ω² = k/m once it moves as a rigid body (EA/L is 14e3
// k).
TEST_F(RodsAndSprings, ARigidBarOnASoftSpring) {
  fem::Model model = build(
      "    fix: {root: all}\n    springs: {joint: {from: {node: 2}, to: {node: 3}, k: [0.01, 0.01, 0.01], kr: [1e9, "
      "1e9, 1e9]}}\n");
  const fem::Structure s = fem::assemble(model);
  const Eigen::MatrixXd K = Eigen::MatrixXd(s.K).selfadjointView<Eigen::Lower>();
  const int row = s.dofs.row({2, 1}), tip = s.dofs.row({3, 1});
  ASSERT_GE(row, 0);
  EXPECT_NEAR(K(row, row) + 2.0 * K(row, tip) + K(tip, tip), 10.0, 1e-9 * K(tip, tip));  // moved together: k alone
}

TEST_F(RodsAndSprings, FaultsAreRefusedByNameAndPlace) {
  EXPECT_THAT(refusal("", "{rod: 0}"), HasSubstr("found '0', expected a number above 0"));
  EXPECT_THAT(refusal("", "{rod: {J: 5}}"), HasSubstr("a rod without 'A'"));
  EXPECT_THAT(refusal("", "{rod: 5, orientation: [0, 0, 1]}"), HasSubstr("a rod, which does not bend"));
  const auto spring = [&](const std::string& inside) { return refusal("    springs: {s: {" + inside + "}}\n"); };
  EXPECT_THAT(spring("from: {node: 2}"), HasSubstr("spring 's' has no stiffness"));
  EXPECT_THAT(spring("from: {node: 2}, k: [1, -1, 1]"), HasSubstr("spring 's' has a negative stiffness"));
  EXPECT_THAT(spring("from: {node: 2}, to: {node: 2}, k: [1, 1, 1]"), HasSubstr("joins a node to itself"));
  EXPECT_THAT(spring("from: {port: foto}, k: [1, 1, 1]"), HasSubstr("unknown port 'foto'. Ports are: foot, tip"));
  EXPECT_THAT(spring("k: [1, 1, 1]"), HasSubstr("a spring inside a body without 'from'"));
  EXPECT_THAT(spring("from: {node: 2}, k: [1, 1]"), HasSubstr("a list of 3 numbers"));
}

// A part turned in its scene keeps its springs: clamped at its foot it has the eigenvalues it had before.
TEST_F(RodsAndSprings, SpringsTurnWithTheirBody) {
  fem::Model part =
      build("    springs: {joint: {from: {node: 2}, to: {node: 4}, k: [1, 2, 3], kr: [4e6, 5e6, 6e6]}}\n");
  part.elements.emplace_back(
      fem::Spring{.node_a = 1, .dof_a = 1, .node_b = 3, .dof_b = 5, .k = 50.0, .axis_b = Vec3(0.6, 0.0, 0.8)});
  for (int node : {1, 2, 3})
    part.elements.emplace_back(fem::PointMass{.node = node, .mass = 1.0, .inertia = Mat3::Identity()});
  const auto spectrum = [](const fem::Model& model) {
    const fem::Structure s = fem::assemble(model);
    const Eigen::MatrixXd K = Eigen::MatrixXd(s.K).selfadjointView<Eigen::Lower>();
    const Eigen::MatrixXd M = Eigen::MatrixXd(s.M).selfadjointView<Eigen::Lower>();
    return Eigen::VectorXd(
        Eigen::GeneralizedSelfAdjointEigenSolver<Eigen::MatrixXd>(K, M, Eigen::EigenvaluesOnly).eigenvalues());
  };
  Network network;
  const Mat3 turn = Eigen::AngleAxisd(0.8, Vec3(1.0, 2.0, -1.0).normalized()).toRotationMatrix();
  network.bodies.push_back(
      reduction::rigid_body("wall", 1.0, Vec3::Zero(), Mat3::Identity(), {{.name = "p", .axes = turn}}));
  network.bodies.push_back(reduction::rigid_body("part", 1.0, Vec3::Zero(), Mat3::Identity(), {{.name = "foot"}}));
  network.joints.push_back({.name = "weld", .parent = {0, 0}, .child = {1, 0}});
  network.ground = {{0, 0}};
  const Eigen::VectorXd after = spectrum(full_model(network, {nullptr, &part}).model);
  part.ports.clear();
  for (int d = 0; d < 6; ++d) part.supports.push_back({{0, d}});
  const Eigen::VectorXd before = spectrum(part);
  ASSERT_EQ(before.size(), 18);
  ASSERT_EQ(after.size(), 18);
  EXPECT_LT((before - after).cwiseAbs().maxCoeff(), 1e-12 * before.maxCoeff());
}

}  // namespace
}  // namespace tenon::assembly
