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
  return e;
}

Vec6 momentum(const Multibody& system, const Sweeps& sweeps, const VectorXd& v) {
  Vec6 total = Vec6::Zero();
  for (std::size_t k = 0; k < system.bodies.size(); ++k)
    total += sweeps.bodies[k].world.wrench(rigid_momentum(sweeps.bodies[k], v.data() + system.v_offset[k]));
  return total;
}

}  // namespace tenon::assembly
