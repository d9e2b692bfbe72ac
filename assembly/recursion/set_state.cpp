#include "assembly/recursion/port_motion.hpp"
#include "fem/rotation.hpp"

namespace tenon::assembly {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;
using fem::shift_twist;

namespace {

// Π_F^d = φ*(d, k) Π^d, k the reference seen from d
void to_reference(const Vec3& to_node, Mat6X& Pi) {
  for (Index i = 0; i < Pi.cols(); ++i) Pi.col(i).head<3>() -= Pi.col(i).tail<3>().cross(to_node);
}

bool deforms(const HingedBody& b) {
  return b.modes() > 0 && b.outer_port >= 0 && !b.body->ports[static_cast<std::size_t>(b.outer_port)].Phi.isZero(0.0);
}

// M_m(k) at rest over (η, x_ref), eq (23)
MatrixXd rest_mass(const ReducedBody& body) {
  const Index n = body.n();
  MatrixXd M(n + 6, n + 6);
  M << MatrixXd::Identity(n, n), body.L, body.L.transpose(), body.D;
  return M;
}

// b_m of a body whose deformation is dropped: gyroscopic forces of the rigid body, eq (75)
void rigid_gyroscopic(const ReducedBody& body, const Vec3& w, VectorXd& b) {
  const Index n = body.n();
  const Vec3 s(body.D(5, 1), body.D(3, 2), body.D(4, 0));  // D = [m, −s̃; s̃, J]
  b.head(n).setZero();
  b.segment<3>(n) = w.cross(w.cross(s));
  const Mat3 J = body.D.bottomRightCorner<3, 3>();
  b.tail<3>() = w.cross(Vec3(J * w));
}

}  // namespace

Sweeps make_sweeps(const Multibody& system) {
  Sweeps sweeps;
  sweeps.bodies.resize(system.bodies.size());
  for (std::size_t k = 0; k < system.bodies.size(); ++k) {
    const HingedBody& b = system.bodies[k];
    BodySweep& s = sweeps.bodies[k];
    const Index n = b.modes();
    s.to_node.setZero();
    s.Pi_t.resize(6, 0);
    if (b.parent >= 0) {
      const HingedBody& parent = system.bodies[static_cast<std::size_t>(b.parent)];
      s.Pi_t = parent.body->ports[static_cast<std::size_t>(b.inner_port)].Phi;
    }
    s.Pi_F.resize(6, 0);
    if (deforms(b)) {
      const reduction::BodyPort& port = b.body->ports[static_cast<std::size_t>(b.outer_port)];
      s.Pi_F = port.Phi;
      to_reference(port.position - b.body->reference, s.Pi_F);
    }
    s.M = rest_mass(*b.body);
    s.b = VectorXd::Zero(n + 6);
    s.L11 = MatrixXd::Zero(n, n);
    s.L21 = s.P_rf = Mat6X::Zero(6, n);
    s.y = s.z_f = VectorXd::Zero(n);
    s.nu_R = VectorXd::Zero(b.dofs());
    s.H_F.setZero(6, b.dofs());
    s.G_R.setZero(6, b.dofs());
    s.D_R.setZero(b.dofs(), b.dofs());
  }
  return sweeps;
}

void set_state(const Multibody& system, const VectorXd& q, const VectorXd& v, Sweeps& sweeps) {
  for (std::size_t k = 0; k < system.bodies.size(); ++k) {
    const HingedBody& b = system.bodies[k];
    BodySweep& s = sweeps.bodies[k];
    const Index n = b.modes();
    const double *eta = q.data() + system.q_offset[k], *eta_dot = v.data() + system.v_offset[k];
    const double *theta = eta + n, *beta = eta_dot + n;
    const bool root = b.parent < 0;

    // node t: V_t = φ*(p, t) V_p + Π_t η̇_p and the part of its rate that velocities make
    DeformedNode t;
    Vec6 V_t = Vec6::Zero(), bias = Vec6::Zero();
    RigidMotion base{Mat3::Identity(), b.inner_position};
    if (!root) {
      const auto p = static_cast<std::size_t>(b.parent);
      const BodySweep& parent = sweeps.bodies[p];
      t = deformed_node(system.bodies[p], b.inner_port, q.data() + system.q_offset[p], v.data() + system.v_offset[p],
                        s.Pi_t);
      const Vec3 w = parent.V.tail<3>();
      V_t = shift_twist(parent.V, t.position);
      for (Index i = 0; i < s.Pi_t.cols(); ++i) V_t += v[system.v_offset[p] + i] * s.Pi_t.col(i);
      bias.head<3>() = w.cross(w.cross(t.position)) + 2.0 * w.cross(t.slide);
      bias.tail<3>() = w.cross(t.turn) + t.turn_rate;
      base = parent.world;
      s.to_node = t.position;
    }
    const Mat3 inner = t.rotation * b.inner_axes;

    // across the hinge
    hinge_motion(b.kind, theta, beta, s.hinge);
    if (b.reversed) reverse(beta, s.hinge);
    Vec6 hinge_rate = Vec6::Zero();
    for (Index j = 0; j < s.H_F.cols(); ++j) hinge_rate += beta[j] * s.hinge.H_star.col(j);
    const Vec3 d = inner * s.hinge.d, v_h = inner * hinge_rate.head<3>(), w_h = inner * hinge_rate.tail<3>();
    const Vec3 w_t = V_t.tail<3>();
    bias.head<3>() +=
        bias.tail<3>().cross(d) + w_t.cross(w_t.cross(d)) + 2.0 * w_t.cross(v_h) + inner * s.hinge.bias.head<3>();
    bias.tail<3>() += w_t.cross(w_h) + inner * s.hinge.bias.tail<3>();

    // node d and the reference of this body
    DeformedNode own;
    if (b.outer_port >= 0) {
      if (s.Pi_F.cols() > 0) {
        own = deformed_node(b, b.outer_port, eta, eta_dot, s.Pi_F);
        if (b.deformation == Deformation::full) to_reference(own.position, s.Pi_F);
      } else {
        own.position = b.body->ports[static_cast<std::size_t>(b.outer_port)].position - b.body->reference;
      }
    }
    s.X.R = inner * s.hinge.R * (own.rotation * b.outer_axes).transpose();
    s.X.r = d - s.X.R * own.position;
    for (Index j = 0; j < s.H_F.cols(); ++j) {
      const Vec3 w = s.X.R.transpose() * (inner * s.hinge.H_star.col(j).tail<3>());
      s.H_F.col(j).tail<3>() = w;
      s.H_F.col(j).head<3>() = s.X.R.transpose() * (inner * s.hinge.H_star.col(j).head<3>()) - w.cross(own.position);
    }
    s.V = s.X.twist(V_t);
    for (Index j = 0; j < s.H_F.cols(); ++j) s.V += beta[j] * s.H_F.col(j);
    for (Index i = 0; i < s.Pi_F.cols(); ++i) s.V -= eta_dot[i] * s.Pi_F.col(i);

    // a_mR, eq (25)
    const Vec3 w = s.V.tail<3>();
    s.a.tail<3>() = s.X.R.transpose() * bias.tail<3>() - w.cross(own.turn) - own.turn_rate;
    s.a.head<3>() = s.X.R.transpose() * bias.head<3>() - s.a.tail<3>().cross(own.position) -
                    w.cross(w.cross(own.position)) - 2.0 * w.cross(own.slide);

    s.alpha_bias =
        s.X.twist(root ? Vec6(Vec6::Zero())
                       : shift_twist(sweeps.bodies[static_cast<std::size_t>(b.parent)].alpha_bias, s.to_node)) +
        s.a;
    s.world.R = base.R * s.X.R;
    s.world.r = base.r + base.R * (s.to_node + s.X.r);
    rigid_gyroscopic(*b.body, w, s.b);
  }
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
}

}  // namespace tenon::assembly
