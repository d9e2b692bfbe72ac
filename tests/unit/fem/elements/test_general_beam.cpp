// Beams whose section varies, or whose shear centre or mass lies off the centroid: closed forms, and the uniform beam.
#include "fem/elements/general_beam.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>
#include <numbers>

#include "fem/elements/beam.hpp"
#include "fem/error.hpp"
#include "fem/structure.hpp"
#include "tests/unit/fem/elements/small_assembly.hpp"

using namespace tenon;
using namespace tenon::fem;
using namespace tenon::fem::testing;

namespace {

const Material alloy{"alloy", 2.1e11, 8.0e10, 0.3, 7800.0};

BeamSection skew_section() {
  return {.name = "skew",
          .A = 3e-3,
          .Iy = 4e-6,
          .Iz = 9e-6,
          .Iyz = 2e-6,
          .J = 1.5e-6,
          .kappa_y = 0.6,
          .kappa_z = 0.45,
          .nsm = 2.5};
}

Model one_beam(const BeamSection& section) {
  Model model;
  model.nodes = {Vec3(1.0, 2.0, -0.5), Vec3(1.9, 2.7, 0.4)};
  model.node_ids = {1, 2};
  model.materials = {alloy};
  model.beam_sections = {section};
  Beam b{.nodes = {0, 1}, .orientation = Vec3(0.2, -0.3, 1.0), .id = 42};
  b.offsets = {Vec3(0.1, -0.05, 0.2), Vec3(-0.3, 0.15, 0.07)};
  model.elements = {b};
  return model;
}

/// All that the general beam is for, at once.
Model odd_taper() {
  BeamSection a = skew_section(), b = skew_section(), c = skew_section();
  a.shear_y = 0.02;
  a.shear_z = -0.01;
  a.nsm_z = 0.03;
  b.A = 1e-3;
  b.Iy = 1e-6;
  b.Iz = 3e-6;
  b.Iyz = -0.5e-6;
  b.J = 0.2e-6;
  b.shear_z = 0.015;
  c.nsm = 0.0;
  Model model = one_beam(a);
  model.beam_sections = {a, b, c};
  model.tapers = {{{0.0, 0}, {0.3, 1}, {1.0, 2}}};
  std::get<Beam>(model.elements[0]).taper = 0;
  return model;
}

/// Nodes along x, clamped or on forks (no displacement, no twist, free to bend) at both ends.
Model straight(double length, int elements) {
  Model model;
  model.materials = {alloy};
  for (int k = 0; k <= elements; ++k) {
    model.nodes.emplace_back(length * k / elements, 0.0, 0.0);
    model.node_ids.push_back(k + 1);
  }
  for (int k = 0; k < elements; ++k)
    model.elements.emplace_back(
        Beam{.nodes = {k, k + 1}, .orientation = Vec3::UnitY(), .rotary_inertia = false, .id = k + 1});
  return model;
}

Model on_forks(double length, int elements, const BeamSection& section) {
  Model model = straight(length, elements);
  model.beam_sections = {section};
  model.supports.push_back({{0, 0}});
  for (const int node : {0, elements})
    for (const int d : {1, 2, 3}) model.supports.push_back({{node, d}});
  return model;
}

Eigen::MatrixXd full(const SparseMatrix& lower) { return Eigen::MatrixXd(lower).selfadjointView<Eigen::Lower>(); }

Eigen::VectorXd squared_frequencies(const Model& model) {
  const Structure s = assemble(model);
  return Eigen::GeneralizedSelfAdjointEigenSolver<Eigen::MatrixXd>(full(s.K), full(s.M)).eigenvalues();
}

/// ω² of bending with torsion at wave number k: EI k⁴ and GJ k² over [m, S; S, I], S the static moment that couples
/// them.
Eigen::Vector2d coupled(double EI, double GJ, double m, double S, double I, double k) {
  const Eigen::Matrix2d K = Eigen::Vector2d(EI * std::pow(k, 4), GJ * k * k).asDiagonal();
  return Eigen::GeneralizedSelfAdjointEigenSolver<Eigen::Matrix2d>(K, (Eigen::Matrix2d() << m, S, S, I).finished())
      .eigenvalues();
}

double nearest(const Eigen::VectorXd& values, double value) { return (values.array() / value - 1.0).abs().minCoeff(); }

}  // namespace

