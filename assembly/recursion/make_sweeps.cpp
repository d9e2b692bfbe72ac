#include "assembly/recursion/port_motion.hpp"
#include "assembly/recursion/sweep_kernels.hpp"
#include "assembly/recursion/sweeps.hpp"

namespace tenon::assembly {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

namespace {

// M_m(k) at rest over (η, x_ref), eq (23)
MatrixXd rest_mass(const ReducedBody& body) {
  const Index n = body.n();
  MatrixXd M(n + 6, n + 6);
  M << MatrixXd::Identity(n, n), body.L, body.L.transpose(), body.D;
  return M;
}

// Nodes t and d as they are without deformation.
void set_nodes(const Multibody& system, const HingedBody& b, BodySweep& s) {
  s.to_node.setZero();
  s.Pi_t.resize(6, 0);
  s.fixed_node = true;
  if (b.parent >= 0) {
    const HingedBody& parent = system.bodies[static_cast<std::size_t>(b.parent)];
    const reduction::BodyPort& port = parent.body->ports[static_cast<std::size_t>(b.inner_port)];
    s.to_node = port.position - parent.body->reference;
    s.fixed_node = parent.modes() == 0 || parent.deformation == Deformation::dropped;
    if (!port.Phi.isZero(0.0)) s.Pi_t = port.Phi;
    if (s.Pi_t.cols() == 0) s.fixed_node = true;
  }
  s.Pi_F.resize(6, 0);
  if (b.outer_port < 0) return;
  const reduction::BodyPort& port = b.body->ports[static_cast<std::size_t>(b.outer_port)];
  s.own_node = port.position - b.body->reference;
  if (b.modes() == 0 || port.Phi.isZero(0.0)) return;
  s.Pi_F = port.Phi;  // Π_F^d = φ*(d, k) Π^d
  to_reference(s.own_node, s.Pi_F);
}

// inner R_z(θ) outerᵀ in its parts, and H_F* along the axis, which θ leaves where it is
void set_plain(const HingedBody& b, BodySweep& s) {
  const double sign = b.reversed ? -1.0 : 1.0;
  const Vec3 inner_axis = b.inner_axes.col(2), outer_axis = b.outer_axes.col(2);
  s.plain = true;
  s.R_0 = inner_axis * outer_axis.transpose();
  s.R_c = b.inner_axes * b.outer_axes.transpose() - s.R_0;
  s.R_s = sign * b.inner_axes * fem::skew(Vec3::UnitZ()) * b.outer_axes.transpose();
  const Vec3 axis = sign * outer_axis;
  s.H_F.col(0) << -axis.cross(s.own_node), axis;
}

}  // namespace

Sweeps make_sweeps(const Multibody& system) {
  Sweeps sweeps;
  sweeps.bodies.resize(system.bodies.size());
  for (std::size_t k = 0; k < system.bodies.size(); ++k) {
    const HingedBody& b = system.bodies[k];
    BodySweep& s = sweeps.bodies[k];
    const Index n = b.modes();
    set_nodes(system, b, s);
    if (b.body->stiffening && b.deformation == Deformation::full && n > 0) {
      s.K_G = MatrixXd::Zero(n, n);
      s.applied = s.port_wrenches = VectorXd::Zero(6 * static_cast<Index>(b.body->ports.size()));
      sweeps.stiffening = true;
    }
    s.M = rest_mass(*b.body);
    s.b = VectorXd::Zero(n + 6);
    const Index height = padded(static_cast<int>(n));
    s.L11 = MatrixXd::Zero(height, n);
    s.L21 = s.P_rf = BodySweep::Mat8X::Zero(8, n);
    s.y = s.z_f = VectorXd::Zero(height);
    s.inverse = VectorXd::Zero(n);
    s.Pi_t8 = BodySweep::Mat8X::Zero(8, s.Pi_t.cols());
    s.Pi_tT = MatrixXd::Zero(padded(static_cast<int>(s.Pi_t.cols())), 6);
    pad_shapes(s);
    s.nu_R = VectorXd::Zero(b.dofs());
    s.H_F.setZero(6, b.dofs());
    s.G_R.setZero(6, b.dofs());
    s.D_R.setZero(b.dofs(), b.dofs());
    if (b.kind == HingeKind::revolute && s.fixed_node && s.Pi_F.cols() == 0) set_plain(b, s);
  }
  return sweeps;
}

}  // namespace tenon::assembly
