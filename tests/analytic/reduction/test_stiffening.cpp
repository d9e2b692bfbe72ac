#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>
#include <iostream>
#include <numbers>

#include "reduction/geometric_stiffness.hpp"
#include "reduction/reduce.hpp"
#include "reduction/shape_integrals.hpp"
#include "tests/reference/rotating_beam.hpp"
#include "tests/unit/reduction/beams.hpp"

using namespace tenon;
using namespace tenon::reduction;
using namespace tenon::tests;

namespace {

// A beam from the origin along a direction, held at its root, with its shape integrals and geometric stiffness.
struct Held {
  BeamData data;
  ReducedBody body;
};

Held held(int elements, int modes, const Mat3& turned = Mat3::Identity()) {
  Held h;
  h.data.elements = elements;
  h.data.mass = fem::BeamMass::nastran;  // no torsional inertia: it would soften flap by Ip/AL², 1e-4 of this section
  fem::Model model = beam(h.data, {{"root", 0}, {"tip", elements}});
  for (Vec3& node : model.nodes) node = turned * node;
  for (fem::Element& element : model.elements)
    std::get<fem::Beam>(element).orientation = turned * std::get<fem::Beam>(element).orientation;
  const fem::Structure structure = fem::assemble(model);
  h.body = reduce(structure, "root", {.basis = Basis::clamped_free, .modes = modes, .nonlinear = true});
  h.body.stiffening = std::make_shared<const GeometricStiffness>(geometric_stiffness(model, structure, h.body));
  check(h.body);
  return h;
}

Eigen::MatrixXd stiffening(const ReducedBody& body, const Vec3& a, const Vec3& alpha, const Vec3& omega,
                           const double* wrenches = nullptr) {
  Eigen::MatrixXd K_G(body.n(), body.n());
  geometric_stiffness(*body.stiffening, a, alpha, omega, wrenches, K_G);
  return K_G;
}

// Ω² of K + Ω²-terms at a spin about z; without Coriolis terms flap (z) and chord (y) are apart
struct Frequencies {
  std::vector<double> flap, chord;
};
Frequencies spinning(const ReducedBody& body, double Omega, bool stiffened = true) {
  const Vec3 omega(0.0, 0.0, Omega);
  Eigen::MatrixXd K = body.omega.cwiseAbs2().asDiagonal();
  if (stiffened) K += stiffening(body, Vec3::Zero(), Vec3::Zero(), omega);
  for (Eigen::Index i = 0; i < body.n(); ++i)  // −½ ωᵀ J2_ik ω of b_f
    K.row(i) -= 0.5 * Omega * Omega * body.shape_integrals->J2.row(6 * i + 2);
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> e(K);
  Frequencies f;
  for (Eigen::Index k = 0; k < body.n(); ++k) {
    const fem::Vec6 tip = body.ports[1].Phi * e.eigenvectors().col(k);
    if (std::abs(tip.z()) > 10.0 * std::max(std::abs(tip.y()), std::abs(tip.x()))) f.flap.push_back(e.eigenvalues()[k]);
    if (std::abs(tip.y()) > 10.0 * std::max(std::abs(tip.z()), std::abs(tip.x())))
      f.chord.push_back(e.eigenvalues()[k]);
  }
  return f;
}

}  // namespace

TEST(Stiffening, OfARotatingCantilever) {
  // 36 clamped modes hold 18 of flap and 14 of chord, whose Ritz errors at λ = 12 are 2.4e-6 and 7.6e-6 in the third;
  // 200 elements err by (kh)²/12 in the chord's centrifugal term
  const Held h = held(200, 36);
  for (const auto& [lambda, flap] : reference::rotating_beams) {
    const double flap_unit = h.data.bending(h.data.section.Iy), chord_unit = h.data.bending(h.data.section.Iz);
    const Frequencies at_flap = spinning(h.body, lambda * flap_unit), at_chord = spinning(h.body, lambda * chord_unit);
    for (std::size_t mode = 0; mode < 3 && flap[mode] > 0.0; ++mode) {
      EXPECT_NEAR(std::sqrt(at_flap.flap[mode]) / flap_unit / flap[mode], 1.0, 5e-5) << lambda << " mode " << mode;
      const double chord = std::sqrt(flap[mode] * flap[mode] - lambda * lambda);
      EXPECT_NEAR(std::sqrt(at_chord.chord[mode]) / chord_unit / chord, 1.0, 5e-5) << lambda << " mode " << mode;
    }
  }
}

