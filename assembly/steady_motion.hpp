#pragma once

#include <string>
#include <vector>

#include "assembly/recursion/linearise.hpp"

/// Motions that look the same at all times to whom turns with them: rest, equilibria, spin at constant rates.
namespace tenon::assembly {

struct SteadyMotion {
  MotionState state;
  Eigen::VectorXd v_dot;   ///< nv: of floating pieces whose reference runs on a circle, else 0
  Eigen::VectorXd held;    ///< nv: what the drives of turning joints give so that they keep their rates, else 0 [N m]
  double time = 0.0;       ///< axes that turn with floating pieces are world axes at time 0 [s]
  double frequency = 0.0;  ///< that motion and gravity bring in [rad/s]; 0 at rest without gravity
  double force = 0.0;      ///< size of what balances, in coordinates of unit mass
  double turned = 0.0;     ///< by the joint that the search for the equilibrium moved most [rad]
};

/// The steady motion nearest to a state: rates of joints and floating pieces are kept, everything else goes to where
/// forces balance (Newton's method with the K of the motion, loops closed): modes bend, hinges swing, a floating piece
/// tilts until a principal axis lies along its spin and moves until its mass centre lies on the axis. Hinges are those
/// of networks: welds, revolute, free roots. Throws NumericalError with the coordinate that stays out of balance when
/// there is none near.
SteadyMotion steady_motion(const Multibody& system, const MotionState& start);

/// The same motion a time later.
SteadyMotion later(const Multibody& system, SteadyMotion motion, double time);

/// As linearise() at the state, but displacements of floating pieces along axes that turn with their spin ω, where the
/// system is time-invariant: x = Q ρ, ẋ = Q (ρ̇ + ω × ρ), ẍ = Q (ρ̈ + 2 ω × ρ̇ + ω × (ω × ρ)).
LinearMotion linearise(const Multibody& system, const SteadyMotion& motion);

/// Columns over displacements, world axes, to columns over displacements along the turning axes.
void turn_columns(const Multibody& system, const SteadyMotion& motion, Eigen::MatrixXd& columns);

/// What is out of balance: generalised forces that the motion needs beyond springs, dampers and gravity, over the same
/// coordinates; `size`: of the forces that should balance.
struct Imbalance {
  Eigen::VectorXd force, size;
};
Imbalance imbalance(const Multibody& system, const SteadyMotion& motion);

/// "panel.mode 2", "panel.turn", "hub.x": of each of the nv coordinates.
std::vector<std::string> coordinate_names(const Multibody& system);

}  // namespace tenon::assembly
