#include "fem/elements/rod.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>
#include <numbers>

#include "fem/error.hpp"
#include "fem/structure.hpp"
#include "tests/unit/fem/elements/small_assembly.hpp"

using namespace tenon;
using namespace tenon::fem;
using namespace tenon::fem::testing;
using ::testing::HasSubstr;

namespace {

constexpr double pi = std::numbers::pi;
const Material steel{"steel", 2.1e11, 8.0e10, 0.3, 7800.0};
const BeamSection bar{.name = "bar", .A = 3e-4, .Iy = 2e-8, .Iz = 3e-8, .J = 4e-8, .nsm = 0.5};
const std::vector<Vec3> askew{Vec3(1.0, 2.0, -0.5), Vec3(1.9, 2.7, 0.4)};
const double length = (askew[1] - askew[0]).norm();
const double mass = (7800.0 * 3e-4 + 0.5) * length;

ElementMatrices matrices(BeamMass kind) {
  ElementMatrices e;
  rod_matrices({.nodes = {0, 1}, .mass = kind, .id = 5}, bar, steel, askew, e);
  return e;
}

/// A rod of n elements on x over unit length, its nodes free where `free` says so; eigenvalues of K − λ M.
Eigen::VectorXd line_of_rods(int n, BeamMass kind, const Material& m, const BeamSection& s,
                             const std::function<bool(const Vec3&, int)>& free, int count) {
  SmallAssembly a;
  for (int i = 0; i <= n; ++i) a.nodes.emplace_back(double(i) / n, 0.0, 0.0);
  for (int i = 0; i < n; ++i) {
    ElementMatrices e;
    const std::array<int, 2> nodes{i, i + 1};
    rod_matrices({.nodes = nodes, .mass = kind}, s, m, a.nodes, e);
    a.add(nodes, e);
  }
  return lowest(restrict_to(a, free), count);
}

std::string refusal(const BeamSection& s, const Material& m, const std::vector<Vec3>& nodes) {
  ElementMatrices e;
  try {
    rod_matrices({.nodes = {0, 1}, .id = 5}, s, m, nodes, e);
  } catch (const ModelError& error) {
    return error.what();
  }
  return "nothing was refused";
}

}  // namespace

TEST(Rod, BearsElongationAndTwistAlone) {
  const ElementMatrices e = matrices(BeamMass::consistent);
  const Eigen::MatrixXd R = rigid_motions(askew);
  EXPECT_LT((e.K * R).cwiseAbs().maxCoeff(), 1e-14 * e.K.cwiseAbs().maxCoeff() * askew[1].norm());
  EXPECT_EQ(zero_modes(e.K, 1e-2, 1e-12), 10);
  const Vec3 x = (askew[1] - askew[0]) / length;
  Eigen::VectorXd u = Eigen::VectorXd::Zero(12);
  u.segment<3>(6) = 1e-3 * x;
  u.segment<3>(9) = 2e-3 * x;
  Eigen::VectorXd force = Eigen::VectorXd::Zero(12);  // EA/L · 1e-3 and GJ/L · 2e-3
  force.segment<3>(6) = 2.1e11 * 3e-4 / length * 1e-3 * x;
  force.segment<3>(9) = 8e10 * 4e-8 / length * 2e-3 * x;
  force.head<6>() = -force.tail<6>();
  EXPECT_LT((e.K * u - force).cwiseAbs().maxCoeff(), 1e-14 * force.cwiseAbs().maxCoeff());
}

TEST(Rod, RigidMassOfALineOrOfTwoHalves) {
  const Vec3 middle = 0.5 * (askew[0] + askew[1]), x = (askew[1] - askew[0]) / length;
  const double polar = 7800.0 * 5e-8 * length;
  for (const BeamMass kind : {BeamMass::consistent, BeamMass::high_order, BeamMass::nastran}) {
    const ElementMatrices e = matrices(kind);
    Eigen::MatrixXd R = rigid_motions(std::vector<Vec3>{askew[0] - middle, askew[1] - middle});
    const double transverse = kind == BeamMass::nastran ? mass * length * length / 4.0 : mass * length * length / 12.0;
    Mat6 D = Mat6::Zero();
    D.topLeftCorner<3, 3>() = mass * Mat3::Identity();
    D.bottomRightCorner<3, 3>() = transverse * (Mat3::Identity() - x * x.transpose()) +
                                  (kind == BeamMass::nastran ? 0.0 : polar) * x * x.transpose();
    EXPECT_LT((R.transpose() * e.M * R - D).cwiseAbs().maxCoeff(), 1e-14 * mass) << static_cast<int>(kind);
  }
}

