#pragma once

#include <array>

#include "assembly/integration/dynamics.hpp"

/// Explicit Runge-Kutta of order 5 with an error estimate of order 4 (Dormand, Prince 1980), on the group.
///
/// A step integrates the increment u from its own start, q = q₀ moved by u, with u̇ = dexp⁻¹₋ᵤ v (Munthe-Kaas): unit
/// quaternions stay so without projection, errors are weighed in nv independent numbers, and order 5 is kept. Plain
/// quaternion kinematics would carry a fourth, dependent number and shorten it in every stage.
namespace tenon::assembly {

struct Tolerance {
  double relative = 1e-8;
  double absolute = 1e-10;  ///< in SI units and radians
};

/// Stages of the last step tried.
struct DormandPrince {
  std::array<Eigen::VectorXd, 7> u_dot, v_dot;
  Eigen::VectorXd u, v, u_error, v_error;
  MotionState stage;
  double h = 0.0;
};

DormandPrince make_dormand_prince(const Multibody& system);

/// Tries a step from `from`, whose acceleration stands in work.v_dot[0], to `to`; returns the error of order 4 over the
/// tolerance, root mean square: 1 or less is within it. The last stage is the acceleration at `to` when nothing is
/// projected afterwards.
double try_step(Dynamics& dynamics, double t, const MotionState& from, double h, const Tolerance& tolerance,
                DormandPrince& work, MotionState& to);

/// The state at the fraction 0 ≤ part ≤ 1 of the last step, to order 4.
void interpolate(const Multibody& system, DormandPrince& work, const MotionState& from, double part, MotionState& at);

/// First step by the size of state, speeds and accelerations (Hairer, Nørsett, Wanner, II.4), at most `longest` [s].
double first_step(Dynamics& dynamics, double t, const MotionState& from, const Tolerance& tolerance, double longest,
                  DormandPrince& work);

}  // namespace tenon::assembly
