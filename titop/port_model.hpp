#pragma once

#include <vector>

#include "reduction/reduced_body.hpp"
#include "titop/state_space.hpp"

namespace tenon::titop {

/// Eq (3) for a body with any number of child ports: inputs [W_C1 .. W_Cm; ẍ_P], outputs [ẍ_C1 .. ẍ_Cm; W_P], six each;
/// W_C is applied to the body, W_P by the body at its parent port. All in the body frame. States [η; η̇].
struct PortModel {
  StateSpace ss;
  std::vector<int> children;  ///< port index in the body of each child block, in order
  int parent = 0;             ///< port index of P

  /// Channel numbers (equally of inputs and outputs) of a child block, or of P.
  std::vector<int> child_channels(int k) const;
  std::vector<int> parent_channels() const;
};

/// Port model of a cantilever body; `children` selects the ports that get channels (default: all but the parent).
PortModel port_model(const reduction::ReducedBody& body);
PortModel port_model(const reduction::ReducedBody& body, const std::vector<int>& children);

}  // namespace tenon::titop
