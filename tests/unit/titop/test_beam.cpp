#include "titop/beam.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>

#include "fem/error.hpp"
#include "titop/attach.hpp"
#include "titop/constrain.hpp"
#include "titop/mode_shapes.hpp"

using namespace tenon;
using namespace tenon::titop;
using Eigen::MatrixXd;

namespace {

const BeamProperties tube{
    .length = 2.0, .E = 7e10, .G = 2.7e10, .rho = 2700.0, .A = 1e-3, .Iy = 3e-8, .Iz = 2e-8, .J = 4e-8, .Ip = 5e-8};

std::string refusal(const BeamProperties& beam, const BeamOptions& options = {}) {
  try {
    beam_body("boom", beam, options);
  } catch (const ModelError& e) {
    return e.what();
  }
  return "";
}

}  // namespace

TEST(BeamBody, RefusesNumbersThatMakeNoBeamByName) {
  const double infinite = std::numeric_limits<double>::infinity(), nan = std::numeric_limits<double>::quiet_NaN();
  const std::pair<const char*, double BeamProperties::*> members[] = {
      {"length", &BeamProperties::length}, {"E", &BeamProperties::E}, {"G", &BeamProperties::G},
      {"rho", &BeamProperties::rho},       {"A", &BeamProperties::A}, {"Iy", &BeamProperties::Iy},
      {"Iz", &BeamProperties::Iz},         {"J", &BeamProperties::J}, {"Ip", &BeamProperties::Ip}};
  for (const auto& [symbol, member] : members)
    for (const double bad : {0.0, -1.0, infinite, nan}) {
      BeamProperties beam = tube;
      beam.*member = bad;
      EXPECT_THAT(refusal(beam), ::testing::HasSubstr(std::string("'boom': ") + symbol + " = ")) << bad;
    }
  EXPECT_THAT(refusal(tube, {.model = BeamModel::clamped_free, .modes = 0}), ::testing::HasSubstr("modes = 0"));
  EXPECT_THAT(refusal(tube, {.model = BeamModel::clamped_free, .modes = most_beam_modes + 1}),
              ::testing::HasSubstr("not between 1 and 100"));
  EXPECT_THAT(refusal(tube, {.zeta = -0.1}), ::testing::HasSubstr("zeta"));
  EXPECT_THAT(refusal(tube, {.samples = 1}), ::testing::HasSubstr("samples"));
}

TEST(BeamBody, NeedsOnlyTheNumbersOfItsDirections) {
  const BeamProperties planar{.length = 1.0, .E = 7e10, .rho = 2700.0, .A = 1e-3, .Iz = 2e-8};
  EXPECT_EQ(beam_body("b", planar, {.bend_xz = false, .torsion = false}).n(), 5);
  const BeamProperties bar{.length = 1.0, .rho = 2700.0, .A = 1e-3};
  const auto rigid = beam_body("b", bar, {.bend_xy = false, .bend_xz = false, .traction = false, .torsion = false});
  EXPECT_EQ(rigid.n(), 0);
  EXPECT_NEAR(rigid.D(5, 5), 2.7 / 3.0, 1e-15);
}

TEST(BeamBody, HasSymmetricPlanes) {  // Iy = Iz: every bending frequency twice, θ_y = −w′
  BeamProperties round = tube;
  round.Iy = round.Iz;
  const auto body = beam_body("b", round, {.traction = false, .torsion = false});
  for (Eigen::Index j = 0; j < 8; j += 2) {
    EXPECT_EQ(body.omega[j], body.omega[j + 1]);
    EXPECT_EQ(body.ports[1].Phi(1, j), body.ports[1].Phi(2, j + 1));
    EXPECT_EQ(body.ports[1].Phi(5, j), -body.ports[1].Phi(4, j + 1));
    EXPECT_EQ(body.L(j, 5), -body.L(j + 1, 4));
  }
}

TEST(BeamBody, ShapesAtTheSamplesEndAtThePorts) {
  for (const BeamModel model : {BeamModel::polynomial, BeamModel::clamped_free}) {
    const auto body = beam_body("b", tube, {.model = model, .modes = 9, .samples = 5});
    ASSERT_EQ(body.node_positions.size(), 5u);
    EXPECT_EQ(body.node_positions[4].x(), 2.0);
    const MatrixXd Phi = body.ports[1].Phi;
    EXPECT_LT(body.node_shapes.topRows(6).cwiseAbs().maxCoeff(), 1e-11 * Phi.cwiseAbs().maxCoeff());
    EXPECT_LT((body.node_shapes.bottomRows(6) - Phi).cwiseAbs().maxCoeff(), 1e-11 * Phi.cwiseAbs().maxCoeff());
    EXPECT_TRUE((body.omega.tail(body.n() - 1) - body.omega.head(body.n() - 1)).minCoeff() >= 0.0);
  }
  const auto none = beam_body("b", tube, {.samples = 0});
  EXPECT_EQ(none.node_shapes.rows(), 0);
  EXPECT_THROW(node_motions(none, MatrixXd::Zero(6, 1), MatrixXd::Zero(10, 1)), ModelError);
}

