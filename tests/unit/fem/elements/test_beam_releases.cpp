#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <cmath>
#include <numbers>

#include "fem/elements/beam.hpp"
#include "fem/error.hpp"
#include "tests/unit/fem/elements/small_assembly.hpp"

using namespace tenon;
using namespace tenon::fem;
using namespace tenon::fem::testing;

namespace {

constexpr Directions ux = 1, uy = 2, rx = 8, ry = 16, rz = 32;
constexpr double h = 0.7;

const Material steel{"steel", 2.1e11, 8.0e10, 0.3, 7800.0};
const BeamSection odd{
    .name = "odd", .A = 3e-3, .Iy = 4e-6, .Iz = 9e-6, .Iyz = 2e-6, .J = 1.5e-6, .kappa_y = 0.6, .kappa_z = 0.45};
const BeamSection rigid_in_shear{.name = "EB", .A = 2e-3, .Iy = 3e-6, .Iz = 5e-6, .J = 1e-6};
const std::vector<Vec3> along_x{Vec3::Zero(), Vec3(h, 0.0, 0.0)};

Beam beam_along_x(Directions end_1, Directions end_2) {
  Beam b;
  b.nodes = {0, 1};
  b.orientation = Vec3::UnitY();
  b.releases = {end_1, end_2};
  b.id = 42;
  return b;
}

ElementMatrices matrices(const Beam& b, const BeamSection& s, std::span<const Vec3> nodes = along_x) {
  ElementMatrices e;
  beam_matrices(b, s, steel, nodes, e);
  return e;
}

std::string refusal(Directions end_1, Directions end_2) {
  try {
    matrices(beam_along_x(end_1, end_2), odd);
  } catch (const ModelError& error) {
    return error.what();
  }
  return "nothing was refused";
}

}  // namespace

TEST(BeamReleases, ClampedPinnedIsTheTextbookMatrix) {
  // force-displacement relations of the propped cantilever with Φ = 12EI/(κGAh²): 3EI/(h³(1 + Φ/4))
  BeamSection s = odd;
  s.Iyz = 0.0;
  const Beam b = beam_along_x(0, rz);
  const ElementMatrices e = matrices(b, s);
  const double Phi = 12 * steel.E * s.Iz / (s.kappa_y * steel.G * s.A * h * h);
  const double k = 3 * steel.E * s.Iz / (h * h * h * (1 + Phi / 4));
  const double row[4] = {k, k * h, -k, 0.0}, row_5[4] = {k * h, k * h * h, -k * h, 0.0};
  const int dof[4] = {1, 5, 7, 11};
  for (int j = 0; j < 4; ++j) {
    EXPECT_NEAR(e.K(1, dof[j]), row[j], 1e-13 * k);
    EXPECT_NEAR(e.K(5, dof[j]), row_5[j], 1e-13 * k);
  }
  EXPECT_EQ(e.K.row(11).norm() + e.M.row(11).norm(), 0.0);
  // mass of the shapes 1 − 3ξ²/2 + ξ³/2, h(ξ − 3ξ²/2 + ξ³/2), 3ξ²/2 − ξ³/2: integrals of polynomials
  Beam light = b;
  light.mass = BeamMass::consistent;
  light.rotary_inertia = false;
  const ElementMatrices c = matrices(light, rigid_in_shear);
  const double m = steel.rho * rigid_in_shear.A * h / 840;
  const double mass[3][3] = {{408, 72 * h, 117}, {72 * h, 16 * h * h, 33 * h}, {117, 33 * h, 198}};
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) EXPECT_NEAR(c.M(dof[i], dof[j]), m * mass[i][j], 1e-13 * 408 * m);
}