// ω = (2j−1) π/2L √(E/ρ). Linear shapes: ω_h/ω − 1 = (kh)²/24; lumped and consistent averaged, as of COUPMASS:
// λ_h h²/c² = 12 (1 − cos kh)/(5 + cos kh) → ω_h/ω − 1 = −(kh)⁴/480. The next orders are (kh)² of these.
TEST(Rod, AxialModesOfAClampedRod) {
  const auto axial = [](const Vec3& x, int d) { return d == 0 && x.x() > 0.0; };
  const BeamSection plain{.name = "plain", .A = 3e-4};
  const double c = std::sqrt(2.1e11 / 7800.0);
  for (const int n : {8, 16}) {
    const Eigen::VectorXd consistent = line_of_rods(n, BeamMass::consistent, steel, plain, axial, 2);
    const Eigen::VectorXd high = line_of_rods(n, BeamMass::high_order, steel, plain, axial, 2);
    const Eigen::VectorXd nastran = line_of_rods(n, BeamMass::nastran, steel, plain, axial, 2);
    for (int j = 0; j < 2; ++j) {
      const double k = (2 * j + 1) * pi / 2.0, kh = k / n;
      EXPECT_NEAR(std::sqrt(consistent[j]) / (k * c) - 1.0, kh * kh / 24.0, 0.1 * kh * kh * kh * kh);
      EXPECT_NEAR(std::sqrt(high[j]) / (k * c) - 1.0, -std::pow(kh, 4) / 480.0, 0.1 * std::pow(kh, 6));
      EXPECT_NEAR(nastran[j], high[j], 1e-10 * high[j]);
    }
  }
}

TEST(Rod, TorsionalModesOfAClampedRod) {
  const auto twist = [](const Vec3& x, int d) { return d == 3 && x.x() > 0.0; };
  const double c = std::sqrt(8e10 * 4e-8 / (7800.0 * 5e-8)), kh = pi / 2.0 / 8;
  const Eigen::VectorXd lambda = line_of_rods(8, BeamMass::high_order, steel, bar, twist, 1);
  EXPECT_NEAR(std::sqrt(lambda[0]) / (pi / 2.0 * c) - 1.0, -std::pow(kh, 4) / 480.0, 0.1 * std::pow(kh, 6));
}

// A stretched string: ω = jπ/L √(N/μ), linear shapes: (kh)²/24 above.
TEST(Rod, AStretchedStringVibrates) {
  constexpr int n = 16;
  constexpr double strain = 1e-3;
  SmallAssembly a;
  const BeamSection wire{.name = "wire", .A = 1e-6};
  for (int i = 0; i <= n; ++i) a.nodes.emplace_back(double(i) / n, 0.0, 0.0);
  for (int i = 0; i < n; ++i) {
    const Rod rod{.nodes = {i, i + 1}, .mass = BeamMass::consistent};
    Eigen::VectorXd u = Eigen::VectorXd::Zero(12);
    u[0] = strain * i / n;
    u[6] = strain * (i + 1) / n;
    ElementMatrices e;
    ElementMatrices::Matrix K_sigma;
    rod_matrices(rod, wire, steel, a.nodes, e);
    rod_geometric_stiffness(rod, wire, steel, a.nodes, u, K_sigma);
    e.K += K_sigma;
    a.add(rod.nodes, e);
  }
  const auto across = [](const Vec3& x, int d) { return d == 1 && x.x() > 0.0 && x.x() < 1.0; };
  const Eigen::VectorXd lambda = lowest(restrict_to(a, across), 3);
  for (int j = 0; j < 3; ++j) {
    const double k = (j + 1) * pi, kh = k / n, omega = k * std::sqrt(2.1e11 * strain / 7800.0);
    EXPECT_NEAR(std::sqrt(lambda[j]) / omega - 1.0, kh * kh / 24.0, 0.1 * std::pow(kh, 4));
  }
}

