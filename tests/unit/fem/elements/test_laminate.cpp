#include "fem/elements/laminate.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "fem/error.hpp"
#include "tests/unit/fem/elements/small_assembly.hpp"

using namespace tenon;
using namespace tenon::fem;
using namespace tenon::fem::testing;

namespace {

constexpr double pi = std::numbers::pi;

/// Graphite-epoxy after Reddy: E1/E2 = 25, G12 = G13 = E2/2, G23 = E2/5, ν12 = 1/4.
Ply graphite(double thickness, double angle) {
  return {.thickness = thickness,
          .angle = angle,
          .E1 = 25e9,
          .E2 = 1e9,
          .nu12 = 0.25,
          .G12 = 0.5e9,
          .G13 = 0.5e9,
          .G23 = 0.2e9,
          .rho = 1600.0};
}

Ply isotropic(double thickness, double E, double nu, double rho) {
  const double G = E / (2 * (1 + nu));
  return {.thickness = thickness, .E1 = E, .E2 = E, .nu12 = nu, .G12 = G, .G13 = G, .G23 = G, .rho = rho};
}

const Material none{"none", 0.0, 0.0, 0.0, 0.0};  // a laminate takes nothing from it
const ShellSection unsymmetric{.name = "unsymmetric",
                               .plies = {graphite(0.01, 0.0), graphite(0.02, 0.5), graphite(0.005, 1.3)}};

/// The distorted patch of MacNeal and Harder, lying askew in space.
const Mat3 axes = Eigen::AngleAxisd(0.7, Vec3(1.0, -2.0, 0.5).normalized()).toRotationMatrix();
const std::vector<Vec3> flat{{0, 0, 0},       {0.24, 0, 0},    {0.24, 0.12, 0}, {0, 0.12, 0},
                             {0.04, 0.02, 0}, {0.18, 0.03, 0}, {0.16, 0.08, 0}, {0.08, 0.08, 0}};
constexpr double area = 0.24 * 0.12;

SmallAssembly patch(bool triangular, const ShellSection& s, double offset, const Vec3& direction) {
  SmallAssembly a;
  for (const Vec3& x : flat) a.nodes.push_back(axes * x);
  const int cells[5][4] = {{0, 1, 5, 4}, {1, 2, 6, 5}, {2, 3, 7, 6}, {3, 0, 4, 7}, {4, 5, 6, 7}};
  const Vec3 axis = axes * direction;
  ElementMatrices e;
  for (const auto& n : cells)
    if (triangular) {
      for (const auto& t : {std::array<int, 3>{n[0], n[1], n[2]}, std::array<int, 3>{n[0], n[2], n[3]}}) {
        tria3_matrices({.nodes = t, .offset = offset, .material_axis = axis}, s, none, a.nodes, e);
        a.add(t, e);
      }
    } else {
      const std::array<int, 4> q{n[0], n[1], n[2], n[3]};
      quad4_matrices({.nodes = q, .offset = offset, .material_axis = axis}, s, none, a.nodes, e);
      a.add(q, e);
    }
  return a;
}

/// Constant strain ε and curvature κ of the nodes' plane: w = −½(κ_x x² + κ_y y² + κ_xy xy), β = −∇w.
Vec6 constant_state(const Vec3& p, const Vec3& strain, const Vec3& kappa) {
  const double x = p.x(), y = p.y(), beta_x = kappa[0] * x + 0.5 * kappa[2] * y,
               beta_y = kappa[1] * y + 0.5 * kappa[2] * x;
  Vec6 u;
  u << strain[0] * x + 0.5 * strain[2] * y, strain[1] * y + 0.5 * strain[2] * x, -0.5 * (beta_x * x + beta_y * y),
      -beta_y, beta_x, 0.0;
  return u;
}

/// Inner nodes' largest error against the exact state, each part in its own size, and the energy.
std::pair<double, double> solve(const SmallAssembly& a, const Vec3& strain, const Vec3& kappa) {
  Eigen::VectorXd exact(48);
  for (int i = 0; i < 8; ++i)
    exact.segment<6>(6 * i) = rotation6(axes) * constant_state(flat[static_cast<std::size_t>(i)], strain, kappa);
  Sparse sparse(48, 48);
  sparse.setFromTriplets(a.K.begin(), a.K.end());
  const Eigen::MatrixXd K(sparse);
  Eigen::VectorXd u = exact;
  u.tail<24>() = K.bottomRightCorner<24, 24>().llt().solve(-K.bottomLeftCorner<24, 24>() * exact.head<24>());
  return {(u - exact).cwiseAbs().maxCoeff() / exact.cwiseAbs().maxCoeff(), 0.5 * u.dot(K * u)};
}

}  // namespace

