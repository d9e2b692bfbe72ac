#include "fem/elements/beam.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <numbers>

#include "fem/elements/point_mass.hpp"
#include "fem/error.hpp"
#include "tests/unit/fem/elements/small_assembly.hpp"

using namespace tenon;
using namespace tenon::fem;
using namespace tenon::fem::testing;

namespace {

const Material steel{"steel", 2.1e11, 8.0e10, 0.3, 7800.0};

BeamSection odd_section() {
  return {.name = "odd",
          .A = 3e-3,
          .Iy = 4e-6,
          .Iz = 9e-6,
          .Iyz = 2e-6,
          .J = 1.5e-6,
          .kappa_y = 0.6,
          .kappa_z = 0.45,
          .nsm = 2.5};
}

Beam odd_beam() {
  Beam b;
  b.nodes = {0, 1};
  b.orientation = Vec3(0.2, -0.3, 1.0);
  b.offsets = {Vec3(0.1, -0.05, 0.2), Vec3(-0.3, 0.15, 0.07)};
  b.id = 42;
  return b;
}

const std::vector<Vec3> two_nodes{Vec3(1.0, 2.0, -0.5), Vec3(1.9, 2.7, 0.4)};

std::string refusal(const Beam& b, const BeamSection& s, const Material& m, std::span<const Vec3> nodes) {
  ElementMatrices e;
  try {
    beam_matrices(b, s, m, nodes, e);
  } catch (const ModelError& error) {
    return error.what();
  }
  return "nothing was refused";
}

}  // namespace

TEST(Beam, RigidMotionsCostNoEnergy) {
  ElementMatrices e;
  beam_matrices(odd_beam(), odd_section(), steel, two_nodes, e);
  const Eigen::MatrixXd R = rigid_motions(two_nodes);
  EXPECT_LT((e.K * R).cwiseAbs().maxCoeff(), 1e-12 * e.K.cwiseAbs().maxCoeff());
  EXPECT_EQ(zero_modes(e.K, 1.0, 1e-12), 6);
  EXPECT_EQ((e.K - e.K.transpose()).norm() + (e.M - e.M.transpose()).norm(), 0.0);  // one triangle is the other's copy
}

TEST(Beam, RigidMassIsThatOfAStraightBar) {
  const BeamSection s = odd_section();
  Beam b = odd_beam();
  const Vec3 p = two_nodes[0] + b.offsets[0], q = two_nodes[1] + b.offsets[1];
  const double h = (q - p).norm(), m = (steel.rho * s.A + s.nsm) * h;
  const Vec3 x = (q - p) / h, z = x.cross(b.orientation).normalized(), y = z.cross(x);
  const Mat3 slender = m * h * h / 12.0 * (Mat3::Identity() - x * x.transpose());
  Mat3 section;  // inertia of the cross-section per length, ∫ρ(r² 1 − r rᵀ) dA with r = (0, y, z)
  section << s.Iy + s.Iz, 0, 0, 0, s.Iy, -s.Iyz, 0, -s.Iyz, s.Iz;
  Mat3 axes;
  axes << x, y, z;
  const Mat3 thick = slender + steel.rho * h * axes * section * axes.transpose();
  const Mat3 torsion_only = slender + steel.rho * h * (s.Iy + s.Iz) * x * x.transpose();
  const Eigen::MatrixXd R = rigid_motions(two_nodes);
  struct Case {
    BeamMass mass;
    bool rotary;
    Mat3 J;
  };
  for (const Case& c : {Case{BeamMass::consistent, true, thick}, Case{BeamMass::high_order, true, thick},
                        Case{BeamMass::consistent, false, torsion_only}, Case{BeamMass::nastran, true, slender}}) {
    b.mass = c.mass;
    b.rotary_inertia = c.rotary;
    ElementMatrices e;
    beam_matrices(b, s, steel, two_nodes, e);
    const Mat6 exact = rigid_mass(m, 0.5 * (p + q), c.J);
    EXPECT_LT((R.transpose() * e.M * R - exact).norm(), 1e-13 * exact.norm());
  }
}

