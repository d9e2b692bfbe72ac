#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "fem/error.hpp"
#include "reduction/reduce.hpp"
#include "tests/refusal.hpp"
#include "tests/unit/reduction/beams.hpp"

using namespace tenon;
using namespace tenon::reduction;
using namespace tenon::tests;
using testing::Contains;
using testing::HasSubstr;

namespace {

constexpr Basis with_statics[] = {Basis::craig_bampton, Basis::craig_bampton_inertia_relief, Basis::clamped_free_static,
                                  Basis::rubin};

Mat6 flexibility(const ReducedBody& body, int port) {
  const Mat6X& Phi = body.ports[static_cast<std::size_t>(port)].Phi;
  return Phi * body.omega.cwiseAbs2().cwiseInverse().asDiagonal() * Phi.transpose();
}

}  // namespace

TEST(Bases, CountsAndSentences) {
  const fem::Structure s = fem::assemble(beam({}, {{"root", 0}, {"tip", 24}}));
  const auto made = [&](Basis basis) { return reduce(s, "root", {.basis = basis, .modes = 3}); };
  const ReducedBody relief = reduce(s, "root", {.modes = 3});  // the default
  EXPECT_EQ(relief.n(), 3 + 6 + 6);
  EXPECT_EQ(
      relief.certificate.basis,
      "craig-bampton with inertia relief, 3 fixed-interface modes, 6 constraint modes and 6 inertia-relief shapes");
  EXPECT_EQ(made(Basis::clamped_free).n(), 3);
  EXPECT_EQ(made(Basis::clamped_free_static).n(), 3 + 6);
  EXPECT_THAT(made(Basis::clamped_free_static).certificate.basis, HasSubstr("6 residual static shapes"));
  const ReducedBody rubin = made(Basis::rubin);
  EXPECT_EQ(rubin.n(), 3 + 12);
  EXPECT_THAT(rubin.certificate.basis, HasSubstr("3 free-free modes and 12 residual"));
  EXPECT_THAT(rubin.certificate.left_out, Contains(HasSubstr("free-free modes from")));
  EXPECT_EQ(rubin.certificate.modes_found, rubin.certificate.modes_counted);
}

// Bars without torsional inertia: a rigid rotation about the beam carries no mass, a twist of the tip neither.
TEST(Bases, MasslessRotations) {
  BeamData data;
  data.mass = fem::BeamMass::nastran;
  const fem::Structure s = fem::assemble(beam(data, {{"root", 0}, {"tip", 24}}));
  const double twist = data.length / (data.material.G * data.section.J);
  for (const Basis basis : with_statics) {
    if (basis == Basis::rubin) {
      EXPECT_THAT(refusal([&] { reduce(s, "root", {.basis = basis}); }),
                  testing::AllOf(HasSubstr("carries no mass"), HasSubstr("Take craig-bampton-inertia-relief")));
      continue;
    }
    const ReducedBody body = reduce(s, "root", {.basis = basis, .modes = 6});
    EXPECT_NEAR(flexibility(body, 1)(3, 3), twist, 1e-9 * twist) << body.certificate.basis;
    EXPECT_THAT(body.certificate.left_out, Contains(HasSubstr("massless")));
  }
  EXPECT_EQ(reduce(s, "root", {.modes = 6}).n(), 6 + 6 + 5);  // no inertia about the axis, no relief
}

// A port whose node has two directions only; the others follow rigidly.
TEST(Bases, DirectionsWithoutDofs) {
  fem::Model model = beam({}, {{"root", 0}, {"mid", 10}, {"tip", 24}});
  for (int node = 0; node <= 24; ++node)
    for (const int d : {0, 2, 3, 4}) model.supports.push_back({{node, d}});
  const fem::Structure s = fem::assemble(model);
  const double cube = 8.0 / (3.0 * 2e11 * 7e-8);  // L³/3EI
  for (const Basis basis : with_statics) {
    const ReducedBody body = reduce(s, "root", {.basis = basis, .modes = 2});
    EXPECT_EQ(body.n(), basis == Basis::craig_bampton                  ? 6
                        : basis == Basis::craig_bampton_inertia_relief ? 8
                        : basis == Basis::rubin                        ? 8
                                                                       : 6)
        << body.certificate.basis;
    EXPECT_NEAR(flexibility(body, 2)(1, 1), cube, 1e-8 * cube);
    EXPECT_EQ(body.ports[2].Phi.row(0).norm(), 0.0);
  }
}

