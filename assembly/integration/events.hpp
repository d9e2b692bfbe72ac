#pragma once

#include <functional>
#include <optional>
#include <string>

#include "assembly/recursion/multibody.hpp"

/// Times at which something happens within the steps of a run.
namespace tenon::assembly {

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

/// A state within a step, by the length from the step's start.
using Land = std::function<const MotionState&(double length)>;

/// The time and state where `value` crosses zero within a step of `h` from `t` (a sign change is known to be there, or
/// a zero at its end): bracketed to 1e-12 of max(1 s, t).
EventHit locate(const Event& event, double t, double h, double before, double after, const Land& land);

/// A step as events see it: from t to t + h, where they are looked for in (after, until].
struct EventWindow {
  double t, h, after, until;
};

/// Adds to `hits` what happens within a step, `before` holding the values at its start, and returns the first that
/// stops the run; nothing later than that is added. A zero at the end of the step belongs to it, one at its start does
/// not. Events that stop are not held to `window.after`: a later call comes to them again.
std::optional<EventHit> find_events(const std::vector<Event>& events, const std::vector<double>& before,
                                    const EventWindow& window, const MotionState& end, const Land& land,
                                    std::vector<EventHit>& hits);

}  // namespace tenon::assembly
