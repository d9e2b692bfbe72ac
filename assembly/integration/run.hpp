#pragma once

#include "assembly/integration/integrate.hpp"

/// What all methods share of a run: rows, events, and the state that a later call continues from.
namespace tenon::assembly {

struct Run {
  const Multibody& system;
  const IntegrationOptions& options;
  const Observer& observer;
  const Keep& keep;
  IntegrationState& state;
  Dynamics dynamics, view;  ///< view: the observer's
  Eigen::VectorXd v_dot;
  double known = 0.0;  ///< an earlier call told the events up to here
  Integration result{};
  bool stop = false;             ///< the observer has seen enough
  std::vector<double> before{};  ///< values of the events at the start of the step

  /// Time of the row k of the samples' grid.
  double sample_time(long k) const { return state.begin + static_cast<double>(k) * options.sample; }
  /// A row, and the first of all if there was none.
  void observe(double t, const MotionState& at);
  void observe_start();
  /// Events: their values at the start of a step, then the first that stops the run within it.
  void watch(double t, const MotionState& at);
  std::optional<EventHit> events(double t, double h, const MotionState& end, const Land& land);
  /// Ends the run at an event.
  void stop_at(const EventHit& hit);
  /// False, and said in the result, when `most_steps` are taken.
  bool may_step();
};

/// Of generalised-α and midpoint: fills in state.h. Throws ModelError when there is no step, or when samples do not
/// fall on steps.
void choose_step(const IntegrationOptions& options, IntegrationState& state);

void run_fixed_steps(Run& run);
void run_adaptive(Run& run);

}  // namespace tenon::assembly
