// Element matrices, and assembly on two threads against one: ratios in one run.
#include <benchmark/benchmark.h>
#include <omp.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <vector>

#include "fem/elements/beam.hpp"
#include "fem/elements/shell.hpp"
#include "fem/structure.hpp"
#include "tests/benchmarks/plate.hpp"

using namespace tenon;

namespace {

const fem::Material aluminium{.name = "aluminium", .E = 7e10, .G = 2.7e10, .nu = 0.3, .rho = 2700.0};

void beam(benchmark::State& state) {
  const fem::BeamSection section{
      .name = "bar", .A = 1e-4, .Iy = 1e-9, .Iz = 2e-9, .J = 2e-9, .kappa_y = 0.8, .kappa_z = 0.8};
  const std::array<fem::Vec3, 2> nodes{fem::Vec3(0.0, 0.0, 0.0), fem::Vec3(0.3, 0.2, 0.1)};
  const fem::Beam element{.nodes = {0, 1}};
  fem::ElementMatrices out;
  for (auto _ : state) {
    fem::beam_matrices(element, section, aluminium, nodes, out);
    benchmark::DoNotOptimize(out.K.data());
  }
}

const fem::ShellSection skin{.name = "skin", .thickness = 1e-3};
const std::array<fem::Vec3, 4> corners{fem::Vec3(0.0, 0.0, 0.0), fem::Vec3(0.1, 0.01, 0.0), fem::Vec3(0.11, 0.1, 0.01),
                                       fem::Vec3(0.0, 0.09, 0.0)};

// normals of a surface curved both ways, so that the curvature terms take part
const std::array<fem::Vec3, 4> normals{fem::Vec3(-0.05, -0.04, 1.0), fem::Vec3(0.05, -0.05, 1.0),
                                       fem::Vec3(0.06, 0.05, 1.0), fem::Vec3(-0.04, 0.04, 1.0)};

void quad(benchmark::State& state) {
  fem::ElementMatrices out;
  for (auto _ : state) {
    fem::quad4_matrices({.nodes = {0, 1, 2, 3}}, skin, aluminium, corners, out);
    benchmark::DoNotOptimize(out.K.data());
  }
}

void triangle(benchmark::State& state) {
  fem::ElementMatrices out;
  for (auto _ : state) {
    fem::tria3_matrices({.nodes = {0, 1, 2}}, skin, aluminium, corners, out);
    benchmark::DoNotOptimize(out.K.data());
  }
}

void curved_quad(benchmark::State& state) {
  fem::ElementMatrices out;
  for (auto _ : state) {
    fem::quad4_matrices({.nodes = {0, 1, 2, 3}}, skin, aluminium, corners, out, normals);
    benchmark::DoNotOptimize(out.K.data());
  }
}

void curved_triangle(benchmark::State& state) {
  fem::ElementMatrices out;
  for (auto _ : state) {
    fem::tria3_matrices({.nodes = {0, 1, 2}}, skin, aluminium, corners, out, normals);
    benchmark::DoNotOptimize(out.K.data());
  }
}

/// What `work` returns is freed after the clock has stopped.
template <class Work>
double seconds(int threads, Work work) {
  omp_set_num_threads(threads);
  const auto start = std::chrono::steady_clock::now();
  const auto result = work();
  const double time = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  benchmark::DoNotOptimize(&result);
  return time;
}

/// Element matrices alone, nothing shared: what the second core of this machine can give.
int quads_side_by_side() {
  constexpr int count = 40'000;
#pragma omp parallel
  {
    fem::ElementMatrices out;
#pragma omp for
    for (int i = 0; i < count; ++i) {
      fem::quad4_matrices({.nodes = {0, 1, 2, 3}}, skin, aluminium, corners, out);
      benchmark::DoNotOptimize(out.K.data());
    }
  }
  return count;
}

/// How many times faster two threads assemble than one, and compute element matrices alone: medians of turns taken one
/// after the other.
void assemble_on_two_threads(benchmark::State& state) {
  const fem::Model model = benchmarks::plate_model({.n = 200, .clamped = true, .tilted = state.range(0) != 0});
  const auto assemble = [&] { return fem::assemble(model); };
  const auto median = [](std::vector<double>& gains) {
    std::sort(gains.begin(), gains.end());
    return gains[gains.size() / 2];
  };
  std::vector<double> gains, limits;
  for (auto _ : state) {
    const double one = seconds(1, assemble), alone = seconds(1, quads_side_by_side);
    gains.push_back(one / seconds(2, assemble));
    limits.push_back(alone / seconds(2, quads_side_by_side));
  }
  state.counters["gain"] = median(gains);
  state.counters["elements_alone"] = median(limits);
}

}  // namespace

BENCHMARK(beam);
BENCHMARK(quad);
BENCHMARK(triangle);
BENCHMARK(curved_quad);
BENCHMARK(curved_triangle);
BENCHMARK(assemble_on_two_threads)->ArgName("tilted")->Arg(0)->Arg(1)->Unit(benchmark::kSecond)->Iterations(9);
BENCHMARK_MAIN();
