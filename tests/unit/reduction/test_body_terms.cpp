#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "fem/error.hpp"
#include "reduction/body_terms.hpp"
#include "reduction/geometric_stiffness.hpp"
#include "reduction/reduce.hpp"
#include "tests/refusal.hpp"
#include "tests/unit/reduction/beams.hpp"
#include "tests/unit/reduction/lumped_body.hpp"

using namespace tenon;
using namespace tenon::reduction;
using namespace tenon::tests;
using testing::HasSubstr;

namespace {

struct State {
  Eigen::VectorXd eta, eta_dot;
  Vec3 v, omega;
};

State random_state(unsigned seed, Eigen::Index n) {
  std::srand(seed);
  return {Eigen::VectorXd::Random(n), Eigen::VectorXd::Random(n), Vec3::Random(), Vec3::Random()};
}

struct Terms {
  Eigen::MatrixXd M;
  Eigen::VectorXd b;
};

Terms terms(const ReducedBody& body, const State& s, Nonlinearity nonlinearity = Nonlinearity::full) {
  const Eigen::Index size = nonlinearity == Nonlinearity::rigid ? 6 : body.n() + 6;
  Terms t{Eigen::MatrixXd::Constant(size, size, 7.0), Eigen::VectorXd::Constant(size, 7.0)};  // all must be written
  body_terms(body, body.shape_integrals.get(), nonlinearity, s.eta.data(), s.eta_dot.data(), s.omega, t.M, t.b);
  return t;
}

double difference(const Terms& a, const NodeSums& b) {
  return std::max((a.M - b.M).cwiseAbs().maxCoeff() / b.M.cwiseAbs().maxCoeff(),
                  (a.b - b.b).cwiseAbs().maxCoeff() / b.b.cwiseAbs().maxCoeff());
}

}  // namespace

TEST(BodyTerms, EqualTheSumsOverTheNodes) {
  for (unsigned seed = 1; seed <= 12; ++seed) {
    const int modes = static_cast<int>(seed) % 6;
    const LumpedBody lumped = random_lumped(seed, 9, modes, false, seed % 2 == 0);
    const State s = random_state(seed, modes);
    EXPECT_LT(difference(terms(lumped.body, s), node_sums(lumped, s.eta, s.eta_dot, s.omega)), 1e-13) << seed;
  }
}

TEST(BodyTerms, EqualTheSumsOverNodesWithRotaryInertia) {
  for (unsigned seed = 1; seed <= 12; ++seed) {
    const int modes = static_cast<int>(seed) % 6;
    const LumpedBody lumped = random_lumped(seed, 9, modes, true, seed % 2 == 0);
    const State s = random_state(seed, modes);
    EXPECT_LT(difference(terms(lumped.body, s), node_sums(lumped, s.eta, s.eta_dot, s.omega)), 1e-13) << seed;
  }
}

TEST(BodyTerms, RuthlessDropsTheDeformationAndRigidTheModes) {
  const LumpedBody lumped = random_lumped(3, 8, 4, true, true);
  State s = random_state(5, 4);
  const Terms ruthless = terms(lumped.body, s, Nonlinearity::ruthless),
              rigid = terms(lumped.body, s, Nonlinearity::rigid);
  const NodeSums at_rest = node_sums(lumped, Eigen::VectorXd::Zero(4), Eigen::VectorXd::Zero(4), s.omega);
  EXPECT_LT(difference(ruthless, at_rest), 1e-13);
  EXPECT_LT((rigid.M - at_rest.M.bottomRightCorner(6, 6)).norm(), 1e-13 * at_rest.M.norm());
  EXPECT_LT((rigid.b - at_rest.b.tail(6)).norm(), 1e-13 * at_rest.b.norm());
}

TEST(BodyTerms, WithoutIntegralsTheMassIsThatAtRest) {
  LumpedBody lumped = random_lumped(4, 8, 3, false, false);
  lumped.body.shape_integrals.reset();
  const State s = random_state(6, 3);
  const NodeSums at_rest = node_sums(lumped, Eigen::VectorXd::Zero(3), Eigen::VectorXd::Zero(3), s.omega);
  for (const Nonlinearity level : {Nonlinearity::full, Nonlinearity::ruthless}) {
    const Terms t = terms(lumped.body, s, level);
    EXPECT_LT((t.M - at_rest.M).norm(), 1e-13 * at_rest.M.norm());
    EXPECT_EQ(t.b.head(3), Eigen::VectorXd::Zero(3));
    EXPECT_LT((t.b.tail(6) - at_rest.b.tail(6)).norm(), 1e-13 * at_rest.b.norm());
  }
}

