// Assembly, modes and Craig-Bampton of a 241,200-dof shell plate (40,000 quads), each as a ratio to one CHOLMOD analyse
// + factor of its own stiffness, measured in the same run. Absolute times are side information.
#include <benchmark/benchmark.h>

#include <algorithm>
#include <chrono>
#include <string>
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

double factor_seconds(const fem::SparseMatrix& K) {
  const auto start = std::chrono::steady_clock::now();
  const reduction::Factor factor = reduction::factorize(K);
  benchmark::DoNotOptimize(factor.n());
  return seconds_since(start);
}

double median(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  return values[values.size() / 2];
}

/// Times of a work as ratios to one analyse + factor of K; that is timed before and after each, so that a change in the
/// machine's speed meets both.
class Ratios {
 public:
  explicit Ratios(const fem::SparseMatrix& K) : K_(K), before_(factor_seconds(K)) {}
  void add(double seconds) {
    const double after = factor_seconds(K_);
    factors_.push_back(0.5 * (before_ + after));
    ratios_.push_back(seconds / factors_.back());
    before_ = after;
  }
  void report(benchmark::State& state, const std::string& name) const {
    state.counters[name] = median(ratios_);
    state.counters["factor_s"] = median(factors_);
  }

 private:
  const fem::SparseMatrix& K_;
  double before_;
  std::vector<double> factors_, ratios_;
};

benchmarks::Plate plate_of(const benchmark::State& state, bool clamped) {
  return {.n = side, .clamped = clamped, .tilted = state.range(0) != 0};
}

double bytes(const fem::SparseMatrix& A) {
  return static_cast<double>(A.nonZeros()) * (sizeof(double) + sizeof(int)) +
         static_cast<double>(A.rows()) * sizeof(int);
}

void assemble_plate(benchmark::State& state) {
  const fem::Model model = benchmarks::plate_model(plate_of(state, true));
  const fem::SparseMatrix K = fem::assemble(model).K;
  Ratios ratios(K);
  double memory = 0.0;
  for (auto _ : state) {
    const benchmarks::PeakMemory peak;
    const auto start = std::chrono::steady_clock::now();
    const fem::Structure s = fem::assemble(model);
    const double seconds = seconds_since(start);
    memory = std::max(memory, peak.rise() / (bytes(s.K) + bytes(s.M)));
    ratios.add(seconds);
  }
  ratios.report(state, "of_factor");
  state.counters["peak_of_KM"] = memory;
}

void twenty_modes(benchmark::State& state) {
  const fem::Structure s = fem::assemble(benchmarks::plate_model(plate_of(state, true)));
  Ratios ratios(s.K);
  for (auto _ : state) {
    const auto start = std::chrono::steady_clock::now();
    const reduction::Modes modes = reduction::solve_modes(s, {.count = 20, .certify = state.range(1) != 0});
    ratios.add(seconds_since(start));
    benchmark::DoNotOptimize(modes.lambda.data());
  }
  ratios.report(state, "of_factor");
}

/// What Craig-Bampton with two ports takes beyond the 20 fixed-interface modes of the same plate.
void craig_bampton_two_ports(benchmark::State& state) {
  const fem::Structure s = fem::assemble(benchmarks::plate_model(plate_of(state, false)));
  fem::Model fixed = benchmarks::plate_model(plate_of(state, false));
  for (const fem::Port& port : fixed.ports)
    for (int d = 0; d < 6; ++d) fixed.supports.push_back({{port.node, d}});
  fixed.ports.clear();
  const fem::Structure interior = fem::assemble(fixed);
  Ratios modes(interior.K), beyond(interior.K);
  for (auto _ : state) {
    auto start = std::chrono::steady_clock::now();
    benchmark::DoNotOptimize(reduction::solve_modes(interior, {.count = 20}).lambda.data());
    const double alone = seconds_since(start);
    modes.add(alone);
    start = std::chrono::steady_clock::now();
    benchmark::DoNotOptimize(
        reduction::reduce(s, "root", {.basis = reduction::Basis::craig_bampton, .modes = 20, .keep_shapes = false})
            .omega.data());
    beyond.add(seconds_since(start) - alone);
  }
  modes.report(state, "modes_of_factor");
  beyond.report(state, "beyond_modes_of_factor");
}

}  // namespace

BENCHMARK(assemble_plate)->ArgName("tilted")->Arg(1)->Arg(0)->Unit(benchmark::kSecond)->Iterations(3);
BENCHMARK(twenty_modes)
    ->ArgNames({"tilted", "certified"})
    ->Args({1, 1})
    ->Args({1, 0})
    ->Args({0, 1})
    ->Unit(benchmark::kSecond)
    ->Iterations(3);
BENCHMARK(craig_bampton_two_ports)->ArgName("tilted")->Arg(1)->Unit(benchmark::kSecond)->Iterations(3);

BENCHMARK_MAIN();
