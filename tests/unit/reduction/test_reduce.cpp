#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "fem/error.hpp"
#include "reduction/modes.hpp"
#include "reduction/reduce.hpp"
#include "tests/refusal.hpp"
#include "tests/unit/reduction/beams.hpp"

using namespace tenon;
using namespace tenon::reduction;
using namespace tenon::tests;
using testing::HasSubstr;

TEST(Reduce, RigidMassMatrixAndFramesOfTheBody) {
  const BeamData data;
  const ReducedBody body = reduce(fem::assemble(beam(data, {{"root", 0}, {"tip", 24}})), "root",
                                  {.basis = Basis::craig_bampton, .modes = 4});
  EXPECT_EQ(body.parent, 0);
  EXPECT_LT(body.reference.norm(), 1e-15);
  const double m = data.mass_total(), l = data.length;
  EXPECT_NEAR(body.D(0, 0), m, 1e-12 * m);
  EXPECT_NEAR(body.D(5, 5), m * l * l / 3.0, 1e-12 * m * l * l);
  EXPECT_NEAR(body.D(1, 5), m * l / 2.0, 1e-12 * m * l);
  EXPECT_EQ(body.n(), 10);  // six static shapes of the tip and four fixed-interface modes
  EXPECT_EQ(body.ports[0].Phi, Mat6X::Zero(6, 10));
  EXPECT_EQ(body.node_shapes.rows(), 6 * 25);
  EXPECT_LT((body.node_shapes.bottomRows(6) - body.ports[1].Phi).norm(), 1e-12 * body.ports[1].Phi.norm());
  EXPECT_EQ(body.certificate.modes_found, body.certificate.modes_counted);
  EXPECT_GT(body.certificate.valid_below, 0.0);
}

TEST(Reduce, StaticFlexibilityOfTheTipIsExact) {
  // Φ Ω⁻² Φᵀ at the tip: L/EA, L³/3EI, L/GJ, L/EI, whatever the number of fixed-interface modes
  const BeamData data;
  const fem::Structure structure = fem::assemble(beam(data, {{"root", 0}, {"tip", 24}}));
  const double l = data.length, E = data.material.E, G = data.material.G;
  for (const int modes : {0, 5}) {
    const ReducedBody body = reduce(structure, "root", {.modes = modes});
    const Mat6X& Phi = body.ports[1].Phi;
    const Mat6 F = Phi * body.omega.cwiseAbs2().cwiseInverse().asDiagonal() * Phi.transpose();
    EXPECT_NEAR(F(0, 0) * E * data.section.A / l, 1.0, 1e-9);
    EXPECT_NEAR(F(1, 1) * 3.0 * E * data.section.Iz / (l * l * l), 1.0, 1e-9);
    EXPECT_NEAR(F(2, 2) * 3.0 * E * data.section.Iy / (l * l * l), 1.0, 1e-9);
    EXPECT_NEAR(F(3, 3) * G * data.section.J / l, 1.0, 1e-9);
    EXPECT_NEAR(F(5, 5) * E * data.section.Iz / l, 1.0, 1e-9);
    EXPECT_NEAR(F(1, 5) * 2.0 * E * data.section.Iz / (l * l), 1.0, 1e-9);
  }
}

TEST(Reduce, AMasslessDirectionKeepsItsFlexibilityAndIsNamed) {
  // Nastran's bars carry no torsional inertia: the tip's twist is a static shape without mass
  BeamData data;
  data.mass = fem::BeamMass::nastran;
  const ReducedBody body = reduce(fem::assemble(beam(data, {{"root", 0}, {"tip", 24}})), "root",
                                  {.basis = Basis::craig_bampton, .modes = 6});
  const Mat6X& Phi = body.ports[1].Phi;
  const Mat6 F = Phi * body.omega.cwiseAbs2().cwiseInverse().asDiagonal() * Phi.transpose();
  EXPECT_NEAR(F(3, 3) * data.material.G * data.section.J / data.length, 1.0, 1e-9);
  ASSERT_EQ(body.n(), 12);
  EXPECT_NEAR(body.omega[11] / body.omega[10], 1e3, 1e-6);
  EXPECT_EQ(body.L.row(11), Eigen::RowVectorXd::Zero(6));
  EXPECT_THAT(body.certificate.left_out, testing::Contains(HasSubstr("massless")));
  EXPECT_LT(body.D.row(3).norm(), 1e-12 * body.D.norm());
}

TEST(Reduce, AllModesLeaveNothingOut) {
  BeamData data;
  data.elements = 6;
  const ReducedBody body = reduce(fem::assemble(beam(data, {{"root", 0}, {"tip", 6}})), "root", {.all_modes = true});
  EXPECT_EQ(body.n(), 36);  // every dof but the root's
  EXPECT_EQ(body.certificate.valid_below, 0.0);
  EXPECT_TRUE(body.certificate.left_out.empty());
}