TEST(Stiffening, ACantileverWithoutItFliesApart) {
  const Held h = held(50, 20);
  const double unit = h.data.bending(h.data.section.Iz);
  EXPECT_LT(spinning(h.body, 4.0 * unit, false).chord[0], 0.0);  // 3.516² − 4² < 0
  EXPECT_GT(spinning(h.body, 4.0 * unit).chord[0], 0.0);
}

TEST(Stiffening, AColumnBucklesUnderItsWeightAndUnderAForce) {
  // upward acceleration a of the base weighs like gravity: ρA a L³/EI = Greenhill's number; force −π²EI/4L² at the tip.
  // 12 of the 24 modes are of flap: Ritz error 6e-7 of the weight's number, 3.9e-5 of the force's (exact clamped-free
  // shapes); tension that is constant in each of 50 elements takes 1.643e-4 off the weight's number (the same shapes)
  const Held h = held(50, 24);
  const double L = h.data.length, EI = h.data.material.E * h.data.section.Iy,
               rho_A = h.data.material.rho * h.data.section.A;
  const Eigen::MatrixXd K = h.body.omega.cwiseAbs2().asDiagonal();
  const auto critical = [&](const Eigen::MatrixXd& K_G) {
    const Eigen::GeneralizedSelfAdjointEigenSolver<Eigen::MatrixXd> e(-K_G, K, Eigen::EigenvaluesOnly);
    return 1.0 / e.eigenvalues().maxCoeff();
  };
  const double a = critical(stiffening(h.body, Vec3::UnitX(), Vec3::Zero(), Vec3::Zero()));
  EXPECT_NEAR(rho_A * a * L * L * L / EI / reference::greenhill, 1.0 - 1.643e-4, 1e-6);
  std::array<double, 12> wrenches{};
  wrenches[6] = -1.0;
  const double P = critical(stiffening(h.body, Vec3::Zero(), Vec3::Zero(), Vec3::Zero(), wrenches.data()));
  EXPECT_NEAR(P * 4.0 * L * L / (std::numbers::pi * std::numbers::pi * EI), 1.0, 1e-4);
}

TEST(Stiffening, IsTheSameInAnyFrame) {
  // all products of ω and all directions of a: a beam turned in space, its loads turned with it. Signs of modes follow
  // the axes: S from the motion of the tip, K_1 = S K_2 S
  const Mat3 turned = Eigen::AngleAxisd(1.1, Vec3(0.3, -0.8, 0.5).normalized()).matrix();
  const Held one = held(20, 8), two = held(20, 8, turned);
  const Vec3 a(3.0, -2.0, 1.0), omega(2.0, -5.0, 4.0);
  const Vec3 force(70.0, -20.0, 30.0), moment(1.0, 2.0, 3.0);
  Eigen::VectorXd tip = Eigen::VectorXd::Zero(12), turned_tip = tip;
  tip.tail(6) << force, moment;
  turned_tip.tail(6) << turned * force, turned * moment;
  const Eigen::MatrixXd K_1 = stiffening(one.body, a, Vec3::Zero(), omega, tip.data()),
                        K_2 = stiffening(two.body, turned * a, Vec3::Zero(), turned * omega, turned_tip.data());
  const fem::Mat6X tip_1 = fem::rotation6(turned) * one.body.ports[1].Phi, &tip_2 = two.body.ports[1].Phi;
  const Eigen::VectorXd sign = (tip_1.array() * tip_2.array()).colwise().sum().sign().transpose();
  ASSERT_GT(K_1.norm(), 0.0);
  const double error = (K_1 - sign.asDiagonal() * K_2 * sign.asDiagonal()).norm() / K_1.norm();
  std::cout << "K_G in another frame: " << error << "\n";
  EXPECT_LT(error, 1e-9);  // ε times the squared ratio of the highest frequency kept to the lowest, 1e4, and a margin
}

