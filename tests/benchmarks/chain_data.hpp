#pragma once

#include <cmath>

/// The chain that every program of the comparison builds: links of 1 m on revolute hinges about z; the axis of every
/// second one is tilted about x.
namespace tenon::bench {

inline constexpr double mass = 2.0, length = 1.0, inertia = 0.2, tilt = 1.0;

inline double bend(long i) { return 0.1 * std::sin(1.0 + static_cast<double>(i)); }

}  // namespace tenon::bench
