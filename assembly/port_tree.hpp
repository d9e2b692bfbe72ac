#pragma once

#include <vector>

#include "assembly/spanning_tree.hpp"
#include "titop/state_space.hpp"

namespace tenon::assembly {

/// What a state of a tree's port model stands for: `scale` times a coordinate, or times its rate.
struct PortState {
  int body = -1;   ///< a modal coordinate of this body, or
  int joint = -1;  ///< the angle of this joint
  int mode = 0;
  bool rate = false;
  double scale = 1.0;
};

/// The port model of a tree with its kinematics: what the closure of loops needs to know.
struct PortTree {
  titop::StateSpace ss;
  std::vector<PortState> states;
  std::vector<Branch> branches;
  std::vector<ReducedBody> bodies;  ///< as they hang in the tree; η are their modal coordinates
  Placement placement;
  double worst_condition = 1.0;  ///< of all channel inversions and feedback solves, equilibrated
};

/// Channel inversion and feedback of port models from the tips to the root. Throws ModelError for loops,
/// NumericalError naming the channels where an inversion is not possible.
PortTree port_tree(const Network& network);

/// δθ̈ → [δθ; δθ̇] of a revolute joint, or [δθ̇] alone without a spring: δθ then has no consequence and would be an idle
/// integrator. Without spring and damper there is no state.
titop::StateSpace drive_states(const Joint& joint);

}  // namespace tenon::assembly