TEST(Beam, ProductOfInertiaIsTurnedPrincipalAxes) {
  // the same section described in its principal axes and in axes turned by an angle
  const double angle = 0.4, I1 = 9e-6, I2 = 2e-6, c = std::cos(angle), s = std::sin(angle);
  BeamSection principal{
      .name = "p", .A = 3e-3, .Iy = I2, .Iz = I1, .Iyz = 0.0, .J = 1e-6, .kappa_y = 0.7, .kappa_z = 0.7};
  BeamSection turned = principal;  // y' = y cos + z sin: ∫y'² = I1 c² + I2 s², ∫y'z' = (I2 − I1) s c
  turned.Iz = I1 * c * c + I2 * s * s;
  turned.Iy = I1 * s * s + I2 * c * c;
  turned.Iyz = (I2 - I1) * s * c;
  const std::vector<Vec3> nodes{Vec3::Zero(), Vec3(0.6, 0.0, 0.0)};
  Beam b;
  b.nodes = {0, 1};
  for (const BeamMass mass : {BeamMass::consistent, BeamMass::high_order, BeamMass::nastran}) {
    b.mass = mass;
    ElementMatrices e1, e2;
    b.orientation = Vec3::UnitY();
    beam_matrices(b, principal, steel, nodes, e1);
    b.orientation = Vec3(0.0, c, s);
    beam_matrices(b, turned, steel, nodes, e2);
    EXPECT_LT((e1.K - e2.K).norm(), 1e-14 * e1.K.norm());
    EXPECT_LT((e1.M - e2.M).norm(), 1e-14 * e1.M.norm());
  }
}

TEST(Beam, EachPlaneIsTheTextbookMatrix) {
  // Przemieniecki 1968, eqs (5.116), (11.31) in the x-y plane with Φ = 12EI/(κGAh²)
  const double h = 0.7, E = steel.E, rho = steel.rho;
  BeamSection s{.name = "s", .A = 2e-3, .Iy = 3e-6, .Iz = 5e-6, .Iyz = 0.0, .J = 1e-6, .kappa_y = 0.8, .kappa_z = 0.0};
  const double P = 12 * E * s.Iz / (s.kappa_y * steel.G * s.A * h * h), P2 = P * P;
  Beam b;
  b.nodes = {0, 1};
  b.orientation = Vec3::UnitY();
  b.mass = BeamMass::consistent;
  const std::vector<Vec3> nodes{Vec3::Zero(), Vec3(h, 0.0, 0.0)};
  ElementMatrices e;
  beam_matrices(b, s, steel, nodes, e);
  const double k = E * s.Iz / (h * h * h * (1 + P));
  EXPECT_NEAR(e.K(1, 1), 12 * k, 1e-13 * 12 * k);
  EXPECT_NEAR(e.K(1, 5), 6 * h * k, 1e-13 * 6 * h * k);
  EXPECT_NEAR(e.K(5, 5), (4 + P) * h * h * k, 1e-13 * 4 * h * h * k);
  EXPECT_NEAR(e.K(5, 11), (2 - P) * h * h * k, 1e-13 * 4 * h * h * k);
  const double m = rho * s.A * h / ((1 + P) * (1 + P)), r2 = s.Iz / (s.A * h * h);
  EXPECT_NEAR(e.M(1, 1) / m, 13.0 / 35 + 7 * P / 10 + P2 / 3 + 6.0 / 5 * r2, 1e-13);
  EXPECT_NEAR(e.M(1, 5) / m, h * (11.0 / 210 + 11 * P / 120 + P2 / 24 + (0.1 - P / 2) * r2), 1e-13);
  EXPECT_NEAR(e.M(1, 7) / m, 9.0 / 70 + 3 * P / 10 + P2 / 6 - 6.0 / 5 * r2, 1e-13);
  EXPECT_NEAR(e.M(1, 11) / m, -h * (13.0 / 420 + 3 * P / 40 + P2 / 24 - (0.1 - P / 2) * r2), 1e-13);
  EXPECT_NEAR(e.M(5, 5) / m, h * h * (1.0 / 105 + P / 60 + P2 / 120 + (2.0 / 15 + P / 6 + P2 / 3) * r2), 1e-13);
  EXPECT_NEAR(e.M(5, 11) / m, -h * h * (1.0 / 140 + P / 60 + P2 / 120 + (1.0 / 30 + P / 6 - P2 / 6) * r2), 1e-13);
  // the x-z plane is rigid in shear: Hermite, with r_y = −w'
  EXPECT_NEAR(e.K(2, 2), 12 * E * s.Iy / (h * h * h), 1e-12 * e.K(2, 2));
  EXPECT_NEAR(e.K(2, 4), -6 * E * s.Iy / (h * h), 1e-13 * e.K(2, 2));
}