TEST(Reduce, RefusesAnUnknownParentPort) {
  const fem::Structure structure = fem::assemble(beam({}, {{"root", 0}, {"tip", 24}}));
  EXPECT_THAT(refusal([&] { reduce(structure, "rot"); }), HasSubstr("Did you mean 'root'?"));
}

TEST(Reduce, RefusesAPartWithoutStiffnessPathAndNamesIt) {
  fem::Model model = beam({}, {{"root", 0}, {"mid", 12}});
  model.elements.erase(model.elements.begin() + 20);  // nodes 22 to 25 hang loose
  const std::string message = refusal([&] { reduce(fem::assemble(model), "root"); });
  EXPECT_THAT(message, HasSubstr("no stiffness path to parent port 'root'"));
  EXPECT_THAT(message, HasSubstr("node 22 ux"));
}

TEST(Reduce, RefusesABodyHeldToTheGround) {
  fem::Model model = beam({}, {{"root", 0}, {"tip", 24}});
  model.elements.emplace_back(fem::Spring{.node_a = 10, .dof_a = 1, .node_b = -1, .dof_b = 0, .k = 50.0, .id = 99});
  const std::string message = refusal([&] { reduce(fem::assemble(model), "root"); });
  EXPECT_THAT(message, HasSubstr("held to the ground"));
  EXPECT_THAT(message, HasSubstr("node 11 uy"));
}

TEST(Reduce, RefusesAMechanismInside) {
  // a bent beam with a ball joint (three translations held together, rotations free) at its corner: the far leg swings
  fem::Model model = beam({}, {{"root", 0}});
  for (std::size_t k = 13; k <= 24; ++k) {
    model.nodes[k] = model.nodes[12] + fem::Vec3(0.02, 0.05, 0.03) * static_cast<double>(k - 12);
    std::get<fem::Beam>(model.elements[k - 1]).orientation = fem::Vec3::UnitX();
  }
  model.nodes.push_back(model.nodes[12]);
  model.node_ids.push_back(99);
  std::get<fem::Beam>(model.elements[12]).nodes[0] = 25;
  for (int d = 0; d < 3; ++d)
    model.elements.emplace_back(
        fem::Spring{.node_a = 12, .dof_a = d, .node_b = 25, .dof_b = d, .k = 1e6, .id = 100 + d});
  EXPECT_THAT(refusal([&] { reduce(fem::assemble(model), "root"); }), HasSubstr("can move without strain"));
}

TEST(Rebase, RefusesAPortThatIsNotThere) {
  const ReducedBody body = rigid_body("hub", 1.0, Vec3::Zero(), Mat3::Identity(), {{"a"}});
  EXPECT_THROW(rebase(body, 3), ModelError);
}

TEST(Rebase, ARigidBodyMovesItsReference) {
  const ReducedBody body = rigid_body("hub", 3.0, Vec3(0.5, 0.0, 0.0), 2.0 * Mat3::Identity(),
                                      {{"a", Vec3::Zero()}, {"b", Vec3(1.0, 2.0, 0.0)}});
  const ReducedBody moved = rebase(body, 1);
  EXPECT_LT((moved.D - fem::rigid_mass(3.0, Vec3(-0.5, -2.0, 0.0), 2.0 * Mat3::Identity())).norm(), 1e-14);
}

TEST(Check, RefusesDamagedBodies) {
  const ReducedBody good =
      reduce(fem::assemble(beam({}, {{"root", 0}, {"tip", 24}})), "root", {.modes = 2, .zeta = 0.01});
  EXPECT_NO_THROW(check(good));
  ReducedBody bad = good;
  bad.zeta.conservativeResize(3);
  EXPECT_THAT(refusal([&] { check(bad); }), HasSubstr("disagree in number"));
  bad = good;
  bad.L(0, 0) = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THAT(refusal([&] { check(bad); }), HasSubstr("not finite"));
  bad = good;
  bad.omega[0] = -1.0;
  EXPECT_THAT(refusal([&] { check(bad); }), HasSubstr("negative"));
  bad = good;
  bad.L *= 2.0;
  EXPECT_THAT(refusal([&] { check(bad); }), HasSubstr("more mass than it has"));
  bad = good;
  bad.D(0, 1) += 1.0;
  EXPECT_THAT(refusal([&] { check(bad); }), HasSubstr("not symmetric"));
  bad = good;
  bad.parent = 7;
  EXPECT_THAT(refusal([&] { check(bad); }), HasSubstr("parent port"));
}
