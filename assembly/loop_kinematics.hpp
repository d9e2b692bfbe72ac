#pragma once

#include <vector>

#include "assembly/loop_closure.hpp"

namespace tenon::assembly {

/// Coordinates of an open tree: six of each free root, the angle of each revolute joint, η of each body; then the
/// angles of the revolute cuts.
struct LoopCoordinates {
  std::vector<int> root, joint, body;  ///< first coordinate of each, −1 where there is none
  std::vector<int> cut;
  Eigen::Index size = 0;
  Eigen::VectorXd scale;  ///< natural size of each
};
LoopCoordinates loop_coordinates(const Network& network, const OpenLoops& open, const PortTree& tree);

/// Motions of the bodies' references over the coordinates, world axes, from the root to the tips:
///   x_k = τ(port) x_parent + R Φ η_parent + [0; axis] δθ.
class LoopMotions {
 public:
  LoopMotions(const Network& open, const PortTree& tree, const LoopCoordinates& coordinates);
  fem::Mat6X port(const PortRef& ref) const;

 private:
  const PortTree& tree_;
  const LoopCoordinates& c_;
  std::vector<fem::Mat6X> x_;
};

}  // namespace tenon::assembly
