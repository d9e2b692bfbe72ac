#include <algorithm>
#include <cmath>

#include "assembly/integration/implicit.hpp"

namespace tenon::assembly {

using Eigen::Index;
using Eigen::VectorXd;

namespace {

// M_m V_m of a body, rows of x_ref: momentum in its own axes about its reference
Vec6 body_momentum(const BodySweep& s, const double* eta_dot) {
  Vec6 p = s.M.bottomRightCorner<6, 6>() * s.V;
  for (Index i = 0; i + 6 < s.M.rows(); ++i) p += eta_dot[i] * s.M.col(i).tail<6>();
  return p;
}

// The wrench at F, in F's axes, of one about the world's origin in world axes.
Vec6 to_body(const RigidMotion& world, const Vec6& f) {
  Vec6 W;
  W.head<3>() = world.R.transpose() * f.head<3>();
  W.tail<3>() = world.R.transpose() * (f.tail<3>() - world.r.cross(f.head<3>()));
  return W;
}

// M_f (V̂ − V̂′), row i of the modes: V̂ = (η̇; V)
double modal_difference(const BodySweep& s, Index i, const double* eta_dot, const Vec6& V, const double* eta_dot2,
                        const Vec6& V2) {
  const Index n = s.M.rows() - 6;
  double p = s.M.col(i).tail<6>().dot(V - V2);
  for (Index j = 0; j < n; ++j) p += s.M(j, i) * (eta_dot[j] - eta_dot2[j]);
  return p;
}

// 𝓗 Φ of what stands in z_f and z_r of the bodies, eq (45) tip to base
void gather(const Multibody& system, Sweeps& sweeps, VectorXd& T) {
  for (int k = static_cast<int>(system.bodies.size()) - 1; k >= 0; --k) {
    const HingedBody& b = system.bodies[static_cast<std::size_t>(k)];
    const BodySweep& s = sweeps.bodies[static_cast<std::size_t>(k)];
    const Index n = b.modes(), first = system.v_offset[static_cast<std::size_t>(k)];
    T.segment(first, n) = s.z_f.head(n);
    for (Index i = 0; i < s.Pi_F.cols(); ++i) T[first + i] -= s.Pi_F.col(i).dot(s.z_r);
    for (Index j = 0; j < s.H_F.cols(); ++j) T[first + n + j] = s.H_F.col(j).dot(s.z_r);
    if (b.parent < 0) continue;
    BodySweep& parent = sweeps.bodies[static_cast<std::size_t>(b.parent)];
    const Vec6 at_node = s.X.wrench(s.z_r);
    parent.z_r += fem::shift_wrench(at_node, s.to_node);
    for (Index i = 0; i < s.Pi_t.cols(); ++i) parent.z_f[i] += s.Pi_t.col(i).dot(at_node);
  }
}

// What the momenta of body k lack to balance the forces over the step: z_f and z_r of the middle.
void imbalance(const Multibody& system, std::size_t k, double h, const VectorXd& v0, const VectorXd& v_mid,
               const VectorXd& v1, ImplicitWork& work, BodySweep& mid) {
  const HingedBody& b = system.bodies[k];
  const BodySweep &start = work.start.bodies[k], &end = work.end.bodies[k];
  const Index n = b.modes(), first = system.v_offset[k];
  const double *e0 = v0.data() + first, *e = v_mid.data() + first, *e1 = v1.data() + first;
  Vec6 fall = Vec6::Zero();  // M_m times it: gravity
  fall.head<3>() = -mid.world.R.transpose() * system.gravity;
  Vec6 turn = fall;  // and with it ω × v, the part of the inertial rate that V̇ lacks
  turn.head<3>() += mid.V.tail<3>().cross(mid.V.head<3>());
  const auto M_rr = mid.M.bottomRightCorner<6, 6>();
  if (n > 0 && (b.deformation == Deformation::dropped || !b.body->shape_integrals)) {
    mid.z_r = M_rr * (end.V - start.V + h * turn) + h * mid.b.tail<6>();
    for (Index i = 0; i < n; ++i) mid.z_r += (e1[i] - e0[i]) * mid.M.col(i).tail<6>();
  } else {
    mid.z_r =
        to_body(mid.world, end.world.wrench(body_momentum(end, e1)) - start.world.wrench(body_momentum(start, e0)));
    mid.z_r += h * (M_rr * fall + mid.b.tail<6>() - work.b[k].tail<6>());
  }
  for (Index i = 0; i < n; ++i)  // p₁ − p₀ − h ∂T/∂η; Ṁ_f by its difference over the step, exact for M of degree 2 in η
    mid.z_f[i] = modal_difference(end, i, e1, end.V, e, mid.V) + modal_difference(start, i, e, mid.V, e0, start.V) +
                 h * (mid.M.col(i).tail<6>().dot(turn) + mid.b[i]);
}

// Power of the wrenches that loads put on the bodies: what they took from b_m.
double load_power(const Multibody& system, const Sweeps& sweeps, const ImplicitWork& work, const VectorXd& v) {
  double power = 0.0;
  for (std::size_t k = 0; k < sweeps.bodies.size(); ++k) {
    const BodySweep& s = sweeps.bodies[k];
    const Index n = system.bodies[k].modes();
    for (Index i = 0; i < n; ++i) power += (work.b[k][i] - s.b[i]) * v[system.v_offset[k] + i];
    power += (work.b[k].tail<6>() - s.b.tail<6>()).dot(s.V);
  }
  return power;
}

// Balances energy over the step (a discrete gradient after Gonzalez 1996): what E₁ − E₀ lacks to the work of inertia,
// gravity and springs along v_mid is given back by a force D v_mid on modes and hinges between bodies, D their own
// inertias, so that total momenta do not feel it. Of order h³, and none when nothing moves inside.
void balance_energy(Dynamics& dynamics, double h, double change, const MotionState& mid, ImplicitWork& work) {
  constexpr double most = 1e-2;  // of the energy inside: beyond, as where all stands still for a moment, it fades out
  const Multibody& system = *dynamics.system;
  passive_forces(system, mid.q, VectorXd::Zero(system.nv), work.x);  // springs without dampers
  const double work_done =
      mid.v.dot(work.r) + h * mid.v.dot(dynamics.T - work.x) + h * load_power(system, dynamics.sweeps, work, mid.v);
  work.x.setZero();
  for (std::size_t k = 0; k < system.bodies.size(); ++k) {
    const HingedBody& b = system.bodies[k];
    const BodySweep& s = dynamics.sweeps.bodies[k];
    const Index n = b.modes(), first = system.v_offset[k];
    work.x.segment(first, n) = mid.v.segment(first, n);
    if (b.parent < 0) continue;  // carries momentum
    for (Index j = 0; j < b.dofs(); ++j) {
      const Vec6 H = s.H_F.col(j);
      work.x[first + n + j] = (H.dot(s.M.bottomRightCorner<6, 6>() * H) + b.inertia[j]) * mid.v[first + n + j];
    }
  }
  const double inside = mid.v.dot(work.x), lack = change - work_done;
  const double size2 = inside * inside + lack * lack / (most * most);
  if (size2 > 0.0) work.r += lack * inside / size2 * work.x;
}

}  // namespace

void midpoint_step(Dynamics& dynamics, double t, double h, const ImplicitOptions& options, ImplicitWork& work,
                   ImplicitState& state) {
  const Multibody& system = *dynamics.system;
  const MotionState& from = state.motion;
  MotionState &to = work.next, &mid = work.mid;
  if (!work.started) set_state(system, from.q, from.v, work.start);
  work.started = true;
  const bool floats = std::all_of(system.bodies.begin(), system.bodies.end(),
                                  [](const HingedBody& b) { return b.parent >= 0 || b.kind == HingeKind::free; });
  const double energy_before = energy(system, work.start, from.q, from.v).total();
  to.v = from.v + h * state.v_dot;
  work.impulse = h * dynamics.lambda;
  work.iterations = 0;
  const double tolerance = options.tolerance > 0.0 ? options.tolerance : 1e-15;
  Convergence convergence{t, h, tolerance, options.most_iterations, round_off_of_gaps(dynamics), work};
  const auto place = [&] {
    mid.v = 0.5 * (from.v + to.v);
    work.delta = h * mid.v;
    for (const int at : work.attitudes) {  // Cayley: a turn by 2 atan(½ h |ω|)
      const double x = 0.5 * work.delta.segment<3>(at).norm();
      work.delta.segment<3>(at) *= x < 1e-8 ? 1.0 : std::atan(x) / x;
    }
    to.q = mid.q = from.q;
    move(system, work.delta, to.q);
    work.delta *= 0.5;
    move(system, work.delta, mid.q);
  };
  const auto apply = [&] {  // work.x to the speeds
    to.v += work.x;
    place();
    set_state(system, to.q, to.v, work.end);
  };
  place();
  set_state(system, to.q, to.v, work.end);
  for (;;) {
    set_state(system, mid.q, mid.v, dynamics.sweeps);
    for (std::size_t k = 0; k < system.bodies.size(); ++k) work.b[k] = dynamics.sweeps.bodies[k].b;
    apply_forces(dynamics, t + 0.5 * h, mid);
    if (work.iterations == 0) {
      const Energy e = energy(system, dynamics.sweeps, mid.q, mid.v);
      work.energy = std::max(work.energy, e.kinetic + e.elastic);
      factor(dynamics, mid, {0.5 * h, 0.25 * h * h}, work);
    }
    for (std::size_t k = 0; k < system.bodies.size(); ++k)
      imbalance(system, k, h, from.v, mid.v, to.v, work, dynamics.sweeps.bodies[k]);
    gather(system, dynamics.sweeps, work.r);
    work.r -= h * dynamics.T;
    for (std::size_t k = 0; k < system.bodies.size(); ++k) {  // rotors
      const Index at = system.v_offset[k] + system.bodies[k].modes();
      for (Index j = 0; j < system.bodies[k].dofs(); ++j)
        work.r[at + j] += system.bodies[k].inertia[j] * (to.v[at + j] - from.v[at + j]);
    }
    if (floats && !dynamics.sweeps.stiffening)
      balance_energy(dynamics, h, energy(system, work.end, to.q, to.v).total() - energy_before, mid, work);
    if (dynamics.loops()) {  // forces with J of the middle, positions closed at the end
      closure_rows(system, work.end, to.q, to.v, dynamics.rows);
      work.gap = dynamics.rows.gap;
      closure_rows(system, dynamics.sweeps, mid.q, mid.v, dynamics.rows);
      dynamics.rows.gap = work.gap;
      work.r.noalias() -= dynamics.rows.J_t * work.impulse;
    }
    const bool last = convergence.reached(correction(dynamics, 2.0 / h, work, work.impulse));
    apply();
    if (last) break;
  }
  if (dynamics.loops()) {
    close_speeds(dynamics, work.end, work, to);
    dynamics.lambda = work.impulse / h;
  }
  state.v_dot = (to.v - from.v) / h;
  state.motion.q = to.q;
  state.motion.v = to.v;
  std::swap(work.start, work.end);
}

}  // namespace tenon::assembly
