#include "titop/port_model.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <Eigen/LU>

#include "fem/error.hpp"
#include "tests/reference/beams.hpp"

using namespace tenon;
using namespace tenon::titop;
using Eigen::MatrixXcd;
using Eigen::MatrixXd;

namespace {

// three ports, two modes, everything coupled
reduction::ReducedBody three_port_body() {
  reduction::ReducedBody b;
  b.name = "body";
  b.omega = Eigen::Vector2d(3.0, 8.0);
  b.zeta = Eigen::Vector2d(0.01, 0.02);
  b.D = fem::rigid_mass(5.0, {0.3, -0.2, 0.1}, fem::Vec3(1.0, 2.0, 3.0).asDiagonal());
  b.L.resize(2, 6);
  b.L << 0.5, -0.3, 0.2, 0.1, 0.0, 0.4, 0.1, 0.6, -0.2, 0.3, 0.2, -0.1;
  for (int p = 0; p < 3; ++p) {
    reduction::BodyPort port;
    port.name = "p" + std::to_string(p);
    port.position = {1.0 * p, 0.5 * p * p, -0.3 * p};
    port.Phi = fem::Mat6X::Zero(6, 2);
    for (int i = 0; p > 0 && i < 6; ++i) port.Phi.row(i) << std::sin(1.0 + i + 6 * p), std::cos(2.0 * i - p);
    b.ports.push_back(port);
  }
  b.reference = b.ports[0].position;
  return b;
}

}  // namespace

// Solves eqs (1) and (2) at one frequency for given inputs, without any state space.
TEST(PortModel, IsTheSolutionOfEquationsOneAndTwo) {
  const reduction::ReducedBody b = three_port_body();
  const PortModel model = port_model(b);
  ASSERT_EQ(model.children, (std::vector<int>{1, 2}));
  const double omega = 4.3;
  const std::complex<double> s(0.0, omega);
  MatrixXcd expected(18, 18);
  for (int u = 0; u < 18; ++u) {
    const Eigen::VectorXcd input = Eigen::VectorXcd::Unit(18, u);
    const Eigen::VectorXcd a_P = input.tail(6);
    Eigen::VectorXcd force = -b.L * a_P;
    for (int c = 0; c < 2; ++c)
      force += b.ports[static_cast<std::size_t>(c + 1)].Phi.transpose() * input.segment(6 * c, 6);
    Eigen::VectorXcd eta(2);
    for (int j = 0; j < 2; ++j)
      eta[j] = force[j] / (s * s + 2.0 * b.zeta[j] * b.omega[j] * s + b.omega[j] * b.omega[j]);
    const Eigen::VectorXcd eta_dd = s * s * eta;
    Eigen::VectorXcd W_P = -b.D * a_P - b.L.transpose() * eta_dd;
    for (int c = 0; c < 2; ++c) {
      expected.block(6 * c, u, 6, 1) =
          reduction::tau(b, c + 1) * a_P + b.ports[static_cast<std::size_t>(c + 1)].Phi * eta_dd;
      W_P += reduction::tau(b, c + 1).transpose() * input.segment(6 * c, 6);
    }
    expected.block(12, u, 6, 1) = W_P;
  }
  EXPECT_LT((response(model.ss, omega) - expected).norm(), 1e-13 * expected.norm());
}

TEST(PortModel, DirectTransmissionIsSymmetricQuasiDefinite) {
  const MatrixXd D = port_model(three_port_body()).ss.D;
  EXPECT_LT((D - D.transpose()).norm(), 1e-14 * D.norm());
}

TEST(PortModel, ChannelsCarryNamesAndUnits) {
  const PortModel model = port_model(three_port_body(), {2});
  EXPECT_EQ(model.child_channels(0).front(), 0);
  EXPECT_EQ(model.parent_channels().front(), 6);
  EXPECT_EQ(model.ss.inputs[5].name, "body.p2.Tz");
  EXPECT_EQ(model.ss.inputs[5].unit, "N m");
  EXPECT_EQ(model.ss.outputs[0].name, "body.p2.ax");
  EXPECT_EQ(model.ss.outputs[6].name, "body.p0.Fx");
}

TEST(PortModel, RigidBodyIsItsMass) {
  const reduction::ReducedBody hub = reduction::rigid_body("hub", 2.0, {0.1, 0.0, 0.0}, fem::Mat3::Identity(),
                                                           {{"P", fem::Vec3::Zero(), fem::Mat3::Identity(), {}}});
  const PortModel model = port_model(hub);
  EXPECT_EQ(model.ss.order(), 0);
  EXPECT_LT((model.ss.D + hub.D).norm(), 1e-15);
}

// The axial direction of the beam has no modal content: an exact zero, never inverted.
TEST(PortModel, DirectionWithoutModalContentIsRefusedByName) {
  reduction::ReducedBody beam = reference::clamped_free_beam("boom", 4);
  beam.ports[1].Phi.row(0).setConstant(1e-17);  // what an FE reduction leaves of a zero
  const PortModel model = port_model(beam);
  EXPECT_EQ(model.ss.D(0, 0), 0.0);
  try {
    invert_channels(model.ss, model.child_channels(0));
    FAIL() << "inverted a rigid direction";
  } catch (const NumericalError& e) {
    EXPECT_THAT(e.what(), ::testing::HasSubstr("'boom.C.Fx' → 'boom.C.ax'"));
    EXPECT_THAT(e.what(), ::testing::HasSubstr("static modes"));
  }
}

TEST(PortModel, FreeFreeBodyIsRefused) {
  reduction::ReducedBody body = three_port_body();
  body.kind = reduction::ReducedBody::Kind::free_free;
  EXPECT_THROW(port_model(body), ModelError);
}
