#pragma once

#include "titop/state_space.hpp"

namespace tenon::titop {

/// y = G₂ G₁ u: the outputs of `first` drive the inputs of `second` in their order. Names: inputs of `first`, outputs
/// of `second`. Throws ModelError where numbers or units of the channels joined differ (an empty unit fits any).
StateSpace series(const StateSpace& first, const StateSpace& second);

/// y = (G₁ + G₂) u: both see the same inputs, outputs add. Names are those of `first`. Throws ModelError where numbers
/// or units of the channels differ.
StateSpace parallel(const StateSpace& first, const StateSpace& second);

}  // namespace tenon::titop
