#include "assembly/recursion/port_motion.hpp"

#include "fem/rotation.hpp"

namespace tenon::assembly {

using Eigen::Index;
using Eigen::VectorXd;
using fem::shift_twist;
using fem::shift_wrench;

DeformedNode deformed_node(const HingedBody& b, int port, const double* eta, const double* eta_dot,
                           Eigen::Ref<Mat6X> Pi) {
  const reduction::BodyPort& p = b.body->ports[static_cast<std::size_t>(port)];
  DeformedNode node;
  node.position = p.position - b.body->reference;
  const Index n = b.modes();
  if (n == 0 || b.deformation == Deformation::dropped) return node;
  Vec6 u = Vec6::Zero(), rate = Vec6::Zero();
  for (Index i = 0; i < n; ++i) {
    u += eta[i] * p.Phi.col(i);
    rate += eta_dot[i] * p.Phi.col(i);
  }
  const Vec3 phi = u.tail<3>(), phi_dot = rate.tail<3>();
  const Mat3 T = fem::rotation_tangent(phi);
  node.position += u.head<3>();
  node.rotation = fem::rotation_matrix(phi);
  node.slide = rate.head<3>();
  node.turn = T * phi_dot;
  node.turn_rate = fem::rotation_tangent_rate(phi, phi_dot);
  for (Index i = 0; i < n; ++i) {
    Pi.col(i).head<3>() = p.Phi.col(i).head<3>();
    Pi.col(i).tail<3>().noalias() = T * p.Phi.col(i).tail<3>();
  }
  return node;
}

void to_reference(const Vec3& to_node, Eigen::Ref<Mat6X> Pi) {
  for (Index i = 0; i < Pi.cols(); ++i) Pi.col(i).head<3>() -= Pi.col(i).tail<3>().cross(to_node);
}

PortMotion port_motion(const Multibody& system, const Sweeps& sweeps, const VectorXd& q, const VectorXd& v,
                       const PortRef& port, const Vec3& place, Mat6X& Pi) {
  PortMotion m;
  if (port.body < 0) {
    m.pose.r = place;
    return m;
  }
  const auto k = static_cast<std::size_t>(port.body);
  const HingedBody& b = system.bodies[k];
  const BodySweep& s = sweeps.bodies[k];
  if (b.deformation == Deformation::dropped) Pi = b.body->ports[static_cast<std::size_t>(port.port)].Phi;
  const double* rates = v.data() + system.v_offset[k];
  const DeformedNode node = deformed_node(b, port.port, q.data() + system.q_offset[k], rates, Pi);
  const Vec3 w = s.V.tail<3>();
  Vec6 V = shift_twist(s.V, node.position), bias = shift_twist(s.alpha_bias, node.position);
  for (Index i = 0; i < b.modes(); ++i) V += rates[i] * Pi.col(i);
  bias.head<3>() += w.cross(w.cross(node.position)) + 2.0 * w.cross(node.slide);
  bias.tail<3>() += w.cross(node.turn) + node.turn_rate;
  m.pose = {s.world.R * node.rotation, s.world.r + s.world.R * node.position};
  m.V << s.world.R * V.head<3>(), s.world.R * V.tail<3>();
  m.bias << s.world.R * bias.head<3>(), s.world.R * bias.tail<3>();
  return m;
}

double add_generalised_force(const Multibody& system, const Sweeps& sweeps, const PortMotion& motion,
                             const PortRef& port, const Mat6X& Pi, const Vec6& wrench, Eigen::Ref<VectorXd> column) {
  if (port.body < 0) return 0.0;
  double size = 0.0;
  const auto add = [&](Index at, double sign, const auto& shape, const Vec6& f) {
    column[at] += sign * shape.dot(f);
    const double most =
        shape.template head<3>().norm() * f.head<3>().norm() + shape.template tail<3>().norm() * f.tail<3>().norm();
    size += most * most;
  };
  auto k = static_cast<std::size_t>(port.body);
  const BodySweep* s = &sweeps.bodies[k];
  Vec6 f;  // in the body's axes: at the node, then about the reference
  f << s->world.R.transpose() * wrench.head<3>(), s->world.R.transpose() * wrench.tail<3>();
  for (Index i = 0; i < system.bodies[k].modes(); ++i) add(system.v_offset[k] + i, 1.0, Pi.col(i), f);
  f = shift_wrench(f, s->world.R.transpose() * (motion.pose.r - s->world.r));
  for (;;) {
    const HingedBody& b = system.bodies[k];
    const Index first = system.v_offset[k], n = b.modes();
    for (Index i = 0; i < s->Pi_F.cols(); ++i) add(first + i, -1.0, s->Pi_F.col(i), f);
    for (Index j = 0; j < s->H_F.cols(); ++j) add(first + n + j, 1.0, s->H_F.col(j), f);
    if (b.parent < 0) return size;
    const Vec6 at_node = s->X.wrench(f);
    const Vec3 to_node = s->to_node;
    const auto p = static_cast<std::size_t>(b.parent);
    for (Index i = 0; i < s->Pi_t.cols(); ++i) add(system.v_offset[p] + i, 1.0, s->Pi_t.col(i), at_node);
    f = shift_wrench(at_node, to_node);
    k = p;
    s = &sweeps.bodies[k];
  }
}

}  // namespace tenon::assembly