// A piece 1e12 times stiffer than the rest. At the root it is a longer clamp. At the tip the sum of both stiffnesses
// keeps four digits of the soft one, fewer after the levers of its rotations: what is not refused must be right.
TEST(Bases, StiffnessRatioOfTwelveDecades) {
  BeamData data;
  const auto stiff = [&](int element) {
    fem::Model model = beam(data, {{"root", 0}, {"near", 23}, {"tip", 24}});
    fem::Material rigid = data.material;
    rigid.E *= 1e12;
    rigid.G *= 1e12;
    model.materials.push_back(rigid);
    std::get<fem::Beam>(model.elements[static_cast<std::size_t>(element)]).material = 1;
    return fem::assemble(model);
  };
  const fem::Structure at_root = stiff(0), at_tip = stiff(23);
  const double h = data.length / 24.0;
  const double EI = data.material.E * data.section.Iz;
  const auto expect_right_or_refused = [&](const fem::Structure& s, Basis basis, double length, double tolerance) {
    ReducedBody body;
    const std::string said = refusal([&] { body = reduce(s, "root", {.basis = basis, .modes = 6}); });
    if (!said.empty()) return false;
    const Mat6 F = flexibility(body, 1);
    EXPECT_NEAR(F(1, 1) * 3.0 * EI / (length * length * length), 1.0, tolerance) << body.certificate.basis;
    EXPECT_NEAR(F(5, 5) * EI / length, 1.0, tolerance) << body.certificate.basis;
    return true;
  };
  for (const Basis basis : with_statics) {
    const bool floats = basis == Basis::rubin;  // the stiff end hangs on the soft rest there too
    EXPECT_TRUE(expect_right_or_refused(at_root, basis, 22.0 * h, 1e-9) || floats);
    expect_right_or_refused(at_tip, basis, 23.0 * h, 1e-3);
  }
}

// A direction with mass but without stiffness: a mechanism, refused by name whatever the basis.
TEST(Bases, ADirectionWithoutStiffnessIsRefused) {
  fem::Model model = beam({}, {{"root", 0}, {"tip", 25}});
  model.nodes.push_back(model.nodes[24]);
  model.node_ids.push_back(99);
  for (int d = 0; d < 5; ++d)
    model.elements.emplace_back(
        fem::Spring{.node_a = 24, .dof_a = d, .node_b = 25, .dof_b = d, .k = 1e6, .id = 100 + d});
  fem::PointMass wheel{.node = 25, .mass = 0.1, .id = 200};
  wheel.inertia = 1e-3 * Mat3::Identity();
  model.elements.emplace_back(wheel);
  const fem::Structure s = fem::assemble(model);
  for (const Basis basis : with_statics)
    EXPECT_NE(refusal([&] { reduce(s, "root", {.basis = basis, .modes = 4}); }), "") << static_cast<int>(basis);
}

// Neighbouring ports: their responses nearly coincide, yet the difference is what makes the short piece flexible.
TEST(Bases, PortsCloseTogether) {
  BeamData data;
  data.elements = 24;
  fem::Model model = beam(data, {{"root", 0}, {"a", 23}, {"b", 24}});
  const double gap = 1e-3 * data.length;
  model.nodes[24] = model.nodes[23] + fem::Vec3(gap, 0.0, 0.0);
  const fem::Structure s = fem::assemble(model);
  for (const Basis basis : with_statics) {
    const ReducedBody body = reduce(s, "root", {.basis = basis, .modes = 4});
    Eigen::MatrixXd apart = body.ports[2].Phi - fem::tau(fem::Vec3(gap, 0.0, 0.0)) * body.ports[1].Phi;
    const Mat6 F = apart * body.omega.cwiseAbs2().cwiseInverse().asDiagonal() * apart.transpose();
    const double bend = gap / (data.material.E * data.section.Iz);
    EXPECT_NEAR(F(5, 5), bend, 1e-5 * bend) << body.certificate.basis;
  }
}

TEST(Bases, AllModesNeedNoInertiaRelief) {
  BeamData data;
  data.elements = 6;
  const fem::Structure s = fem::assemble(beam(data, {{"root", 0}, {"tip", 6}}));
  for (const Basis basis : with_statics) {
    const ReducedBody body = reduce(s, "root", {.basis = basis, .all_modes = true});
    EXPECT_EQ(body.n(), 36) << body.certificate.basis;
    EXPECT_EQ(body.certificate.valid_below, 0.0);
  }
}