// D(C) − Φ…: a beam with its child port moved by an arm and back, and the parent port likewise.
TEST(MovePort, ThereAndBack) {
  const fem::Vec3 arm(0.3, -0.2, 0.5);
  const auto body = beam_body("b", tube);
  for (const int port : {0, 1}) {
    const auto back = move_port(move_port(body, port, arm), port, -arm);
    EXPECT_LT((back.D - body.D).norm(), 1e-15 * body.D.norm());
    EXPECT_LT((back.L - body.L).norm(), 1e-15 * body.L.norm());
    EXPECT_LT((back.ports[1].Phi - body.ports[1].Phi).norm(), 1e-15 * body.ports[1].Phi.norm());
    EXPECT_LT((back.reference - body.reference).norm(), 1e-15);
  }
}

// A wrench on the arm is the wrench and its moment at the old port; W_P likewise at the other end.
TEST(MovePort, CarriesWrenchesByTheArm) {
  const fem::Vec3 arm(0.3, -0.2, 0.5);
  const auto body = beam_body("b", tube);
  const StateSpace G = port_model(body).ss, moved = port_model(move_port(move_port(body, 0, arm), 1, -arm)).ss;
  MatrixXd out = MatrixXd::Zero(12, 12), in = out;  // ẍ_C' = τ(−arm) ẍ_C, W_P' = τ(−arm)ᵀ W_P; inputs the other way
  const fem::Mat6 there = fem::tau(arm), back = fem::tau(-arm);
  out.topLeftCorner(6, 6) = back;
  out.bottomRightCorner(6, 6) = back.transpose();
  in.topLeftCorner(6, 6) = back.transpose();
  in.bottomRightCorner(6, 6) = back;
  const auto expected = response(gains(out, G, in, G.outputs, G.inputs), 100.0), found = response(moved, 100.0);
  EXPECT_LT((expected - found).norm(), 1e-12 * found.norm());
  EXPECT_LT((there * back - fem::Mat6::Identity()).norm(), 1e-15);
}

TEST(AttachMass, RefusesWhatHasNoMassMatrix) {
  const auto body = beam_body("b", tube);
  fem::Mat3 J = fem::Mat3::Zero();
  EXPECT_THROW(attach_mass(body, 1, -1.0, {2, 0, 0}), ModelError);
  EXPECT_THROW(attach_mass(body, 2, 1.0, {2, 0, 0}), ModelError);
  J(0, 1) = 1.0;
  EXPECT_THROW(attach_mass(body, 1, 1.0, {2, 0, 0}, J), ModelError);
  J(1, 0) = 1.0;  // eigenvalues ±1
  EXPECT_THROW(attach_mass(body, 1, 1.0, {2, 0, 0}, J), ModelError);
}

TEST(Boundary, EndsSayWhatEveryDirectionDoes) {
  const auto body = beam_body("b", tube);
  using Fixed = std::array<bool, 6>;
  const auto both = [&](End P, End C, Scope scope, BendingPlane plane = BendingPlane::xy) {
    const Boundary b = boundary(body, {P, C}, scope, plane);
    return std::pair<Fixed, Fixed>{b.ports[0].fixed, b.ports[1].fixed};
  };
  EXPECT_EQ(both(End::pinned, End::sliding, Scope::spatial),
            (std::pair<Fixed, Fixed>{{1, 1, 1, 1, 1, 0}, {1, 0, 1, 1, 1, 1}}));
  EXPECT_EQ(both(End::pinned, End::sliding, Scope::spatial, BendingPlane::xz),
            (std::pair<Fixed, Fixed>{{1, 1, 1, 1, 0, 1}, {1, 1, 0, 1, 1, 1}}));
  EXPECT_EQ(both(End::free, End::pinned, Scope::planar),
            (std::pair<Fixed, Fixed>{{0, 0, 1, 1, 1, 0}, {1, 1, 0, 0, 0, 0}}));
  EXPECT_EQ(both(End::free, End::clamped, Scope::bending),
            (std::pair<Fixed, Fixed>{{1, 0, 1, 1, 1, 0}, {0, 1, 0, 0, 0, 1}}));
  EXPECT_THROW(boundary(body, {End::free}), ModelError);
  EXPECT_THROW(constrained_modes(body, {}), ModelError);

  const PortModel model = port_model(body);
  const Boundary b = boundary(body, {End::pinned, End::sliding});
  const Boundary again = boundary_of(model, inverted_channels(model, b));
  for (std::size_t p = 0; p < 2; ++p) EXPECT_EQ(again.ports[p].fixed, b.ports[p].fixed);
}

