#include <algorithm>
#include <cmath>

#include "assembly/integration/run.hpp"

namespace tenon::assembly {

using Eigen::VectorXd;

void run_fixed_steps(Run& run) {
  IntegrationState& state = run.state;
  const IntegrationOptions& options = run.options;
  const bool alpha = options.method == Method::generalized_alpha;
  const double h = state.h, close = 1e-9 * h;
  const long per_sample = options.sample > 0.0 ? std::lround(options.sample / h) : 1L;
  if (state.steps == 0) {
    accelerations(run.dynamics, state.t, state.at.motion, state.at.v_dot);
    state.at.a = state.at.v_dot;
    state.lambda = run.dynamics.lambda;
  }
  ImplicitWork work = make_implicit_work(run.dynamics);
  ImplicitState to, landed;
  const auto step = [&](double length, ImplicitState& at) {  // from `state`, which stays
    at = state.at;
    run.dynamics.lambda = state.lambda;
    work.energy = state.energy;
    (alpha ? generalized_alpha_step : midpoint_step)(run.dynamics, state.t, length, options.implicit, work, at);
  };
  const Land land = [&](double length) -> const MotionState& {
    work.started = false;
    step(length, landed);
    work.started = false;
    return landed.motion;
  };
  run.observe_start();
  VectorXd lambda;
  while (!run.stop && state.t + h <= options.until + close && run.may_step()) {
    run.watch(state.t, state.at.motion);
    step(h, to);
    run.result.iterations += work.iterations;
    run.result.most_iterations = std::max(run.result.most_iterations, work.iterations);
    run.result.worst_gap = std::max(run.result.worst_gap, work.gap_left);
    lambda = run.dynamics.lambda;
    const double energy = work.energy;
    if (const auto hit = run.events(state.t, h, to.motion, land)) return run.stop_at(*hit);
    std::swap(state.at, to);
    state.lambda = lambda;
    state.energy = energy;
    ++state.steps;
    ++run.result.steps;
    state.t = state.begin + static_cast<double>(state.steps) * h;
    if (state.steps % per_sample == 0) {
      run.observe(state.t, state.at.motion);
      ++state.samples;
    }
    if (run.keep) run.keep(state);
  }
  if (run.stop || !run.result.failure.empty() || state.seen >= options.until - close) return;
  if (const double rest = options.until - state.t; rest > close) {  // no whole step: seen, but not gone
    run.watch(state.t, state.at.motion);
    const MotionState end = land(rest);
    if (const auto hit = run.events(state.t, rest, end, land)) return run.stop_at(*hit);
    run.observe(options.until, end);
  } else {
    run.observe(state.t, state.at.motion);
  }
}

}  // namespace tenon::assembly
