#include <cmath>

#include "assembly/recursion/port_motion.hpp"
#include "assembly/recursion/stiffening.hpp"
#include "assembly/recursion/sweep_kernels.hpp"
#include "fem/rigid_motion.hpp"
#include "fem/rotation.hpp"
#include "reduction/body_terms.hpp"

namespace tenon::assembly {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;
using fem::shift_twist;

namespace {

// M_m(η) and b_m; of a body whose deformation is dropped M_m stays as make_sweeps() left it, eq (75)
void set_body_terms(const double* eta, const double* eta_dot, const Vec3& w, BodySweep& s) {
  const reduction::ShapeIntegrals* integrals = s.body->shape_integrals.get();
  if (s.shifts_mass)
    reduction::body_terms(*s.body, integrals, reduction::Nonlinearity::full, eta, eta_dot, w, s.M, s.b);
  else
    reduction::ruthless_gyroscopics(*s.body, integrals, w, s.b);
}

// Where a body hangs: pose, twist and a_mR from the state of its parent, eqs (45), (25), for any hinge and nodes that
// deform. `eta_p`, `rates_p`: η and η̇ of the parent.
void hang(const Multibody& system, std::size_t k, const BodySweep& parent, const double* eta_p, const double* rates_p,
          const double* eta, const double* eta_dot, BodySweep& s) {
  const HingedBody& b = system.bodies[k];
  const double *theta = eta + s.n, *beta = eta_dot + s.n;

  // node t: V_t = φ*(p, t) V_p + Π_t η̇_p and the part of its rate that velocities make
  DeformedNode t;
  t.position = s.to_node;
  if (!s.fixed_node) {
    t = deformed_node(system.bodies[static_cast<std::size_t>(s.parent)], b.inner_port, eta_p, rates_p, s.Pi_t);
    s.Pi_tT.topRows(s.n_t) = s.Pi_t.transpose();
    s.to_node = t.position;
  }
  Vec6 V_t = shift_twist(parent.V, t.position), bias = Vec6::Zero();
  for (Index i = 0; i < s.n_t; ++i) V_t += rates_p[i] * s.Pi_t.col(i);
  const Vec3 w_p = parent.V.tail<3>();
  bias.head<3>() = w_p.cross(w_p.cross(t.position)) + 2.0 * w_p.cross(t.slide);
  bias.tail<3>() = w_p.cross(t.turn) + t.turn_rate;
  const Mat3 inner = t.rotation * b.inner_axes;

  // across the hinge
  HingeMotion hinge;
  hinge_motion(b.kind, theta, beta, hinge);
  if (b.reversed) reverse(beta, hinge);
  Vec6 rate = Vec6::Zero();
  for (Index j = 0; j < s.H_F.cols(); ++j) rate += beta[j] * hinge.H_star.col(j);
  const Vec3 d = inner * hinge.d, v_h = inner * rate.head<3>(), w_h = inner * rate.tail<3>();
  const Vec3 w_t = V_t.tail<3>();
  bias.head<3>() +=
      bias.tail<3>().cross(d) + w_t.cross(w_t.cross(d)) + 2.0 * w_t.cross(v_h) + inner * hinge.bias.head<3>();
  bias.tail<3>() += w_t.cross(w_h) + inner * hinge.bias.tail<3>();

  // node d and the reference of this body
  DeformedNode own;
  own.position = s.own_node;
  if (s.Pi_F.cols() > 0) {
    own = deformed_node(b, b.outer_port, eta, eta_dot, s.Pi_F);
    if (b.deformation == Deformation::full) to_reference(own.position, s.Pi_F);
  }
  s.X.R = inner * hinge.R * (own.rotation * b.outer_axes).transpose();
  s.X.r = d - s.X.R * own.position;
  for (Index j = 0; j < s.H_F.cols(); ++j) {
    const Vec3 w = s.X.R.transpose() * (inner * hinge.H_star.col(j).tail<3>());
    s.H_F.col(j).tail<3>() = w;
    s.H_F.col(j).head<3>() = s.X.R.transpose() * (inner * hinge.H_star.col(j).head<3>()) - w.cross(own.position);
  }
  s.V = s.X.twist(V_t);
  for (Index j = 0; j < s.H_F.cols(); ++j) s.V += beta[j] * s.H_F.col(j);
  for (Index i = 0; i < s.Pi_F.cols(); ++i) s.V -= eta_dot[i] * s.Pi_F.col(i);

  const Vec3 w = s.V.tail<3>();
  s.a.tail<3>() = s.X.R.transpose() * bias.tail<3>() - w.cross(own.turn) - own.turn_rate;
  s.a.head<3>() = s.X.R.transpose() * bias.head<3>() - s.a.tail<3>().cross(own.position) -
                  w.cross(w.cross(own.position)) - 2.0 * w.cross(own.slide);
  s.alpha_bias = s.X.twist(shift_twist(parent.alpha_bias, s.to_node)) + s.a;
  s.world.R.noalias() = parent.world.R * s.X.R;
  s.world.r = parent.world.r + parent.world.R * (s.to_node + s.X.r);
}

BodyMotion motion_of(BodySweep& s) { return {s.world.R.data(), s.V.data(), s.alpha_bias.data()}; }

}  // namespace

void set_state(const Multibody& system, const VectorXd& q, const VectorXd& v, Sweeps& sweeps) {
  const SweepKernels& kernels = sweep_kernels();
  BodySweep ground;
  ground.V.setZero();
  ground.alpha_bias.setZero();
  for (std::size_t k = 0; k < system.bodies.size(); ++k) {
    if (sweeps.large) fetch_ahead(sweeps, k, 1, motion_reach);
    BodySweep& s = sweeps.bodies[k];
    const auto p = static_cast<std::size_t>(s.parent);
    if (s.parent < 0) ground.world.r = system.bodies[k].inner_position;
    BodySweep& parent = s.parent < 0 ? ground : sweeps.bodies[p];
    const double *eta = q.data() + system.q_offset[k], *eta_dot = v.data() + system.v_offset[k];
    if (s.plain) {
      const double theta = eta[s.n];
      kernels.hang({s.inner_axes.data(), s.outer_axes.data(), s.to_node.data(), s.own_node.data(), s.H_F.data()},
                   std::cos(theta), s.sign * std::sin(theta), eta_dot[s.n], motion_of(parent), s.X.R.data(), s.a.data(),
                   motion_of(s));
    } else {
      const double *eta_p = nullptr, *rates_p = nullptr;
      if (s.parent >= 0) eta_p = q.data() + system.q_offset[p], rates_p = v.data() + system.v_offset[p];
      hang(system, k, parent, eta_p, rates_p, eta, eta_dot, s);
    }
    if (s.n == 0)
      kernels.rigid_load(s.M.data(), s.V.data(), s.b.data());
    else
      set_body_terms(eta, eta_dot, s.V.tail<3>(), s);
  }
  if (sweeps.stiffening) add_stiffening(system, q, sweeps);
}

void apply_wrench(const Multibody& system, const VectorXd& q, int body, int port, const Vec6& wrench, Sweeps& sweeps) {
  const auto k = static_cast<std::size_t>(body);
  const HingedBody& b = system.bodies[k];
  BodySweep& s = sweeps.bodies[k];
  const reduction::BodyPort& p = b.body->ports[static_cast<std::size_t>(port)];
  const Index n = b.modes();
  Vec6 u = Vec6::Zero();
  if (b.deformation == Deformation::full)
    for (Index i = 0; i < n; ++i) u += q[system.q_offset[k] + i] * p.Phi.col(i);
  Vec6 f = wrench;
  f.tail<3>() = fem::rotation_tangent(u.tail<3>()).transpose() * wrench.tail<3>();
  for (Index i = 0; i < n; ++i) s.b[i] -= p.Phi.col(i).dot(f);
  s.b.tail<6>() -= fem::shift_wrench(wrench, p.position + u.head<3>() - b.body->reference);
  if (s.applied.size() > 0) s.applied.segment<6>(6 * port) += wrench;
}

}  // namespace tenon::assembly
