// Networks linearised from their recursive model: at rest they are the linear system of the same scene; about gravity
// and spin, closed forms and differences of the finite motion.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <iostream>
#include <numbers>

#include "assembly/build.hpp"
#include "assembly/linearised.hpp"
#include "assembly/recursion/stiffening.hpp"
#include "assembly/second_order.hpp"
#include "tests/reference/networks.hpp"
#include "tests/refusal.hpp"
#include "tests/support/temporary_folder.hpp"

namespace tenon::assembly {
namespace {

using Eigen::Index;
using Eigen::MatrixXcd;
using Eigen::MatrixXd;
using Eigen::VectorXd;
using testing::HasSubstr;

class AtRest : public testing::TestWithParam<const char*> {};

TEST_P(AtRest, EqualsTheLinearSystem) {
  const Scene scene = read_scene(std::filesystem::path(TENON_SOURCE_DIR) / GetParam());
  const Network network = build_network(scene, plan(scene));
  const SecondOrderSystem system = second_order(network);
  const SystemModes expected = modes(system);
  const LinearisedNetwork l = linearised(network, make_simulation(network, {}));
  const LinearisedModes found = modes(l);
  ASSERT_EQ(found.omega.size(), expected.omega.size());
  EXPECT_EQ(l.free, expected.rigid);
  double by_frequency = 0.0, by_damping = 0.0, by_response = 0.0;
  for (Index k = expected.rigid; k < expected.omega.size(); ++k) {
    by_frequency = std::max(by_frequency, std::abs(found.omega[k] / expected.omega[k] - 1.0));
    by_damping = std::max(by_damping, std::abs(found.zeta[k] - expected.zeta[k]));
  }
  for (const double omega : {0.3, 3.0, 30.0, 300.0, 3000.0}) {
    const MatrixXcd a = response(system, omega), b = titop::response(l.ss, omega);
    for (Index i = 0; i < a.rows(); ++i)
      by_response = std::max(by_response, (b.row(i) - a.row(i)).cwiseAbs().maxCoeff() / a.row(i).cwiseAbs().maxCoeff());
  }
  std::cout << GetParam() << ": frequencies " << by_frequency << ", damping " << by_damping << ", responses "
            << by_response << "\n";
  EXPECT_LT(by_frequency, 1e-9);
  EXPECT_LT(by_damping, 1e-9);
  EXPECT_LT(by_response, 1e-8);
}

INSTANTIATE_TEST_SUITE_P(Linearised, AtRest, testing::Values("data/spacecraft/scene.yaml", "data/fourbar/scene.yaml"));

SceneSimulation turning(const char* name, const Vec3& rate) {
  SceneSimulation section;
  InitialMotion initial;
  initial.name = name;
  initial.turning = rate;
  section.initial.push_back(initial);
  return section;
}

SceneSimulation spinning(const char* joint, double rate) {
  SceneSimulation section;
  InitialMotion initial;
  initial.name = joint;
  initial.joint = true;
  initial.rate = rate;
  section.initial.push_back(initial);
  return section;
}

// A bar on a hinge about y, let go 30 degrees before it hangs: ω² = m g l / (J + m l²) about hanging.
TEST(Linearised, APendulumAboutTheHangingItFinds) {
  Network net;
  net.bodies = {reference::rigid_bar("post"), reference::rigid_bar("bar")};
  Joint hinge = reference::weld("hinge", {0, 0}, {1, 0});
  hinge.kind = JointKind::revolute;
  hinge.axis = Vec3::UnitY();
  hinge.angle = std::numbers::pi / 3.0;
  hinge.damping = 0.01;
  net.joints = {hinge};
  net.ground = {{0, 0}};
  SceneSimulation section;
  section.gravity = {0.0, 0.0, -9.81};
  const LinearisedNetwork l = linearised(net, make_simulation(net, section));
  const LinearisedModes found = modes(l);
  EXPECT_NEAR(l.about.turned, std::numbers::pi / 6.0, 1e-9);
  ASSERT_EQ(found.omega.size(), 1);
  const double omega = std::sqrt(2.0 * 9.81 * 0.5 / (0.2 + 2.0 * 0.25));
  EXPECT_NEAR(found.omega[0], omega, 1e-9);
  EXPECT_NEAR(found.zeta[0], 0.01 / (0.7 * 2.0 * omega), 1e-9);
  EXPECT_EQ(found.growth, 0.0);
}

// A body afloat that spins about z beside its mass centre and a little off its principal axis finds the motion in which
// it does neither. Poles in its axes: nutation ω √((C − A)(C − B) / AB), and ω for what stands in space: two
// translations, the momentum's direction. Double poles part by the root of what differences leave, 1e-6.
TEST(Linearised, ABodyAfloatFindsItsSpinAxis) {
  const Mat3 tilt = Eigen::AngleAxisd(0.1, Vec3(1.0, 0.5, 0.2).normalized()).toRotationMatrix();
  const Mat3 J = tilt * Vec3(4.0, 5.0, 7.0).asDiagonal() * tilt.transpose();
  Network net;
  net.bodies = {reduction::rigid_body("hub", 3.0, {0.1, -0.2, 0.3}, J, {reference::port("p")})};
  const double omega = 2.0;
  const LinearisedNetwork l = linearised(net, make_simulation(net, turning("hub", {0.0, 0.0, omega})));
  const Vec3 w = l.about.state.v.tail<3>();
  EXPECT_LT((J * w).cross(w).norm(), 1e-9 * J.norm() * omega * omega);
  EXPECT_NEAR(w.norm(), omega, 1e-12);
  const LinearisedModes found = modes(l);
  EXPECT_EQ(l.free, 2);  // along the axis, about it
  ASSERT_EQ(found.omega.size(), 6);
  EXPECT_NEAR(found.omega[2], omega * std::sqrt(3.0 * 2.0 / 20.0), 1e-9);
  for (Index k = 3; k < 6; ++k) EXPECT_NEAR(found.omega[k], omega, 1e-5);
  EXPECT_EQ(found.growth, 0.0);
  // about the intermediate axis it tumbles: growth ω √((B − A)(C − B) / AC)
  net.bodies[0] =
      reduction::rigid_body("hub", 3.0, Vec3::Zero(), Vec3(4.0, 7.0, 5.0).asDiagonal(), {reference::port("p")});
  EXPECT_NEAR(modes(linearised(net, make_simulation(net, turning("hub", {0.0, 0.0, omega})))).growth,
              omega * std::sqrt(1.0 * 2.0 / (4.0 * 7.0)), 1e-9);
}

// A hub afloat with a wheel about z through the common mass centre: whirls at h / (A_hub + A_wheel), h = C_wheel Ω.
Network wheel_on_hub(const Vec3& wheel) {
  Network net;
  const Mat3 round = 3.0 * Mat3::Identity();
  net.bodies = {reduction::rigid_body("hub", 5.0, Vec3::Zero(), round, {reference::port("axle")}),
                reduction::rigid_body("wheel", 1.0, Vec3::Zero(), wheel.asDiagonal(),
                                      {reference::port("axle"), reference::port("rim", {0.3, 0.0, 0.0})})};
  Joint axle = reference::weld("axle", {0, 0}, {1, 0});
  axle.kind = JointKind::revolute;
  axle.damping = 0.02;
  net.joints = {axle};
  net.inputs = {{"push", PortRef{0, 0}, 0, {}}};
  return net;
}

TEST(Linearised, AWheelMakesItsHubWhirl) {
  const double rate = 40.0;
  const Network net = wheel_on_hub({0.05, 0.05, 0.08});
  const LinearisedNetwork l = linearised(net, make_simulation(net, spinning("axle", rate)));
  const LinearisedModes found = modes(l);
  ASSERT_EQ(found.omega.size() - l.free, 1);
  EXPECT_NEAR(found.omega[l.free], 0.08 * rate / 3.05, 1e-8);
  EXPECT_NEAR(l.about.held[6], 0.02 * rate, 1e-12);  // the drive bears the friction of its bearing
}

TEST(Linearised, RefusesWhatIsNotSteady) {
  const auto said = [](const Network& net, const SceneSimulation& section) {
    return tests::refusal([&] { linearised(net, make_simulation(net, section)); });
  };
  EXPECT_THAT(said(wheel_on_hub({0.05, 0.06, 0.08}), spinning("axle", 40.0)), HasSubstr("not steady"));
  Network net = wheel_on_hub({0.05, 0.05, 0.08});
  net.outputs = {{"rim", Quantity::acceleration, PortRef{1, 1}, 0, {}}};
  EXPECT_THAT(said(net, spinning("axle", 40.0)), HasSubstr("output 'rim' moves with a body that turns"));
  net.outputs.clear();
  SceneSimulation falling;
  falling.gravity = {0.0, 0.0, -9.81};
  EXPECT_THAT(said(net, falling), HasSubstr("'hub.z' stays out of balance"));
  const Scene scene = read_scene(std::filesystem::path(TENON_SOURCE_DIR) / "data/fourbar/scene.yaml");
  EXPECT_THAT(said(build_network(scene, plan(scene)), spinning("drive", 5.0)), HasSubstr("not steady"));
}

const char* const spinner = R"(units: SI
materials: {alloy: {E: 70e9, nu: 0.33, rho: 2700}}
bodies:
  hub:
    rigid: {mass: 8, inertia: [2, 3, 4], com: [0.05, 0, 0.1]}
    ports: {east: [0.5, 0, 0]}
  boom: {beam: {from: [0, 0, 0], to: [1.5, 0, 0], section: {tube: [0.02, 0.017]}, material: alloy, elements: 6}, reduction: {modes: 6}}
joints: {east: {parent: hub.east, child: boom.P, revolute: y, angle: 20 deg, stiffness: 400}}
inputs: {push: {at: boom.C, force: z}}
outputs:
  turn: {at: east, measure: acceleration}
  move: {at: boom.C, displacement: [x, y, z]}
  run: {at: boom.C, velocity: [x, y, z]}
  roll: {at: boom.C, angular_rate: [x, y, z]}
  rush: {at: boom.C, acceleration: [x, y, z]}
  swing: {at: boom.C, angular_acceleration: [x, y, z]}
  hub: {at: hub, acceleration: [x, y, z]}
simulation: {initial: {hub: {angular_rate: [0, 0.3, 2]}}}
)";

// (A rotation is recorded as the vector from the placed attitude, which is no rotation in space: left out.)
// y = C_p ξ + C_v ξ̇ + C_a ξ̈ against fourth-order differences of what a simulation records, and the equations against
// differences of inverse dynamics, along random ξ, ξ̇, ξ̈.
TEST(Linearised, OutputsAboutASpinAreRatesOfWhatIsRecorded) {
  const TemporaryFolder folder;
  const Scene scene = read_scene(folder.write("scene.yaml", spinner));
  Plan kept = plan(scene);
  for (BodyPlan& body : kept.bodies) body.options.nonlinear = true;
  const Network net = build_network(scene, kept);
  const Simulation simulation = make_simulation(net, read_simulation(scene));
  const Multibody& system = simulation.bodies.system;
  const LinearisedNetwork l = linearised(net, simulation);
  const VectorXd &v0 = l.about.state.v, &a0 = l.about.v_dot;
  Recorder recorder(net, simulation);
  Dynamics dynamics = make_dynamics(system);
  const auto hub = static_cast<Index>(system.v_offset[0]);
  ASSERT_EQ(system.bodies[0].name, "hub");
  const Mat3 R = Eigen::Quaterniond(l.about.state.q.data() + system.q_offset[0] + 3).toRotationMatrix();
  const Vec3 own = v0.segment<3>(hub + 3), world = R * own;

  std::srand(7);
  double worst = 0.0, worst_force = 0.0;
  for (int trial = 0; trial < 5; ++trial) {
    VectorXd xi = VectorXd::Random(system.nv), rate = VectorXd::Random(system.nv), second = VectorXd::Random(system.nv);
    const auto& boom = system.bodies[1];
    xi.segment(system.v_offset[1], boom.modes()).array() /= boom.body->omega.array().square();
    const auto at = [&](double h) {
      MotionState state = l.about.state;
      move(system, h * xi, state.q);
      VectorXd dv = rate, da = second;
      const Vec3 x = xi.segment<3>(hub), phi = xi.segment<3>(hub + 3), x_dot = rate.segment<3>(hub),
                 phi_dot = rate.segment<3>(hub + 3);
      dv.segment<3>(hub) += world.cross(x);
      dv.segment<3>(hub + 3) += own.cross(phi);
      da.segment<3>(hub) += 2.0 * world.cross(x_dot) + world.cross(world.cross(x));
      da.segment<3>(hub + 3) += own.cross(phi_dot);
      state.v = v0 + h * dv;
      const VectorXd v_dot = a0 + h * da;
      set_state(system, state.q, state.v, dynamics.sweeps);
      restiffen(system, state.q, a0, dynamics.sweeps);  // stress as of the steady motion's accelerations
      VectorXd force(system.nv), passive(system.nv);
      inverse_dynamics(system, dynamics.sweeps, v_dot, force);
      passive_forces(system, state.q, state.v, passive);
      const std::vector<double>& row = recorder.record({0.0, state, v_dot, dynamics});
      VectorXd y(static_cast<Index>(net.outputs.size()) + system.nv);
      y.head(l.C_position.rows()) = Eigen::Map<const VectorXd>(row.data(), l.C_position.rows());
      y.tail(system.nv) = force - passive;
      return y;
    };
    const double h = 1e-3;
    const VectorXd change = (8.0 * (at(h) - at(-h)) - (at(2.0 * h) - at(-2.0 * h))) / (12.0 * h);
    const VectorXd y = l.C_position * xi + l.C_velocity * rate + l.C_acceleration * second;
    const VectorXd f = l.K * xi + l.C * rate + l.M * second;
    worst = std::max(worst, (change.head(y.size()) - y).norm() / y.norm());
    worst_force = std::max(worst_force, (change.tail(system.nv) - f).norm() / f.norm());
  }
  std::cout << "outputs " << worst << ", forces " << worst_force << "\n";
  EXPECT_LT(worst, 1e-8);
  EXPECT_LT(worst_force, 1e-8);
}

}  // namespace
}  // namespace tenon::assembly
