#pragma once

#include <limits>

#include "assembly/integration/dormand_prince.hpp"
#include "assembly/integration/events.hpp"
#include "assembly/integration/implicit.hpp"
#include "assembly/integration/method.hpp"

/// One door to all integrators: sampling, events, checkpoints, and what came out when a step fails.
namespace tenon::assembly {

struct IntegrationOptions {
  Method method = Method::generalized_alpha;
  double until = 1.0;     ///< [s]
  double step = 0.0;      ///< [s] of fixed steps, shortened to divide `sample`; adaptive: the first, 0: chosen; a run
                          ///< that goes on keeps its own
  double sample = 0.0;    ///< [s] between samples, counted from the begin; 0: every step
  Tolerance tolerance{};  ///< of adaptive methods
  ImplicitOptions implicit{};
  long most_steps = 1'000'000'000;  ///< of one call
  std::vector<Event> events{};
};

/// Everything a run continues from, bit for bit.
struct IntegrationState {
  double begin = 0.0;  ///< time of the first sample [s]
  double t = 0.0;
  long steps = 0;
  long samples = 0;                 ///< of the grid, already observed
  double seen = 0.0;                ///< time of the last sample, on the grid or at an end [s]
  double step = 0.0, sample = 0.0;  ///< as asked for [s]
  ImplicitState at;
  Eigen::VectorXd lambda;  ///< forces of the closures, to start iterations from
  double h = 0.0;          ///< fixed: the step; adaptive: the next to try [s]
  double error = 1e-4;     ///< of the last adaptive step over the tolerance
  double energy = 0.0;     ///< the scale of corrections so far [J]
};

/// Checks the state. Throws ModelError as check_state() does.
IntegrationState begin(const Multibody& system, const MotionState& state, double t = 0.0);

/// What an observer sees: sweeps, forces and accelerations of this very state. Returning false stops the run.
struct Sample {
  double t;
  const MotionState& state;
  const Eigen::VectorXd& v_dot;
  Dynamics& dynamics;  ///< λ, sweeps: after forward_dynamics()
};
using Observer = std::function<bool(const Sample& sample)>;

struct Integration {
  std::string failure;     ///< why it ended early; empty when it did not
  std::string stopped_by;  ///< the event that ended it
  std::vector<EventHit> events;
  long steps = 0, rejected = 0, iterations = 0, evaluations = 0;
  int most_iterations = 0;  ///< of a step
  double worst_gap = 0.0;   ///< of the loops after any step, before projection [m]
};

using Keep = std::function<void(const IntegrationState&)>;

/// Integrates from `state` to options.until. Samples are observed at begin, begin + sample, ... and at the end.
/// `state` moves on to where a later call continues as if there had been no stop (the start of the step that reached
/// `until`, when that is none of its own); another `sample` counts from there. `keep`, when given, sees it after every
/// step. Failures of a step, and `most_steps`, end the run and are told in the result; what was observed stands.
/// Throws ModelError for options that make no sense, and what the first evaluation throws.
Integration integrate(const Multibody& system, const Loads& loads, IntegrationState& state,
                      const IntegrationOptions& options, const Observer& observer, const Keep& keep = {});

}  // namespace tenon::assembly
