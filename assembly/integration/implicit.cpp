#include "assembly/integration/implicit.hpp"

#include <fmt/format.h>

#include <cmath>

#include "fem/error.hpp"

namespace tenon::assembly {

using Eigen::VectorXd;

ImplicitWork make_implicit_work(const Dynamics& dynamics) {
  const Multibody& system = *dynamics.system;
  ImplicitWork work;
  work.matrix = work.start = work.end = dynamics.sweeps;
  work.r = work.x = work.a = work.v_dot = work.delta = VectorXd::Zero(system.nv);
  work.gap = work.impulse = work.change = VectorXd::Zero(dynamics.rows.rows());
  work.mid = work.next = rest_state(system);
  work.attitudes = attitude_offsets(system);
  for (const BodySweep& s : dynamics.sweeps.bodies) work.b.push_back(s.b);
  return work;
}

void factor(Dynamics& dynamics, const MotionState& state, const ImplicitTerms& terms, ImplicitWork& work) {
  set_state(*dynamics.system, state.q, state.v, work.matrix);
  articulate(*dynamics.system, work.matrix, terms);
  if (!dynamics.loops()) return;
  closure_rows(*dynamics.system, work.matrix, state.q, state.v, dynamics.rows);
  closure_inertia(*dynamics.system, work.matrix, dynamics.rows, work.inertia);
}

CorrectionSize correction(Dynamics& dynamics, double per_gap, ImplicitWork& work, VectorXd& force) {
  solve(*dynamics.system, work.matrix, work.r, work.x);
  work.x = -work.x;
  const double forces = -work.x.dot(work.r);
  if (!dynamics.loops()) return {forces, forces};
  work.gap_left = dynamics.rows.gap.cwiseAbs().maxCoeff();
  dynamics.rows.gamma = per_gap * dynamics.rows.gap;
  close(dynamics.rows, work.inertia, work.x, work.change);
  force += work.change;
  work.delta.noalias() = dynamics.rows.J_t * work.change;
  return {work.x.dot(work.delta - work.r), forces};
}

void close_speeds(Dynamics& dynamics, Sweeps& sweeps, ImplicitWork& work, MotionState& state) {
  for (int pass = 0; pass < 4; ++pass) {
    set_state(*dynamics.system, state.q, state.v, sweeps);
    closure_rows(*dynamics.system, sweeps, state.q, state.v, dynamics.rows);
    work.gap_left = dynamics.rows.gap.cwiseAbs().maxCoeff();
    const double size = std::max(1e-300, state.v.cwiseAbs().maxCoeff() * dynamics.rows.length);
    if (dynamics.rows.rate.cwiseAbs().maxCoeff() <= 1e-14 * size) return;
    dynamics.rows.gamma = dynamics.rows.rate;
    work.x.setZero();
    close(dynamics.rows, work.inertia, work.x, work.change);
    state.v += work.x;
  }
  set_state(*dynamics.system, state.q, state.v, sweeps);
}

bool Convergence::reached(const CorrectionSize& correction) {
  constexpr double round_off = 1e-11;  // corrections that shrink no more below this share are round-off
  const double size2 = correction.all, size = std::sqrt(std::abs(size2));
  const int count = ++work.iterations;
  if (!std::isfinite(size2))
    throw NumericalError(fmt::format("the step of {:.3g} s from t = {:.6g} s does not converge", h, t), size2,
                         "Take smaller steps");
  work.energy = std::max(work.energy, 0.5 * size2);
  const double scale = std::sqrt(2.0 * work.energy);
  const double rate = count > 1 && last > 0.0 ? size / last : 1.0;
  // what is left after this correction: size × rate/(1 − rate)
  const bool done = size <= tolerance * scale || (rate < 0.5 && size * rate / (1.0 - rate) <= tolerance * scale) ||
                    (rate > 0.5 && std::sqrt(std::abs(correction.forces)) <= round_off * scale &&
                     (size <= round_off * scale || work.gap_left <= closed));
  last = size;
  if (!done && count >= most_iterations)
    throw NumericalError(fmt::format("the step of {:.3g} s from t = {:.6g} s does not converge in {} iterations; the "
                                     "last corrects speeds by this share",
                                     h, t, count),
                         size / scale, "Take smaller steps");
  return done;
}

}  // namespace tenon::assembly
