#include "assembly/recursion/cost.hpp"

#include <fmt/format.h>

#include <Eigen/Cholesky>
#include <algorithm>
#include <chrono>

#include "fem/error.hpp"
#include "titop/beam.hpp"

namespace tenon::assembly {

using Eigen::MatrixXd;
using Eigen::VectorXd;

Flops composite_flops(int bodies, int modes) {
  const double n = modes, N = bodies, all = N * (n + 1.0), sum_k = 0.5 * N * (N + 1.0);
  Flops f;
  f.multiplications = N * (48.0 * n + 90.0);  // 1: R(k)
  f.additions = N * (n * n + 48.5 * n + 116.0);
  f.multiplications += sum_k * (12.0 * n * n + 34.0 * n + 13.0);  // 2: 𝓜
  f.additions += sum_k * (11.0 * n * n + 24.0 * n + 13.0);
  f.multiplications += N * (2.0 * n * n + 54.0 * n + 206.0);  // 3: 𝓒
  f.additions += N * (2.0 * n * n + 50.0 * n + 143.0);
  f.additions += all;                                                              // 4: T − 𝓒
  f.multiplications += all * all * all / 6.0 + 1.5 * all * all - 2.0 / 3.0 * all;  // 5: 𝓜 χ̇ = T − 𝓒
  f.additions += all * all * all / 6.0 + all * all - 7.0 / 6.0 * all;
  return f;
}

Flops articulated_flops(int bodies, int modes) {
  const double n = modes, N = bodies;
  Flops f;
  if (modes <= 7) {  // 1: eq (63)
    f.multiplications = 5.0 / 6.0 * n * n * n + 12.5 * n * n + 764.0 / 3.0 * n + 180.0;
    f.additions = 5.0 / 6.0 * n * n * n + 10.5 * n * n + 548.0 / 3.0 * n + 164.0;
  } else {
    f.multiplications = 12.0 * n * n + 255.0 * n + 572.0;
    f.additions = 13.0 * n * n + 182.0 * n + 445.0;
  }
  f.multiplications += n * n + 25.0 * n + 49.0;  // 2: eq (64), tip to base
  f.additions += n * n + 24.0 * n + 50.0;
  f.multiplications += 18.0 * n + 52.0;  // 3: base to tip
  f.additions += 19.0 * n + 42.0;
  return {N * f.multiplications, N * f.additions};
}

void composite_forward_dynamics(const Multibody& system, Sweeps& sweeps, const VectorXd& T, MatrixXd& mass,
                                VectorXd& v_dot) {
  composite_mass_matrix(system, sweeps, mass);
  VectorXd bias(system.nv);
  inverse_dynamics(system, sweeps, VectorXd::Zero(system.nv), bias);
  Eigen::LLT<Eigen::Ref<MatrixXd>> factors(mass);
  if (factors.info() != Eigen::Success)
    throw ModelError("the mass matrix of the system is singular", "Give every hinge something with mass to move");
  v_dot = factors.solve(T - bias);
}

MeasuredCost measure_cost(const Multibody& system) {
  using Clock = std::chrono::steady_clock;
  const MotionState state = rest_state(system);
  Sweeps sweeps = make_sweeps(system);
  const VectorXd T = VectorXd::Ones(system.nv);
  VectorXd v_dot(system.nv);
  MatrixXd mass;
  const auto best = [&](const auto& run) {  // the least of a fifth of a second, three runs at least
    double least = 1e300;
    const auto begin = Clock::now();
    for (int k = 0; k < 3 || std::chrono::duration<double>(Clock::now() - begin).count() < 0.2; ++k) {
      const auto start = Clock::now();
      set_state(system, state.q, state.v, sweeps);
      run();
      least = std::min(least, std::chrono::duration<double>(Clock::now() - start).count());
    }
    return least;
  };
  MeasuredCost cost;
  cost.articulated = best([&] { articulated_forward_dynamics(system, sweeps, T, v_dot); });
  cost.composite = best([&] { composite_forward_dynamics(system, sweeps, T, mass, v_dot); });
  return cost;
}

std::string cheaper(const MeasuredCost& cost) {
  const bool articulated = cost.articulated_is_cheaper();
  const double ratio = articulated ? cost.composite / cost.articulated : cost.articulated / cost.composite;
  return fmt::format("{} bodies, {:.3g} times faster than {} bodies", articulated ? "articulated" : "composite", ratio,
                     articulated ? "composite" : "articulated");
}

Multibody beam_chain(int bodies, int modes) {
  const titop::BeamProperties strip{.length = 1.0,
                                    .E = 70e9,
                                    .G = 26e9,
                                    .rho = 2700.0,
                                    .A = 4e-4,
                                    .Iy = 1.3e-8,
                                    .Iz = 1.3e-8,
                                    .J = 2.2e-8,
                                    .Ip = 2.6e-8};
  const titop::BeamOptions options{.model = titop::BeamModel::clamped_free,
                                   .modes = std::max(1, modes),
                                   .bend_xy = modes > 0,
                                   .bend_xz = false,
                                   .traction = false,
                                   .torsion = false,
                                   .samples = 0};
  const auto link = std::make_shared<const ReducedBody>(titop::beam_body("link", strip, options));
  return serial_chain(link, bodies, Deformation::dropped);
}

}  // namespace tenon::assembly