namespace {

// Kinetic energy in coordinates q = (η, r, φ): reference at r (inertial), attitude R = exp(φ~) R0. Node velocities by
// central differences of positions would lose digits; they follow from q̇ with ω = φ̇ at φ = 0 and, to first order in φ,
// ω = φ̇ + ½ φ × φ̇ (inertial axes).
double kinetic_energy(const LumpedBody& lumped, const Eigen::VectorXd& q, const Eigen::VectorXd& q_dot) {
  const Eigen::Index n = lumped.shapes.cols();
  const Vec3 phi = q.tail<3>(), phi_dot = q_dot.tail<3>();
  const Mat3 R = Eigen::AngleAxisd(phi.norm(), phi.norm() > 0.0 ? Vec3(phi.normalized()) : Vec3::UnitX()).matrix();
  const Vec3 w = R.transpose() * (phi_dot + 0.5 * phi.cross(phi_dot));
  const Vec3 v = R.transpose() * q_dot.segment<3>(n);
  double T = 0.0;
  for (std::size_t j = 0; j < lumped.nodes.size(); ++j) {
    const Vec3 l = lumped.position(j) + lumped.psi(j) * q.head(n);
    T += 0.5 * lumped.nodes[j].mass * (v + w.cross(l) + lumped.psi(j) * q_dot.head(n)).squaredNorm();
  }
  return T;
}

}  // namespace

TEST(BodyTerms, FollowFromLagrangesEquations) {
  // d/dt ∂T/∂q̇ − ∂T/∂q at φ = 0 by fourth-order differences of T with step h: error h⁴ and ε/h² ~ 1e-10
  const LumpedBody lumped = random_lumped(8, 7, 4, false, true);
  const State s = random_state(9, 4);
  const Eigen::VectorXd q_ddot = Eigen::VectorXd::Random(10);
  Eigen::VectorXd q = Eigen::VectorXd::Zero(10), q_dot(10);
  q.head(4) = s.eta;
  q_dot << s.eta_dot, s.v, s.omega;
  const auto along = [](const auto& f, double h) {
    return (8.0 * (f(h) - f(-h)) - (f(2.0 * h) - f(-2.0 * h))) / (12.0 * h);
  };
  // T is quadratic in q̇, so ∂T/∂q̇_i is exact for any step
  const auto momentum = [&](const Eigen::VectorXd& at, const Eigen::VectorXd& rate, Eigen::Index i) {
    const Eigen::VectorXd e = Eigen::VectorXd::Unit(10, i);
    return 0.5 * (kinetic_energy(lumped, at, rate + e) - kinetic_energy(lumped, at, rate - e));
  };
  Eigen::VectorXd force(10);
  for (Eigen::Index i = 0; i < 10; ++i) {
    const Eigen::VectorXd e = Eigen::VectorXd::Unit(10, i);
    const double rate =
        along([&](double t) { return momentum(q + t * q_dot + 0.5 * t * t * q_ddot, q_dot + t * q_ddot, i); }, 2e-3);
    const double gradient = along([&](double t) { return kinetic_energy(lumped, q + t * e, q_dot); }, 2e-3);
    force[i] = rate - gradient;
  }
  const Terms t = terms(lumped.body, s);
  Eigen::VectorXd alpha = q_ddot;  // v̇ is inertial already, ω̇ = φ̈ at φ = 0
  const Eigen::VectorXd expected = t.M * alpha + t.b;
  EXPECT_LT((force - expected).norm(), 1e-8 * expected.norm());
}

