#include "assembly/integration/events.hpp"

#include <algorithm>
#include <cmath>

namespace tenon::assembly {

EventHit locate(const Event& event, double t, double h, double before, double after, const Land& land) {
  if (after == 0.0) return {event.name, t + h, land(h)};
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
    if ((f > 0.0) != (before > 0.0)) {
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

std::optional<EventHit> find_events(const std::vector<Event>& events, const std::vector<double>& before,
                                    const EventWindow& window, const MotionState& end, const Land& land,
                                    std::vector<EventHit>& hits) {
  std::optional<EventHit> first;
  std::vector<EventHit> found;
  for (std::size_t k = 0; k < events.size(); ++k) {
    const Event& event = events[k];
    const double value = event.value(window.t + window.h, end);
    if (before[k] == 0.0 || (value != 0.0 && (before[k] > 0.0) == (value > 0.0))) continue;
    EventHit hit = locate(event, window.t, window.h, before[k], value, land);
    if (hit.t > window.until || (!event.stop && hit.t <= window.after)) continue;
    if (event.stop && (!first || hit.t < first->t)) first = hit;
    found.push_back(std::move(hit));
  }
  for (EventHit& hit : found)
    if (!first || hit.t <= first->t) hits.push_back(std::move(hit));
  return first;
}

}  // namespace tenon::assembly
