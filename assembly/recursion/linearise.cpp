#include "assembly/recursion/linearise.hpp"

#include <Eigen/QR>
#include <array>

#include "assembly/recursion/closure.hpp"
#include "assembly/recursion/stiffening.hpp"
#include "fem/rotation.hpp"

namespace tenon::assembly {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

namespace {

constexpr double step = 1e-3;
constexpr std::array<std::pair<double, double>, 4> stencil{
    {{-2.0, 1.0 / 12.0}, {-1.0, -2.0 / 3.0}, {1.0, 2.0 / 3.0}, {2.0, -1.0 / 12.0}}};  // of the first derivative

// ∂(−T_passive)/∂ξ and ∂/∂χ: modes, springs and dampers
void passive_matrices(const Multibody& system, const VectorXd& q, LinearMotion& linear) {
  for (std::size_t k = 0; k < system.bodies.size(); ++k) {
    const HingedBody& b = system.bodies[k];
    const Index n = b.modes(), r = b.dofs(), first = system.v_offset[k];
    linear.K.block(first, first, n, n) += MatrixXd(b.body->omega.cwiseAbs2().asDiagonal());
    linear.C.block(first, first, n, n) += reduction::damping(*b.body);
    linear.C.block(first + n, first + n, r, r) += MatrixXd(b.damping.asDiagonal());
    MatrixXd springs = b.stiffness.asDiagonal();
    if (hinge_coordinates(b.kind) > r && r > 0) {  // torque T⁻¹ k φ over rotations δ = Tᵀ δφ
      VectorXd delta(r);
      displacements(b.kind, q.data() + system.q_offset[k] + n, delta.data());
      const Index a = r - 3;
      const Vec3 phi = delta.tail<3>();
      const Mat3 T_inverse = fem::rotation_tangent(phi).inverse();
      Mat3 rate = Mat3::Zero();  // ∂(T⁻¹)/∂φ k φ by differences; zero at rest
      if (!phi.isZero(0.0))
        for (int i = 0; i < 3; ++i)
          for (const auto& [at, weight] : stencil)
            rate.col(i) += weight / step *
                           (fem::rotation_tangent(phi + at * step * Vec3::Unit(i)).inverse() *
                            b.stiffness.tail<3>().cwiseProduct(phi));
      springs.block(a, a, 3, 3) = (T_inverse * Mat3(b.stiffness.tail<3>().asDiagonal()) + rate) * T_inverse.transpose();
    }
    linear.K.block(first + n, first + n, r, r) += springs;
  }
}

// δβ = ξ̇ + Ω ξ: an attitude moved by ξ in its own axes sees the steady turn ω as ω + ω × ξ
MatrixXd turning(const Multibody& system, const VectorXd& v) {
  MatrixXd Omega = MatrixXd::Zero(system.nv, system.nv);
  for (std::size_t k = 0; k < system.bodies.size(); ++k) {
    const HingedBody& b = system.bodies[k];
    if (hinge_coordinates(b.kind) == b.dofs()) continue;
    const Index a = system.v_offset[k] + b.modes() + b.dofs() - 3;
    Omega.block<3, 3>(a, a) = fem::skew(v.segment<3>(a));
  }
  return Omega;
}

}  // namespace

LinearMotion linearise(const Multibody& system, const MotionState& state, const VectorXd& v_dot) {
  const Index nv = system.nv;
  Sweeps sweeps = make_sweeps(system);
  LinearMotion linear{MatrixXd(nv, nv), MatrixXd::Zero(nv, nv), MatrixXd::Zero(nv, nv), {}};
  set_state(system, state.q, state.v, sweeps);
  composite_mass_matrix(system, sweeps, linear.M);
  ClosureRows rows = make_closure_rows(system);
  closure_rows(system, sweeps, state.q, state.v, rows);
  linear.J = rows.J_t.transpose();
  passive_matrices(system, state.q, linear);

  VectorXd T(nv), held(nv);
  restiffen(system, state.q, v_dot, sweeps);
  inverse_dynamics(system, sweeps, v_dot, T);
  passive_forces(system, state.q, state.v, held);
  const VectorXd driven = T - held;
  const VectorXd lambda = rows.rows() > 0 ? VectorXd(rows.J_t.completeOrthogonalDecomposition().solve(driven))
                                          : VectorXd();  // what the closures carry
  const auto residual = [&](const VectorXd& q, const VectorXd& v) {
    set_state(system, q, v, sweeps);
    restiffen(system, q, v_dot, sweeps);
    inverse_dynamics(system, sweeps, v_dot, T);
    if (lambda.size() == 0) return;
    closure_rows(system, sweeps, q, v, rows);
    T.noalias() -= rows.J_t * lambda;
  };
  const bool moves = !state.v.isZero(0.0), loaded = moves || !v_dot.isZero(0.0) || !system.gravity.isZero(0.0);
  for (Index j = 0; loaded && j < nv; ++j)
    for (const auto& [at, weight] : stencil) {
      VectorXd delta = VectorXd::Zero(nv), q = state.q, v = state.v;
      delta[j] = at * step;
      move(system, delta, q);
      residual(q, state.v);
      linear.K.col(j) += weight / step * T;
      if (!moves) continue;
      v[j] += at * step;
      residual(state.q, v);
      linear.C.col(j) += weight / step * T;
    }
  // δβ̇ = ξ̈ + Ω ξ̇ + Ω̇ ξ
  const MatrixXd Omega = turning(system, state.v);
  linear.K += linear.C * Omega + linear.M * turning(system, v_dot);
  linear.C += linear.M * Omega;
  return linear;
}

}  // namespace tenon::assembly
