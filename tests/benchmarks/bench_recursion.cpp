// Recursive dynamics of chains: time per body and per call, and composite against articulated bodies. `counted_flops/s`
// divides the flops that the spatial-operator paper counts, for free-free modes, by the time of these chains, whose
// cantilever modes are less work than that. Run on one core; ratios are of one run.
#include <benchmark/benchmark.h>

#include "arm.hpp"
#include "assembly/integration/implicit.hpp"
#include "assembly/recursion/cost.hpp"
#include "chain.hpp"

using namespace tenon;
using assembly::Multibody;
using bench::bent;
using bench::chain;

namespace {

void articulated(benchmark::State& state) {
  const auto bodies = static_cast<int>(state.range(0)), modes = static_cast<int>(state.range(1));
  const Multibody mb = chain(bodies, modes);
  const assembly::MotionState s = bent(mb);
  assembly::Sweeps sweeps = make_sweeps(mb);
  Eigen::VectorXd T = Eigen::VectorXd::Zero(mb.nv), v_dot(mb.nv);
  for (auto _ : state) {
    set_state(mb, s.q, s.v, sweeps);
    passive_forces(mb, s.q, s.v, T);
    articulated_forward_dynamics(mb, sweeps, T, v_dot);
    benchmark::DoNotOptimize(v_dot.data());
  }
  const double calls = static_cast<double>(state.iterations()) * bodies;
  state.counters["per_body"] = benchmark::Counter(calls, benchmark::Counter::kIsRate | benchmark::Counter::kInvert);
  state.counters["counted_flops/s"] =
      benchmark::Counter(calls * assembly::articulated_flops(1, modes).total(), benchmark::Counter::kIsRate);
}

void inverse(benchmark::State& state) {
  const auto bodies = static_cast<int>(state.range(0)), modes = static_cast<int>(state.range(1));
  const Multibody mb = chain(bodies, modes);
  const assembly::MotionState s = bent(mb);
  assembly::Sweeps sweeps = make_sweeps(mb);
  Eigen::VectorXd T(mb.nv);
  for (auto _ : state) {
    set_state(mb, s.q, s.v, sweeps);
    inverse_dynamics(mb, sweeps, s.v, T);
    benchmark::DoNotOptimize(T.data());
  }
  state.counters["per_body"] = benchmark::Counter(static_cast<double>(state.iterations()) * bodies,
                                                  benchmark::Counter::kIsRate | benchmark::Counter::kInvert);
}

void composite(benchmark::State& state) {
  const auto bodies = static_cast<int>(state.range(0)), modes = static_cast<int>(state.range(1));
  const Multibody mb = chain(bodies, modes);
  const assembly::MotionState s = bent(mb);
  assembly::Sweeps sweeps = make_sweeps(mb);
  Eigen::VectorXd T(mb.nv), v_dot(mb.nv);
  Eigen::MatrixXd mass;
  for (auto _ : state) {
    set_state(mb, s.q, s.v, sweeps);
    passive_forces(mb, s.q, s.v, T);
    composite_forward_dynamics(mb, sweeps, T, mass, v_dot);
    benchmark::DoNotOptimize(v_dot.data());
  }
  state.counters["per_body"] = benchmark::Counter(static_cast<double>(state.iterations()) * bodies,
                                                  benchmark::Counter::kIsRate | benchmark::Counter::kInvert);
}

// A swinging arm in steps of 1 ms: wall time over time simulated.
void real_time(benchmark::State& state) {
  const auto deformation = state.range(0) == 1 ? assembly::Deformation::full : assembly::Deformation::dropped;
  const Multibody mb = bench::arm(50, deformation);
  assembly::Dynamics dynamics = make_dynamics(mb);
  assembly::ImplicitWork work = make_implicit_work(dynamics);
  assembly::ImplicitState at{rest_state(mb), Eigen::VectorXd::Zero(mb.nv), Eigen::VectorXd::Zero(mb.nv)};
  constexpr double h = 1e-3;
  double t = 0.0;
  long iterations = 0;
  for (auto _ : state) {
    generalized_alpha_step(dynamics, t, h, {}, work, at);
    t += h;
    iterations += work.iterations;
  }
  state.counters["of_real_time"] = benchmark::Counter(t, benchmark::Counter::kIsRate | benchmark::Counter::kInvert);
  state.counters["iterations"] = static_cast<double>(iterations) / static_cast<double>(state.iterations());
}

}  // namespace

BENCHMARK(real_time)->Arg(0)->Arg(1)->Iterations(1000)->Unit(benchmark::kMicrosecond);
BENCHMARK(articulated)->ArgsProduct({{10, 100, 1000, 10000}, {0, 1, 5, 10}})->Unit(benchmark::kMicrosecond);
BENCHMARK(inverse)->ArgsProduct({{10, 1000}, {0, 10}})->Unit(benchmark::kMicrosecond);
BENCHMARK(composite)->ArgsProduct({{2, 10, 100}, {0, 1, 5, 10, 15}})->Unit(benchmark::kMicrosecond);
BENCHMARK(articulated)->ArgsProduct({{2, 10, 100}, {15}})->Unit(benchmark::kMicrosecond);
BENCHMARK_MAIN();
