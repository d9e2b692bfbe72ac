#pragma once

#include <Eigen/Core>

#include "assembly/network.hpp"
#include "titop/state_space.hpp"

namespace tenon::assembly {

/// The same network by port algebra: channel inversion and feedback of port models as in the TITOP paper, from the tips
/// to the root. A free root is inverted at P (its wrench becomes the input), the axis channel of a revolute joint is
/// inverted at the child, drives act by feedback of δθ, δθ̇, δθ̈. States are ω_j η_j, η̇_j of the bodies and δθ, δθ̇ of
/// the joints with a spring or damper; rigid motions have no states, as in the paper. Inputs and outputs are those of
/// the network; outputs of positions and velocities need the second-order route.
struct PortAlgebra {
  titop::StateSpace ss;
  double worst_condition = 1.0;  ///< of all channel inversions and feedback solves, equilibrated
};

/// Loops are cut, and closed by inverting the channels of the cut (loop_closure.hpp). Throws ModelError for position or
/// velocity outputs, NumericalError naming the channels where an inversion is not possible (redundant closure rows
/// among them); each points to the second-order route.
PortAlgebra port_algebra(const Network& network);

/// Natural frequencies from the poles of A [rad/s], ascending: |λ| of each oscillating pair; real poles (overdamped or
/// without stiffness) and double integrators are left out. The undamped ones when the network has no damping.
Eigen::VectorXd frequencies(const PortAlgebra& system);

}  // namespace tenon::assembly
