#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>

#include "assembly/integration/run.hpp"
#include "fem/error.hpp"

namespace tenon::assembly {

void run_adaptive(Run& run) {
  IntegrationState& state = run.state;
  const IntegrationOptions& options = run.options;
  const bool loops = run.dynamics.loops();
  DormandPrince work = make_dormand_prince(run.system);
  MotionState to = state.at.motion, at = to;
  if (state.h == 0.0) {
    state.step = options.step;
    state.h = options.step > 0.0 ? options.step
                                 : first_step(run.dynamics, state.t, state.at.motion, options.tolerance,
                                              std::max(1e-300, options.until - state.t), work);
  }
  accelerations(run.dynamics, state.t, state.at.motion, work.v_dot[0]);
  run.observe_start();
  bool rejected = false;
  double tried = state.h;  // first of the step: where a call that ends within it leaves the next one
  std::string fault;       // of the trials since the last step
  while (!run.stop && state.t < options.until && run.may_step()) {
    const double h = state.h;
    if (!(h > 16.0 * std::numeric_limits<double>::epsilon() * std::abs(state.t)) || !(h > 0.0)) {
      state.h = tried;
      throw NumericalError(
          fmt::format("steps shrink to nothing at t = {:.6g} s{}{}", state.t, fault.empty() ? "" : ": ", fault), h,
          "Look for forces that jump or stiff springs there, or use --method generalized-alpha");
    }
    double error = std::numeric_limits<double>::infinity();
    try {
      error = try_step(run.dynamics, state.t, state.at.motion, h, options.tolerance, work, to);
    } catch (const Error& failed) {  // overflow within a step that is too long, perhaps
      fault = failed.what();
    }
    if (!(error <= 1.0)) {
      const double factor = std::isfinite(error) ? std::max(0.2, 0.9 * std::pow(error, -0.2)) : 0.1;
      state.h = h * factor;
      ++run.result.rejected;
      rejected = true;
      continue;
    }
    fault.clear();
    // PI control (Hairer, Wanner, IV.2): exponents 0.2 − 0.75·0.04 and 0.04
    const double factor = 0.9 * std::pow(std::max(error, 1e-10), -0.17) * std::pow(std::max(state.error, 1e-4), 0.04);
    const double next = h * std::clamp(factor, 0.2, rejected ? 1.0 : 10.0);
    rejected = false;
    const auto land = [&](double length) -> const MotionState& {
      interpolate(run.system, work, state.at.motion, std::min(1.0, length / h), at);
      if (loops) project(run.system, run.view.sweeps, run.view.rows, at);
      return at;
    };
    run.watch(state.t, state.at.motion);
    const auto hit = run.events(state.t, h, to, std::cref(land));
    const bool last = state.t + h >= options.until;
    const double end = hit ? hit->t : last ? options.until : state.t + h;
    if (options.sample > 0.0)
      for (; !run.stop; ++state.samples) {
        const double t = run.sample_time(state.samples);
        if (hit ? t >= end : t > end * (1.0 + 1e-15)) break;
        run.observe(std::min(end, t), land(std::min(end, t) - state.t));
      }
    if (!hit && !run.stop) ++run.result.steps;
    if (run.stop || hit || last) {
      state.h = tried;
      if (hit && !run.stop)
        run.stop_at(*hit);
      else if (!run.stop && state.seen < end - 1e-9 * h)
        run.observe(end, land(end - state.t));
      return;
    }
    state.at.motion = to;
    state.t += h;
    state.h = tried = next;
    state.error = std::max(error, 1e-4);
    ++state.steps;
    if (loops) {
      run.result.worst_gap =
          std::max(run.result.worst_gap, project(run.system, run.dynamics.sweeps, run.dynamics.rows, state.at.motion));
      accelerations(run.dynamics, state.t, state.at.motion, work.v_dot[0]);
    } else {
      std::swap(work.v_dot[0], work.v_dot[6]);
    }
    if (options.sample == 0.0) {
      run.observe(state.t, state.at.motion);
      ++state.samples;
    }
    if (run.keep) run.keep(state);
  }
}

}  // namespace tenon::assembly
