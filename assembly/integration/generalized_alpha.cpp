#include <cmath>

#include "assembly/integration/implicit.hpp"

namespace tenon::assembly {

using Eigen::VectorXd;

void generalized_alpha_step(Dynamics& dynamics, double t, double h, const ImplicitOptions& options, ImplicitWork& work,
                            ImplicitState& state) {
  const Multibody& system = *dynamics.system;
  const double rho = options.rho_infinity;
  const double alpha_m = (2.0 * rho - 1.0) / (rho + 1.0), alpha_f = rho / (rho + 1.0);
  const double gamma = 0.5 + alpha_f - alpha_m, beta = 0.25 * (gamma + 0.5) * (gamma + 0.5);
  const double mu = (1.0 - alpha_m) / (1.0 - alpha_f);  // ∂χ̇₁/∂a₁
  const MotionState& from = state.motion;
  MotionState& to = work.next;

  // (1 − α_m) a₁ + α_m a₀ = (1 − α_f) χ̇₁ + α_f χ̇₀, begun with χ̇₁ = χ̇₀
  work.a = (state.v_dot - alpha_m * state.a) / (1.0 - alpha_m);
  work.iterations = 0;
  const double tolerance = options.tolerance > 0.0 ? options.tolerance : 1e-10;
  Convergence convergence{t, h, tolerance, options.most_iterations, round_off_of_gaps(dynamics), work};
  for (;;) {
    work.delta = h * from.v + h * h * ((0.5 - beta) * state.a + beta * work.a);
    to.q = from.q;
    move(system, work.delta, to.q);
    to.v = from.v + h * ((1.0 - gamma) * state.a + gamma * work.a);
    work.v_dot = ((1.0 - alpha_m) * work.a + alpha_m * state.a - alpha_f * state.v_dot) / (1.0 - alpha_f);
    set_forces(dynamics, t + h, to);
    if (work.iterations == 0) {
      const Energy e = energy(system, dynamics.sweeps, to.q, to.v);
      work.energy = std::max(work.energy, e.kinetic + e.elastic);
      factor(dynamics, to, {gamma * h / mu, beta * h * h / mu}, work);
    }
    inverse_dynamics(system, dynamics.sweeps, work.v_dot, work.r);  // 𝓜 χ̇ + 𝓒 − T − Jᵀ λ
    work.r -= dynamics.T;
    if (dynamics.loops()) {
      closure_rows(system, dynamics.sweeps, to.q, to.v, dynamics.rows);
      work.r.noalias() -= dynamics.rows.J_t * dynamics.lambda;
    }
    const CorrectionSize size = correction(dynamics, mu / (beta * h * h), work, dynamics.lambda);
    work.a += work.x / mu;
    const double to_speeds = std::pow(gamma * h / mu, 2);
    if (convergence.reached({size.all * to_speeds, size.forces * to_speeds})) break;
  }
  work.delta = h * from.v + h * h * ((0.5 - beta) * state.a + beta * work.a);
  move(system, work.delta, state.motion.q);
  state.motion.v += h * ((1.0 - gamma) * state.a + gamma * work.a);
  work.v_dot = ((1.0 - alpha_m) * work.a + alpha_m * state.a - alpha_f * state.v_dot) / (1.0 - alpha_f);
  state.v_dot = work.v_dot;
  state.a = work.a;
  if (dynamics.loops()) close_speeds(dynamics, dynamics.sweeps, work, state.motion);
}

}  // namespace tenon::assembly
