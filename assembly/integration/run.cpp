#include "assembly/integration/run.hpp"

#include <fmt/format.h>

#include <cmath>

#include "fem/error.hpp"

namespace tenon::assembly {

void Run::observe(double t, const MotionState& at) {
  state.seen = t;
  if (!observer) return;
  accelerations(view, t, at, v_dot);
  if (!observer({t, at, v_dot, view})) stop = true;
}

void Run::observe_start() {
  if (state.samples > 0) return;
  observe(state.t, state.at.motion);
  state.samples = 1;
}

void Run::watch(double t, const MotionState& at) {
  before.resize(options.events.size());
  for (std::size_t k = 0; k < before.size(); ++k) before[k] = options.events[k].value(t, at);
}

std::optional<EventHit> Run::events(double t, double h, const MotionState& end, const Land& land) {
  if (before.empty()) return {};
  return find_events(options.events, before, {t, h, known, options.until}, end, land, result.events);
}

void Run::stop_at(const EventHit& hit) {
  result.stopped_by = hit.name;
  observe(hit.t, hit.state);
}

bool Run::may_step() {
  if (result.steps < options.most_steps) return true;
  result.failure = fmt::format("the run stops at t = {:.6g} s after {} steps, the most it may take. Allow more",
                               state.t, result.steps);
  return false;
}

void choose_step(const IntegrationOptions& options, IntegrationState& state) {
  if (state.h == 0.0) {
    if (!(options.step > 0.0)) throw ModelError("no step is given", "Methods with fixed steps need one: give --step");
    const double span = options.sample > 0.0 ? options.sample : options.until - state.begin;
    state.step = options.step;
    state.h = span > 0.0 ? span / std::max(1.0, std::ceil(span / options.step - 1e-9)) : options.step;
  }
  const double per_sample = options.sample / state.h;
  if (options.sample > 0.0 && (per_sample < 0.5 || std::abs(per_sample - std::round(per_sample)) > 1e-9 * per_sample))
    throw ModelError(
        fmt::format("samples every {:.9g} s do not fall on the run's steps of {:.9g} s", options.sample, state.h),
        "Give a multiple of the step, or start anew");
}

}  // namespace tenon::assembly
