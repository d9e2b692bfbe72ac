#include <gtest/gtest.h>

#include <iostream>

#include "dense_operators.hpp"
#include "random_multibody.hpp"

// Random chains and trees on hinges of every kind: the recursions of the spatial-operator paper against dense operators
// and against differences in time. What is compared is algebra, so tolerances are round-off times the condition.
namespace tenon::assembly {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;
using testing::DenseOperators;
using testing::RandomMultibody;

constexpr int systems = 200;
constexpr int most_bodies = 12;

double difference(const MatrixXd& a, const MatrixXd& b) { return (a - b).norm() / std::max(1e-300, b.norm()); }

double condition(const MatrixXd& mass) {
  const VectorXd w = Eigen::SelfAdjointEigenSolver<MatrixXd>(mass, Eigen::EigenvaluesOnly).eigenvalues();
  return w.tail(1)[0] / w[0];
}

TEST(Recursion, ArticulatedAndCompositeEqualTheDenseOperators) {
  double worst_mass = 0.0, worst_solve = 0.0, worst_forward = 0.0, worst_condition = 0.0;
  int nv = 0;
  for (unsigned seed = 1; seed <= systems; ++seed) {
    RandomMultibody random(seed);
    const Multibody mb =
        random.system(most_bodies, random.random.chance(0.5) ? Deformation::full : Deformation::dropped);
    if (mb.nv == 0) continue;
    const MotionState state = random.state(mb);
    Sweeps sweeps = make_sweeps(mb);
    set_state(mb, state.q, state.v, sweeps);
    const MatrixXd mass = testing::dense_operators(mb, sweeps).mass();
    const double cond = condition(mass);

    MatrixXd composite;
    composite_mass_matrix(mb, sweeps, composite);
    worst_mass = std::max(worst_mass, difference(composite, mass));

    articulate(mb, sweeps);
    const VectorXd f = random.vector(mb.nv, 1.0);
    VectorXd x(mb.nv);
    solve(mb, sweeps, f, x);
    worst_solve = std::max(worst_solve, difference(mass * x, f) / cond);

    VectorXd acceleration(mb.nv), back(mb.nv), bias(mb.nv);
    forward_dynamics(mb, sweeps, f, acceleration);
    VectorXd at_once(mb.nv);
    articulated_forward_dynamics(mb, sweeps, f, at_once);
    EXPECT_LT(difference(at_once, acceleration), 1e-14) << "seed " << seed;  // the same operations in one sweep
    inverse_dynamics(mb, sweeps, acceleration, back);
    inverse_dynamics(mb, sweeps, VectorXd::Zero(mb.nv), bias);
    const double size = f.norm() + bias.norm();
    worst_forward = std::max(worst_forward, (back - f).norm() / size / cond);
    EXPECT_LT(difference(acceleration, mass.ldlt().solve(f - bias)), 1e-14 * cond) << "seed " << seed;
    worst_condition = std::max(worst_condition, cond);
    nv = std::max(nv, mb.nv);
  }
  std::cout << systems << " systems, up to " << nv << " speeds, condition up to " << worst_condition
            << ": composite mass " << worst_mass << ", M (M⁻¹ f) " << worst_solve
            << " of the condition, inverse of forward dynamics " << worst_forward << " of the condition\n";
  EXPECT_LT(worst_mass, 1e-13);
  EXPECT_LT(worst_solve, 1e-15);
  EXPECT_LT(worst_forward, 1e-15);
}

// Eqs (51)–(56) with dense blocks: R, P, D, G, K, Ψ, and what the lemmas say of them.
// A body whose deformation is dropped, of nodes with rotary inertia: b_m is that of the node sums at rest, eq (37).
TEST(Recursion, DroppedDeformationKeepsTheGyroscopicForcesOfRest) {
  for (unsigned seed = 1; seed <= 10; ++seed) {
    const tests::LumpedBody lumped = tests::random_lumped(seed, 7, 4, true, true);
    HingedBody b;
    b.name = "lumped";
    b.body = std::make_shared<const ReducedBody>(lumped.body);
    b.deformation = Deformation::dropped;
    b.kind = HingeKind::spherical;
    b.outer_port = 0;
    Multibody mb;
    mb.bodies = {b};
    index(mb);
    const MotionState state = RandomMultibody(seed).state(mb);
    Sweeps sweeps = make_sweeps(mb);
    set_state(mb, state.q, state.v, sweeps);
    const VectorXd still = VectorXd::Zero(4);
    const tests::NodeSums at_rest = tests::node_sums(lumped, still, still, sweeps.bodies[0].V.tail<3>());
    EXPECT_LT(difference(sweeps.bodies[0].b, at_rest.b), 1e-13) << seed;
  }
}

TEST(Recursion, LemmasOfThePaperHold) {
  double worst51 = 0.0, worst61 = 0.0, worst62 = 0.0, worst63 = 0.0, worst_split = 0.0;
  for (unsigned seed = 1; seed <= systems; ++seed) {
    RandomMultibody random(seed);
    Multibody mb = random.system(most_bodies, Deformation::dropped);
    for (HingedBody& b : mb.bodies) b.inertia.setZero();  // the paper's hinges have none
    if (mb.nv == 0) continue;
    const MotionState state = random.state(mb);
    Sweeps sweeps = make_sweeps(mb);
    set_state(mb, state.q, state.v, sweeps);
    articulate(mb, sweeps);
    const DenseOperators d = testing::dense_operators(mb, sweeps);
    const Index rows = d.M_m.rows();
    MatrixXd R = d.M_m, P = d.M_m, D = MatrixXd::Zero(mb.nv, mb.nv), G = MatrixXd::Zero(rows, mb.nv);
    for (int k = static_cast<int>(mb.bodies.size()) - 1; k >= 0; --k) {
      const auto b = static_cast<std::size_t>(k);
      const Index at = d.row[b], size = mb.bodies[b].modes() + 6, first = mb.v_offset[b];
      const Index dofs = mb.bodies[b].modes() + mb.bodies[b].dofs();
      const MatrixXd H = d.H.block(first, at, dofs, size), Pk = P.block(at, at, size, size);
      const MatrixXd Dk = H * Pk * H.transpose();
      D.block(first, first, dofs, dofs) = Dk;
      const MatrixXd Gk = dofs > 0 ? MatrixXd(Pk * H.transpose() * Dk.inverse()) : MatrixXd(size, 0);
      G.block(at, first, size, dofs) = Gk;
      const MatrixXd P_plus = Pk - Gk * H * Pk;
      worst_split = std::max(worst_split, difference(sweeps.bodies[b].P_plus, P_plus.bottomRightCorner(6, 6)) /
                                              std::max(1.0, Pk.norm() / P_plus.norm()));
      if (mb.bodies[b].parent < 0) continue;
      const auto p = static_cast<std::size_t>(mb.bodies[b].parent);
      const Index to = d.row[p], parent_size = mb.bodies[p].modes() + 6;
      const MatrixXd phi = d.E_phi.block(to, at, parent_size, size);
      R.block(to, to, parent_size, parent_size) += phi * R.block(at, at, size, size) * phi.transpose();
      P.block(to, to, parent_size, parent_size) += phi * P_plus * phi.transpose();
    }
    const MatrixXd one = MatrixXd::Identity(rows, rows), one_v = MatrixXd::Identity(mb.nv, mb.nv);
    // on a tree the decomposition (48) holds on the blocks of bodies along one branch; 𝓗 Φ M_m Φ* 𝓗* is compared on
    // a chain and by its diagonal blocks elsewhere
    const MatrixXd Phi_tilde = d.Phi - one, M = d.mass();
    const bool chain = std::all_of(mb.bodies.begin(), mb.bodies.end(), [&](const HingedBody& b) {
      return b.parent == static_cast<int>(&b - mb.bodies.data()) - 1;
    });
    if (chain)
      worst51 = std::max(worst51,
                         difference(R + Phi_tilde * R + R * Phi_tilde.transpose(), d.Phi * d.M_m * d.Phi.transpose()));
    const double cond = condition(M);
    const MatrixXd K = d.E_phi * G, E_psi = d.E_phi * (one - G * d.H);
    const MatrixXd Psi = (one - E_psi).inverse();
    const MatrixXd factor = one_v + d.H * d.Phi * K, inverse = one_v - d.H * Psi * K;
    worst61 = std::max(worst61, difference(factor * D * factor.transpose(), M));
    worst62 = std::max(worst62, (factor * inverse - one_v).norm() / (factor.norm() * inverse.norm()));
    worst63 = std::max(worst63, difference(inverse.transpose() * D.inverse() * inverse, M.inverse()) / cond);
  }
  std::cout << "lemma 5.1 " << worst51 << ", 6.1 " << worst61 << ", 6.2 " << worst62 << ", 6.3 " << worst63
            << " of the condition, split form " << worst_split << "\n";
  EXPECT_LT(worst51, 1e-13);
  EXPECT_LT(worst61, 1e-12);
  EXPECT_LT(worst62, 1e-13);
  EXPECT_LT(worst63, 1e-14);
  EXPECT_LT(worst_split, 1e-11);
}

// V and a_m are the rates of the poses: differences of second order with step h err by h² of the third derivative.
TEST(Recursion, TwistsAndAccelerationsAreRatesOfThePoses) {
  const double h = 1e-4;
  double worst_twist = 0.0, worst_rate = 0.0;
  for (unsigned seed = 1; seed <= 60; ++seed) {
    RandomMultibody random(seed);
    Multibody mb = random.system(6, Deformation::full);
    mb.gravity.setZero();
    const MotionState state = random.state(mb, 0.1);
    Sweeps here = make_sweeps(mb), before = make_sweeps(mb), after = make_sweeps(mb);
    VectorXd q_before = state.q, q_after = state.q, T(mb.nv);
    move(mb, -h * state.v, q_before);
    move(mb, h * state.v, q_after);
    set_state(mb, state.q, state.v, here);
    set_state(mb, q_before, state.v, before);
    set_state(mb, q_after, state.v, after);
    inverse_dynamics(mb, here, VectorXd::Zero(mb.nv), T);
    for (std::size_t k = 0; k < mb.bodies.size(); ++k) {
      const BodySweep &a = before.bodies[k], &b = after.bodies[k], &s = here.bodies[k];
      const Mat3 turn = s.world.R.transpose() * (b.world.R - a.world.R) / (2.0 * h);
      Vec6 twist, rate;
      twist << s.world.R.transpose() * (b.world.r - a.world.r) / (2.0 * h), turn(2, 1), turn(0, 2), turn(1, 0);
      rate << s.world.R.transpose() * (b.world.R * b.V.head<3>() - a.world.R * a.V.head<3>()) / (2.0 * h),
          s.world.R.transpose() * (b.world.R * b.V.tail<3>() - a.world.R * a.V.tail<3>()) / (2.0 * h);
      const double speed = 1.0 + s.V.norm();
      worst_twist = std::max(worst_twist, (twist - s.V).norm() / std::pow(speed, 3));
      worst_rate = std::max(worst_rate, (rate - s.alpha).norm() / std::pow(speed, 4));
    }
  }
  std::cout << "twists " << worst_twist << ", accelerations " << worst_rate << " beside h² = " << h * h << "\n";
  EXPECT_LT(worst_twist, 2.0 * h * h);
  EXPECT_LT(worst_rate, 2.0 * h * h);
}

// With the integrals of the shapes the equations are those of one kinetic energy: without dampers energy stays, and
// momentum without ground. Central differences along the motion err by h² of the third derivative (up to 35 of the
// power).
TEST(Recursion, MotionKeepsEnergyAndMomentum) {
  const double h = 1e-5;
  double worst_energy = 0.0, worst_momentum = 0.0;
  int floating = 0;
  for (unsigned seed = 1; seed <= 100; ++seed) {
    RandomMultibody random(seed);
    Multibody mb = random.system(5, Deformation::full, true);
    for (HingedBody& b : mb.bodies) b.damping.setZero();
    const bool afloat = seed % 2 == 0;
    if (afloat) mb = RandomMultibody::afloat(mb);
    const MotionState state = random.state(mb, 0.1);
    Sweeps sweeps = make_sweeps(mb);
    VectorXd T(mb.nv), v_dot(mb.nv);
    set_state(mb, state.q, state.v, sweeps);
    passive_forces(mb, state.q, state.v, T);
    articulate(mb, sweeps);
    forward_dynamics(mb, sweeps, T, v_dot);
    double E[2];
    Vec6 p[2];
    for (int side = 0; side < 2; ++side) {
      const double t = side == 0 ? -h : h;
      VectorXd q = state.q;
      move(mb, t * state.v, q);
      const VectorXd v = state.v + t * v_dot;
      set_state(mb, q, v, sweeps);
      E[side] = energy(mb, sweeps, q, v).total();
      p[side] = momentum(mb, sweeps, v);
    }
    // size of what must cancel: powers of the inertia and of the elastic forces
    const double power = 1.0 + state.v.cwiseAbs().dot(T.cwiseAbs()) + std::abs(E[0]) * (1.0 + v_dot.norm());
    worst_energy = std::max(worst_energy, std::abs(E[1] - E[0]) / (2.0 * h) / power);
    if (!afloat) continue;
    ++floating;
    worst_momentum = std::max(worst_momentum, (p[1] - p[0]).norm() / (2.0 * h) / (p[0].norm() * (1.0 + v_dot.norm())));
  }
  std::cout << "power that is left " << worst_energy << ", force that is left on " << floating << " floating systems "
            << worst_momentum << ", beside h² = " << h * h << "\n";
  EXPECT_LT(worst_energy, 100.0 * h * h);
  EXPECT_LT(worst_momentum, 100.0 * h * h);
}

// At rest what inverse dynamics holds is the gradient of the potential: of deformed bodies that shift their mass, and
// to first order, at η = 0, of bodies whose modes shift neither mass nor ports or ports alone. Central differences err
// by h²/6 of the third derivative, of the size of the potential, and by round-off over h.
TEST(Recursion, GravityIsTheGradientOfItsEnergy) {
  const double h = 1e-5;
  double worst = 0.0;
  for (unsigned seed = 1; seed <= 90; ++seed) {
    RandomMultibody random(seed);
    const bool lumped = seed % 3 == 0;
    const Multibody mb = random.system(6, seed % 3 == 1 ? Deformation::dropped : Deformation::full, lumped);
    const MotionState state = random.state(mb, lumped ? 0.1 : 0.0);
    const VectorXd still = VectorXd::Zero(mb.nv);
    Sweeps sweeps = make_sweeps(mb);
    VectorXd T(mb.nv), gradient(mb.nv);
    const auto potential = [&](const VectorXd& delta) {
      VectorXd q = state.q;
      move(mb, delta, q);
      set_state(mb, q, still, sweeps);
      return energy(mb, sweeps, q, still).gravity;
    };
    for (Index j = 0; j < mb.nv; ++j)
      gradient[j] = (potential(h * VectorXd::Unit(mb.nv, j)) - potential(-h * VectorXd::Unit(mb.nv, j))) / (2.0 * h);
    const double size = 1.0 + std::abs(potential(still));
    inverse_dynamics(mb, sweeps, still, T);
    if (mb.nv > 0) worst = std::max(worst, (gradient - T).lpNorm<Eigen::Infinity>() / (size + T.norm()));
  }
  std::cout << "gravity and the gradient of its energy within " << worst << "\n";
  EXPECT_LT(worst, 1e-9);
}

}  // namespace
}  // namespace tenon::assembly
