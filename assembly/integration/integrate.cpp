#include "assembly/integration/integrate.hpp"

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <optional>

#include "assembly/integration/cvode.hpp"
#include "fem/error.hpp"

namespace tenon::assembly {

using Eigen::VectorXd;

namespace {

constexpr std::array<std::pair<Method, const char*>, 5> names{{{Method::generalized_alpha, "generalized-alpha"},
                                                               {Method::midpoint, "midpoint"},
                                                               {Method::dormand_prince, "dormand-prince"},
                                                               {Method::bdf, "bdf"},
                                                               {Method::adams, "adams"}}};

// A run: the parts that all methods share.
struct Run {
  const Multibody& system;
  const IntegrationOptions& options;
  const Observer& observer;
  const std::function<void(const IntegrationState&)>& keep;
  IntegrationState& state;
  Dynamics dynamics, view;  // the view is the observer's
  VectorXd v_dot;
  Integration result;
  bool stop = false;
  std::vector<double> before;  // values of the events at the start of the step

  double sample_time(long k) const { return state.begin + static_cast<double>(k) * options.sample; }

  void observe(double t, const MotionState& at) {
    if (!observer) return;
    accelerations(view, t, at, v_dot);
    if (!observer({t, at, v_dot, view})) stop = true;
  }

  void watch(double t, const MotionState& at) {
    before.resize(options.events.size());
    for (std::size_t k = 0; k < before.size(); ++k) before[k] = options.events[k].value(t, at);
  }

