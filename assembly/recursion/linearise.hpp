#pragma once

#include "assembly/recursion/sweeps.hpp"

namespace tenon::assembly {

/// M ξ̈ + C ξ̇ + K ξ = f about an equilibrium or a steady motion, ξ the small displacement of the coordinates (attitudes
/// as rotations), f generalised forces.
struct LinearMotion {
  Eigen::MatrixXd M;  ///< nv×nv
  Eigen::MatrixXd C;  ///< dampers, and the gyroscopic terms of the motion
  Eigen::MatrixXd K;  ///< springs and modes, and what gravity and the motion stiffen or soften
  Eigen::MatrixXd J;  ///< m×nv: closure rows J ξ = 0
};

/// The system linearised about a state with the accelerations χ̇ that it is held at (zero for an equilibrium or a steady
/// motion in coordinates). Springs, dampers and M are exact; what gravity and velocities add is differenced to fourth
/// order, step 1e-3 (error 1e-12 of those terms); at rest without gravity they vanish exactly.
LinearMotion linearise(const Multibody& system, const MotionState& state, const Eigen::VectorXd& v_dot);

}  // namespace tenon::assembly