TEST(BodyTerms, EnergyChangesByThePowerOfTheForcesAlone) {
  // ½ V_mᵀ(M α_body + ...) : d/dt ½ V_mᵀ M_m(η) V_m = V_mᵀ (M_m α_m + b_m) for any η̈ and any acceleration, with FE mass
  const ReducedBody body = reduce(fem::assemble(beam({.mass = fem::BeamMass::high_order}, {{"root", 0}, {"tip", 24}})),
                                  "root", {.modes = 3, .nonlinear = true});
  const Eigen::Index n = body.n();
  State s = random_state(11, n);
  s.eta *= 0.1;
  const Eigen::VectorXd rate = Eigen::VectorXd::Random(n + 6);  // body derivatives of (η̇, v, ω)
  const auto energy = [&](double t) {
    State at = s;
    at.eta += t * s.eta_dot + 0.5 * t * t * rate.head(n);
    Eigen::VectorXd V(n + 6);
    V << s.eta_dot, s.v, s.omega;
    V += t * rate;
    return 0.5 * V.dot(terms(body, at).M * V);
  };
  const double h = 1e-3, change = (8.0 * (energy(h) - energy(-h)) - (energy(2 * h) - energy(-2 * h))) / (12.0 * h);
  const Terms t = terms(body, s);
  Eigen::VectorXd alpha = rate, V(n + 6);
  alpha.segment<3>(n) += s.omega.cross(s.v);  // inertial derivative of v
  V << s.eta_dot, s.v, s.omega;
  const double power = V.dot(t.M * alpha + t.b);
  EXPECT_NEAR(change, power, 1e-9 * std::abs(V.dot(t.M * V)));
}

namespace {

// Largest errors of J1, J2 and C1 of a cantilever along x without rotary inertia, first three bending modes a plane.
// Orthonormality alone says what they are: W_ik = ∫ρA ψ_i ψ_kᵀ is δ_ik e eᵀ in the plane e of a mode and ± e_y e_zᵀ for
// modes of one number in both planes, which have one shape; J2_ik = 2 tr(W) 1 − W − Wᵀ and c_ki = ± e_x follow, and
// ∫ρA x ψ_i is C0_i turned.
Vec3 errors_of_bending(int elements) {
  BeamData data{.elements = elements, .mass = fem::BeamMass::nastran};
  const ReducedBody body = reduce(fem::assemble(beam(data, {{"root", 0}, {"tip", elements}})), "root",
                                  {.basis = Basis::clamped_free, .modes = 6, .nonlinear = true});
  const ShapeIntegrals& s = *body.shape_integrals;
  Eigen::MatrixXd J1 = Eigen::MatrixXd::Zero(6, 6), J2 = Eigen::MatrixXd::Zero(36, 6),
                  C1 = Eigen::MatrixXd::Zero(18, 6);
  for (Eigen::Index i = 0; i < 6; ++i) {
    const bool z = i % 2 == 0;  // Iy < Iz: the softer plane first
    J1(3, i) = -body.L(i, 5);
    J1(4, i) = body.L(i, 4);
    J2.block<6, 1>(6 * i, i) << 2.0, z ? 2.0 : 0.0, z ? 0.0 : 2.0, 0.0, 0.0, 0.0;
    const Eigen::Index k = z ? i + 1 : i - 1;  // the other plane's mode of the same number
    const Vec3 tip_i = body.ports[1].Phi.col(i).head<3>(), tip_k = body.ports[1].Phi.col(k).head<3>();
    C1(3 * i, k) = tip_k.cross(tip_i).x() > 0.0 ? 1.0 : -1.0;
    J2(6 * i + 5, k) = tip_i.sum() * tip_k.sum() > 0.0 ? -1.0 : 1.0;
  }
  return {(s.J1 - J1).cwiseAbs().maxCoeff() / J1.cwiseAbs().maxCoeff(), (s.J2 - J2).cwiseAbs().maxCoeff() / 2.0,
          (s.C1 - C1).cwiseAbs().maxCoeff()};
}

}  // namespace

TEST(ShapeIntegrals, OfABeamFollowFromOrthonormality) {
  // An element's axial motion is linear where its bending is cubic: 1 − (kh)²/12 of the mass of a sine moves along,
  // k = 7.8548/L for the third mode. It shows in J2 alone and falls by four when h is halved.
  const Vec3 coarse = errors_of_bending(50), fine = errors_of_bending(100);
  const double kh = 7.8548 / 100.0;
  EXPECT_LT(fine[1], kh * kh / 12.0);
  EXPECT_NEAR(coarse[1] / fine[1], 4.0, 0.1);
  EXPECT_LT(fine[0], 1e-11);  // bending against bending, the same cubics: nothing but rounding
  EXPECT_LT(fine[2], 1e-9);
}