// Jones, Mechanics of Composite Materials (2.97): 1/E_x = c⁴/E1 + (1/G12 − 2ν12/E1) s²c² + s⁴/E2.
TEST(Laminate, OffAxisModulus) {
  for (const double angle : {0.0, 0.3, -0.8, pi / 2}) {
    const LaminateStiffness l = laminate({.name = "ply", .plies = {graphite(0.01, angle)}});
    const double c2 = std::pow(std::cos(angle), 2), s2 = 1.0 - c2;
    const double compliance = c2 * c2 / 25e9 + (1 / 0.5e9 - 0.5 / 25e9) * s2 * c2 + s2 * s2 / 1e9;
    EXPECT_NEAR(l.A.inverse()(0, 0) * 0.01 / compliance, 1.0, 1e-13) << angle;
  }
}

// Closed forms of a cross-ply pair of ply thickness h: A11 = h(Q11 + Q22), B11 = h²(Q22 − Q11)/2 with 0° at the bottom.
TEST(Laminate, CrossPlyPair) {
  const double h = 0.003, whole = 1.0 - 0.25 * 0.25 / 25.0, Q11 = 25e9 / whole, Q22 = 1e9 / whole;
  const LaminateStiffness l = laminate({.name = "pair", .plies = {graphite(h, 0.0), graphite(h, pi / 2)}});
  EXPECT_NEAR(l.A(0, 0) / (h * (Q11 + Q22)), 1.0, 1e-13);
  EXPECT_NEAR(l.B(0, 0) / (h * h * (Q22 - Q11) / 2), 1.0, 1e-13);
  EXPECT_NEAR(l.B(1, 1) / (h * h * (Q11 - Q22) / 2), 1.0, 1e-13);
  EXPECT_NEAR(l.D(0, 0) / (h * h * h * (Q11 + Q22) / 3), 1.0, 1e-13);
  EXPECT_NEAR(l.shear(0, 0) / l.shear(1, 1), 1.0, 1e-12);  // a mirror image
}

// κ = 5/6 of a homogeneous section however it is cut; a sandwich of thin stiff faces has G_c d²/c (Allen, Analysis and
// Design of Structural Sandwich Panels (1969), 2.2), left out: the core's bending and the faces' shear, t_f/c = 1e-3.
TEST(Laminate, ShearStiffness) {
  const Ply third = isotropic(0.01, 7e10, 0.3, 2700);
  const LaminateStiffness l = laminate({.name = "one", .plies = {third, third, third}});
  EXPECT_NEAR(l.shear(0, 0) / (5.0 / 6.0 * third.G13 * 0.03), 1.0, 1e-12);
  EXPECT_NEAR(l.shear(0, 1), 0.0, 1e-12 * l.shear(0, 0));

  const double c = 0.05, t_f = 5e-5, d = c + t_f;
  const Ply face = isotropic(t_f, 7e10, 0.3, 2700), core = isotropic(c, 1e5, 0.3, 50);
  const LaminateStiffness s = laminate({.name = "sandwich", .plies = {face, core, face}});
  EXPECT_NEAR(s.shear(0, 0) / (core.G13 * d * d / c), 1.0, 1e-3);
}

// Constant membrane and bending states, coupled by B and by the offset e: displacements and energy exact,
// ½ (ε'Aε + 2 ε'Bκ + κ'Dκ) A with the middle surface's ε + eκ.
TEST(Laminate, PatchTests) {
  const LaminateStiffness l = laminate(unsymmetric);
  const Vec3 direction(1.0, 0.4, 0.0);
  const Mat3 T = strain_rotation(std::atan2(0.4, 1.0));
  for (const bool triangular : {false, true})
    for (const double e : {0.0, 0.03}) {
      const SmallAssembly a = patch(triangular, unsymmetric, e, direction);
      for (const auto& [strain, kappa] : {std::pair{Vec3(1e-3, 4e-4, 7e-4), Vec3(0, 0, 0)},
                                          {Vec3(0, 0, 0), Vec3(2e-2, 1e-2, -3e-2)},
                                          {Vec3(1e-3, 4e-4, 7e-4), Vec3(2e-2, 1e-2, -3e-2)}}) {
        const auto [error, energy] = solve(a, strain, kappa);
        const Vec3 eps = T * (strain + e * kappa), k = T * kappa;
        const double exact = 0.5 * area * (eps.dot(l.A * eps) + 2 * eps.dot(l.B * k) + k.dot(l.D * k));
        EXPECT_LT(error, 1e-10) << "triangles " << triangular << " offset " << e;
        EXPECT_NEAR(energy / exact, 1.0, 1e-10) << "triangles " << triangular << " offset " << e;
      }
    }
}

