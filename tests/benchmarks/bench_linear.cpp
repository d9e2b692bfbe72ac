// Sweeps and interconnections. The sweep is an absolute time (its goal is one); the interconnection is a ratio to dense
// eigen-solves of the result's size, measured in the same run.
#include <benchmark/benchmark.h>

#include <Eigen/Eigenvalues>
#include <chrono>
#include <filesystem>
#include <numbers>

#include "assembly/build.hpp"
#include "assembly/port_algebra.hpp"
#include "assembly/sweep.hpp"

using namespace tenon;

namespace {

double seconds_since(std::chrono::steady_clock::time_point start) {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

/// The four-bar mechanism of the TITOP paper at 361 angles: modes and mode shapes.
void sweep_four_bar(benchmark::State& state) {
  const assembly::Scene scene =
      assembly::read_scene(std::filesystem::path(TENON_SOURCE_DIR) / "data" / "fourbar" / "scene.yaml");
  const assembly::Network network = assembly::build_network(scene, assembly::plan(scene));
  for (auto _ : state)
    benchmark::DoNotOptimize(
        assembly::sweep(network, 0,
                        {.from = 0.0, .to = 2.0 * std::numbers::pi, .steps = 361, .modes = 15, .shapes = true})
            .data());
}

/// A cantilever body with modes of its own, as long as its index.
reduction::ReducedBody link(int k, int modes) {
  reduction::ReducedBody body = reduction::rigid_body(
      "link" + std::to_string(k), 2.0, fem::Vec3(0.5, 0.0, 0.0), 0.2 * fem::Mat3::Identity(),
      {{"P", fem::Vec3::Zero(), fem::Mat3::Identity(), {}}, {"C", fem::Vec3::UnitX(), fem::Mat3::Identity(), {}}});
  body.omega = Eigen::VectorXd::LinSpaced(modes, 1.0 + 0.01 * k, 50.0);
  body.zeta = Eigen::VectorXd::Zero(modes);
  body.L = Eigen::MatrixXd::NullaryExpr(modes, 6, [&](Eigen::Index i, Eigen::Index j) {
    return 0.3 * std::cos(1.0 + 2.4 * static_cast<double>(i * 6 + j) + k) / std::sqrt(modes);
  });
  body.ports[0].Phi = fem::Mat6X::Zero(6, modes);
  body.ports[1].Phi = fem::Mat6X::NullaryExpr(6, modes, [&](Eigen::Index i, Eigen::Index j) {
    return 0.5 * std::sin(0.7 + 1.9 * static_cast<double>(i + 6 * j) + k);
  });
  return body;
}

assembly::Network chain(int bodies, int modes) {
  assembly::Network net;
  for (int k = 0; k < bodies; ++k) {
    net.bodies.push_back(link(k, modes));
    if (k == 0) continue;
    assembly::Joint joint;
    joint.name = "j" + std::to_string(k);
    joint.parent = {k - 1, 1};
    joint.child = {k, 0};
    net.joints.push_back(joint);
  }
  net.ground = {{0, 0}};
  net.inputs = {{"push", assembly::PortRef{bodies - 1, 1}, 1, {}}};
  net.outputs = {{"tip", assembly::Quantity::acceleration, assembly::PortRef{bodies - 1, 1}, 1, {}}};
  return net;
}

/// Bodies of 20 modes in a row by port algebra against a dense eigen-solve of the result's A. At 100 bodies (order
/// 4,000) the eigen-solve is that of order 1,000 times 64.
void interconnect(benchmark::State& state) {
  const auto bodies = static_cast<int>(state.range(0));
  const assembly::Network net = chain(bodies, 20);
  const assembly::Network small = chain(25, 20);
  auto start = std::chrono::steady_clock::now();
  const Eigen::MatrixXd A = assembly::port_algebra(small).ss.A;
  start = std::chrono::steady_clock::now();
  const Eigen::EigenSolver<Eigen::MatrixXd> eigen(A, false);
  benchmark::DoNotOptimize(eigen.eigenvalues().data());
  const double ratio = static_cast<double>(40 * bodies) / static_cast<double>(A.rows());
  const double solve = seconds_since(start) * ratio * ratio * ratio;
  double seconds = 0.0;
  for (auto _ : state) {
    start = std::chrono::steady_clock::now();
    benchmark::DoNotOptimize(assembly::port_algebra(net).ss.A.data());
    seconds += seconds_since(start);
  }
  state.counters["of_eigen_solve"] = seconds / static_cast<double>(state.iterations()) / solve;
}

}  // namespace

BENCHMARK(sweep_four_bar)->Unit(benchmark::kMillisecond);
BENCHMARK(interconnect)->ArgName("bodies")->Arg(25)->Arg(100)->Unit(benchmark::kSecond)->Iterations(1);

BENCHMARK_MAIN();
