#include "assembly/recursion/sweeps.hpp"
#include "fem/rotation.hpp"

namespace tenon::assembly {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;
using fem::shift_twist;
using fem::shift_wrench;

void inverse_dynamics(const Multibody& system, Sweeps& sweeps, const VectorXd& v_dot, VectorXd& T) {
  const auto count = static_cast<int>(system.bodies.size());
  Vec6 base = Vec6::Zero();
  base.head<3>() = -system.gravity;
  for (int k = 0; k < count; ++k) {  // base to tip: α_m, then f_m = M_m α_m + b_m
    const HingedBody& b = system.bodies[static_cast<std::size_t>(k)];
    BodySweep& s = sweeps.bodies[static_cast<std::size_t>(k)];
    const Index n = b.modes(), first = system.v_offset[static_cast<std::size_t>(k)];
    Vec6 at_node = base;
    if (b.parent >= 0) {
      const auto p = static_cast<std::size_t>(b.parent);
      at_node = shift_twist(sweeps.bodies[p].alpha, s.to_node);
      for (Index i = 0; i < s.Pi_t.cols(); ++i) at_node += v_dot[system.v_offset[p] + i] * s.Pi_t.col(i);
    }
    s.alpha = s.X.twist(at_node) + s.a;
    for (Index j = 0; j < s.H_F.cols(); ++j) s.alpha += v_dot[first + n + j] * s.H_F.col(j);
    for (Index i = 0; i < s.Pi_F.cols(); ++i) s.alpha -= v_dot[first + i] * s.Pi_F.col(i);
    s.z_f.head(n) = s.b.head(n);
    s.z_r = s.b.tail<6>();
    for (Index i = 0; i < n; ++i) {
      const double rate = v_dot[first + i];
      for (Index j = 0; j < n; ++j) s.z_f[j] += s.M(j, i) * rate;
      s.z_f[i] += s.M.col(i).tail<6>().dot(s.alpha);
      s.z_r += rate * s.M.col(i).tail<6>();
    }
    s.z_r += s.M.bottomRightCorner<6, 6>() * s.alpha;
  }
  for (int k = count - 1; k >= 0; --k) {  // tip to base: T = 𝓗 f_m, eq (45)
    const HingedBody& b = system.bodies[static_cast<std::size_t>(k)];
    const BodySweep& s = sweeps.bodies[static_cast<std::size_t>(k)];
    const Index n = b.modes(), first = system.v_offset[static_cast<std::size_t>(k)];
    T.segment(first, n) = s.z_f.head(n);
    for (Index i = 0; i < s.Pi_F.cols(); ++i) T[first + i] -= s.Pi_F.col(i).dot(s.z_r);
    for (Index j = 0; j < s.H_F.cols(); ++j)
      T[first + n + j] = s.H_F.col(j).dot(s.z_r) + b.inertia[j] * v_dot[first + n + j];
    if (b.parent < 0) continue;
    BodySweep& parent = sweeps.bodies[static_cast<std::size_t>(b.parent)];
    const Vec6 at_node = s.X.wrench(s.z_r);
    parent.z_r += shift_wrench(at_node, s.to_node);
    for (Index i = 0; i < s.Pi_t.cols(); ++i) parent.z_f[i] += s.Pi_t.col(i).dot(at_node);
  }
}

namespace {

// Asks for the springs and dampers of a body ahead.
void fetch_springs(const Multibody& system, std::size_t k) {
  constexpr std::size_t bodies = 12;
  if (k + bodies >= system.bodies.size()) return;
  const HingedBody& b = system.bodies[k + bodies];
  __builtin_prefetch(&b), __builtin_prefetch(b.damping.data());
}

}  // namespace

void passive_forces(const Multibody& system, const VectorXd& q, const VectorXd& v, VectorXd& T) {
  for (std::size_t k = 0; k < system.bodies.size(); ++k) {
    fetch_springs(system, k);
    const HingedBody& b = system.bodies[k];
    const ReducedBody& body = *b.body;
    const Index n = b.modes(), first = system.v_offset[k], at = system.q_offset[k];
    for (Index i = 0; i < n; ++i) {
      const double w = body.omega[i];
      T[first + i] = -w * w * q[at + i];
      if (body.C.size() == 0) T[first + i] -= 2.0 * body.zeta[i] * w * v[first + i];
    }
    if (body.C.size() > 0) T.segment(first, n).noalias() -= body.C * v.segment(first, n);
    const Index r = b.dofs();
    if (r == 0) continue;
    const double *theta = q.data() + at + n, *beta = v.data() + first + n;
    if (hinge_coordinates(b.kind) == r) {
      for (Index j = 0; j < r; ++j) T[first + n + j] = -b.stiffness[j] * theta[j] - b.damping[j] * beta[j];
      continue;
    }
    Vec6 delta, force = Vec6::Zero();
    displacements(b.kind, theta, delta.data());
    for (Index j = 0; j < r; ++j) force[j] = -b.stiffness[j] * delta[j];
    // β = T(φ)ᵀ φ̇ in outboard axes: the torque of ½ φᵀ k φ is T⁻¹ k φ
    const Vec3 phi = delta.segment<3>(r - 3);
    const Vec3 torque = fem::rotation_tangent(phi).inverse() * force.segment<3>(r - 3);
    force.segment<3>(r - 3) = torque;
    for (Index j = 0; j < r; ++j) T[first + n + j] = force[j] - b.damping[j] * beta[j];
  }
}

}  // namespace tenon::assembly