// A beam rigid along its axis, held at both ends: the second axial support is redundant, its reaction is shared.
TEST(Constrain, RedundantSupportsAreCounted) {
  const auto body = beam_body("b", tube, {.traction = false});
  const ConstrainedModes modes = constrained_modes(body, boundary(body, {End::clamped, End::clamped}));
  EXPECT_EQ(modes.redundant, 1);
  EXPECT_EQ(modes.removed, 5);
  EXPECT_EQ(modes.rigid.cols(), 0);
  const ConstrainedModel model = constrain_by_inversion(body, boundary(body, {End::clamped, End::clamped}));
  EXPECT_EQ(model.ss.order(), 2 * (9 - 5));
}

// Static reaction of a clamped-pinned beam under a unit moment at the pin: −3/(2l) and ½ (textbook), by both routes;
// the static shape is a cubic, which the quintic basis contains.
TEST(Constrain, StaticReactionsOfTheProppedCantilever) {
  const auto body = beam_body("b", tube);
  const Boundary propped = boundary(body, {End::clamped, End::pinned});
  const double EI = tube.E * tube.Iz, l = tube.length;
  for (const ConstrainedModel& model : {constrain(body, propped), constrain_by_inversion(body, propped)}) {
    const auto find = [](const std::vector<Channel>& channels, const std::string& name) {
      for (std::size_t i = 0; i < channels.size(); ++i)
        if (channels[i].name == name) return static_cast<Eigen::Index>(i);
      ADD_FAILURE() << name;
      return Eigen::Index{0};
    };
    ASSERT_EQ(model.ss.inputs.size(), 1u);
    EXPECT_EQ(model.ss.inputs[0].name, "b.C.Tz");
    const MatrixXd G = response(model.ss, 0.0).real();
    const auto& out = model.ss.outputs;
    EXPECT_NEAR(G(find(out, "b.C.rz"), 0), l / (4.0 * EI), 1e-9 * l / (4.0 * EI));
    EXPECT_NEAR(G(find(out, "b.C.Fy"), 0), -1.5 / l, 1e-9);  // on the body
    EXPECT_NEAR(G(find(out, "b.P.Fy"), 0), -1.5 / l, 1e-9);  // by the body
    EXPECT_NEAR(G(find(out, "b.P.Tz"), 0), -0.5, 1e-9);
    EXPECT_NEAR(G(find(out, "b.P.Fx"), 0), 0.0, 1e-9);
  }
}

// A rigid mode's position is the double integral of W/m: exact at any frequency.
TEST(Constrain, SlidingBeamMovesAsItsMassAtLowFrequency) {
  const auto body = beam_body("b", tube);
  const Boundary sliding = boundary(body, {End::sliding, End::sliding});
  const double mass = tube.rho * tube.A * tube.length, omega = 1e-3;
  for (const ConstrainedModel& model : {constrain(body, sliding), constrain_by_inversion(body, sliding)}) {
    EXPECT_EQ(model.rigid, 1);
    ASSERT_EQ(model.ss.inputs[0].name, "b.P.Fy");  // by the body
    ASSERT_EQ(model.ss.outputs[0].name, "b.P.uy");
    EXPECT_NEAR(response(model.ss, omega)(0, 0).real() * mass * omega * omega, 1.0, 1e-8);
    EXPECT_NEAR(response(model.ss, omega)(0, 1).real() * mass * omega * omega, -1.0, 1e-8);
  }
}

// What moves without inertia, a released direction that the modes carry alone: refused with a sentence.
TEST(Constrain, RefusesMotionWithoutInertia) {
  reduction::ReducedBody body = beam_body("b", {.length = 1.0, .E = 1.0, .rho = 1.0, .A = 1.0, .Iz = 1.0},
                                          {.bend_xz = false, .traction = false, .torsion = false});  // Ip = 0
  EXPECT_THROW(constrained_modes(body, boundary(body, {End::free, End::free})), NumericalError);
  EXPECT_THROW(constrain_by_inversion(body, boundary(body, {End::free, End::free})), NumericalError);
}
