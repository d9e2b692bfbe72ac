#include "assembly/integration/dynamics.hpp"

#include <fmt/format.h>

#include <cmath>

#include "assembly/recursion/stiffening.hpp"
#include "fem/error.hpp"

namespace tenon::assembly {

using Eigen::Index;
using Eigen::VectorXd;

namespace {

// The body that a speed belongs to.
const HingedBody& owner(const Multibody& system, Index speed) {
  std::size_t k = system.bodies.size() - 1;
  while (k > 0 && system.v_offset[k] > speed) --k;
  return system.bodies[k];
}

// The closure that a row belongs to.
const Closure& closure_of(const Multibody& system, Index row) {
  auto closure = system.closures.begin();
  while (row >= 6 - hinge_dofs(closure->kind)) row -= 6 - hinge_dofs((closure++)->kind);
  return *closure;
}

void require_finite(const Multibody& system, const VectorXd& x, double t, const char* what, const char* cure) {
  for (Index i = 0; i < x.size(); ++i)
    if (!std::isfinite(x[i]))
      throw NumericalError(
          fmt::format("the {} of body '{}' at t = {:.6g} s is no number", what, owner(system, i).name, t), x[i], cure);
}

}  // namespace

Dynamics make_dynamics(const Multibody& system, Loads loads) {
  if (system.v_offset.size() != system.bodies.size() || system.bodies.empty())
    throw ModelError("the system's coordinates are not numbered", "Give it bodies and call index() first");
  Dynamics dynamics;
  dynamics.system = &system;
  dynamics.loads = std::move(loads);
  dynamics.sweeps = make_sweeps(system);
  if (!system.closures.empty()) dynamics.rows = make_closure_rows(system);
  dynamics.T = VectorXd::Zero(system.nv);
  dynamics.lambda = VectorXd::Zero(dynamics.rows.rows());
  return dynamics;
}

void set_forces(Dynamics& dynamics, double t, const MotionState& state) {
  set_state(*dynamics.system, state.q, state.v, dynamics.sweeps);
  apply_forces(dynamics, t, state);
}

void apply_forces(Dynamics& dynamics, double t, const MotionState& state) {
  const Multibody& system = *dynamics.system;
  passive_forces(system, state.q, state.v, dynamics.T);
  if (dynamics.loads) {
    dynamics.loads(t, state, dynamics.sweeps, dynamics.T);
    restiffen(system, state.q, dynamics.sweeps);
  }
  require_finite(system, dynamics.T, t, "force", "Look at the forces that act on it, or take smaller steps");
  ++dynamics.evaluations;
}

void accelerations(Dynamics& dynamics, double t, const MotionState& state, VectorXd& v_dot) {
  const Multibody& system = *dynamics.system;
  set_forces(dynamics, t, state);
  articulated_forward_dynamics(system, dynamics.sweeps, dynamics.T, v_dot);
  if (dynamics.loops()) {
    closure_rows(system, dynamics.sweeps, state.q, state.v, dynamics.rows);
    closure_inertia(system, dynamics.sweeps, dynamics.rows, dynamics.inertia);
    close(dynamics.rows, dynamics.inertia, v_dot, dynamics.lambda);
  }
  require_finite(system, v_dot, t, "acceleration", "Look at the forces that act on it, or take smaller steps");
}

void increment_rates(const Multibody& system, const VectorXd& u, const VectorXd& v, VectorXd& u_dot) {
  u_dot = v;
  for (std::size_t k = 0; k < system.bodies.size(); ++k) {
    const int first = attitude(system.bodies[k].kind);
    if (first < 0) continue;
    const Index at = system.v_offset[k] + system.bodies[k].modes() + first;
    const Vec3 phi = u.segment<3>(at), w = v.segment<3>(at), turn = phi.cross(w);
    const double angle2 = phi.squaredNorm(), half = 0.5 * std::sqrt(angle2);
    // (1 − x cot x)/(4x²), x = |u|/2: below x = 0.1 by series, the first term left out is below 1e-15
    const double c = half < 0.1 ? (1.0 + angle2 / 60.0 * (1.0 + angle2 / 42.0 * (1.0 + angle2 / 40.0))) / 12.0
                                : (1.0 - half / std::tan(half)) / angle2;
    u_dot.segment<3>(at) += 0.5 * turn + c * phi.cross(turn);
  }
}

std::vector<int> attitude_offsets(const Multibody& system) {
  std::vector<int> offsets;
  for (std::size_t k = 0; k < system.bodies.size(); ++k)
    if (const int first = attitude(system.bodies[k].kind); first >= 0)
      offsets.push_back(system.v_offset[k] + system.bodies[k].modes() + first);
  return offsets;
}

void check_state(Dynamics& dynamics, const MotionState& state) {
  const Multibody& system = *dynamics.system;
  if (state.q.size() != system.nq || state.v.size() != system.nv)
    throw ModelError(fmt::format("the initial state has {} coordinates and {} speeds where the system has {} and {}",
                                 state.q.size(), state.v.size(), system.nq, system.nv),
                     "Start from rest_state()");
  for (std::size_t k = 0; k < system.bodies.size(); ++k) {
    const HingedBody& b = system.bodies[k];
    const auto q = state.q.segment(system.q_offset[k], b.modes() + hinge_coordinates(b.kind));
    if (!q.allFinite() || !state.v.segment(system.v_offset[k], b.modes() + b.dofs()).allFinite())
      throw ModelError(fmt::format("the initial state of body '{}' is no number", b.name), "Give finite numbers");
    if (attitude(b.kind) >= 0 && std::abs(q.tail<4>().norm() - 1.0) > 1e-9)
      throw ModelError(
          fmt::format("the initial attitude of body '{}' is a quaternion of length {:.9g}", b.name, q.tail<4>().norm()),
          "Normalise it");
  }
  if (!dynamics.loops()) return;
  set_state(system, state.q, state.v, dynamics.sweeps);
  closure_rows(system, dynamics.sweeps, state.q, state.v, dynamics.rows);
  const double tolerance = 1e-6 * dynamics.rows.length;
  Index row = 0;
  if (const double gap = dynamics.rows.gap.cwiseAbs().maxCoeff(&row); gap > tolerance)
    throw ModelError(fmt::format("closure '{}' gapes by {:.3g} m at the start", closure_of(system, row).name, gap),
                     "Give hinge positions that close the loops, or project() the state first");
  check_sides(system, dynamics.rows);
  const double speed = std::max(1.0, state.v.cwiseAbs().maxCoeff());
  if (const double rate = dynamics.rows.rate.cwiseAbs().maxCoeff(&row); rate > tolerance * speed)
    throw ModelError(fmt::format("closure '{}' opens at {:.3g} m/s at the start", closure_of(system, row).name, rate),
                     "Give speeds that keep the loops closed, or project() the state first");
}

}  // namespace tenon::assembly
