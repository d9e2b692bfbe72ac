#pragma once

#include <algorithm>
#include <cstddef>
#include <vector>

#include "assembly/recursion/multibody.hpp"
#include "assembly/recursion/sweep_kernels.hpp"
#include "fem/rigid_motion.hpp"

/// Work space of the recursions. What every pass reads stands at the head of a body's record; blocks whose size depends
/// on modes and hinge stand in one store, body after body, each at the start of a cache line.
namespace tenon::assembly {

using fem::Mat6;
using fem::Mat6X;
using fem::RigidMotion;
using fem::Vec6;

/// What the recursions know of one body k, in its own axes about its reference F_k unless said. Columns over modes are
/// padded to a multiple of eight (sweep_kernels.hpp).
struct alignas(64) BodySweep {
  using Matrix = Eigen::Map<Eigen::MatrixXd>;
  using Vector = Eigen::Map<Eigen::VectorXd>;
  using Square = Eigen::Map<Mat6>;
  using Columns = Eigen::Map<Mat6X>;
  using PaddedColumns = Eigen::Map<Eigen::Matrix<double, 8, Eigen::Dynamic>>;

  int parent = -1, n = 0, r = 0;  ///< modes, degrees of freedom of the hinge
  int n_t = 0;                    ///< modes of the parent that move node t
  int gathered = 0;               ///< which of Sweeps::gathered is this body's
  int stored = 0;                 ///< numbers that its blocks take from H_F on
  bool leaf = true;               ///< has no children
  bool opens = false;             ///< the first to reach its parent, tip to base
  bool plain = false;             ///< a revolute hinge between nodes that do not deform: X by θ alone, H_F constant
  bool fixed_node = true;         ///< node t does not deform
  bool shifts_mass = false;       ///< M_m follows η
  double sign = 1.0;              ///< −1: the hinge is reversed
  double rotor = 0.0;             ///< inertia on the one β of a hinge with one
  double inverse_D = 0.0;         ///< 1/D_R of a hinge with one degree of freedom

  alignas(64) double P_a[8] = {};     ///< P_R a_mR, padded
  RigidMotion X;                      ///< F_k seen from node t of the parent, in the parent's axes
  Vec3 to_node = Vec3::Zero();        ///< node t from the parent's reference, parent's axes [m]
  Vec6 V, a;                          ///< twist and a_mR, eqs (11), (25)
  Vec6 alpha;                         ///< inertial rate of V
  Columns H_F{nullptr, 6, 0};         ///< 6×n_r: H_F* = φ*(O_k, k) H*
  Columns G_R{nullptr, 6, 0};         ///< 6×n_r
  Vector b{nullptr, 0};               ///< n+6, eq (37), less the loads at ports
  Matrix M{nullptr, 0, 0};            ///< (n+6)×(n+6) over (η, x_ref), eq (23); shared while constant
  const ReducedBody* body = nullptr;  ///< of the system, which outlives its sweeps
  Vec3 own_node = Vec3::Zero();       ///< node d from the reference, undeformed
  Mat3 inner_axes, outer_axes;        ///< of the hinge, see HingedBody
  RigidMotion world;                  ///< F_k seen from the inertial frame
  Vec6 alpha_bias;                    ///< alpha without χ̇ and gravity
  Columns Pi_t{nullptr, 6, 0};        ///< 6×n_t: shapes of the parent at node t, its axes; shared while constant
  Matrix Pi_tT{nullptr, 0, 6};        ///< padded×6: its transpose
  Columns Pi_F{nullptr, 6, 0};        ///< 6×n: Π_F^d = φ*(d, k) Π^d; no columns when node d does not deform
  Matrix L11{nullptr, 0, 0};          ///< padded×n: D_f = L11 L11ᵀ, strictly lower; the reciprocal diagonal apart
  Vector inverse{nullptr, 0};         ///< n
  PaddedColumns L21{nullptr, 8, 0};   ///< 8×n: P_rf, then μ L11⁻ᵀ, so that g μᵀ = L21 L21ᵀ
  Vector z_f{nullptr, 0};             ///< padded; the articulated passes leave ε_f, then L11⁻¹ ε_f here
  Vec6 z_r;                           ///< of inverse dynamics: what the hinge passes on
  Matrix D_R{nullptr, 0, 0};          ///< n_r×n_r: its Cholesky factor, for more than one degree of freedom
  Square P_rr{nullptr};               ///< composite bodies
  Square P_plus{nullptr};             ///< P_R⁺ about F_k, left by articulate()
  Matrix K_G{nullptr, 0, 0};          ///< n×n: geometric stiffening, empty without it
  Vector port_wrenches{nullptr, 0};   ///< 6 per port, on the body, with K_G
  Vector applied{nullptr, 0};         ///< of them, those of apply_wrench()

  /// Calls f for each block that stands in the store.
  template <class Function>
  void blocks(const Function& f) {
    f(H_F), f(G_R), f(b), f(M), f(Pi_t), f(Pi_tT), f(Pi_F), f(L11), f(inverse), f(L21), f(z_f), f(D_R), f(K_G);
    f(port_wrenches), f(applied), f(P_rr), f(P_plus);
  }
};

/// What a body has gathered from its children so far, columns of six padded to eight: P(k) with its lower triangle
/// counting, and z(k). Bodies whose turns do not overlap share one: a chain has two.
struct alignas(64) Gathered {
  double P[6][8] = {};
  double z[8] = {};
};

/// Work space for all bodies. Copies have a store of their own.
struct Sweeps {
  std::vector<BodySweep> bodies;
  std::vector<Gathered> gathered;
  bool stiffening = false;  ///< some body carries it
  bool large = false;       ///< more than a core's second cache holds: passes ask for bodies ahead

  Sweeps() = default;
  Sweeps(const Sweeps& other);
  Sweeps(Sweeps&&) noexcept = default;
  Sweeps& operator=(Sweeps other) noexcept;

  struct alignas(64) CacheLine {
    double x[8] = {};
  };
  std::vector<CacheLine> store;
};

/// What a pass reads of a body: cache lines from the head of its record and of its blocks.
struct Reach {
  int record, blocks;
};
inline constexpr Reach dynamics_reach{8, 1 << 20},  ///< eqs (63) and (64)
    motion_reach{13, 4};                            ///< set_state()

/// Asks for what a pass in the direction of `step` (±1) will need of the bodies ahead: records early enough to know
/// where their blocks are. Returns those blocks, for the kernels to ask for over the modes of body k; of a rigid body
/// they are asked for here.
inline Ahead fetch_ahead(const Sweeps& sweeps, std::size_t k, std::ptrdiff_t step, const Reach& reach) {
  constexpr std::ptrdiff_t records = 6, blocks = 3;  // bodies ahead
  const auto fetch = [](const void* from, int lines) {
    for (int i = 0; i < lines; ++i) __builtin_prefetch(static_cast<const char*>(from) + 64 * i);
  };
  const auto body = [&](std::ptrdiff_t ahead) {  // none beyond the last; the index wraps below zero
    const auto at = k + static_cast<std::size_t>(step * ahead);
    return at < sweeps.bodies.size() ? &sweeps.bodies[at] : nullptr;
  };
  if (const BodySweep* s = body(records)) fetch(s, reach.record);
  const BodySweep* s = body(blocks);
  if (!s) return {};
  const int lines = std::min(reach.blocks, s->stored / pad), n = sweeps.bodies[k].n;
  if (n > 0 && lines > motion_reach.blocks) return {s->H_F.data(), (lines + n - 1) / n};
  fetch(s->H_F.data(), lines);
  return {};
}

}  // namespace tenon::assembly