TEST(Laminate, SixZeroModesAndRigidMassWithOffset) {
  const std::vector<Vec3> warped{{0, 0, 0.15}, {1.2, 0.1, -0.1}, {0.9, 1.1, 0.2}, {-0.2, 0.6, -0.15}};
  ShellSection heavy_top = unsymmetric;
  heavy_top.plies.back().rho *= 5.0;
  ElementMatrices e;
  quad4_matrices({.nodes = {0, 1, 2, 3}, .offset = 0.2}, heavy_top, none, warped, e);
  EXPECT_LT((e.K * rigid_motions(warped)).cwiseAbs().maxCoeff(), 1e-11 * e.K.cwiseAbs().maxCoeff());
  EXPECT_EQ(zero_modes(e.K, 1.0, 1e-11), 6);

  // a triangle in the x-y plane, as three points at the mid-sides at the mass's own height
  const std::vector<Vec3> triangle{{0, 0, 0}, {1, 0, 0}, {0.2, 0.9, 0}};
  tria3_matrices({.nodes = {0, 1, 2}, .offset = 0.2}, heavy_top, none, triangle, e);
  const LaminateStiffness l = laminate(heavy_top);
  const double A = 0.45, z = 0.2 + l.first_moment / l.mass;
  Vec3 centre = Vec3::Zero();
  Mat3 second = Mat3::Zero();
  for (std::size_t i = 0; i < 3; ++i) {
    const Vec3 x = 0.5 * (triangle[i] + triangle[(i + 1) % 3]) + Vec3(0, 0, z);
    centre += x / 3.0;
    second += l.mass * A / 3.0 * x * x.transpose();
  }
  second -= l.mass * A * centre * centre.transpose();
  const double rotary = (l.second_moment - l.first_moment * l.first_moment / l.mass) * A;
  const Mat3 J = second.trace() * Mat3::Identity() - second + Vec3(rotary, rotary, 0.0).asDiagonal().toDenseMatrix();
  const Mat6 exact = rigid_mass(l.mass * A, centre, J);
  const Eigen::MatrixXd R = rigid_motions(triangle);
  EXPECT_LT((R.transpose() * e.M * R - exact).norm(), 1e-13 * exact.norm());
}

// Of one isotropic ply, and of three that make up the same: the element of the plain section. (Quads of plain sections
// have a term that laminates go without.)
TEST(Laminate, OfOneMaterialIsThePlainShell) {
  const Material aluminium{"aluminium", 7e10, 7e10 / 2.6, 0.3, 2700.0};
  const std::vector<Vec3> nodes{{0, 0, 0}, {1, 0, 0}, {0.2, 0.9, 0}};
  ElementMatrices plain, layered;
  tria3_matrices({.nodes = {0, 1, 2}}, {.name = "plain", .thickness = 0.06, .nsm = 3.0}, aluminium, nodes, plain);
  for (const int n : {1, 3}) {
    const ShellSection s{.name = "layers",
                         .nsm = 3.0,
                         .plies = std::vector<Ply>(std::size_t(n), isotropic(0.06 / n, 7e10, 0.3, 2700.0))};
    tria3_matrices({.nodes = {0, 1, 2}}, s, none, nodes, layered);
    EXPECT_LT((plain.K - layered.K).norm(), 1e-12 * plain.K.norm()) << n;
    EXPECT_LT((plain.M - layered.M).norm(), 1e-12 * plain.M.norm()) << n;
  }
}

TEST(Laminate, RefusesWhatIsNone) {
  using ::testing::HasSubstr;
  const auto refusal = [](const ShellSection& s, const Vec3& direction = Vec3::Zero()) -> std::string {
    const std::vector<Vec3> square{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}};
    ElementMatrices e;
    try {
      quad4_matrices({.nodes = {0, 1, 2, 3}, .id = 7, .material_axis = direction}, s, none, square, e);
    } catch (const ModelError& error) {
      return error.what();
    }
    return "nothing was refused";
  };
  const auto with = [](auto change) {
    ShellSection s = unsymmetric;
    change(s.plies[1]);
    return s;
  };
  EXPECT_EQ(refusal(unsymmetric), "nothing was refused");
  EXPECT_THAT(refusal(with([](Ply& p) { p.thickness = 0.0; })), HasSubstr("'unsymmetric', ply 2: its thickness is 0"));
  EXPECT_THAT(refusal(with([](Ply& p) { p.E2 = -1.0; })), HasSubstr("E2 -1"));
  EXPECT_THAT(refusal(with([](Ply& p) { p.nu12 = 5.1; })), HasSubstr("|ν12| < √(E1/E2) = 5"));
  EXPECT_THAT(refusal(with([](Ply& p) { p.G23 = 0.0; })), HasSubstr("G23 0"));
  EXPECT_THAT(refusal(with([](Ply& p) { p.rho = -1.0; })), HasSubstr("density"));
  EXPECT_THAT(refusal(with([](Ply& p) { p.angle = NAN; })), HasSubstr("not finite"));
  EXPECT_THAT(refusal(unsymmetric, Vec3::UnitZ()), HasSubstr("normal to it"));
}