TEST(Stiffening, SurvivesAChangeOfParentPort) {
  // an L hung by its root and then by its tip, against the same L reduced by its tip: all modes kept, so both span the
  // same motions; the same frequencies under the same loads
  BeamData data;
  data.elements = 6;
  fem::Model model = beam(data, {{"root", 0}, {"tip", 6}});
  for (std::size_t k = 4; k <= 6; ++k)
    model.nodes[k] = model.nodes[3] + Vec3(0.1, 0.9, 0.2) * static_cast<double>(k - 3) / 3.0;
  for (fem::Element& element : model.elements) std::get<fem::Beam>(element).orientation = Vec3::UnitZ();
  const fem::Structure structure = fem::assemble(model);
  ReducedBody by_root = reduce(structure, "root", {.all_modes = true}),
              by_tip = reduce(structure, "tip", {.all_modes = true});
  for (ReducedBody* body : {&by_root, &by_tip})
    body->stiffening = std::make_shared<const GeometricStiffness>(geometric_stiffness(model, structure, *body));
  const ReducedBody moved = rebase(by_root, 1);
  check(moved);
  const Vec3 a(3.0, -2.0, 1.0), alpha(0.5, 4.0, -3.0), omega(2.0, -5.0, 4.0);
  for (Eigen::Index load = 0; load < 24; ++load)  // R_zᵀ K_σ R_z of each
    EXPECT_NEAR(moved.stiffening->K.col(load).tail<1>()[0], by_tip.stiffening->K.col(load).tail<1>()[0],
                1e-7 * by_tip.stiffening->K.cwiseAbs().maxCoeff());
  EXPECT_LT((moved.stiffening->spin - by_tip.stiffening->spin).norm(), 1e-10 * by_tip.stiffening->spin.norm());
  std::array<double, 12> wrenches{200.0, 300.0, -100.0, 20.0, 10.0, 30.0, 7.0, 7.0, 7.0, 7.0, 7.0, 7.0};
  const auto lowest = [&](const ReducedBody& body) {
    const Eigen::MatrixXd K_G = stiffening(body, 1e3 * a, 1e3 * alpha, 1e2 * omega, wrenches.data());
    const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> e(Eigen::MatrixXd(body.omega.cwiseAbs2().asDiagonal()) + K_G);
    return Eigen::VectorXd(e.eigenvalues().head(8));
  };
  const Eigen::VectorXd one = lowest(moved), two = lowest(by_tip), unloaded = by_tip.omega.head(8).cwiseAbs2();
  EXPECT_GT(((two - unloaded).array() / unloaded.array()).abs().maxCoeff(), 0.05);  // the loads matter
  EXPECT_LT(((one - two).array() / two.array()).abs().maxCoeff(), 1e-7);
}

TEST(Stiffening, OfAngularAcceleration) {
  // a column that stands off the reference on a stiff massless arm of length r feels r α along its axis
  BeamData data;
  data.elements = 20;
  fem::Model model = beam(data, {{"root", 0}, {"tip", 20}});
  const double r = 0.5;
  const auto root = static_cast<int>(model.nodes.size());
  model.nodes.emplace_back(0.0, r, 0.0);
  model.node_ids.push_back(99);
  model.materials.push_back({.name = "stiff", .E = 2e16, .G = 8e15, .nu = 0.25, .rho = 0.0});
  fem::Beam arm = std::get<fem::Beam>(model.elements[0]);
  arm.nodes = {root, 0};
  arm.material = 1;
  arm.orientation = fem::Vec3::UnitX();
  model.elements.emplace_back(arm);
  model.ports[0].node = root;
  const fem::Structure structure = fem::assemble(model);
  ReducedBody body = reduce(structure, "root", {.basis = Basis::clamped_free, .modes = 8});
  body.stiffening = std::make_shared<const GeometricStiffness>(geometric_stiffness(model, structure, body));
  // reference at (0, r, 0), column along x at y = 0: α_z × (−r y) = r α along x
  const Eigen::MatrixXd by_alpha = stiffening(body, Vec3::Zero(), Vec3(0.0, 0.0, 2.0), Vec3::Zero()),
                        by_a = stiffening(body, Vec3(2.0 * r, 0.0, 0.0), Vec3::Zero(), Vec3::Zero());
  ASSERT_GT(by_a.norm(), 0.0);
  EXPECT_LT((by_alpha - by_a).norm(), 1e-4 * by_a.norm());  // 1e-5 of the column's compliance is the arm's
}
