// Assembly, modes and Craig-Bampton of a 241,200-dof shell plate (40,000 quads), each as a ratio to one CHOLMOD analyse
// + factor of its own stiffness, measured in the same run. Absolute times are side information.
#include <benchmark/benchmark.h>

#include <algorithm>
#include <chrono>
#include <vector>

#include "fem/structure.hpp"
#include "reduction/factor.hpp"
#include "reduction/modes.hpp"
#include "reduction/reduce.hpp"
#include "tests/benchmarks/peak_memory.hpp"
#include "tests/benchmarks/plate.hpp"

using namespace tenon;

namespace {

constexpr int side = 200;

double seconds_since(std::chrono::steady_clock::time_point start) {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

/// One analyse + factor, the median of three.
double factor_seconds(const fem::SparseMatrix& K) {
  std::vector<double> seconds;
  for (int i = 0; i < 3; ++i) {
    const auto start = std::chrono::steady_clock::now();
    const reduction::Factor factor = reduction::factorize(K);
    seconds.push_back(seconds_since(start));
    benchmark::DoNotOptimize(factor.n());
  }
  std::sort(seconds.begin(), seconds.end());
  return seconds[1];
}

benchmarks::Plate plate_of(const benchmark::State& state, bool clamped) {
  return {.n = side, .clamped = clamped, .tilted = state.range(0) != 0};
}

double bytes(const fem::SparseMatrix& A) {
  return static_cast<double>(A.nonZeros()) * (sizeof(double) + sizeof(int)) +
         static_cast<double>(A.rows()) * sizeof(int);
}

void assemble_plate(benchmark::State& state) {
  const fem::Model model = benchmarks::plate_model(plate_of(state, true));
  const double factor = factor_seconds(fem::assemble(model).K);
  double seconds = 0.0, memory = 0.0;
  for (auto _ : state) {
    const benchmarks::PeakMemory peak;
    const auto start = std::chrono::steady_clock::now();
    const fem::Structure s = fem::assemble(model);
    seconds += seconds_since(start);
    memory = std::max(memory, peak.rise() / (bytes(s.K) + bytes(s.M)));
  }
  state.counters["of_factor"] = seconds / static_cast<double>(state.iterations()) / factor;
  state.counters["peak_of_KM"] = memory;
  state.counters["factor_s"] = factor;
}

void twenty_modes(benchmark::State& state) {
  const fem::Structure s = fem::assemble(benchmarks::plate_model(plate_of(state, true)));
  const double factor = factor_seconds(s.K);
  double seconds = 0.0;
  for (auto _ : state) {
    const auto start = std::chrono::steady_clock::now();
    const reduction::Modes modes = reduction::solve_modes(s, {.count = 20, .certify = state.range(1) != 0});
    seconds += seconds_since(start);
    benchmark::DoNotOptimize(modes.lambda.data());
  }
  state.counters["of_factor"] = seconds / static_cast<double>(state.iterations()) / factor;
  state.counters["factor_s"] = factor;
}

/// What Craig-Bampton with two ports takes beyond the 20 fixed-interface modes of the same plate.
void craig_bampton_two_ports(benchmark::State& state) {
  const fem::Structure s = fem::assemble(benchmarks::plate_model(plate_of(state, false)));
  fem::Model fixed = benchmarks::plate_model(plate_of(state, false));
  for (const fem::Port& port : fixed.ports)
    for (int d = 0; d < 6; ++d) fixed.supports.push_back({{port.node, d}});
  fixed.ports.clear();
  const fem::Structure interior = fem::assemble(fixed);
  const double factor = factor_seconds(interior.K);
  double modes = 0.0, reduction_ = 0.0;
  for (auto _ : state) {
    auto start = std::chrono::steady_clock::now();
    benchmark::DoNotOptimize(reduction::solve_modes(interior, {.count = 20}).lambda.data());
    modes += seconds_since(start);
    start = std::chrono::steady_clock::now();
    benchmark::DoNotOptimize(reduction::reduce(s, "root", {.modes = 20, .keep_shapes = false}).omega.data());
    reduction_ += seconds_since(start);
  }
  const auto n = static_cast<double>(state.iterations());
  state.counters["beyond_modes_of_factor"] = (reduction_ - modes) / n / factor;
  state.counters["modes_of_factor"] = modes / n / factor;
  state.counters["factor_s"] = factor;
}

}  // namespace

BENCHMARK(assemble_plate)->ArgName("tilted")->Arg(1)->Arg(0)->Unit(benchmark::kSecond)->Iterations(3);
BENCHMARK(twenty_modes)
    ->ArgNames({"tilted", "certified"})
    ->Args({1, 1})
    ->Args({1, 0})
    ->Args({0, 1})
    ->Unit(benchmark::kSecond)
    ->Iterations(2);
BENCHMARK(craig_bampton_two_ports)->ArgName("tilted")->Arg(1)->Unit(benchmark::kSecond)->Iterations(2);

BENCHMARK_MAIN();