TEST(GeneralBeam, WithOneCentredSectionIsTheUniformBeam) {
  for (const BeamMass mass : {BeamMass::consistent, BeamMass::high_order})
    for (const bool shear : {true, false})
      for (const Directions release : {Directions{0}, Directions{0b110000}}) {
        BeamSection section = skew_section();
        if (!shear) section.kappa_y = section.kappa_z = 0.0;
        Model model = one_beam(section);
        Beam& beam = std::get<Beam>(model.elements[0]);
        beam.mass = mass;
        beam.releases[1] = release;
        ElementMatrices expected, general;
        beam_matrices(beam, section, alloy, model.nodes, expected);
        general_beam_matrices(beam, SectionLine(model, beam), alloy, model.nodes, general);
        EXPECT_LT((general.K - expected.K).cwiseAbs().maxCoeff(), 1e-12 * expected.K.cwiseAbs().maxCoeff());
        EXPECT_LT((general.M - expected.M).cwiseAbs().maxCoeff(), 1e-12 * expected.M.cwiseAbs().maxCoeff());
        Eigen::VectorXd u(12);
        u << 0, 0, 0, 0, 0, 0, 1e-3, 2e-3, -1e-3, 1e-3, 0, 2e-3;
        ElementMatrices::Matrix stiffening, expected_stiffening;
        beam_geometric_stiffness(beam, section, alloy, model.nodes, u, expected_stiffening);
        general_beam_geometric_stiffness(beam, SectionLine(model, beam), alloy, model.nodes, u, stiffening);
        EXPECT_LT((stiffening - expected_stiffening).cwiseAbs().maxCoeff(),
                  1e-11 * expected_stiffening.cwiseAbs().maxCoeff());
      }
}

TEST(GeneralBeam, RigidMotionsCostNothingAndCarryTheMass) {
  const Model model = odd_taper();
  const Structure s = assemble(model);
  const Eigen::MatrixXd K = full(s.K), M = full(s.M);
  const Eigen::MatrixXd R = rigid_motions(model.nodes);
  EXPECT_LT((K * R).cwiseAbs().maxCoeff(), 1e-12 * K.cwiseAbs().maxCoeff());
  EXPECT_EQ(zero_modes(K, 1.0, 1e-12), 6);
  const Mat6 D = R.transpose() * M * R;
  const MassProperties p = geometric_mass_properties(model);  // by another route: points along the axis
  const Mat6 expected = rigid_mass(p.mass, p.centre, p.inertia);
  EXPECT_LT((D - expected).cwiseAbs().maxCoeff(), 1e-10 * expected.cwiseAbs().maxCoeff());
}

// A force at the tip of a cantilever whose sizes fall in proportion to 1 − c x/L, one element: δ = P L³ / (3 E I₀ (1 −
// c)).
TEST(GeneralBeam, OneElementBendsAsATaperedCantilever) {
  for (const double ratio : {0.5, 0.25, 0.1}) {
    Model model = straight(2.0, 1);
    const double c = 1.0 - ratio, I = 1e-4 / 12;
    const BeamSection thick{.name = "root", .A = 0.01, .Iy = I, .Iz = I, .J = 1e-5};
    BeamSection thin = thick;
    thin.A *= ratio * ratio;
    for (double* moment : {&thin.Iy, &thin.Iz, &thin.J}) *moment *= std::pow(ratio, 4);
    model.beam_sections = {thick, thin};
    model.tapers = {{{0.0, 0}, {1.0, 1}}};
    std::get<Beam>(model.elements[0]).taper = 0;
    for (int d = 0; d < 6; ++d) model.supports.push_back({{0, d}});
    const Structure s = assemble(model);
    const Eigen::MatrixXd flexibility = full(s.K).inverse();
    EXPECT_NEAR(flexibility(1, 1) * 3.0 * alloy.E * I * ratio / 8.0, 1.0, 1e-8) << ratio;
    EXPECT_NEAR(flexibility(0, 0) * alloy.E * thick.A * ratio / 2.0, 1.0, 1e-8) << ratio;      // ∫ dx/A
    const double twist = (std::pow(ratio, -3) - 1.0) / (3.0 * c) * 2.0 / (alloy.G * thick.J);  // ∫ dx/GJ
    EXPECT_NEAR(flexibility(3, 3) / twist, 1.0, 1e-8) << ratio;
  }
}