TEST(BeamReleases, BarHingedAtBothEndsIsATruss) {
  const Beam b = beam_along_x(ry | rz, ry | rz | rx);
  const ElementMatrices e = matrices(b, odd);
  Eigen::MatrixXd K = Eigen::MatrixXd::Zero(12, 12);
  const double k = steel.E * odd.A / h;
  K(0, 0) = K(6, 6) = k;
  K(0, 6) = K(6, 0) = -k;
  EXPECT_LT((e.K - K).cwiseAbs().maxCoeff(), 1e-15 * k);
  for (int i = 1; i < 12; ++i)
    if (i != 6) {
      EXPECT_EQ(e.K.row(i).norm(), 0.0) << i;  // exactly: rows without stiffness are to be seen as such
    }
  // transverse motion is a straight line: ρAh/6 [2 1; 1 2], and ρI/h [1 −1; −1 1] of the section's turning
  const double m = steel.rho * odd.A * h, r = steel.rho * odd.Iz / h;
  EXPECT_NEAR(e.M(1, 1), m / 3 + r, 1e-12 * m);
  EXPECT_NEAR(e.M(1, 7), m / 6 - r, 1e-12 * m);
  // and under the axial force N a string, N/h [1 −1; −1 1]
  Eigen::VectorXd u = Eigen::VectorXd::Zero(12);
  u[6] = 1e-3;
  ElementMatrices::Matrix K_sigma;
  beam_geometric_stiffness(b, odd, steel, along_x, u, K_sigma);
  const double N_h = k * 1e-3 / h;
  for (const int d : {1, 2}) {
    EXPECT_NEAR(K_sigma(d, d), N_h, 1e-12 * N_h);
    EXPECT_NEAR(K_sigma(d, d + 6), -N_h, 1e-12 * N_h);
  }
  EXPECT_EQ(K_sigma.row(5).norm() + K_sigma.row(11).norm(), 0.0);
}

TEST(BeamReleases, AReleasedAxialForceStressesNothing) {
  Eigen::VectorXd u = Eigen::VectorXd::Zero(12);
  u[6] = 1e-3;
  ElementMatrices::Matrix K_sigma;
  beam_geometric_stiffness(beam_along_x(ux, 0), odd, steel, along_x, u, K_sigma);
  EXPECT_EQ(K_sigma.norm(), 0.0);
}

TEST(BeamReleases, StiffnessIsTheSchurComplement) {
  // another route: the released block inverted at once
  const Eigen::MatrixXd K = matrices(beam_along_x(0, 0), odd).K;
  const std::array<std::array<Directions, 2>, 4> sets{{{rz, 0}, {ry | rz, rz}, {uy, rx | rz}, {ry | rz | rx, ry | rz}}};
  for (const auto& set : sets) {
    std::vector<int> kept, gone;
    for (int i = 0; i < 12; ++i)
      ((set[static_cast<std::size_t>(i / 6)] >> (i % 6) & 1) == 0 ? kept : gone).push_back(i);
    const Eigen::MatrixXd schur = K(kept, kept) - K(kept, gone) * K(gone, gone).inverse() * K(gone, kept);
    const Eigen::MatrixXd condensed = matrices(beam_along_x(set[0], set[1]), odd).K;
    EXPECT_LT((condensed(kept, kept) - schur).norm(), 1e-13 * K.norm());
    EXPECT_EQ(condensed(gone, gone).norm() + condensed(kept, gone).norm(), 0.0);
  }
}

TEST(BeamReleases, KeepRigidMotionsAndMasses) {
  const std::vector<Vec3> nodes{Vec3(1.0, 2.0, -0.5), Vec3(1.9, 2.7, 0.4)};
  Beam b = beam_along_x(0, 0);
  b.orientation = Vec3(0.2, -0.3, 1.0);
  b.offsets = {Vec3(0.1, -0.05, 0.2), Vec3(-0.3, 0.15, 0.07)};
  const Eigen::MatrixXd R = rigid_motions(nodes);
  const ElementMatrices joined = matrices(b, odd, nodes);
  b.releases = {static_cast<Directions>(ry | rz), static_cast<Directions>(rx | rz | ux)};
  const ElementMatrices e = matrices(b, odd, nodes);
  EXPECT_LT((e.K * R).cwiseAbs().maxCoeff(), 1e-12 * joined.K.cwiseAbs().maxCoeff());
  EXPECT_EQ(zero_modes(e.K, 1.0, 1e-12), 6 + 5);
  const Eigen::MatrixXd rigid = R.transpose() * joined.M * R;
  EXPECT_LT((R.transpose() * e.M * R - rigid).norm(), 1e-13 * rigid.norm());
}

