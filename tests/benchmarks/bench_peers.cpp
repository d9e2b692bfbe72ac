// Forward dynamics of the same rigid chain by this project, by DART and by Simbody, in one run; the accelerations of
// all three are compared first. Built when both are installed (libdart-dev, libsimbody-dev).
#include <benchmark/benchmark.h>

#include <dart/dynamics/BodyNode.hpp>
#include <dart/dynamics/Inertia.hpp>
#include <dart/dynamics/RevoluteJoint.hpp>
#include <dart/dynamics/Skeleton.hpp>
#include <iostream>

#include "assembly/recursion/sweeps.hpp"
#include "chain.hpp"
#include "simbody_chain.hpp"

using namespace tenon;

namespace {

struct Ours {
  assembly::Multibody mb;
  assembly::MotionState s;
  assembly::Sweeps sweeps;
  Eigen::VectorXd T, v_dot;
  explicit Ours(int bodies)
      : mb(bench::chain(bodies, 0)), s(bench::bent(mb)), sweeps(make_sweeps(mb)), T(mb.nv), v_dot(mb.nv) {
    T.setZero();
  }
  void run() {
    set_state(mb, s.q, s.v, sweeps);
    articulated_forward_dynamics(mb, sweeps, T, v_dot);
  }
};

struct Dart {
  dart::dynamics::SkeletonPtr skeleton = dart::dynamics::Skeleton::create("chain");
  Eigen::VectorXd q, v;
  explicit Dart(int bodies) {
    skeleton->setGravity(Eigen::Vector3d(0.0, 0.0, -9.81));
    dart::dynamics::BodyNode* parent = nullptr;
    for (int k = 0; k < bodies; ++k) {
      dart::dynamics::RevoluteJoint::Properties joint;
      joint.mName = "j" + std::to_string(k);
      joint.mAxis =
          k % 2 == 1 ? Eigen::Vector3d(0.0, -std::sin(bench::tilt), std::cos(bench::tilt)) : Eigen::Vector3d::UnitZ();
      if (k > 0) joint.mT_ParentBodyToJoint.translation() = bench::length * Eigen::Vector3d::UnitX();
      const dart::dynamics::BodyNode::AspectProperties body("b" + std::to_string(k));
      parent = skeleton->createJointAndBodyNodePair<dart::dynamics::RevoluteJoint>(parent, joint, body).second;
      parent->setInertia(dart::dynamics::Inertia(bench::mass, Eigen::Vector3d(0.5 * bench::length, 0.0, 0.0),
                                                 bench::inertia * Eigen::Matrix3d::Identity()));
    }
    q = Eigen::VectorXd::NullaryExpr(bodies, [](Eigen::Index i) { return bench::bend(i); });
    v = -q;
  }
  void run() {
    skeleton->setPositions(q);
    skeleton->setVelocities(v);
    skeleton->computeForwardDynamics();
  }
};

template <class System>
void forward(benchmark::State& state) {
  const auto bodies = static_cast<int>(state.range(0));
  System system(bodies);
  for (auto _ : state) system.run();
  state.counters["per_body"] = benchmark::Counter(static_cast<double>(state.iterations()) * bodies,
                                                  benchmark::Counter::kIsRate | benchmark::Counter::kInvert);
}

bool agree() {
  Ours ours(20);
  Dart dart(20);
  bench::SimbodyChain simbody(20);
  ours.run();
  dart.run();
  simbody.run();
  double by_dart = (dart.skeleton->getAccelerations() - ours.v_dot).norm() / ours.v_dot.norm(), by_simbody = 0.0;
  for (int k = 0; k < 20; ++k) by_simbody = std::max(by_simbody, std::abs(simbody.acceleration(k) - ours.v_dot[k]));
  by_simbody /= ours.v_dot.norm();
  std::cout << "accelerations of 20 links: DART " << by_dart << ", Simbody " << by_simbody << " apart\n";
  return by_dart < 1e-10 && by_simbody < 1e-10;
}

}  // namespace

BENCHMARK(forward<Ours>)->Arg(10)->Arg(100)->Arg(1000)->Unit(benchmark::kMicrosecond);
BENCHMARK(forward<bench::SimbodyChain>)->Arg(10)->Arg(100)->Arg(1000)->Unit(benchmark::kMicrosecond);
BENCHMARK(forward<Dart>)->Arg(10)->Arg(100)->Arg(1000)->Unit(benchmark::kMicrosecond);

int main(int argc, char** argv) {
  if (!agree()) return 1;
  benchmark::Initialize(&argc, argv);
  benchmark::RunSpecifiedBenchmarks();
}