TEST(Beam, NastranMassIsCoupmass) {
  // NX Nastran, COUPMASS = 1, as read off its printed matrices: Euler-Bernoulli without rotary and torsional inertia
  const double h = 2.0;
  BeamSection s = odd_section();
  Beam b;
  b.nodes = {0, 1};
  b.orientation = Vec3::UnitY();
  b.mass = BeamMass::nastran;
  const std::vector<Vec3> nodes{Vec3::Zero(), Vec3(h, 0.0, 0.0)};
  ElementMatrices e;
  beam_matrices(b, s, steel, nodes, e);
  const double m = (steel.rho * s.A + s.nsm) * h;
  EXPECT_NEAR(e.M(0, 0), 5 * m / 12, 1e-14 * m);
  EXPECT_NEAR(e.M(0, 6), m / 12, 1e-14 * m);
  EXPECT_NEAR(e.M(1, 1), 156 * m / 420, 1e-14 * m);
  EXPECT_NEAR(e.M(1, 5), 22 * h * m / 420, 1e-14 * m);
  EXPECT_NEAR(e.M(1, 7), 54 * m / 420, 1e-14 * m);
  EXPECT_NEAR(e.M(1, 11), -13 * h * m / 420, 1e-14 * m);
  EXPECT_NEAR(e.M(5, 5), 4 * h * h * m / 420, 1e-14 * m);
  EXPECT_NEAR(e.M(5, 11), -3 * h * h * m / 420, 1e-14 * m);
  EXPECT_NEAR(e.M.row(3).norm() + e.M.row(9).norm(), 0.0, 1e-14 * m);
}

TEST(Beam, RefusesWhatIsNoBeam) {
  using ::testing::AllOf;
  using ::testing::HasSubstr;
  const BeamSection s = odd_section();
  const Beam b = odd_beam();
  Beam zero = b;
  zero.offsets = {Vec3::Zero(), two_nodes[0] - two_nodes[1]};
  EXPECT_THAT(refusal(zero, s, steel, two_nodes), AllOf(HasSubstr("beam element 42"), HasSubstr("length is zero")));
  Beam parallel = b;
  parallel.offsets = {Vec3::Zero(), Vec3::Zero()};
  parallel.orientation = 3.0 * (two_nodes[0] - two_nodes[1]);
  EXPECT_THAT(refusal(parallel, s, steel, two_nodes), HasSubstr("parallel"));
  Material m = steel;
  m.E = 0.0;
  EXPECT_THAT(refusal(b, s, m, two_nodes), AllOf(HasSubstr("beam element 42"), HasSubstr("Young")));
  m = steel;
  m.G = 0.0;
  EXPECT_THAT(refusal(b, s, m, two_nodes), HasSubstr("shear modulus"));
  BeamSection flat = s;
  flat.A = 0.0;
  EXPECT_THAT(refusal(b, flat, steel, two_nodes), HasSubstr("area"));
  BeamSection impossible = s;
  impossible.Iyz = 7e-6;
  EXPECT_THAT(refusal(b, impossible, steel, two_nodes), HasSubstr("second moments"));
  m = steel;
  m.rho = 0.0;
  EXPECT_EQ(refusal(b, s, m, two_nodes), "nothing was refused");
}

TEST(PointMass, IsARigidBodyAtItsOffset) {
  PointMass p;
  p.mass = 3.0;
  p.offset = Vec3(0.1, -0.2, 0.5);
  p.inertia << 0.3, -0.02, 0.01, -0.02, 0.4, 0.05, 0.01, 0.05, 0.5;
  ElementMatrices e;
  point_mass_matrices(p, e);
  EXPECT_EQ(e.K.norm(), 0.0);
  Vec6 twist;
  twist << 0.3, 0.1, -0.2, 0.5, -0.6, 0.7;
  const Vec3 omega = twist.tail<3>(), v = twist.head<3>() + omega.cross(p.offset);
  EXPECT_NEAR(twist.dot(e.M * twist), p.mass * v.squaredNorm() + omega.dot(p.inertia * omega), 1e-14);
  p.mass = -1.0;
  EXPECT_THROW(point_mass_matrices(p, e), ModelError);
  p.mass = 1.0;
  p.inertia(0, 0) = -0.3;
  EXPECT_THROW(point_mass_matrices(p, e), ModelError);
}
