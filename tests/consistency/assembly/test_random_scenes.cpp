// Port algebra against second-order assembly on a thousand random scenes: trees and loops, welds and drives, floating
// and grounded. What each scene must have is counted from its parts, on a third route.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>
#include <Eigen/QR>

#include "assembly/disjoint.hpp"
#include "assembly/port_algebra.hpp"
#include "assembly/second_order.hpp"
#include "fem/error.hpp"
#include "random_network.hpp"
#include "titop/poles_zeros.hpp"

using namespace tenon::assembly;
using Eigen::MatrixXcd;
using Eigen::MatrixXd;
using Eigen::VectorXd;
using tenon::assembly::testing::RandomNetwork;
using tenon::assembly::testing::undamped;

namespace {

constexpr unsigned scenes = 250;  // a shard; four shards
// Condition of a channel inversion up to which round-off stays below 1e-8 of 1e-3, the floor of a response.
constexpr double reliable = 1e-8 * 1e-3 / 2.2e-16;

int rank(const MatrixXd& A) {
  if (A.rows() == 0) return 0;
  const VectorXd pivots = Eigen::ColPivHouseholderQR<MatrixXd>(A).matrixQR().diagonal().cwiseAbs();
  return static_cast<int>((pivots.array() > 1e-10 * pivots[0]).count());
}

// Motions that the joints allow, and those of them without strain: dimensions of null(G) and null([G; F]).
std::pair<int, int> dimensions(const Network& net) {
  const DisjointSystem d = disjoint(net);
  MatrixXd G = d.G * d.scale.asDiagonal(), F = d.stiffness_root * d.scale.asDiagonal();
  for (MatrixXd* rows : {&G, &F})
    for (Eigen::Index i = 0; i < rows->rows(); ++i)
      if (const double length = rows->row(i).norm(); length > 0.0) rows->row(i) /= length;
  MatrixXd both(G.rows() + F.rows(), G.cols());
  both << G, F;
  const auto n = static_cast<int>(d.scale.size());
  return {n - rank(G), n - rank(both)};
}

// Worst entry of a − b against the entry itself, or against 1e-3 of the largest entry. An acceleration is a sum C x + D
// u in port algebra, and no truer than its terms: unity here, what a unit wrench does to one of these bodies alone.
double difference(const MatrixXcd& a, const MatrixXcd& b) {
  const double floor = 1e-3 * std::max(a.cwiseAbs().maxCoeff(), 1.0);
  return ((a - b).cwiseAbs().array() / a.cwiseAbs().array().max(floor)).maxCoeff();
}

struct Worst {
  int trees = 0, loops = 0, refused = 0, padded = 0, ill = 0, floating = 0;
  double frequency = 0.0, response = 0.0, real_part = 0.0, condition = 1.0;
};

void compare(const Network& net, Worst& worst) {
  const bool loop = !place(net).closing_joints.empty() || net.ground.size() > 1;
  const Network still = undamped(net);
  const SecondOrderSystem second = second_order(net);
  const SystemModes found = modes(second_order(still));
  const auto [free, rigid] = dimensions(net);
  ASSERT_EQ(found.omega.size(), free);
  ASSERT_EQ(found.rigid, rigid);
  worst.floating += net.ground.empty();
  PortAlgebra ports, undamped_ports;
  try {  // redundant rows are refused, unless neither side can move there
    ports = port_algebra(net);
    undamped_ports = port_algebra(still);
  } catch (const tenon::NumericalError& refusal) {
    ASSERT_GT(second.redundant, 0) << refusal.what();
    EXPECT_THAT(refusal.what(), ::testing::HasSubstr("second-order route"));
    ++worst.refused;
    return;
  }
  ++(loop ? worst.loops : worst.trees);
  worst.padded += second.redundant > 0;  // closed all the same: rows of zeros on both sides
  const VectorXd a = found.omega.tail(free - rigid), b = frequencies(undamped_ports);
  ASSERT_EQ(undamped_ports.ss.order(),
            2 * a.size());  // nothing for rigid motions, no integrators of what is prescribed
  ASSERT_EQ(b.size(), a.size());
  worst.condition = std::max(worst.condition, ports.worst_condition);
  worst.ill += ports.worst_condition > reliable;
  const double ill =
      std::min(1.0, reliable / ports.worst_condition);  // what is reported as ill-conditioned is as wrong
  if (a.size() == 0) return;
  const double apart = ((a - b).array() / a.array()).abs().maxCoeff();
  EXPECT_LT(apart, 1e-9) << "redundant " << second.redundant << ", condition " << ports.worst_condition << " and "
                         << undamped_ports.worst_condition;
  worst.frequency = std::max(worst.frequency, apart);
  worst.real_part = std::max(worst.real_part, tenon::titop::poles(ports.ss).real().maxCoeff() / a[0]);
  for (Eigen::Index i = 1; i < a.size(); ++i) {
    if (a[i] < 1.01 * a[i - 1]) continue;
    const double omega = std::sqrt(a[i - 1] * a[i]);
    worst.response = std::max(worst.response, ill * difference(response(second, omega), response(ports.ss, omega)));
  }
}

class RandomScenes : public ::testing::TestWithParam<unsigned> {};

TEST_P(RandomScenes, BothLinearRoutesAgree) {
  Worst worst;
  for (unsigned seed = GetParam(); seed < GetParam() + scenes; ++seed) {
    SCOPED_TRACE(fmt::format("scene {}", seed));
    compare(RandomNetwork(seed).scene(), worst);
    if (HasFatalFailure()) return;
  }
  fmt::print(
      "{} trees, {} with loops, {} refused for redundant rows, {} closed beside rows of zeros, {} floating, {} "
      "ill-conditioned: frequency {:.1e}, response {:.1e}, greatest real part {:.1e} of the first frequency, worst "
      "condition {:.1e}\n",
      worst.trees, worst.loops, worst.refused, worst.padded, worst.floating, worst.ill, worst.frequency, worst.response,
      worst.real_part, worst.condition);
  EXPECT_GT(worst.loops, 50);
  EXPECT_GT(worst.refused, 5);
  EXPECT_LT(worst.frequency, 1e-9);
  EXPECT_LT(worst.response, 1e-8);
  EXPECT_LT(worst.real_part, 1e-10);
}

INSTANTIATE_TEST_SUITE_P(, RandomScenes, ::testing::Values(10000u, 20000u, 30000u, 40000u));

}  // namespace
