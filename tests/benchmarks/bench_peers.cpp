// Forward dynamics of the same rigid chain by this project, by DART and by Simbody, in one run; the accelerations of
// all three are compared first. Built when both are installed (libdart-dev, libsimbody-dev).
#include <Simbody.h>
#include <benchmark/benchmark.h>

#include <dart/dynamics/dynamics.hpp>
#include <iostream>

#include "assembly/recursion/sweeps.hpp"
#include "chain.hpp"

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
    articulate(mb, sweeps);
    forward_dynamics(mb, sweeps, T, v_dot);
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
    q = Eigen::VectorXd::NullaryExpr(bodies, bench::bend);
    v = -q;
  }
  void run() {
    skeleton->setPositions(q);
    skeleton->setVelocities(v);
    skeleton->computeForwardDynamics();
  }
};

struct Simbody {
  SimTK::MultibodySystem system;
  SimTK::SimbodyMatterSubsystem matter{system};
  SimTK::GeneralForceSubsystem forces{system};
  SimTK::Force::Gravity gravity{forces, matter, SimTK::Vec3(0, 0, -9.81)};
  SimTK::State state;
  int bodies;
  explicit Simbody(int count) : bodies(count) {
    const SimTK::Vec3 centre(0.5 * bench::length, 0, 0);
    const SimTK::Body::Rigid link(SimTK::MassProperties(
        bench::mass, centre, SimTK::Inertia(bench::inertia).shiftFromMassCenter(centre, bench::mass)));
    SimTK::MobilizedBody parent = matter.Ground();
    for (int k = 0; k < count; ++k) {
      const SimTK::Rotation turn = k % 2 == 1 ? SimTK::Rotation(bench::tilt, SimTK::XAxis) : SimTK::Rotation();
      parent = SimTK::MobilizedBody::Pin(parent, SimTK::Transform(turn, SimTK::Vec3(k > 0 ? bench::length : 0.0, 0, 0)),
                                         link, SimTK::Transform(turn));
    }
    state = system.realizeTopology();
  }
  void run() {
    SimTK::Vector& q = state.updQ();
    SimTK::Vector& u = state.updU();
    for (int k = 0; k < bodies; ++k) {
      q[k] = bench::bend(k);
      u[k] = -bench::bend(k);
    }
    system.realize(state, SimTK::Stage::Acceleration);
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
  Simbody simbody(20);
  ours.run();
  dart.run();
  simbody.run();
  double by_dart = (dart.skeleton->getAccelerations() - ours.v_dot).norm() / ours.v_dot.norm(), by_simbody = 0.0;
  for (int k = 0; k < 20; ++k) by_simbody = std::max(by_simbody, std::abs(simbody.state.getUDot()[k] - ours.v_dot[k]));
  by_simbody /= ours.v_dot.norm();
  std::cout << "accelerations of 20 links: DART " << by_dart << ", Simbody " << by_simbody << " apart\n";
  return by_dart < 1e-10 && by_simbody < 1e-10;
}

}  // namespace

BENCHMARK(forward<Ours>)->Arg(10)->Arg(100)->Arg(1000)->Unit(benchmark::kMicrosecond);
BENCHMARK(forward<Simbody>)->Arg(10)->Arg(100)->Arg(1000)->Unit(benchmark::kMicrosecond);
BENCHMARK(forward<Dart>)->Arg(10)->Arg(100)->Arg(1000)->Unit(benchmark::kMicrosecond);

int main(int argc, char** argv) {
  if (!agree()) return 1;
  benchmark::Initialize(&argc, argv);
  benchmark::RunSpecifiedBenchmarks();
}
