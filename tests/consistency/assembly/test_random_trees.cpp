#include <fmt/format.h>
#include <gtest/gtest.h>

#include "assembly/disjoint.hpp"
#include "assembly/port_algebra.hpp"
#include "assembly/recursion/linearise.hpp"
#include "assembly/second_order.hpp"
#include "kinematic_map.hpp"
#include "random_network.hpp"

using namespace tenon::assembly;
using Eigen::MatrixXcd;
using Eigen::MatrixXd;
using Eigen::VectorXd;
using tenon::assembly::testing::kinematic_map;
using tenon::assembly::testing::RandomNetwork;
using tenon::assembly::testing::undamped;

namespace {

constexpr int trees = 40;  // of each of the two kinds

// Rigid motions and flexible modes a tree must have: counted from its parts, not from any spectrum.
std::pair<int, int> expected_modes(const Network& net) {
  int rigid = net.ground.empty() ? 6 : 0, flexible = 0;
  for (const ReducedBody& body : net.bodies) flexible += body.n();
  for (const Joint& joint : net.joints)
    if (joint.kind == JointKind::revolute) ++(joint.stiffness > 0.0 ? flexible : rigid);
  return {rigid, flexible};
}

// below, between and above the resonances; not between two that are closer than 1 %
std::vector<double> between(const VectorXd& omega) {
  std::vector<double> points{omega.size() ? 0.3 * omega[0] : 1.0, omega.size() ? 2.0 * omega[omega.size() - 1] : 3.0};
  for (Eigen::Index i = 1; i < omega.size(); ++i)
    if (omega[i] > 1.01 * omega[i - 1]) points.push_back(std::sqrt(omega[i - 1] * omega[i]));
  return points;
}

double difference(const MatrixXd& a, const MatrixXd& b) { return (a - b).norm() / (a.norm() > 0.0 ? a.norm() : 1.0); }

// worst entry of a − b against the entry itself; entries below 1e-3 of the largest against that: an acceleration far
// below resonance is a small difference C x + D u in any first-order form, and decoupled pairs are zero. A network held
// everywhere that is asked answers zero: there, 1e-3 of the acceleration that a unit force gives to 1000 kg is the
// floor.
double difference(const MatrixXcd& a, const MatrixXcd& b) {
  const double floor = 1e-3 * std::max(a.cwiseAbs().maxCoeff(), 1e-3);
  double worst = 0.0;
  for (Eigen::Index i = 0; i < a.rows(); ++i)
    for (Eigen::Index j = 0; j < a.cols(); ++j)
      worst = std::max(worst, std::abs(a(i, j) - b(i, j)) / std::max(std::abs(a(i, j)), floor));
  return worst;
}

struct Worst {
  double frequency = 0.0, response = 0.0, state_space = 0.0, mass = 0.0, stiffness = 0.0, condition = 1.0;
};

void compare(const Network& net, Worst& worst) {
  const SecondOrderSystem second = second_order(net);
  const Network still = undamped(net);
  const SystemModes found = modes(second_order(still));
  const PortAlgebra ports = port_algebra(net), undamped_ports = port_algebra(still);
  const auto [rigid, flexible] = expected_modes(net);
  ASSERT_EQ(found.rigid, rigid);
  ASSERT_EQ(found.omega.size() - found.rigid, flexible);
  ASSERT_EQ(undamped_ports.ss.order(), 2 * flexible);  // nothing for rigid motions, no spurious integrators
  const VectorXd a = found.omega.tail(flexible), b = frequencies(undamped_ports);
  ASSERT_EQ(b.size(), flexible);
  if (flexible > 0) worst.frequency = std::max(worst.frequency, ((a - b).array() / a.array()).abs().maxCoeff());

  const tenon::titop::StateSpace first_order = state_space(net, second);
  for (const double omega : between(a)) {
    const MatrixXcd H = response(second, omega);
    worst.response = std::max(worst.response, difference(H, response(ports.ss, omega)));
    worst.state_space = std::max(worst.state_space, difference(H, response(first_order, omega)));
  }
  worst.condition = std::max(worst.condition, ports.worst_condition);

  const NetworkMultibody tree = make_multibody(net);
  const LinearMotion motion = linearise(tree.system, rest_state(tree.system), VectorXd::Zero(tree.system.nv));
  const DisjointSystem parts = disjoint(net);
  const MatrixXd J = kinematic_map(tree, second);
  ASSERT_EQ(tree.system.nv, rigid + flexible);
  EXPECT_LT((second.G * J).norm(), 1e-12 * J.norm());  // the map obeys the joints
  worst.mass = std::max(worst.mass, difference(motion.M, J.transpose() * parts.M * J));
  worst.stiffness = std::max(worst.stiffness, difference(motion.K, J.transpose() * parts.K * J));
}

void compare_many(bool any_port, unsigned seed) {
  Worst worst;
  for (unsigned k = 0; k < trees; ++k) {
    SCOPED_TRACE(fmt::format("tree {}", seed + k));
    compare(RandomNetwork(seed + k).tree(any_port), worst);
    if (::testing::Test::HasFatalFailure()) return;
  }
  fmt::print(
      "{} random trees: frequency {:.1e}, response {:.1e}, state space {:.1e}, mass {:.1e}, stiffness {:.1e}, "
      "worst condition {:.1e}\n",
      trees, worst.frequency, worst.response, worst.state_space, worst.mass, worst.stiffness, worst.condition);
  EXPECT_LT(worst.frequency, 1e-9);
  EXPECT_LT(worst.response, 1e-8);
  EXPECT_LT(worst.state_space, 1e-8);
  EXPECT_LT(worst.mass, 1e-12);
  EXPECT_LT(worst.stiffness, 1e-12);
}

}  // namespace

TEST(RandomTrees, RoutesAgreeWhenBodiesHangByTheirParentPort) { compare_many(false, 1000); }

TEST(RandomTrees, RoutesAgreeWhenBodiesHangByAnyPort) { compare_many(true, 5000); }
