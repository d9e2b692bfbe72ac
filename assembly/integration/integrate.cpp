#include "assembly/integration/integrate.hpp"

#include <fmt/format.h>

#include <cmath>

#include "assembly/integration/cvode.hpp"
#include "fem/error.hpp"

namespace tenon::assembly {

using Eigen::VectorXd;

namespace {

void check(const IntegrationOptions& options, const IntegrationState& state, bool loops) {
  if (!std::isfinite(options.until) || options.until < state.t)
    throw ModelError(fmt::format("the run shall end at {:.6g} s, before it begins at {:.6g} s", options.until, state.t),
                     "Give a later time");
  const auto demand = [](bool good, const char* what, double value, const char* cure) {
    if (!good) throw ModelError(fmt::format("{} is {:.6g}", what, value), cure);
  };
  const auto size = [&](const char* what, double x) {
    demand(std::isfinite(x) && x >= 0.0, what, x, "Give a positive number of seconds, or 0 to have it chosen");
  };
  size("the step", options.step);
  size("the time between samples", options.sample);
  const auto tolerance = [&](const char* what, double x) {
    demand(std::isfinite(x) && x > 0.0, what, x, "Give a positive number");
  };
  tolerance("the relative tolerance", options.tolerance.relative);
  tolerance("the absolute tolerance", options.tolerance.absolute);
  const double rho = options.implicit.rho_infinity, newton = options.implicit.tolerance;
  demand(rho >= 0.0 && rho <= 1.0, "rho_infinity", rho, "Give a number from 0 (most damping) to 1 (none)");
  demand(std::isfinite(newton) && newton >= 0.0, "the tolerance of implicit steps", newton, "Give a positive number");
  const bool kept = fixed_steps(options.method) || options.method == Method::dormand_prince;
  if (kept && state.h > 0.0 && options.step > 0.0 && options.step != state.step)
    throw ModelError(fmt::format("the run goes on with its own step of {:.6g} s, and another of {:.6g} s is given",
                                 state.h, options.step),
                     "Leave the step out, or start anew");
  if (loops && options.method == Method::adams)
    throw ModelError("adams takes no closed loops", "Use --method bdf, or generalized-alpha with --step");
}

// Rows go on at the first time of another grid that has not been seen.
void choose_samples(const IntegrationOptions& options, IntegrationState& state) {
  if (state.samples > 0 && options.sample > 0.0 && options.sample != state.sample)
    state.samples = 1 + static_cast<long>(std::floor((state.seen - state.begin) / options.sample * (1.0 + 1e-12)));
  state.sample = options.sample;
}

}  // namespace

IntegrationState begin(const Multibody& system, const MotionState& state, double t) {
  Dynamics dynamics = make_dynamics(system);
  check_state(dynamics, state);
  IntegrationState start;
  start.begin = start.t = start.seen = t;
  start.at = {state, VectorXd::Zero(system.nv), VectorXd::Zero(system.nv)};
  start.lambda = VectorXd::Zero(dynamics.rows.rows());
  return start;
}

Integration integrate(const Multibody& system, const Loads& loads, IntegrationState& state,
                      const IntegrationOptions& options, const Observer& observer, const Keep& keep) {
  Run run{system,
          options,
          observer,
          keep,
          state,
          make_dynamics(system, loads),
          make_dynamics(system, loads),
          VectorXd::Zero(system.nv),
          state.samples > 0 ? state.seen : -std::numeric_limits<double>::infinity()};
  check(options, state, run.dynamics.loops());
  if (fixed_steps(options.method)) choose_step(options, state);
  choose_samples(options, state);
  try {
    if (fixed_steps(options.method))
      run_fixed_steps(run);
    else if (options.method == Method::dormand_prince)
      run_adaptive(run);
    else
      run_cvode(run);
  } catch (const Error& fault) {
    if (state.samples == 0) throw;  // there is nothing to keep
    run.result.failure = fault.what();
  }
  run.result.evaluations = run.dynamics.evaluations;
  return std::move(run.result);
}

}  // namespace tenon::assembly
