#pragma once

#include <limits>

#include "assembly/integration/dormand_prince.hpp"
#include "assembly/integration/implicit.hpp"

/// One door to all integrators: sampling, events, checkpoints, and what came out when a step fails.
namespace tenon::assembly {

enum class Method {
  generalized_alpha,  ///< fixed steps; stiff modes that a step does not resolve are damped
  midpoint,           ///< fixed steps; keeps momentum and, but for bounded swings, energy: long conservative runs
  dormand_prince,     ///< adaptive, explicit, order 5: rigid or soft systems to any tolerance
  bdf,                ///< SUNDIALS CVODE, orders 1 to 5, stiff: the reference
  adams,              ///< SUNDIALS CVODE, orders 1 to 12, not stiff: the reference
};

std::string name(Method method);
/// By the names of name(). Throws InputError with the choice.
Method method_named(const std::string& word);
/// Takes steps of one size.
bool fixed_steps(Method method);

/// Zero where something happens, e.g. a height above ground.
struct Event {
  std::string name;
  std::function<double(double t, const MotionState& state)> value;
  bool stop = true;
};

struct EventHit {
  std::string name;
  double t = 0.0;
  MotionState state;
};

struct IntegrationOptions {
  Method method = Method::generalized_alpha;
  double until = 1.0;     ///< [s]
  double step = 0.0;      ///< [s] of fixed steps, shortened to divide `sample`; adaptive: the first, 0: chosen
  double sample = 0.0;    ///< [s] between samples; 0: every step
  Tolerance tolerance{};  ///< of adaptive methods
  ImplicitOptions implicit{};
  long most_steps = 1'000'000'000;
  std::vector<Event> events{};
};

/// Everything a run continues from, bit for bit.
struct IntegrationState {
  double begin = 0.0;  ///< time of the first sample [s]
  double t = 0.0;
  long steps = 0;
  long samples = 0;  ///< already observed
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

/// Integrates from `state` to options.until. Samples are observed at begin, begin + sample, ... and at the end.
/// `state` moves on to where a later call continues as if there had been no stop (adaptive methods: the start of the
/// step that reached `until`). `keep`, when given, sees it after every step. Failures of a step end the run and are
/// told in the result; what was observed stands. Throws ModelError for options that make no sense.
Integration integrate(const Multibody& system, const Loads& loads, IntegrationState& state,
                      const IntegrationOptions& options, const Observer& observer,
                      const std::function<void(const IntegrationState&)>& keep = {});

/// The time and state where `value` crosses zero within a step of `h` from `from` (a sign change is known to be there),
/// by steps that land on it: bracketed to 1e-12 of max(1 s, t). `land` takes a step of the given size.
EventHit locate(const Event& event, double t, double h, double before, double after,
                const std::function<const MotionState&(double step)>& land);

}  // namespace tenon::assembly