TEST(Rebase, TransformsTheIntegralsExactly) {
  // shapes relative to port Q written out node by node, against the algebra on the integrals alone
  for (const bool inertia : {false, true}) {
    LumpedBody lumped = random_lumped(21, 9, 5, inertia, inertia);
    Mat6X Phi = lumped.shapes.middleRows<6>(12);
    const Vec3 Q = lumped.nodes[2].position;
    lumped.body.ports.push_back({.name = "tip", .position = Q, .axes = Mat3::Identity(), .Phi = Phi});
    const ReducedBody moved = rebase(lumped.body, 1);
    // V from the new shapes at the old root: Φ' = −τ Φ_Q V
    LumpedBody relative = lumped;
    relative.reference = Q;
    for (std::size_t j = 0; j < lumped.nodes.size(); ++j)
      relative.shapes.middleRows<6>(6 * static_cast<Eigen::Index>(j)) -= fem::tau(lumped.nodes[j].position - Q) * Phi;
    const Eigen::MatrixXd V =
        (lumped.body.omega.cwiseAbs2().asDiagonal() *  // modes of eq (1) hung by Q are K-orthogonal
         Eigen::MatrixXd::Identity(5, 5));
    Eigen::MatrixXd Mzz = Eigen::MatrixXd::Zero(5, 5);
    for (std::size_t j = 0; j < lumped.nodes.size(); ++j) {
      const Eigen::MatrixXd T = relative.motion(j, Eigen::VectorXd::Zero(5)).leftCols(5);
      Mzz += T.transpose() * relative.spatial_inertia(j) * T;
    }
    const Eigen::MatrixXd modes = Eigen::GeneralizedSelfAdjointEigenSolver<Eigen::MatrixXd>(V, Mzz).eigenvectors();
    relative.shapes = (relative.shapes * modes).eval();
    fill(relative);
    // signs of the modes are free: compare through squares and through both signs at once
    Eigen::VectorXd sign(5);
    for (Eigen::Index k = 0; k < 5; ++k) sign[k] = relative.body.L.row(k).dot(moved.L.row(k)) < 0.0 ? -1.0 : 1.0;
    relative.shapes = (relative.shapes * sign.asDiagonal()).eval();
    fill(relative);
    const State s = random_state(22, 5);
    const NodeSums expected = node_sums(relative, s.eta, s.eta_dot, s.omega);
    EXPECT_LT(difference(terms(moved, s), expected), 1e-11);  // rebase's own eigenvectors carry 1e-13
  }
}

TEST(Check, RefusesIntegralsOfAnotherBody) {
  LumpedBody one = random_lumped(1, 6, 3, false, false);
  const LumpedBody other = random_lumped(2, 6, 4, false, false);
  EXPECT_NO_THROW(check(one.body));
  one.body.shape_integrals = other.body.shape_integrals;
  EXPECT_THAT(refusal([&] { check(one.body); }), HasSubstr("do not fit its 3 modes"));
}

TEST(GeometricStiffness, RefusesWhatDoesNotBelongTogether) {
  const fem::Model model = beam({.elements = 6}, {{"root", 0}, {"tip", 6}}),
                   other = beam({.elements = 4}, {{"root", 0}});
  const fem::Structure structure = fem::assemble(model);
  ReducedBody body = reduce(structure, "root", {.modes = 2});
  EXPECT_THAT(refusal([&] { geometric_stiffness(other, structure, body); }), HasSubstr("the model that the structure"));
  EXPECT_THAT(refusal([&] { geometric_stiffness(model, fem::assemble(other), body); }), HasSubstr("node shapes"));
  body.stiffening = std::make_shared<const GeometricStiffness>(geometric_stiffness(model, structure, body));
  EXPECT_NO_THROW(check(body));
  body.ports.push_back(body.ports[1]);
  EXPECT_THAT(refusal([&] { check(body); }), HasSubstr("geometric stiffness of body"));
}
