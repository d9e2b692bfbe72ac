#include "assembly/recursion/stiffening.hpp"

#include <Eigen/Cholesky>
#include <algorithm>

#include "reduction/geometric_stiffness.hpp"

namespace tenon::assembly {

using Eigen::Index;
using Eigen::VectorXd;

namespace {

bool floats(const Multibody& system, int root) {
  const HingedBody& b = system.bodies[static_cast<std::size_t>(root)];
  return b.parent < 0 && b.kind == HingeKind::free && b.stiffness.isZero(0.0) &&
         std::none_of(system.closures.begin(), system.closures.end(), [&](const Closure& c) {
           return c.inner.body < 0 && system.root[static_cast<std::size_t>(c.outer.body)] == root;
         });
}

// Adds to alpha the acceleration of a tree that floats as one rigid body: I a + z = 0 about its root.
void release(const Multibody& system, int root, Sweeps& sweeps) {
  const RigidMotion base = sweeps.bodies[static_cast<std::size_t>(root)].world;
  const auto seen = [&](const BodySweep& s) -> RigidMotion {
    return {base.R.transpose() * s.world.R, base.R.transpose() * (s.world.r - base.r)};
  };
  Mat6 I = Mat6::Zero();
  Vec6 z = Vec6::Zero();
  for (std::size_t k = static_cast<std::size_t>(root); k < sweeps.bodies.size(); ++k) {
    if (system.root[k] != root) continue;
    const BodySweep& s = sweeps.bodies[k];
    const Mat6 M_rr = s.M.bottomRightCorner<6, 6>();
    I += seen(s).inertia(M_rr);
    z += seen(s).wrench(M_rr * s.alpha + s.b.tail<6>());
  }
  const Vec6 a = -I.ldlt().solve(z);
  for (std::size_t k = static_cast<std::size_t>(root); k < sweeps.bodies.size(); ++k)
    if (system.root[k] == root) sweeps.bodies[k].alpha += seen(sweeps.bodies[k]).twist(a);
}

// Accelerations less gravity of all bodies, into alpha: with χ̇ = 0, but for trees that float.
void accelerate(const Multibody& system, Sweeps& sweeps) {
  for (BodySweep& s : sweeps.bodies) {
    s.alpha = s.alpha_bias;
    s.alpha.head<3>() -= s.world.R.transpose() * system.gravity;
  }
  for (int k = 0; k < static_cast<int>(system.bodies.size()); ++k)
    if (floats(system, k)) release(system, k, sweeps);
}

// b_f −= K_G η, as the last stiffen() left it
void take_off(const Multibody& system, const VectorXd& q, Sweeps& sweeps) {
  for (std::size_t k = 0; k < system.bodies.size(); ++k) {
    BodySweep& s = sweeps.bodies[k];
    const Index n = s.K_G.rows();
    if (n > 0) s.b.head(n).noalias() -= s.K_G * q.segment(system.q_offset[k], n);
  }
}

// b_f += K_G η under the accelerations in alpha and the wrenches applied at ports
void stiffen(const Multibody& system, const VectorXd& q, Sweeps& sweeps) {
  const auto count = static_cast<int>(system.bodies.size());
  for (BodySweep& s : sweeps.bodies) {
    s.z_r = s.M.bottomRightCorner<6, 6>() * s.alpha + s.b.tail<6>();
    s.port_wrenches = s.applied;
  }
  for (int k = count - 1; k >= 0; --k) {  // tip to base: what each hinge carries
    const HingedBody& b = system.bodies[static_cast<std::size_t>(k)];
    BodySweep& s = sweeps.bodies[static_cast<std::size_t>(k)];
    if (s.K_G.size() > 0) {
      reduction::geometric_stiffness(*b.body->stiffening, s.alpha.head<3>(), s.alpha.tail<3>(), s.V.tail<3>(),
                                     s.port_wrenches.data(), s.K_G);
      const Index n = b.modes();
      s.b.head(n).noalias() += s.K_G * q.segment(system.q_offset[static_cast<std::size_t>(k)], n);
    }
    if (b.parent < 0) continue;
    BodySweep& parent = sweeps.bodies[static_cast<std::size_t>(b.parent)];
    const Vec6 at_node = s.X.wrench(s.z_r);
    parent.z_r += fem::shift_wrench(at_node, s.to_node);
    if (parent.port_wrenches.size() > 0) parent.port_wrenches.segment<6>(6 * b.inner_port) -= at_node;
  }
}

}  // namespace

void add_stiffening(const Multibody& system, const VectorXd& q, Sweeps& sweeps) {
  for (BodySweep& s : sweeps.bodies) s.applied.setZero();
  accelerate(system, sweeps);
  stiffen(system, q, sweeps);
}

void restiffen(const Multibody& system, const VectorXd& q, Sweeps& sweeps) {
  if (!sweeps.stiffening) return;
  take_off(system, q, sweeps);
  accelerate(system, sweeps);
  stiffen(system, q, sweeps);
}

void restiffen(const Multibody& system, const VectorXd& q, const VectorXd& v_dot, Sweeps& sweeps) {
  if (!sweeps.stiffening) return;
  take_off(system, q, sweeps);
  VectorXd T(system.nv);
  inverse_dynamics(system, sweeps, v_dot, T);  // leaves the accelerations less gravity in alpha
  stiffen(system, q, sweeps);
}

SpinRatio spin_ratio(const Multibody& system, const Sweeps& sweeps) {
  SpinRatio worst;
  for (std::size_t k = 0; k < system.bodies.size(); ++k) {
    const ReducedBody& body = *system.bodies[k].body;
    if (body.n() == 0 || body.omega[0] == 0.0 || sweeps.bodies[k].K_G.size() > 0) continue;
    const double ratio = sweeps.bodies[k].V.tail<3>().norm() / body.omega[0];
    if (worst.body < 0 || ratio > worst.ratio) worst = {static_cast<int>(k), ratio};
  }
  return worst;
}

}  // namespace tenon::assembly
