#pragma once

#include "assembly/network.hpp"
#include "titop/state_space.hpp"

namespace tenon::assembly {

/// The same network by port algebra: channel inversion and feedback of port models as in the TITOP paper. Inputs and
/// outputs are those of the network (outputs of positions and velocities need the second-order route). Throws
/// ModelError for loops.
struct PortAlgebra {
  titop::StateSpace ss;
  double worst_condition = 1.0;  ///< of all channel inversions and feedback solves, equilibrated
};
PortAlgebra port_algebra(const Network& network);

/// Undamped natural frequencies from the poles of A [rad/s], ascending, double integrators left out.
Eigen::VectorXd frequencies(const PortAlgebra& system);

}  // namespace tenon::assembly
