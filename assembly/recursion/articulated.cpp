#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "assembly/recursion/sweep_kernels.hpp"
#include "assembly/recursion/sweeps.hpp"
#include "fem/error.hpp"

namespace tenon::assembly {

using Eigen::Index;
using Eigen::VectorXd;
using fem::shift_inertia;
using fem::shift_twist;
using fem::shift_wrench;

namespace {

constexpr double least_pivot = 1e-13;  // of the diagonal before elimination: below, what is left is round-off

[[noreturn]] void no_inertia(const HingedBody& b, const std::string& what) {
  throw ModelError(fmt::format("{} of body '{}' has no inertia to move", what, b.name),
                   "Give the body (or what hangs on it) mass there, the hinge a rotor inertia, or lock it");
}

// The modes of body k out of its articulated inertia: D_f, μ, P_R of eq (63).
void take_out_modes(const HingedBody& b, const ImplicitTerms& implicit, BodySweep& s) {
  const Index n = b.modes();
  s.P_R = s.P_rr;
  if (n == 0) return;
  if (s.Pi_F.cols() > 0) {  // H_f = [1, −Π_Fᵀ]: D_f = P_ff − P_fr Π_F − Π_Fᵀ P_rf + Π_Fᵀ P_rr Π_F, μ = P_rf − P_rr Π_F
    for (Index j = 0; j < n; ++j) {
      const Vec6 P_Pi = s.P_rr * s.Pi_F.col(j);
      s.L21.col(j).head<6>() = s.P_rf.col(j).head<6>() - P_Pi;
      const Vec6 half = s.P_rf.col(j).head<6>() - 0.5 * P_Pi;
      for (Index i = 0; i < n; ++i) {
        const double value = half.dot(s.Pi_F.col(i));
        s.L11(std::max(i, j), std::min(i, j)) -= i == j ? 2.0 * value : value;
      }
    }
  } else {
    s.L21 = s.P_rf;
  }
  if (implicit.damping != 0.0 || implicit.stiffness != 0.0) {
    const ReducedBody& body = *b.body;
    if (body.C.size() > 0) s.L11.topRows(n) += implicit.damping * body.C;
    for (Index i = 0; i < n; ++i) {
      const double w = body.omega[i];
      s.L11(i, i) += implicit.stiffness * w * w + (body.C.size() > 0 ? 0.0 : implicit.damping * 2.0 * body.zeta[i] * w);
    }
  }
  Eigen::Matrix<double, 8, 6> P = Eigen::Matrix<double, 8, 6>::Zero();
  P.topRows<6>() = s.P_rr;
  const int failed = sweep_kernels().eliminate_modes(static_cast<int>(n), least_pivot, s.L11.data(), s.inverse.data(),
                                                     s.L21.data(), P.data());
  if (failed >= 0) no_inertia(b, fmt::format("mode {}", failed + 1));
  s.P_R = P.topRows<6>();
}

// The hinge of body k: D_R, G_R, P_R⁺ of eq (63); D_R is left as its Cholesky factor.
void take_out_hinge(const HingedBody& b, const ImplicitTerms& implicit, BodySweep& s) {
  const Index r = s.H_F.cols();
  if (r == 0) {
    s.P_plus = s.P_R;
    return;
  }
  if (r == 1) {
    const double extra = b.inertia[0] + implicit.damping * b.damping[0] + implicit.stiffness * b.stiffness[0];
    const Vec6 h = s.H_F.col(0);
    const double D = sweep_kernels().take_out_axis(s.P_R.data(), h.data(), extra, s.G_R.data(), s.P_plus.data());
    if (!(D > least_pivot * h.cwiseAbs2().dot(s.P_rr.diagonal().cwiseAbs())))
      no_inertia(b, fmt::format("the degree of freedom of the {} hinge", name(b.kind)));
    s.D_R(0, 0) = std::sqrt(D);
    return;
  }
  s.P_plus = s.P_R;
  HingeMap U(6, r);
  for (Index j = 0; j < r; ++j) U.col(j).noalias() = s.P_R * s.H_F.col(j);
  for (Index j = 0; j < r; ++j) {
    double size = 0.0;  // what the pivot is left of
    for (Index i = 0; i < 6; ++i) size += s.H_F(i, j) * s.H_F(i, j) * std::abs(s.P_rr(i, i));
    for (Index i = j; i < r; ++i) s.D_R(i, j) = s.H_F.col(i).dot(U.col(j));
    s.D_R(j, j) += b.inertia[j] + implicit.damping * b.damping[j] + implicit.stiffness * b.stiffness[j];
    if (!(s.D_R(j, j) > least_pivot * size))
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
    s.P_plus -= U.col(j) * U.col(j).transpose();
  }
  s.G_R = U;
  for (Index j = r - 1; j >= 0; --j) {  // G_R = P_R H_F* D_R⁻¹
    for (Index k = j + 1; k < r; ++k) s.G_R.col(j) -= s.D_R(k, j) * s.G_R.col(k);
    s.G_R.col(j) /= s.D_R(j, j);
  }
}

// ν ← D_R⁻¹ ν
void solve_hinge(const BodySweep& s, VectorXd& nu) {
  const Index r = nu.size();
  for (Index j = 0; j < r; ++j) {
    for (Index k = 0; k < j; ++k) nu[j] -= s.D_R(j, k) * nu[k];
    nu[j] /= s.D_R(j, j);
  }
  for (Index j = r - 1; j >= 0; --j) {
    for (Index k = j + 1; k < r; ++k) nu[j] -= s.D_R(k, j) * nu[k];
    nu[j] /= s.D_R(j, j);
  }
}

// Γ of a child onto its parent: P(p) += 𝓐 Γ 𝓐*
void add_to_parent(const BodySweep& child, BodySweep& parent) {
  const auto n = static_cast<int>(child.Pi_t.cols());
  if (n == 0) {
    const Vec3 r = child.to_node + child.X.r;
    sweep_kernels().carry_inertia(child.P_plus.data(), child.X.R.data(), r.data(), parent.P_rr.data());
    return;
  }
  const Mat6 Gamma = child.X.inertia(child.P_plus);  // about node t, in the parent's axes
  parent.P_rr += shift_inertia(Gamma, child.to_node);
  Eigen::Matrix<double, 8, 6> padded_Gamma = Eigen::Matrix<double, 8, 6>::Zero();
  padded_Gamma.topRows<6>() = Gamma;
  sweep_kernels().add_child_modes(n, padded_Gamma.data(), child.Pi_t8.data(), child.Pi_tT.data(), child.to_node.data(),
                                  parent.L11.data(), parent.P_rf.data());
}

}  // namespace

void articulate(const Multibody& system, Sweeps& sweeps, const ImplicitTerms& implicit) {
  const auto count = static_cast<int>(system.bodies.size());
  for (BodySweep& s : sweeps.bodies) {
    const Index n = s.L11.cols();
    s.P_rr = s.M.bottomRightCorner<6, 6>();
    if (n == 0) continue;
    s.L11.topRows(n) = s.M.topLeftCorner(n, n);
    s.P_rf.topRows<6>() = s.M.bottomLeftCorner(6, n);
  }
  for (int k = count - 1; k >= 0; --k) {
    const HingedBody& b = system.bodies[static_cast<std::size_t>(k)];
    BodySweep& s = sweeps.bodies[static_cast<std::size_t>(k)];
    take_out_modes(b, implicit, s);
    take_out_hinge(b, implicit, s);
    if (b.parent >= 0) add_to_parent(s, sweeps.bodies[static_cast<std::size_t>(b.parent)]);
  }
}

namespace {

// Eq (64); without motion: no a_m, no b_m, base at rest.
template <bool Motion>
void sweep(const Multibody& system, Sweeps& sweeps, const VectorXd& T, VectorXd& v_dot) {
  const SweepKernels& kernels = sweep_kernels();
  const Vec6 still = Vec6::Zero();
  const auto count = static_cast<int>(system.bodies.size());
  for (BodySweep& s : sweeps.bodies) {
    const Index n = s.L11.cols();
    if constexpr (Motion) {
      s.z_f.head(n) = s.b.head(n);
      s.z_r = s.b.tail<6>();
    } else {
      s.z_f.setZero();
      s.z_r.setZero();
    }
  }
  for (int k = count - 1; k >= 0; --k) {  // tip to base
    const HingedBody& b = system.bodies[static_cast<std::size_t>(k)];
    BodySweep& s = sweeps.bodies[static_cast<std::size_t>(k)];
    const Index n = s.L11.cols(), r = s.H_F.cols(), first = system.v_offset[static_cast<std::size_t>(k)];
    Vec6 z = s.z_r;  // z_R
    if (n > 0) {
      s.y.head(n) = T.segment(first, n) - s.z_f.head(n);  // ε_f
      for (Index i = 0; i < s.Pi_F.cols(); ++i) s.y[i] += s.Pi_F.col(i).dot(s.z_r);
      Eigen::Matrix<double, 8, 1> felt = Eigen::Matrix<double, 8, 1>::Zero();  // g ε_f
      kernels.lower_sweep(static_cast<int>(n), s.L11.data(), s.inverse.data(), s.L21.data(), s.y.data(), felt.data());
      z += felt.head<6>();
    }
    if (r == 1) {
      const double* a = Motion ? s.a.data() : still.data();
      const double epsilon = kernels.hinge_sweep(s.P_R.data(), a, s.H_F.data(), s.G_R.data(), T[first + n], z.data());
      s.nu_R[0] = epsilon / (s.D_R(0, 0) * s.D_R(0, 0));
    } else {
      if constexpr (Motion) z.noalias() += s.P_R * s.a;
      for (Index j = 0; j < r; ++j) s.nu_R[j] = T[first + n + j] - s.H_F.col(j).dot(z);  // ε_R
      for (Index j = 0; j < r; ++j) z += s.nu_R[j] * s.G_R.col(j);                       // z_R⁺
      solve_hinge(s, s.nu_R);
    }
    if (b.parent >= 0) {
      BodySweep& parent = sweeps.bodies[static_cast<std::size_t>(b.parent)];
      const Vec6 at_node = s.X.wrench(z);
      parent.z_r += shift_wrench(at_node, s.to_node);
      if (s.Pi_t.cols() > 0)
        kernels.add_mode_forces(static_cast<int>(s.Pi_t.cols()), s.Pi_tT.data(), at_node.data(), parent.z_f.data());
    }
  }
  Vec6 base = Vec6::Zero();
  if constexpr (Motion) base.head<3>() = -system.gravity;
  for (int k = 0; k < count; ++k) {  // base to tip
    const HingedBody& b = system.bodies[static_cast<std::size_t>(k)];
    BodySweep& s = sweeps.bodies[static_cast<std::size_t>(k)];
    const Index n = s.L11.cols(), r = s.H_F.cols(), first = system.v_offset[static_cast<std::size_t>(k)];
    Vec6 at_node = base;
    if (b.parent >= 0) {
      const auto p = static_cast<std::size_t>(b.parent);
      at_node = shift_twist(sweeps.bodies[p].alpha, s.to_node);
      for (Index i = 0; i < s.Pi_t.cols(); ++i) at_node += v_dot[system.v_offset[p] + i] * s.Pi_t.col(i);
    }
    s.alpha = s.X.twist(at_node);  // α_R⁺
    for (Index j = 0; j < r; ++j) v_dot[first + n + j] = s.nu_R[j] - s.G_R.col(j).dot(s.alpha);
    for (Index j = 0; j < r; ++j) s.alpha += v_dot[first + n + j] * s.H_F.col(j);
    if constexpr (Motion) s.alpha += s.a;
    if (n > 0) {
      Eigen::Matrix<double, 8, 1> alpha = Eigen::Matrix<double, 8, 1>::Zero();
      alpha.head<6>() = s.alpha;
      kernels.upper_sweep(static_cast<int>(n), s.L11.data(), s.inverse.data(), s.L21.data(), alpha.data(), s.y.data());
      v_dot.segment(first, n) = s.y.head(n);
      for (Index i = 0; i < s.Pi_F.cols(); ++i) s.alpha -= s.y[i] * s.Pi_F.col(i);
    }
  }
}

}  // namespace

void forward_dynamics(const Multibody& system, Sweeps& sweeps, const VectorXd& T, VectorXd& v_dot) {
  sweep<true>(system, sweeps, T, v_dot);
}

void solve(const Multibody& system, Sweeps& sweeps, const VectorXd& f, VectorXd& x) {
  sweep<false>(system, sweeps, f, x);
}

}  // namespace tenon::assembly
