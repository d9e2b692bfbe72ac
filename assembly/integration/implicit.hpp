#pragma once

#include <limits>

#include "assembly/integration/dynamics.hpp"

/// Implicit steps: quasi-Newton whose iteration matrix M + γh C + βh² K is the implicit articulated body (NUMERICS 4e),
/// O(N) for any stiffness. What it leaves out (gyroscopic and geometric terms) costs iterations, never accuracy.
namespace tenon::assembly {

struct ImplicitOptions {
  /// Of what a correction leaves of the speeds against the largest so far, both in the norm of M̂. 0: 1e-10 with
  /// generalised-α, which damps it; round-off with the midpoint, where it would add up over long runs.
  double tolerance = 0.0;
  int most_iterations = 40;
  double rho_infinity = 0.9;  ///< generalised-α: what a step leaves of infinitely fast modes, 0 to 1
};

/// Work space of both methods.
struct ImplicitWork {
  Sweeps matrix;           ///< articulated with the implicit terms
  Sweeps start, end;       ///< midpoint: momenta at both ends of the step
  ClosureInertia inertia;  ///< Λ of the implicit bodies
  Eigen::VectorXd r, x;    ///< nv: residual, correction
  Eigen::VectorXd a, v_dot, delta;
  Eigen::VectorXd gap, impulse, change;  ///< m
  MotionState mid, next;
  std::vector<int> attitudes;
  std::vector<Eigen::VectorXd> b;  ///< of each body, b_m without loads
  bool started = false;            ///< `start` holds the state the step leaves from
  double energy = 0.0;             ///< largest so far, the scale of corrections [J]
  int iterations = 0;              ///< of the last step
  double gap_left = 0.0;           ///< of the loops after the last step [m]
};

ImplicitWork make_implicit_work(const Dynamics& dynamics);

/// Where a step ends and what the next one needs of it.
struct ImplicitState {
  MotionState motion;
  Eigen::VectorXd v_dot;  ///< generalised-α: accelerations of the equations of motion
  Eigen::VectorXd a;      ///< and those that the method averages
};

/// Generalised-α (Chung, Hulbert 1993; on the group Brüls, Cardona, Arnold 2012) from t to t + h, second order, damps
/// what a step does not resolve. Loops are closed in position by their forces, then in speed by the smallest change in
/// the metric of M̂ (index 3 with projection, as in α-RATTLE). Throws NumericalError when the step does not converge.
void generalized_alpha_step(Dynamics& dynamics, double t, double h, const ImplicitOptions& options, ImplicitWork& work,
                            ImplicitState& state);

/// Implicit midpoint from t to t + h, second order, symmetric, undamped. What is balanced over the step are momenta: of
/// each body in the inertial frame, P₁ − P₀ = h F(mid), of each mode p₁ − p₀ = h (∂T/∂η + Q)(mid), tested with the
/// Jacobians at mid; attitudes turn by Cayley's map of h (v₀ + v₁)/2. So a floating system keeps its linear and angular
/// momentum to round-off, whatever the step, and a free rigid body its energy. When every root floats, energy is
/// balanced too, by a force of order h² on modes and hinges between bodies that fades out where all of them stand
/// still. Grounded systems swing in energy by O(h²). Bodies whose deformation is dropped, or that have no shape
/// integrals, keep no momentum (their equations do not) and are balanced in their own axes; with geometric stiffening
/// energy() is not what is kept, and nothing balances it. Throws NumericalError when the step does not converge.
void midpoint_step(Dynamics& dynamics, double t, double h, const ImplicitOptions& options, ImplicitWork& work,
                   ImplicitState& state);

// What the two share.

/// Articulates M + γh C + βh² K at a state, and Λ of the closures with it.
void factor(Dynamics& dynamics, const MotionState& state, const ImplicitTerms& terms, ImplicitWork& work);

/// The size x·M̂ x of a correction, and that of what forces alone ask for: the rest closes gaps.
struct CorrectionSize {
  double all, forces;
};

/// work.x = −M̂⁻¹ r, moved so that J x = −gap × `per_gap`; adds the change of the closures' forces to `force`.
CorrectionSize correction(Dynamics& dynamics, double per_gap, ImplicitWork& work, Eigen::VectorXd& force);

/// Moves the speeds of a state so that the loops do not open, J v = 0, by the least change in the metric of M̂; sets the
/// sweeps to it.
void close_speeds(Dynamics& dynamics, Sweeps& sweeps, ImplicitWork& work, MotionState& state);

/// Decides by the sizes of corrections (as energies) when to stop.
struct Convergence {
  double t, h, tolerance;
  int most_iterations;
  double closed;  ///< gaps no larger are round-off [m]: short steps make large corrections of them
  ImplicitWork& work;
  double last = 0.0;
  /// Throws NumericalError when a correction is no number or there are too many.
  bool reached(const CorrectionSize& size);
};

/// The round-off of positions in a system of that size [m].
inline double round_off_of_gaps(const Dynamics& dynamics) {
  return 16.0 * std::numeric_limits<double>::epsilon() * dynamics.rows.length;
}

}  // namespace tenon::assembly