TEST(BeamReleases, RefuseAMechanismByName) {
  using ::testing::AllOf;
  using ::testing::HasSubstr;
  const auto named = [](const char* what) {
    return AllOf(HasSubstr("beam element 42"), HasSubstr("mechanism"), HasSubstr(what));
  };
  EXPECT_THAT(refusal(ux, ux), named("ux released at end 2"));
  EXPECT_THAT(refusal(uy, uy), named("uy released at end 2"));
  EXPECT_THAT(refusal(rx, rx), named("rx released at end 2"));
  EXPECT_THAT(refusal(uy | rz, rz), named("rz released at end 2"));
  EXPECT_THAT(refusal(rz, uy | rz), named("rz released at end 2"));
  EXPECT_EQ(refusal(rz | rx, rz), "nothing was refused");
  BeamSection no_torsion = odd;  // a direction that carries nothing has nothing to release
  no_torsion.J = 0.0;
  EXPECT_NO_THROW(matrices(beam_along_x(rx, rx), no_torsion));
}

TEST(BeamReleases, HingeAmidAClampedBeam) {
  // Clamped at both ends, hinged in the middle, half length 1, EI = m = 1: the halves are cantilevers
  // (cos β cosh β = −1) or propped ones (tan β = tanh β). The consistent mass errs upwards, by (βh)⁴/2880 of β; the
  // released element, which turns freely under its own inertia load (mean deflection h⁴/320 for h⁴/720), adds
  // (βh)⁴ h/640 or less. Higher orders are within a fifth of that at βh ≤ 0.5.
  const std::array<double, 5> exact{1.875104068711961, 3.926602312047919, 4.694091132974175, 7.068582745628732,
                                    7.854757438237613};
  const Material unit{"unit", 1.0, 1.0, 0.0, 1.0};
  const BeamSection slender{.name = "s", .A = 1.0, .Iy = 1.0, .Iz = 1.0, .J = 1.0};
  constexpr int n = 16;
  SmallAssembly a;
  for (int i = 0; i <= 2 * n; ++i) a.nodes.emplace_back(i / double(n), 0.0, 0.0);
  for (int i = 0; i < 2 * n; ++i) {
    Beam b = beam_along_x(0, i == n - 1 ? rz : Directions{0});
    b.nodes = {i, i + 1};
    b.mass = BeamMass::consistent;
    b.rotary_inertia = false;
    ElementMatrices e;
    beam_matrices(b, slender, unit, a.nodes, e);
    a.add(b.nodes, e);
  }
  const System s =
      restrict_to(a, [](const Vec3& x, int d) { return (d == 1 || d == 5) && x.x() > 1e-9 && x.x() < 2.0 - 1e-9; });
  const Eigen::GeneralizedSelfAdjointEigenSolver<Eigen::MatrixXd> modes(Eigen::MatrixXd(s.K), Eigen::MatrixXd(s.M),
                                                                        Eigen::EigenvaluesOnly);
  for (int j = 0; j < 5; ++j) {
    const double beta = exact[static_cast<std::size_t>(j)], bh4 = std::pow(beta / n, 4);
    const double error = std::pow(modes.eigenvalues()[j], 0.25) / beta - 1.0;
    EXPECT_GT(error, -1e-9) << j;
    EXPECT_LT(error, 1.2 * bh4 * (1.0 / 2880 + 1.0 / (640 * n)) + 1e-9) << j;
  }
}
