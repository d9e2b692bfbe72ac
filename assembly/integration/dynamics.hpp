#pragma once

#include <functional>

#include "assembly/recursion/closure.hpp"

/// What every integrator needs of a system: its accelerations, and the group its attitudes move on.
namespace tenon::assembly {

/// What acts besides gravity, springs and dampers. Called after set_state(): adds generalised forces to T (nv) and
/// wrenches by apply_wrench().
using Loads = std::function<void(double t, const MotionState& state, Sweeps& sweeps, Eigen::VectorXd& T)>;

/// A system with work space for its motion. Nothing allocates after make_dynamics() while no loop closes.
struct Dynamics {
  const Multibody* system = nullptr;
  Loads loads;
  Sweeps sweeps;
  ClosureRows rows;
  Eigen::VectorXd T;       ///< nv: springs, dampers and loads of the last evaluation
  Eigen::VectorXd lambda;  ///< m: forces of the closures
  long evaluations = 0;    ///< of the equations of motion

  bool loops() const { return !system->closures.empty(); }
};

/// Throws ModelError when the system has not been indexed. Keeps a pointer to it.
Dynamics make_dynamics(const Multibody& system, Loads loads = {});

/// set_state() and the forces at it: dynamics.T, wrenches in the sweeps. Throws NumericalError when a force is no
/// number.
void set_forces(Dynamics& dynamics, double t, const MotionState& state);

/// The forces alone, after set_state().
void apply_forces(Dynamics& dynamics, double t, const MotionState& state);

/// χ̇ at a state, eq (64), with the forces of the closures when loops close. Throws NumericalError when it is no number.
void accelerations(Dynamics& dynamics, double t, const MotionState& state, Eigen::VectorXd& v_dot);

/// u̇ when q = q₀ moved by u and its speeds are v: attitudes turn by the rotation vector u in the axes of q₀, so that
/// u̇ = dexp⁻¹₋ᵤ v = v + ½ u × v + (1 − ½|u| cot ½|u|)/|u|² u × (u × v). nv numbers each; good for |u| < π.
void increment_rates(const Multibody& system, const Eigen::VectorXd& u, const Eigen::VectorXd& v,
                     Eigen::VectorXd& u_dot);

/// Where the three speeds of an attitude stand among the nv, for each body that has one.
std::vector<int> attitude_offsets(const Multibody& system);

/// Finite numbers, unit quaternions, loops closed within 1e-6 of the system's size, in speed of that times the largest
/// speed or 1/s, whichever is more. Throws ModelError that names the body or the closure.
void check_state(Dynamics& dynamics, const MotionState& state);

}  // namespace tenon::assembly
