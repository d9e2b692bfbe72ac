#pragma once

#include <functional>

#include "assembly/recursion/multibody.hpp"
#include "fem/rigid_motion.hpp"

/// The recursions of the spatial-operator paper over the bodies of a tree. Each needs work space that make_sweeps()
/// sizes once; none allocates afterwards.
namespace tenon::assembly {

using fem::Mat6;
using fem::Mat6X;
using fem::RigidMotion;
using fem::Vec6;

/// What the recursions know of one body k, in its own axes about its reference F_k unless said. Columns of six that
/// meet the inner loops over modes are padded to eight, columns over modes to a multiple of eight (sweep_kernels.hpp).
struct BodySweep {
  using Mat8X = Eigen::Matrix<double, 8, Eigen::Dynamic>;

  RigidMotion X;          ///< F_k seen from node t of the parent, in the parent's axes
  Vec3 to_node;           ///< node t from the parent's reference, parent's axes [m]
  RigidMotion world;      ///< F_k seen from the inertial frame
  Mat6X Pi_t;             ///< 6×n_parent: shapes of the parent at node t, its axes
  Mat8X Pi_t8;            ///< the same, padded
  Eigen::MatrixXd Pi_tT;  ///< padded×6: its transpose
  Mat6X Pi_F;             ///< 6×n: Π_F^d = φ*(d, k) Π^d; no columns when node d does not deform
  HingeMap H_F{6, 0};     ///< 6×n_r: H_F* = φ*(O_k, k) H*
  HingeMotion hinge;
  Vec6 V, a;          ///< twist and a_mR, eqs (11), (25)
  Vec6 alpha;         ///< inertial rate of V
  Vec6 alpha_bias;    ///< the same without χ̇ and gravity
  Eigen::MatrixXd M;  ///< (n+6)×(n+6) over (η, x_ref), eq (23)
  Eigen::VectorXd b;  ///< n+6, eq (37), less the loads at ports

  // a revolute hinge between nodes that do not move: R = R_0 + cos θ R_c + sin θ R_s, H_F constant
  bool plain = false, fixed_node = false;  ///< fixed_node: node t does not deform
  Mat3 R_0, R_c, R_s;
  Vec3 own_node = Vec3::Zero();  ///< node d from the reference

  // geometric stiffening, empty without it
  Eigen::MatrixXd K_G;            ///< n×n
  Eigen::VectorXd port_wrenches;  ///< 6 per port, on the body
  Eigen::VectorXd applied;        ///< of them, those of apply_wrench()

  // articulated body, eqs (63), (64)
  Eigen::MatrixXd L11;      ///< padded×n: D_f = L11 L11ᵀ, strictly lower; the reciprocal diagonal apart
  Eigen::VectorXd inverse;  ///< n
  Mat8X L21;                ///< 8×n: μ L11⁻ᵀ, so that g μᵀ = L21 L21ᵀ
  Mat8X P_rf;               ///< 8×n
  Mat6 P_rr, P_R, P_plus;
  HingeMap G_R{6, 0};                                                  ///< 6×n_r
  Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, 0, 6, 6> D_R;  ///< n_r×n_r: its Cholesky factor
  Eigen::VectorXd y;                                                   ///< padded: L11⁻¹ ε_f
  Eigen::VectorXd nu_R;                                                ///< D_R⁻¹ ε_R
  Eigen::VectorXd z_f;                                                 ///< padded
  Vec6 z_r;
};

/// Copies Pi_t into its padded forms.
inline void pad_shapes(BodySweep& s) {
  s.Pi_t8.topRows<6>() = s.Pi_t;
  s.Pi_tT.topRows(s.Pi_t.cols()) = s.Pi_t.transpose();
}

/// Stiffness and damping inside D_f and D_R, for implicit steps (NUMERICS 4e): M + γh C + βh² K in place of M.
struct ImplicitTerms {
  double damping = 0.0;    ///< γh [s]
  double stiffness = 0.0;  ///< βh² [s²]
};

struct Sweeps {
  std::vector<BodySweep> bodies;
  bool stiffening = false;  ///< some body carries it
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

/// Tip to base: articulated-body quantities, eq (63). Throws ModelError naming body and degree of freedom when a hinge
/// or a mode has no inertia to move.
void articulate(const Multibody& system, Sweeps& sweeps, const ImplicitTerms& implicit = {});

/// χ̇ from total generalised forces T (applied and passive) after articulate(), eq (64).
void forward_dynamics(const Multibody& system, Sweeps& sweeps, const Eigen::VectorXd& T, Eigen::VectorXd& v_dot);

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
