#pragma once

#include <vector>

#include "assembly/network.hpp"
#include "fem/model.hpp"

namespace tenon::assembly {

/// The unreduced model of a whole network: every FE body's model moved to its place, rigid bodies as masses with rigid
/// links to their ports, joints as exact constraints (a revolute joint adds its angle as a scalar dof).
struct FullModel {
  fem::Model model;
  std::vector<int> first_node;              ///< per body, in model.nodes
  std::vector<std::vector<int>> port_node;  ///< per body and port
  std::vector<int> angle_node;              ///< per joint: the scalar point of its angle, −1 for welds
};

/// `models[b]` is the FE model of body b, or nullptr for a rigid body (n = 0). Throws ModelError for a flexible body
/// without one.
FullModel full_model(const Network& network, const std::vector<const fem::Model*>& models);

}  // namespace tenon::assembly