  // The first event that stops the run within a step from t to t + h, or none; others are kept.
  std::optional<EventHit> events(double t, double h, const MotionState& after,
                                 const std::function<const MotionState&(double)>& land) {
    std::optional<EventHit> first;
    for (std::size_t k = 0; k < before.size(); ++k) {
      const Event& event = options.events[k];
      const double value = event.value(t + h, after);
      if (before[k] == 0.0 || (before[k] > 0.0) == (value > 0.0)) continue;
      EventHit hit = locate(event, t, h, before[k], value, land);
      if (event.stop && (!first || hit.t < first->t)) first = hit;
      result.events.push_back(std::move(hit));
    }
    if (first) std::erase_if(result.events, [&](const EventHit& hit) { return hit.t > first->t; });
    return first;
  }
};

void fixed(Run& run) {
  IntegrationState& state = run.state;
  const IntegrationOptions& options = run.options;
  const bool alpha = options.method == Method::generalized_alpha;
  if (state.h == 0.0) {
    if (!(options.step > 0.0)) throw ModelError("no step is given", "Methods with fixed steps need one: give --step");
    const double span = options.sample > 0.0 ? options.sample : options.until - state.begin;
    state.h = span / std::max(1.0, std::ceil(span / options.step - 1e-9));
    accelerations(run.dynamics, state.t, state.at.motion, state.at.v_dot);
    state.at.a = state.at.v_dot;
    state.lambda = run.dynamics.lambda;
  }
  const double h = state.h;
  const long per_sample = options.sample > 0.0 ? std::max(1L, static_cast<long>(std::lround(options.sample / h))) : 1L;
  ImplicitWork work = make_implicit_work(run.dynamics);
  run.dynamics.lambda = state.lambda;
  work.energy = state.energy;
  ImplicitState from = state.at;
  const auto step = [&](double length, ImplicitState& at) {
    (alpha ? generalized_alpha_step : midpoint_step)(run.dynamics, state.t, length, options.implicit, work, at);
  };
  if (state.steps == 0 && state.samples == 0) run.observe(state.t, state.at.motion), state.samples = 1;
  while (!run.stop && state.t < options.until - 1e-9 * h && state.steps < options.most_steps) {
    run.watch(state.t, state.at.motion);
    from = state.at;
    step(h, state.at);
    run.result.iterations += work.iterations;
    run.result.most_iterations = std::max(run.result.most_iterations, work.iterations);
    run.result.worst_gap = std::max(run.result.worst_gap, work.gap_left);
    if (!run.before.empty()) {
      const VectorXd lambda = run.dynamics.lambda;
      ImplicitState landed;
      const auto hit = run.events(state.t, h, state.at.motion, [&](double length) -> const MotionState& {
        landed = from;
        work.started = false;
        step(length, landed);
        work.started = false;
        return landed.motion;
      });
      run.dynamics.lambda = lambda;
      if (hit) {
        run.result.stopped_by = hit->name;
        run.observe(hit->t, hit->state);
        state.at = from;  // a later call comes to the event again
        return;
      }
    }
    ++state.steps;
    ++run.result.steps;
    state.t = state.begin + static_cast<double>(state.steps) * h;
    state.lambda = run.dynamics.lambda;
    state.energy = work.energy;
    if (state.steps % per_sample == 0) run.observe(state.t, state.at.motion), ++state.samples;
    if (run.keep) run.keep(state);
  }
}

void adaptive(Run& run) {
  IntegrationState& state = run.state;
  const IntegrationOptions& options = run.options;
  const bool loops = run.dynamics.loops();
  DormandPrince work = make_dormand_prince(run.system);
  MotionState to = state.at.motion, at = to;
  if (state.h == 0.0)
    state.h = options.step > 0.0 ? options.step
                                 : first_step(run.dynamics, state.t, state.at.motion, options.tolerance,
                                              std::max(1e-300, options.until - state.t), work);
  accelerations(run.dynamics, state.t, state.at.motion, work.v_dot[0]);
  if (state.samples == 0) run.observe(state.t, state.at.motion), state.samples = 1;
  bool rejected = false;
  while (!run.stop && state.t < options.until && state.steps < options.most_steps) {
    const double h = state.h;
    if (!(h > 16.0 * std::numeric_limits<double>::epsilon() * std::abs(state.t)) || !(h > 0.0))
      throw NumericalError(fmt::format("steps shrink to nothing at t = {:.6g} s", state.t), h,
                           "Look for forces that jump or stiff springs there, or use --method generalized-alpha");
    double error = std::numeric_limits<double>::infinity();
    try {
      error = try_step(run.dynamics, state.t, state.at.motion, h, options.tolerance, work, to);
    } catch (const NumericalError&) {  // overflow within a step that is too long
    }
    if (!(error <= 1.0)) {
      const double factor = std::isfinite(error) ? std::max(0.2, 0.9 * std::pow(error, -0.2)) : 0.1;
      state.h = h * factor;
      ++run.result.rejected;
      rejected = true;
      continue;
    }
    // PI control (Hairer, Wanner, IV.2): exponents 0.2 − 0.75·0.04 and 0.04
    const double factor = 0.9 * std::pow(std::max(error, 1e-10), -0.17) * std::pow(std::max(state.error, 1e-4), 0.04);
    const double next = h * std::clamp(factor, 0.2, rejected ? 1.0 : 10.0);
    rejected = false;
    if (!options.events.empty()) {
      run.watch(state.t, state.at.motion);
      const auto hit = run.events(state.t, h, to, [&](double length) -> const MotionState& {
        interpolate(run.system, work, state.at.motion, length / h, at);
        return at;
      });
      if (hit && hit->t <= options.until) {
        for (; options.sample > 0.0 && run.sample_time(state.samples) < hit->t && !run.stop; ++state.samples) {
          interpolate(run.system, work, state.at.motion, (run.sample_time(state.samples) - state.t) / h, at);
          run.observe(run.sample_time(state.samples), at);
        }
        run.result.stopped_by = hit->name;
        run.observe(hit->t, hit->state);
        return;
      }
    }
    const bool last = state.t + h >= options.until;
    const auto show = [&](double t) {
      interpolate(run.system, work, state.at.motion, std::min(1.0, (t - state.t) / h), at);
      if (loops) project(run.system, run.view.sweeps, run.view.rows, at);
      run.observe(t, at);
    };
    const double end = last ? options.until : state.t + h;
    double seen = state.t;
    if (options.sample > 0.0)
      for (; run.sample_time(state.samples) <= end * (1.0 + 1e-15) && !run.stop; ++state.samples)
        show(seen = std::min(end, run.sample_time(state.samples)));
    if (last) {
      if (seen < end - 1e-9 * h && !run.stop) show(end);
      ++run.result.steps;
      return;
    }
    state.at.motion = to;
    state.t += h;
    state.h = next;
    state.error = std::max(error, 1e-4);
    ++state.steps;
    ++run.result.steps;
    if (loops) {
      run.result.worst_gap =
          std::max(run.result.worst_gap, project(run.system, run.dynamics.sweeps, run.dynamics.rows, state.at.motion));
      accelerations(run.dynamics, state.t, state.at.motion, work.v_dot[0]);
    } else {
      std::swap(work.v_dot[0], work.v_dot[6]);
    }
    if (options.sample == 0.0) run.observe(state.t, state.at.motion), ++state.samples;
    if (run.keep) run.keep(state);
  }
}

}  // namespace

std::string name(Method method) {
  for (const auto& [m, word] : names)
    if (m == method) return word;
  return {};
}

Method method_named(const std::string& word) {
  for (const auto& [m, known] : names)
    if (word == known) return m;
  throw InputError({"method"}, fmt::format("there is no method '{}'", word),
                   "Choose generalized-alpha, midpoint, dormand-prince, bdf or adams");
}

bool fixed_steps(Method method) { return method == Method::generalized_alpha || method == Method::midpoint; }

IntegrationState begin(const Multibody& system, const MotionState& state, double t) {
  Dynamics dynamics = make_dynamics(system);
  check_state(dynamics, state);
  IntegrationState start;
  start.begin = start.t = t;
  start.at = {state, VectorXd::Zero(system.nv), VectorXd::Zero(system.nv)};
  start.lambda = VectorXd::Zero(dynamics.rows.rows());
  return start;
}

EventHit locate(const Event& event, double t, double h, double before, double after,
                const std::function<const MotionState&(double step)>& land) {
  double low = 0.0, high = h, f_low = before, f_high = after;  // Illinois: regula falsi that halves the stale side
  const double tolerance = 1e-12 * std::max(1.0, std::abs(t));
  const MotionState* at = nullptr;
  double x = h;
  for (int k = 0; k < 200 && (high - low > tolerance || !at); ++k) {
    x = k % 3 == 2 ? 0.5 * (low + high) : (low * f_high - high * f_low) / (f_high - f_low);  // and now and then halves
    if (!(x > low) || !(x < high)) x = 0.5 * (low + high);
    at = &land(x);
    const double f = event.value(t + x, *at);
    if (f == 0.0) break;
    if ((f > 0.0) == (f_high > 0.0)) {
      high = x;
      f_high = f;
      f_low *= 0.5;
    } else {
      low = x;
      f_low = f;
      f_high *= 0.5;
    }
  }
  return {event.name, t + x, *at};
}

Integration integrate(const Multibody& system, const Loads& loads, IntegrationState& state,
                      const IntegrationOptions& options, const Observer& observer,
                      const std::function<void(const IntegrationState&)>& keep) {
  if (!std::isfinite(options.until) || options.until < state.t)
    throw ModelError(fmt::format("the run shall end at {:.6g} s, before it begins at {:.6g} s", options.until, state.t),
                     "Give a later time");
  if (options.sample < 0.0 || options.step < 0.0 || !(options.tolerance.relative > 0.0))
    throw ModelError("a step, a sampling interval or a tolerance is negative", "Give positive numbers");
  Run run{system,
          options,
          observer,
          keep,
          state,
          make_dynamics(system, loads),
          make_dynamics(system, loads),
          VectorXd::Zero(system.nv),
          {},
          false,
          {}};
  try {
    if (fixed_steps(options.method))
      fixed(run);
    else if (options.method == Method::dormand_prince)
      adaptive(run);
    else
      integrate_cvode(system, run.dynamics, state, options, run.result, [&](double t, const MotionState& at) {
        run.observe(t, at);
        return !run.stop;
      });
  } catch (const NumericalError& fault) {
    run.result.failure = fault.what();
  }
  run.result.evaluations = run.dynamics.evaluations;
  return std::move(run.result);
}

}  // namespace tenon::assembly