TEST(Rod, ATurnedStressedRodTurnsItsForce) {
  const Vec3 x = (askew[1] - askew[0]) / length, theta(0.3, -0.2, 0.7);
  Eigen::VectorXd u = Eigen::VectorXd::Zero(12), turn(12);
  u.segment<3>(6) = 1e-4 * x;
  const double N = 2.1e11 * 3e-4 * 1e-4 / length;
  ElementMatrices::Matrix K;
  rod_geometric_stiffness({.nodes = {0, 1}}, bar, steel, askew, u, K);
  for (int i = 0; i < 2; ++i) turn.segment<6>(6 * i) << theta.cross(askew[static_cast<std::size_t>(i)]), theta;
  const Eigen::VectorXd force = K * turn;
  EXPECT_LT((force.segment<3>(6) - N * theta.cross(x)).norm(), 1e-12 * N);
  EXPECT_LT((force.segment<3>(0) + N * theta.cross(x)).norm(), 1e-12 * N);
}

// A mass on three bars at angle α to the vertical, evenly around it: k_z = 3 EA/L cos²α, k_x = k_y = 3/2 EA/L sin²α.
// The bars' torsion leaves no rotation of the apex loose; two bars leave one, across both.
TEST(Rod, ATripodThroughTheAssembler) {
  Model model;
  model.source = "tripod";
  model.materials = {{.name = "massless", .E = 7e10, .G = 2.6e10, .nu = 0.33, .rho = 0.0}};
  model.beam_sections = {{.name = "bar", .A = 1e-4, .J = 1e-9}};
  const double alpha = 0.4, h = 2.0, L = h / std::cos(alpha), EA_L = 7e10 * 1e-4 / L;
  model.nodes.emplace_back(0.0, 0.0, h);
  for (int i = 0; i < 3; ++i) {
    const double phi = 0.1 + 2.0 * pi * i / 3.0;
    model.nodes.emplace_back(h * std::tan(alpha) * std::cos(phi), h * std::tan(alpha) * std::sin(phi), 0.0);
    model.elements.emplace_back(Rod{.nodes = {0, i + 1}, .id = i});
    for (int d = 0; d < 6; ++d) model.supports.push_back({{i + 1, d}});
  }
  for (int i = 0; i < 4; ++i) model.node_ids.push_back(i + 1);
  model.elements.emplace_back(PointMass{.node = 0, .mass = 12.0, .id = 9});
  const Structure s = assemble(model);
  ASSERT_EQ(s.n(), 6);
  const Eigen::MatrixXd K = Eigen::MatrixXd(s.K).selfadjointView<Eigen::Lower>();
  const double kx = 1.5 * EA_L * std::pow(std::sin(alpha), 2), kz = 3.0 * EA_L * std::pow(std::cos(alpha), 2);
  EXPECT_LT((K.topLeftCorner<3, 3>() - Mat3(Vec3(kx, kx, kz).asDiagonal())).norm(), 1e-14 * kz);
  EXPECT_GT(Eigen::SelfAdjointEigenSolver<Mat3>(K.bottomRightCorner<3, 3>()).eigenvalues()[0], 1.0);

  model.elements.erase(model.elements.begin());
  const Structure two = assemble(model);
  EXPECT_EQ(two.n(), 5);
  const Eigen::MatrixXd turn =
      Eigen::MatrixXd(Eigen::MatrixXd(two.K).selfadjointView<Eigen::Lower>()).bottomRightCorner<2, 2>();
  EXPECT_GT(turn.determinant(), 0.1 * turn.trace() * turn.trace() / 4.0);
}

TEST(Rod, FaultsAreNamed) {
  const std::vector<Vec3> point{askew[0], askew[0]};
  EXPECT_THAT(refusal(bar, steel, point), HasSubstr("rod element 5: both ends lie at (1, 2, -0.5)"));
  EXPECT_THAT(refusal({.name = "none"}, steel, askew), HasSubstr("neither area nor torsion constant"));
  EXPECT_THAT(refusal({.name = "s", .A = -1.0}, steel, askew), HasSubstr("its area is -1"));
  EXPECT_THAT(refusal({.name = "s", .A = 1.0, .nsm = -2.0}, steel, askew), HasSubstr("non-structural mass is -2"));
  EXPECT_THAT(refusal(bar, {.name = "m", .E = 0.0, .G = 1.0}, askew), HasSubstr("Young's modulus of material 'm'"));
  EXPECT_THAT(refusal(bar, {.name = "m", .E = 1.0}, askew), HasSubstr("shear modulus of material 'm' is 0"));
  EXPECT_THAT(refusal(bar, {.name = "m", .E = 1.0, .G = 1.0, .rho = -1.0}, askew), HasSubstr("density"));
}
