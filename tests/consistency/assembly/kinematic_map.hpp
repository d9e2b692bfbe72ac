#pragma once

#include "assembly/recursion/sweeps.hpp"
#include "assembly/second_order.hpp"

namespace tenon::assembly::testing {

/// q = J χ from the speeds of the tree to the coordinates of the second-order assembly, speed by speed, at rest.
inline Eigen::MatrixXd kinematic_map(const NetworkMultibody& tree, const SecondOrderSystem& second) {
  Sweeps sweeps = make_sweeps(tree.system);
  const MotionState rest = rest_state(tree.system);
  Eigen::MatrixXd J = Eigen::MatrixXd::Zero(second.G.cols(), tree.system.nv);
  for (int j = 0; j < tree.system.nv; ++j) {
    const Eigen::VectorXd unit = Eigen::VectorXd::Unit(tree.system.nv, j);
    set_state(tree.system, rest.q, unit, sweeps);
    for (std::size_t k = 0; k < tree.body.size(); ++k) {
      const auto b = static_cast<std::size_t>(tree.body[k]);
      const BodySweep& s = sweeps.bodies[b];
      const int n = tree.system.bodies[b].modes();
      J.col(j).segment<6>(second.offset[k]) << s.world.R * s.V.head<3>(), s.world.R * s.V.tail<3>();
      J.col(j).segment(second.offset[k] + 6, n) = unit.segment(tree.system.v_offset[b], n);
    }
  }
  return J;
}

}  // namespace tenon::assembly::testing