// A force through the centroid, off the shear centre by c_y, twists the tip by −c_y P L/GJ and bends it as ever.
TEST(GeneralBeam, ALoadOffTheShearCentreTwists) {
  BeamSection channel = skew_section();
  channel.Iyz = 0.0;
  channel.kappa_y = channel.kappa_z = 0.0;
  channel.shear_y = -0.05;
  Model model = straight(3.0, 2);
  model.beam_sections = {channel};
  for (int d = 0; d < 6; ++d) model.supports.push_back({{0, d}});
  const Structure s = assemble(model);
  const Eigen::MatrixXd flexibility = full(s.K).inverse();
  const Eigen::VectorXd under_load = flexibility.col(8);  // P = 1 N along z at the tip
  EXPECT_NEAR(under_load(9), 0.05 * 3.0 / (alloy.G * channel.J), 1e-12 * 0.05 * 3.0 / (alloy.G * channel.J));
  // at the centroid: that of the shear centre and the twist's share, c_y² P L/GJ
  const double expected = 27.0 / (3.0 * alloy.E * channel.Iy) + 0.05 * 0.05 * 3.0 / (alloy.G * channel.J);
  EXPECT_NEAR(under_load(8), expected, 1e-10 * expected);
}

// Bending and torsion of a beam on forks couple through the distance a of centroid and shear centre:
// [m, m a; m a, I_p + m a²] with EI k⁴, GJ k², k = nπ/L. The error of `high_order` falls with h⁴.
TEST(GeneralBeam, BendingAndTorsionCoupleThroughTheShearCentre) {
  BeamSection channel{.name = "channel", .A = 2e-3, .Iy = 3e-6, .Iz = 1e-6, .J = 4e-8, .shear_y = -0.04};
  const double length = 2.0, m = alloy.rho * channel.A, I_p = alloy.rho * (channel.Iy + channel.Iz), a = 0.04;
  std::array<double, 3> errors{};
  for (std::size_t k = 0; k < errors.size(); ++k) {
    const Eigen::VectorXd computed = squared_frequencies(on_forks(length, 8 << k, channel));
    for (int n = 1; n <= 2; ++n)
      for (const double expected :
           coupled(alloy.E * channel.Iy, alloy.G * channel.J, m, m * a, I_p + m * a * a, n * std::numbers::pi / length))
        errors[k] = std::max(errors[k], nearest(computed, expected));
  }
  EXPECT_LT(errors[2], std::pow(2.0 * std::numbers::pi / 32, 4) / 100.0);
  EXPECT_GT(errors[0] / errors[1], 13.0);
  EXPECT_GT(errors[1] / errors[2], 13.0);
}

// The same through non-structural mass off the centroid: m v² − 2 S v φ + I φ², S = nsm z, I = I_p + nsm z².
TEST(GeneralBeam, BendingAndTorsionCoupleThroughTheMass) {
  BeamSection bar{.name = "bar", .A = 2e-3, .Iy = 3e-6, .Iz = 1e-6, .J = 4e-7, .nsm = 9.0, .nsm_z = 0.06};
  const double length = 2.0, m = alloy.rho * bar.A + bar.nsm, I_p = alloy.rho * (bar.Iy + bar.Iz), z = bar.nsm_z;
  Model model = on_forks(length, 64, bar);
  for (Element& e : model.elements) std::get<Beam>(e).mass = BeamMass::consistent;
  const Eigen::VectorXd computed = squared_frequencies(model);
  for (int n = 1; n <= 2; ++n)
    for (const double expected : coupled(alloy.E * bar.Iz, alloy.G * bar.J, m, -bar.nsm * z, I_p + bar.nsm * z * z,
                                         n * std::numbers::pi / length))
      EXPECT_LT(nearest(computed, expected), std::pow(n * std::numbers::pi / 64, 2) / 12.0 * 1.1);  // linear twist
}

TEST(GeneralBeam, RefusesWhatItCannotIntegrate) {
  Model model = odd_taper();
  model.beam_sections[1].J = 0.0;
  EXPECT_THAT([&] { assemble(model); },
              ::testing::ThrowsMessage<ModelError>(::testing::HasSubstr("no torsional stiffness")));
  model = odd_taper();
  model.beam_sections[2].Iyz = 6e-6;
  EXPECT_THAT([&] { assemble(model); },
              ::testing::ThrowsMessage<ModelError>(::testing::HasSubstr("does not resist bending")));
}
