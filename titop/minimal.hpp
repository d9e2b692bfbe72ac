#pragma once

#include "titop/state_space.hpp"

namespace tenon::titop {

/// A system without the states that its inputs cannot move or its outputs cannot see, and what was taken out.
struct Minimal {
  StateSpace ss;
  Eigen::VectorXcd uncontrollable, unobservable;  ///< the poles removed [rad/s]
  double least_kept = 0.0;       ///< smallest pivot that counted as a coupling, of the normalised system (norm about 1)
  double largest_dropped = 0.0;  ///< largest that counted as none; near `least_kept` the order is a matter of opinion
};

/// Minimal realisation: states that exact zeros of A, B and C cut off from every input or output go first, without
/// rounding; then by orthogonal staircases: of (A, B) for the uncontrollable states, of the dual for the
/// unobservable ones; no Gramians, so stable, marginally stable and unstable systems alike. A coupling counts as none
/// below `tolerance` of the normalised system (titop/balance.hpp). Names and units of the channels stay; the states are
/// orthogonal combinations of the balanced ones. Where zeros of A do not show it, a staircase over three or more
/// decades of frequency may keep a hidden state: look at the pivots. Van Dooren, IEEE Trans. Autom. Control 26 (1981)
/// 111–129.
Minimal minimal(const StateSpace& ss, double tolerance = 1e-10);

}  // namespace tenon::titop
