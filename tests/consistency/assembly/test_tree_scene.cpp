// A scene with a tree: a hub with two flexible children, one of which, a finite-element boom, carries two bodies at its
// middle and at its tip. Ports are addressed by name. Four routes: second order, port algebra, composite-body mass
// matrix, and the full unreduced assembly.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include "assembly/build.hpp"
#include "assembly/disjoint.hpp"
#include "assembly/port_algebra.hpp"
#include "assembly/recursion/linearise.hpp"
#include "assembly/second_order.hpp"
#include "fem/structure.hpp"
#include "kinematic_map.hpp"
#include "reduction/modes.hpp"
#include "tests/support/temporary_folder.hpp"

using namespace tenon;
using namespace tenon::assembly;
using Eigen::MatrixXd;
using Eigen::VectorXd;

namespace {

const char* const scene_text = R"(units: SI
materials: {alloy: {E: 70e9, nu: 0.33, rho: 2700}}
bodies:
  hub:
    rigid: {mass: 40, inertia: [6, 5, 7], com: [0.05, 0, 0.1]}
    ports: {east: [0.5, 0, 0], west: {at: [-0.5, 0.1, 0], rotate: {axis: z, angle: 180 deg}}}
  boom:
    fe: beam_16.msh
    material: alloy
    sections: {beam: {rectangle: [0.02, 0.03], orientation: [0, 1, 0]}}
    ports: {root: {set: left}, middle: {at: [0.5, 0, 0]}, tip: {set: right}}
    damping: 0.01
    reduction: {modes: 20}
  mast:
    beam: {from: [0, 0, 0], to: [1.5, 0, 0], section: {tube: [0.02, 0.017]}, material: alloy}
    reduction: {modes: 20}
  arm:
    beam: {from: [0, 0, 0], to: [0, 0.8, 0], section: {circle: 0.008}, material: alloy}
    reduction: {modes: 20}
  dish:
    rigid: {mass: 1.5, inertia: [0.02, 0.03, 0.04], com: [0.1, 0, 0.05]}
    ports: {foot: [0, 0, 0]}
joints:
  east: {parent: hub.east, child: boom.root, revolute: y, angle: 20 deg, stiffness: 4000, inertia: 0.05}
  west: {parent: hub.west, child: mast.P, weld: true}
  side: {parent: boom.middle, child: arm.P, weld: true}
  end: {parent: boom.tip, child: dish.foot, revolute: [0, 1, 1], angle: -30 deg, stiffness: 90}
inputs: {torque: {at: east}, push: {at: dish.foot, force: [x, y, z]}}
outputs: {turn: {at: east, measure: acceleration}, far: {at: arm.C, acceleration: [x, y, z]}, hub: {at: hub, acceleration: z}}
)";

struct Built {
  Scene scene;
  Network network;
};

Built build(const std::string& kept = "20") {
  static const TemporaryFolder folder;
  std::filesystem::copy_file(std::filesystem::path(TENON_SOURCE_DIR) / "data/reference/beam_16.msh",
                             folder.path() / "beam_16.msh", std::filesystem::copy_options::overwrite_existing);
  std::string text = scene_text;
  for (std::size_t at = 0; (at = text.find("{modes: 20}", at)) != std::string::npos; ++at)
    text.replace(at, 11, "{modes: " + kept + "}");
  Built built{read_scene(folder.write("scene.yaml", text)), {}};
  built.network = build_network(built.scene, plan(built.scene));
  return built;
}

}  // namespace

TEST(TreeScene, AllRoutesAgree) {
  Network net = build().network;
  const SecondOrderSystem damped = second_order(net);
  const PortAlgebra damped_ports = port_algebra(net);
  for (ReducedBody& body : net.bodies) body.zeta.setZero();
  const SystemModes found = modes(second_order(net));
  ASSERT_EQ(found.rigid, 6);
  const Eigen::Index flexible = found.omega.size() - 6;
  const VectorXd omega = found.omega.tail(flexible), ports = frequencies(port_algebra(net));
  ASSERT_EQ(ports.size(), flexible);
  const double by_ports = ((ports - omega).array() / omega.array()).abs().maxCoeff();
  double by_response = 0.0;
  for (const double at : {3.0, 30.0, 300.0, 3000.0}) {
    const Eigen::MatrixXcd a = response(damped, at), b = response(damped_ports.ss, at);
    by_response = std::max(by_response, (a - b).cwiseAbs().maxCoeff() / a.cwiseAbs().maxCoeff());
  }

  const NetworkMultibody tree = make_multibody(net);
  const LinearMotion motion = linearise(tree.system, rest_state(tree.system), VectorXd::Zero(tree.system.nv));
  ASSERT_EQ(tree.system.nv, found.omega.size());
  const DisjointSystem parts = disjoint(net);
  const MatrixXd J = tenon::assembly::testing::kinematic_map(tree, second_order(net)), M = J.transpose() * parts.M * J,
                 K = J.transpose() * parts.K * J;
  const double by_tree = std::max((motion.M - M).norm() / M.norm(), (motion.K - K).norm() / K.norm());
  fmt::print("two bodies on one child: port algebra {:.1e}, responses {:.1e}, composite matrices {:.1e} apart\n",
             by_ports, by_response, by_tree);
  EXPECT_LT(by_ports, 1e-9);
  EXPECT_LT(by_response, 1e-8);
  EXPECT_LT(by_tree, 1e-12);
}

// Ritz values lie above the full ones and fall with every mode kept; with all of them the bases are complete, and the
// frequencies those of the full assembly to the round-off of its sparse eigen-solve.
TEST(TreeScene, ConvergesToTheFullAssembly) {
  const Built first = build("5");
  const fem::Structure whole = fem::assemble(full_model(first.scene, first.network).model);
  const reduction::Modes exact = reduction::solve_modes(whole, {.count = 30});
  ASSERT_EQ(exact.rigid, 6);
  double before = INFINITY;
  for (const char* kept : {"5", "10", "20", "all"}) {
    const SystemModes found = modes(second_order(build(kept).network));
    ASSERT_EQ(found.rigid, 6);
    double worst = 0.0;
    for (Eigen::Index i = 6; i < 30; ++i) {
      const double error = found.omega[i] / std::sqrt(exact.lambda[i]) - 1.0;
      EXPECT_GT(error, -1e-9) << i;
      worst = std::max(worst, error);
    }
    fmt::print("{} modes a body, {} coordinates for {}: worst error of 24 modes {:.1e}\n", kept, found.omega.size(),
               whole.n(), worst);
    EXPECT_LT(worst, before);
    before = worst;
  }
  EXPECT_LT(before, 1e-9);
}
