#include "assembly/recursion/sweeps.hpp"
#include "fem/rigid_motion.hpp"
#include "fem/rotation.hpp"

namespace tenon::assembly {

using Eigen::Index;
using Eigen::VectorXd;

namespace {

// M_m V_m of body k: over (η, x_ref)
Vec6 rigid_momentum(const BodySweep& s, const double* eta_dot) {
  const Index n = s.M.rows() - 6;
  Vec6 p = s.M.bottomRightCorner<6, 6>() * s.V;
  for (Index i = 0; i < n; ++i) p += eta_dot[i] * s.M.col(i).tail<6>();
  return p;
}

// Potential of gravity to first order in the modes that move neither mass nor ports: u, the displacement they give each
// body, as the twists that gravity's force on them is the dual of (Π_t, Π_F and M_rf of eqs (13), (23)).
double first_order_gravity(const Multibody& system, const Sweeps& sweeps, const VectorXd& q) {
  thread_local std::vector<Vec6> u;  // kept, so that steps take nothing from the heap
  u.assign(system.bodies.size(), Vec6::Zero());
  double potential = 0.0;
  for (std::size_t k = 0; k < system.bodies.size(); ++k) {
    const HingedBody& b = system.bodies[k];
    const BodySweep& s = sweeps.bodies[k];
    const double* eta = q.data() + system.q_offset[k];
    if (b.parent >= 0) {
      const auto p = static_cast<std::size_t>(b.parent);
      Vec6 at_node = fem::shift_twist(u[p], s.to_node);
      if (system.bodies[p].deformation == Deformation::dropped)
        for (Index i = 0; i < s.Pi_t.cols(); ++i) at_node += q[system.q_offset[p] + i] * s.Pi_t.col(i);
      u[k] = s.X.twist(at_node);
    }
    const bool dropped = b.deformation == Deformation::dropped;
    if (dropped)
      for (Index i = 0; i < s.Pi_F.cols(); ++i) u[k] -= eta[i] * s.Pi_F.col(i);
    Vec3 moment = s.M.bottomRightCorner<6, 6>().topRows<3>() * u[k];
    if (dropped || !b.body->shape_integrals)
      for (Index i = 0; i < b.modes(); ++i) moment += eta[i] * s.M.col(i).segment<3>(b.modes());
    potential -= system.gravity.dot(s.world.R * moment);
  }
  return potential;
}

}  // namespace

Energy energy(const Multibody& system, const Sweeps& sweeps, const VectorXd& q, const VectorXd& v) {
  Energy e;
  for (std::size_t k = 0; k < system.bodies.size(); ++k) {
    const HingedBody& b = system.bodies[k];
    const BodySweep& s = sweeps.bodies[k];
    const Index n = b.modes(), r = b.dofs();
    const double *eta = q.data() + system.q_offset[k], *eta_dot = v.data() + system.v_offset[k];
    e.kinetic += 0.5 * s.V.dot(rigid_momentum(s, eta_dot));
    for (Index i = 0; i < n; ++i) {
      double p = s.M.col(i).tail<6>().dot(s.V);
      for (Index j = 0; j < n; ++j) p += s.M(j, i) * eta_dot[j];
      e.kinetic += 0.5 * eta_dot[i] * p;
      e.elastic += 0.5 * b.body->omega[i] * b.body->omega[i] * eta[i] * eta[i];
    }
    Vec6 delta;
    displacements(b.kind, eta + n, delta.data());
    for (Index j = 0; j < r; ++j) {
      e.kinetic += 0.5 * b.inertia[j] * eta_dot[n + j] * eta_dot[n + j];
      e.elastic += 0.5 * b.stiffness[j] * delta[j] * delta[j];
    }
    const Mat6 M_rr = s.M.bottomRightCorner<6, 6>();  // Σ m (world place) = m r + R s
    e.gravity -= system.gravity.dot(M_rr(0, 0) * s.world.r + s.world.R * fem::first_moment(M_rr));
  }
  if (!system.gravity.isZero(0.0)) e.gravity += first_order_gravity(system, sweeps, q);
  return e;
}

Vec6 momentum(const Multibody& system, const Sweeps& sweeps, const VectorXd& v) {
  Vec6 total = Vec6::Zero();
  for (std::size_t k = 0; k < system.bodies.size(); ++k)
    total += sweeps.bodies[k].world.wrench(rigid_momentum(sweeps.bodies[k], v.data() + system.v_offset[k]));
  return total;
}

}  // namespace tenon::assembly
