// Linear motion about accelerated motions, where the accelerations themselves stiffen, against the differentials of
// Newton's and Euler's equations and of the load that accelerates.
#include <gtest/gtest.h>

#include "assembly/recursion/linearise.hpp"
#include "reduction/geometric_stiffness.hpp"
#include "reduction/reduce.hpp"
#include "tests/unit/reduction/beams.hpp"

namespace tenon::assembly {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;
using fem::skew;

// A free body with its mass off the reference, R = 1: m (a + R(ω̇ × c + ω × (ω × c))) = F in world axes,
// J ω̇ + ω × Jω + m c × Rᵀa = T in the body's; δω = ξ̇ + ω × ξ, δω̇ its rate, δR = ξ×, δa = ẍ. Differences of fourth
// order with step 1e-3 err by 1e-12 of the terms.
TEST(Linearise, AFreeBodyThatIsAcceleratedFollowsNewtonAndEuler) {
  const double m = 3.0;
  const Vec3 c(0.3, -0.2, 0.5), w(0.7, -0.4, 1.1), a(0.8, 2.0, -1.3), w_dot(-0.9, 1.7, 0.6);
  const Mat3 J_c = (Mat3() << 2.0, 0.1, -0.2, 0.1, 1.5, 0.3, -0.2, 0.3, 1.1).finished();
  const Mat3 J = J_c - m * skew(c) * skew(c);  // about the reference
  Multibody system;
  HingedBody body;
  body.name = "body";
  body.body = std::make_shared<const ReducedBody>(
      reduction::rigid_body("body", m, c, J_c, {{"origin", Vec3::Zero(), Mat3::Identity(), {}}}));
  body.outer_port = 0;
  body.kind = HingeKind::free;
  system.bodies = {body};
  index(system);
  MotionState state = rest_state(system);
  state.v << 0.5, -0.3, 0.2, w;
  VectorXd v_dot(6);
  v_dot << a, w_dot;
  const LinearMotion linear = linearise(system, state, v_dot);

  // by δω̇, δω and ξ
  const Mat3 F_rate = -m * skew(c), F_turn = -m * (skew(w.cross(c)) + skew(w) * skew(c)),
             F_xi = -m * skew(w_dot.cross(c) + w.cross(w.cross(c)));
  const Mat3 T_turn = skew(w) * J - skew(J * w), T_xi = m * skew(c) * skew(a);
  const Mat3 W = skew(w), W_dot = skew(w_dot);
  MatrixXd M = MatrixXd::Zero(6, 6), C = M, K = M;
  M << m * Mat3::Identity(), F_rate, m * skew(c), J;
  C.topRightCorner<3, 3>() = F_rate * W + F_turn;
  C.bottomRightCorner<3, 3>() = J * W + T_turn;
  K.topRightCorner<3, 3>() = F_rate * W_dot + F_turn * W + F_xi;
  K.bottomRightCorner<3, 3>() = J * W_dot + T_turn * W + T_xi;
  EXPECT_LT((linear.M - M).norm(), 1e-12 * M.norm());
  EXPECT_LT((linear.C - C).norm(), 1e-10 * C.norm());
  EXPECT_LT((linear.K - K).norm(), 1e-10 * K.norm());

  state.v.setZero();  // and from rest, where only the accelerations are left
  K.topRightCorner<3, 3>() = F_rate * W_dot - m * skew(w_dot.cross(c));
  K.bottomRightCorner<3, 3>() = J * W_dot + T_xi;
  const LinearMotion from_rest = linearise(system, state, v_dot);
  EXPECT_LT(from_rest.C.norm(), 1e-10 * C.norm());
  EXPECT_LT((from_rest.K - K).norm(), 1e-10 * K.norm());
}

// A beam that slides lengthwise, at rest, pulled by its root: what stiffens is the load of θ̈ alone.
TEST(Linearise, ALengthwiseAccelerationStiffensABeam) {
  tests::BeamData data;
  const fem::Model model = tests::beam(data, {{"root", 0}, {"tip", data.elements}});
  const fem::Structure structure = fem::assemble(model);
  reduction::ReducedBody body = reduction::reduce(structure, "root", {.modes = 8, .nonlinear = true});
  body.name = "beam";
  const auto stiffening =
      std::make_shared<const reduction::GeometricStiffness>(reduction::geometric_stiffness(model, structure, body));
  const Index n = body.n();
  const double rate = -40.0;
  const auto K = [&](bool with) {
    body.stiffening = with ? stiffening : nullptr;
    Multibody system;
    HingedBody beam;
    beam.name = body.name;
    beam.body = std::make_shared<const ReducedBody>(body);
    beam.outer_port = 0;
    beam.kind = HingeKind::prismatic;
    beam.inner_axes = beam.outer_axes = (Mat3() << 0, 0, 1, 1, 0, 0, 0, 1, 0).finished();  // z of the hinge along x
    system.bodies = {beam};
    index(system);
    return linearise(system, rest_state(system), rate * VectorXd::Unit(system.nv, n)).K;
  };
  const MatrixXd difference = (K(true) - K(false)).topLeftCorner(n, n);
  MatrixXd expected(n, n);
  reduction::geometric_stiffness(*stiffening, rate * Vec3::UnitX(), Vec3::Zero(), Vec3::Zero(), nullptr, expected);
  ASSERT_GT(expected.norm(), 1.0);
  EXPECT_LT((difference - expected).norm(), 1e-9 * expected.norm());  // round-off of K over the step 1e-3
}

}  // namespace
}  // namespace tenon::assembly
