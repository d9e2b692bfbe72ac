#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "assembly/recursion/sweep_kernels.hpp"
#include "assembly/recursion/sweeps.hpp"
#include "fem/error.hpp"

namespace tenon::assembly {

using Eigen::Index;
using Eigen::VectorXd;
using fem::shift_twist;
using fem::shift_wrench;

namespace {

constexpr double least_pivot = 1e-13;  // of the diagonal before elimination: below, what is left is round-off

[[noreturn]] void no_inertia(const HingedBody& b, const std::string& what) {
  throw ModelError(fmt::format("{} of body '{}' has no inertia to move", what, b.name),
                   "Give the body (or what hangs on it) mass there, the hinge a rotor inertia, or lock it");
}

// What the children of a body add to: M_m(k).
void open_inertia(BodySweep& s, Gathered& at) {
  const Index n = s.n;
  sweep_kernels().copy_inertia(s.M.data() + n * (n + 6) + n, s.n + 6, at.P[0]);
  if (n == 0) return;
  s.L11.topRows(n) = s.M.topLeftCorner(n, n);
  s.L21.topRows<6>() = s.M.bottomLeftCorner(6, n);
}

using PaddedInertia = Eigen::Matrix<double, 8, 6>;
Eigen::Map<PaddedInertia> inertia(Gathered& at) { return Eigen::Map<PaddedInertia>(at.P[0]); }

// The modes of body k out of its articulated inertia: D_f, μ of eq (63); P_R is left in place of P.
void take_out_modes(const HingedBody& b, const ImplicitTerms& implicit, const Ahead& ahead, BodySweep& s,
                    Gathered& at) {
  const Index n = s.n;
  if (s.Pi_F.cols() > 0) {  // H_f = [1, −Π_Fᵀ]: D_f = P_ff − P_fr Π_F − Π_Fᵀ P_rf + Π_Fᵀ P_rr Π_F, μ = P_rf − P_rr Π_F
    const Mat6 P_rr = inertia(at).topRows<6>().selfadjointView<Eigen::Lower>();
    for (Index j = 0; j < n; ++j) {
      const Vec6 P_Pi = P_rr * s.Pi_F.col(j);
      const Vec6 half = s.L21.col(j).head<6>() - 0.5 * P_Pi;
      s.L21.col(j).head<6>() -= P_Pi;
      for (Index i = 0; i < n; ++i) {
        const double value = half.dot(s.Pi_F.col(i));
        s.L11(std::max(i, j), std::min(i, j)) -= i == j ? 2.0 * value : value;
      }
    }
  }
  if (implicit.damping != 0.0 || implicit.stiffness != 0.0) {
    const ReducedBody& body = *b.body;
    if (body.C.size() > 0) s.L11.topRows(n) += implicit.damping * body.C;
    for (Index i = 0; i < n; ++i) {
      const double w = body.omega[i];
      s.L11(i, i) += implicit.stiffness * w * w + (body.C.size() > 0 ? 0.0 : implicit.damping * 2.0 * body.zeta[i] * w);
    }
  }
  const int failed =
      sweep_kernels().eliminate_modes(s.n, least_pivot, s.L11.data(), s.inverse.data(), s.L21.data(), at.P[0], ahead);
  if (failed >= 0) no_inertia(b, fmt::format("mode {}", failed + 1));
}

// A hinge with several degrees of freedom: D_R, G_R of eq (63), P_R⁺ in place of P_R; D_R is left as its Cholesky
// factor. `size`: the diagonal of P_rr.
void take_out_hinge(const HingedBody& b, const ImplicitTerms& implicit, const Vec6& size, BodySweep& s, Mat6& P) {
  const Index r = s.r;
  HingeMap U(6, r);
  for (Index j = 0; j < r; ++j) U.col(j).noalias() = P * s.H_F.col(j);
  for (Index j = 0; j < r; ++j) {
    for (Index i = j; i < r; ++i) s.D_R(i, j) = s.H_F.col(i).dot(U.col(j));
    s.D_R(j, j) += b.inertia[j] + implicit.damping * b.damping[j] + implicit.stiffness * b.stiffness[j];
    if (!(s.D_R(j, j) > least_pivot * s.H_F.col(j).cwiseAbs2().dot(size)))  // what the pivot is left of
      no_inertia(b, fmt::format("degree of freedom {} of the {} hinge", j + 1, name(b.kind)));
  }
  for (Index j = 0; j < r; ++j) {
    const double before = s.D_R(j, j);
    for (Index k = 0; k < j; ++k) s.D_R(j, j) -= s.D_R(j, k) * s.D_R(j, k);
    if (!(s.D_R(j, j) > least_pivot * before))
      no_inertia(b, fmt::format("degree of freedom {} of the {} hinge", j + 1, name(b.kind)));
    s.D_R(j, j) = std::sqrt(s.D_R(j, j));
    for (Index i = j + 1; i < r; ++i) {
      for (Index k = 0; k < j; ++k) s.D_R(i, j) -= s.D_R(i, k) * s.D_R(j, k);
      s.D_R(i, j) /= s.D_R(j, j);
    }
  }
  for (Index j = 0; j < r; ++j) {  // U ← U D_R^{-T/2}, so that P_R⁺ = P_R − U Uᵀ
    for (Index k = 0; k < j; ++k) U.col(j) -= s.D_R(j, k) * U.col(k);
    U.col(j) /= s.D_R(j, j);
    P -= U.col(j) * U.col(j).transpose();
  }
  s.G_R = U;
  for (Index j = r - 1; j >= 0; --j) {  // G_R = P_R H_F* D_R⁻¹
    for (Index k = j + 1; k < r; ++k) s.G_R.col(j) -= s.D_R(k, j) * s.G_R.col(k);
    s.G_R.col(j) /= s.D_R(j, j);
  }
}

// ν ← D_R⁻¹ ν
void solve_hinge(const BodySweep& s, double* nu) {
  for (int j = 0; j < s.r; ++j) {
    for (int k = 0; k < j; ++k) nu[j] -= s.D_R(j, k) * nu[k];
    nu[j] /= s.D_R(j, j);
  }
  for (int j = s.r - 1; j >= 0; --j) {
    for (int k = j + 1; k < s.r; ++k) nu[j] -= s.D_R(k, j) * nu[k];
    nu[j] /= s.D_R(j, j);
  }
}

// P_R⁺ = P_R − U Uᵀ/D (U null: P_R⁺ itself) onto the parent: P(p) += 𝓐 Γ 𝓐*
void add_to_parent(const BodySweep& s, const Gathered& at, const double* U, BodySweep& parent, Gathered& to) {
  const SweepKernels& kernels = sweep_kernels();
  const Vec3 l = s.to_node + s.X.r;
  kernels.carry_inertia(at.P[0], U, s.inverse_D, s.X.R.data(), l.data(), to.P[0]);
  if (s.n_t == 0) return;
  Gathered Gamma;  // about node t, in the parent's axes
  kernels.carry_inertia(at.P[0], U, s.inverse_D, s.X.R.data(), s.X.r.data(), Gamma.P[0]);
  kernels.add_child_modes(s.n_t, Gamma.P[0], s.Pi_t.data(), s.Pi_tT.data(), s.to_node.data(), parent.L11.data(),
                          parent.L21.data());
}

// Eq (63) for body k: what its children left goes on to its parent. `keep`: leaves P_plus.
void articulate_body(const Multibody& system, const ImplicitTerms& implicit, bool keep, std::size_t k,
                     const Ahead& ahead, Sweeps& sweeps) {
  const SweepKernels& kernels = sweep_kernels();
  const HingedBody& b = system.bodies[k];
  BodySweep& s = sweeps.bodies[k];
  Gathered& at = sweeps.gathered[static_cast<std::size_t>(s.gathered)];
  if (s.leaf) open_inertia(s, at);
  const Vec6 size = inertia(at).diagonal().cwiseAbs();  // what pivots of the hinge are left of
  if (s.n > 0) take_out_modes(b, implicit, ahead, s, at);
  alignas(64) double U[8];
  if (s.r == 1) {
    double extra = s.rotor;
    if (implicit.damping != 0.0) extra += implicit.damping * b.damping[0];
    if (implicit.stiffness != 0.0) extra += implicit.stiffness * b.stiffness[0];
    const double D = kernels.take_out_axis(at.P[0], s.H_F.data(), s.a.data(), extra, U, s.P_a);
    if (!(D > least_pivot * s.H_F.col(0).cwiseAbs2().dot(size)))
      no_inertia(b, fmt::format("the degree of freedom of the {} hinge", name(b.kind)));
    s.inverse_D = 1.0 / D;
    const Eigen::Map<const Vec6> u(U);
    s.G_R.col(0) = s.inverse_D * u;
    if (keep) s.P_plus = inertia(at).topRows<6>() - u * s.G_R.col(0).transpose();
  } else {
    Mat6 P = inertia(at).topRows<6>().selfadjointView<Eigen::Lower>();
    Eigen::Map<Vec6>(s.P_a) = P * s.a;
    take_out_hinge(b, implicit, size, s, P);
    inertia(at).topRows<6>() = P;
    if (keep) s.P_plus = P;
  }
  if (s.parent < 0) return;
  BodySweep& parent = sweeps.bodies[static_cast<std::size_t>(s.parent)];
  Gathered& to = sweeps.gathered[static_cast<std::size_t>(parent.gathered)];
  if (s.opens) open_inertia(parent, to);
  add_to_parent(s, at, s.r == 1 ? U : nullptr, parent, to);
}

// What the children of a body add to: b_m(k), or nothing without motion.
template <bool Motion>
void open_forces(BodySweep& s, Gathered& at) {
  for (int i = 0; i < 6; ++i) at.z[i] = Motion ? s.b[s.n + i] : 0.0;
  for (int i = 0; i < s.n; ++i) s.z_f[i] = Motion ? s.b[i] : 0.0;
}

constexpr double still[8] = {};

// Eq (64) for body k, tip to base: ε_f into z_f, ν_R into v_dot, z on to the parent.
template <bool Motion>
void gather_forces(const Multibody& system, const VectorXd& T, std::size_t k, const Ahead& ahead, Sweeps& sweeps,
                   VectorXd& v_dot) {
  const SweepKernels& kernels = sweep_kernels();
  BodySweep& s = sweeps.bodies[k];
  Gathered& at = sweeps.gathered[static_cast<std::size_t>(s.gathered)];
  const Index n = s.n, first = system.v_offset[k];
  if (s.leaf) open_forces<Motion>(s, at);
  if (n > 0) {
    s.z_f.head(n) = T.segment(first, n) - s.z_f.head(n);  // ε_f
    for (Index i = 0; i < s.Pi_F.cols(); ++i) s.z_f[i] += s.Pi_F.col(i).dot(Eigen::Map<const Vec6>(at.z));
    kernels.lower_sweep(s.n, s.L11.data(), s.inverse.data(), s.L21.data(), s.z_f.data(), at.z, ahead);  // z_r + g ε_f
  }
  Gathered* to = nullptr;
  BodySweep* parent = nullptr;
  if (s.parent >= 0) {
    parent = &sweeps.bodies[static_cast<std::size_t>(s.parent)];
    to = &sweeps.gathered[static_cast<std::size_t>(parent->gathered)];
    if (s.opens) open_forces<Motion>(*parent, *to);
  }
  const bool rigid_node = s.n_t == 0;
  double at_node[8] = {};
  double* z_to = to && rigid_node ? to->z : at_node;
  const Vec3 l = rigid_node ? Vec3(s.to_node + s.X.r) : s.X.r;
  const double* P_a = Motion ? s.P_a : still;
  if (s.r == 1) {
    v_dot[first + n] = s.inverse_D * kernels.carry_force(at.z, P_a, s.H_F.data(), s.G_R.data(), T[first + n],
                                                         s.X.R.data(), l.data(), z_to);
  } else {
    Vec6 z = Eigen::Map<const Vec6>(at.z) + Eigen::Map<const Vec6>(P_a);  // z_R
    const Index r = s.r;
    for (Index j = 0; j < r; ++j) v_dot[first + n + j] = T[first + n + j] - s.H_F.col(j).dot(z);  // ε_R
    for (Index j = 0; j < r; ++j) z += v_dot[first + n + j] * s.G_R.col(j);                       // z_R⁺
    solve_hinge(s, v_dot.data() + first + n);
    Eigen::Map<Vec6>(z_to) += RigidMotion{s.X.R, l}.wrench(z);
  }
  if (!to || rigid_node) return;
  Eigen::Map<Vec6>(to->z) += shift_wrench(Eigen::Map<const Vec6>(at_node), s.to_node);
  kernels.add_mode_forces(s.n_t, s.Pi_tT.data(), at_node, parent->z_f.data());
}

// Eq (64) for body k, base to tip: β̇ = ν_R − G_R* α_R⁺, η̈ = ν_f − g* α_R.
template <bool Motion>
void accelerate(const Multibody& system, const Vec6& base, std::size_t k, const Ahead& ahead, Sweeps& sweeps,
                VectorXd& v_dot) {
  const SweepKernels& kernels = sweep_kernels();
  BodySweep& s = sweeps.bodies[k];
  const Index n = s.n, r = s.r, first = system.v_offset[k];
  const Vec6* from = &base;
  Vec6 at_node;
  Vec3 l = s.X.r;
  if (s.parent >= 0) {
    const auto p = static_cast<std::size_t>(s.parent);
    from = &sweeps.bodies[p].alpha;
    if (s.n_t == 0) {
      l += s.to_node;
    } else {
      at_node = shift_twist(*from, s.to_node);
      for (Index i = 0; i < s.n_t; ++i) at_node += v_dot[system.v_offset[p] + i] * s.Pi_t.col(i);
      from = &at_node;
    }
  }
  const double* a = Motion ? s.a.data() : still;
  if (r == 1) {
    v_dot[first + n] = kernels.carry_rate(from->data(), s.X.R.data(), l.data(), s.H_F.data(), s.G_R.data(),
                                          v_dot[first + n], a, s.alpha.data());
  } else {
    s.alpha = RigidMotion{s.X.R, l}.twist(*from);  // α_R⁺
    for (Index j = 0; j < r; ++j) v_dot[first + n + j] -= s.G_R.col(j).dot(s.alpha);
    for (Index j = 0; j < r; ++j) s.alpha += v_dot[first + n + j] * s.H_F.col(j);
    s.alpha += Eigen::Map<const Vec6>(a);
  }
  if (n == 0) return;
  Eigen::Matrix<double, 8, 1> alpha;
  alpha << s.alpha, 0.0, 0.0;
  kernels.upper_sweep(s.n, s.L11.data(), s.inverse.data(), s.L21.data(), alpha.data(), s.z_f.data(), ahead);
  v_dot.segment(first, n) = s.z_f.head(n);
  for (Index i = 0; i < s.Pi_F.cols(); ++i) s.alpha -= s.z_f[i] * s.Pi_F.col(i);
}

template <bool Motion>
void accelerate(const Multibody& system, Sweeps& sweeps, VectorXd& v_dot) {
  Vec6 base = Vec6::Zero();
  if constexpr (Motion) base.head<3>() = -system.gravity;
  for (std::size_t k = 0; k < sweeps.bodies.size(); ++k) {
    const Ahead ahead = sweeps.large ? fetch_ahead(sweeps, k, 1, dynamics_reach) : Ahead{};
    accelerate<Motion>(system, base, k, ahead, sweeps, v_dot);
  }
}

// Bodies from tip to base.
template <class Pass>
void inward(const Sweeps& sweeps, const Pass& pass) {
  for (std::size_t k = sweeps.bodies.size(); k-- > 0;) {
    pass(k, sweeps.large ? fetch_ahead(sweeps, k, -1, dynamics_reach) : Ahead{});
  }
}

}  // namespace

void articulate(const Multibody& system, Sweeps& sweeps, const ImplicitTerms& implicit) {
  inward(sweeps, [&](std::size_t k, const Ahead& ahead) { articulate_body(system, implicit, true, k, ahead, sweeps); });
}

void forward_dynamics(const Multibody& system, Sweeps& sweeps, const VectorXd& T, VectorXd& v_dot) {
  inward(sweeps, [&](std::size_t k, const Ahead& ahead) { gather_forces<true>(system, T, k, ahead, sweeps, v_dot); });
  accelerate<true>(system, sweeps, v_dot);
}

void articulated_forward_dynamics(const Multibody& system, Sweeps& sweeps, const VectorXd& T, VectorXd& v_dot) {
  inward(sweeps, [&](std::size_t k, const Ahead& ahead) {
    articulate_body(system, {}, false, k, ahead, sweeps);
    gather_forces<true>(system, T, k, {}, sweeps, v_dot);
  });
  accelerate<true>(system, sweeps, v_dot);
}

void solve(const Multibody& system, Sweeps& sweeps, const VectorXd& f, VectorXd& x) {
  inward(sweeps, [&](std::size_t k, const Ahead& ahead) { gather_forces<false>(system, f, k, ahead, sweeps, x); });
  accelerate<false>(system, sweeps, x);
}

}  // namespace tenon::assembly
