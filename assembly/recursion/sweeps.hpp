#pragma once

#include <functional>

#include "assembly/recursion/body_sweep.hpp"

/// The recursions of the spatial-operator paper over the bodies of a tree. Each needs work space that make_sweeps()
/// sizes once; none allocates afterwards.
namespace tenon::assembly {

/// Stiffness and damping inside D_f and D_R, for implicit steps (NUMERICS 4e): M + γh C + βh² K in place of M.
struct ImplicitTerms {
  double damping = 0.0;    ///< γh [s]
  double stiffness = 0.0;  ///< βh² [s²]
};

Sweeps make_sweeps(const Multibody& system);

/// Base to tip: poses, V, a_mR, M_m, b_m for a state, eqs (45), (23), (25), (37).
void set_state(const Multibody& system, const Eigen::VectorXd& q, const Eigen::VectorXd& v, Sweeps& sweeps);

/// A wrench on a body at one of its ports, about the deformed port, in the body's axes [N, N m]. Geometric stiffening
/// feels it after restiffen().
void apply_wrench(const Multibody& system, const Eigen::VectorXd& q, int body, int port, const Vec6& wrench,
                  Sweeps& sweeps);

/// Elastic, spring and damper forces −Kϑ − Cχ, nv.
void passive_forces(const Multibody& system, const Eigen::VectorXd& q, const Eigen::VectorXd& v, Eigen::VectorXd& T);

/// T = 𝓜 χ̇ + 𝓒 with 𝓒 of motion, gravity and applied wrenches (elastic forces are passive_forces()), eq (45).
void inverse_dynamics(const Multibody& system, Sweeps& sweeps, const Eigen::VectorXd& v_dot, Eigen::VectorXd& T);

/// The system mass matrix by composite bodies, eq (50), nv×nv.
void composite_mass_matrix(const Multibody& system, Sweeps& sweeps, Eigen::MatrixXd& mass);

/// Tip to base: articulated-body quantities, eq (63), and P_R a_mR of the same state. Throws ModelError naming body and
/// degree of freedom when a hinge or a mode has no inertia to move.
void articulate(const Multibody& system, Sweeps& sweeps, const ImplicitTerms& implicit = {});

/// χ̇ from total generalised forces T (applied and passive) after articulate(), eq (64).
void forward_dynamics(const Multibody& system, Sweeps& sweeps, const Eigen::VectorXd& T, Eigen::VectorXd& v_dot);

/// articulate() and forward_dynamics() in one sweep each way; leaves what solve() needs, but no P_plus.
void articulated_forward_dynamics(const Multibody& system, Sweeps& sweeps, const Eigen::VectorXd& T,
                                  Eigen::VectorXd& v_dot);

/// x = 𝓜⁻¹ f after articulate(): eq (64) without velocities, gravity and loads.
void solve(const Multibody& system, Sweeps& sweeps, const Eigen::VectorXd& f, Eigen::VectorXd& x);

/// Kinetic energy ½ Σ V_mᵀ M_m V_m, elastic energy and that of hinge springs, and −m g·c of gravity [J]; to first order
/// in modes that do not shift mass or ports. That of geometric stiffening is not in it.
struct Energy {
  double kinetic = 0.0, elastic = 0.0, gravity = 0.0;
  double total() const { return kinetic + elastic + gravity; }
};
Energy energy(const Multibody& system, const Sweeps& sweeps, const Eigen::VectorXd& q, const Eigen::VectorXd& v);

/// Linear momentum and angular momentum about the world's origin, world axes.
Vec6 momentum(const Multibody& system, const Sweeps& sweeps, const Eigen::VectorXd& v);

}  // namespace tenon::assembly
