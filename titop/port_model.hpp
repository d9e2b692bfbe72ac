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
/// Rows of Phi that are round-off beside the other rows of their kind (below 1e-14 of the largest) are exact zeros
/// here, and so is a residual mass below 1e-10 of D: such a channel has D(i, i) = 0 and invert_channels refuses it by
/// name. Throws ModelError for a free-free body:
/// reduction::rebase it to the port it hangs by.
PortModel port_model(const reduction::ReducedBody& body);
PortModel port_model(const reduction::ReducedBody& body, const std::vector<int>& children);

/// The six names and units of a port's channels: wrench "panel.tip.Fx" [N], acceleration "panel.tip.ax" [m/s²].
std::vector<Channel> wrench_channels(const std::string& port);
std::vector<Channel> acceleration_channels(const std::string& port);

}  // namespace tenon::titop
