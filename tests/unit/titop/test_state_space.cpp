#include "titop/state_space.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <Eigen/LU>

#include "fem/error.hpp"

using namespace tenon;
using namespace tenon::titop;
using Eigen::MatrixXcd;
using Eigen::MatrixXd;

namespace {

std::vector<Channel> channels(const std::string& prefix, int count) {
  std::vector<Channel> c;
  for (int i = 1; i <= count; ++i) c.push_back({prefix + std::to_string(i), "1"});
  return c;
}

// x'' + 2 x' + 9 x = u, y = x
StateSpace oscillator() {
  StateSpace ss;
  ss.A.resize(2, 2);
  ss.A << 0, 1, -9, -2;
  ss.B = Eigen::Vector2d(0, 1);
  ss.C = Eigen::RowVector2d(1, 0);
  ss.D = MatrixXd::Zero(1, 1);
  ss.inputs = channels("u", 1);
  ss.outputs = channels("y", 1);
  return ss;
}

// three channels, D well conditioned, units of very different size
StateSpace three_channels() {
  StateSpace ss;
  ss.A.resize(2, 2);
  ss.A << -1, 2, -3, -0.5;
  ss.B.resize(2, 3);
  ss.B << 1, 0.5, -1, 0, 2, 1;
  ss.C.resize(3, 2);
  ss.C << 1, 0, 0.3, -1, 2, 1;
  ss.D.resize(3, 3);
  ss.D << 2, 0.4, -0.1, 0.3, -3, 0.2, 0.5, 0.1, 1.5;
  const Eigen::Vector3d units(1e6, 1.0, 1e-6);
  ss.C = units.asDiagonal() * ss.C;
  ss.D = units.asDiagonal() * ss.D;
  ss.inputs = channels("u", 3);
  ss.outputs = channels("y", 3);
  return ss;
}

double difference(const MatrixXcd& a, const MatrixXcd& b) { return (a - b).norm() / a.norm(); }

}  // namespace

TEST(StateSpace, ResponseIsTheTransferFunction) {
  const std::complex<double> s(0.0, 1.7), expected = 1.0 / (s * s + 2.0 * s + 9.0);
  EXPECT_LT(std::abs(response(oscillator(), 1.7)(0, 0) - expected), 1e-15);
}

TEST(StateSpace, ResponseAtAPoleIsRefused) {
  StateSpace integrator = oscillator();
  integrator.A << 0, 1, 0, 0;
  EXPECT_THROW(response(integrator, 0.0), NumericalError);
}

TEST(StateSpace, FeedbackGivesTheClosedLoop) {
  // y = G (v − 4 y): 1/(s² + 2 s + 13)
  const StateSpace closed = feedback(oscillator(), MatrixXd::Constant(1, 1, -4.0));
  const std::complex<double> s(0.0, 0.6), expected = 1.0 / (s * s + 2.0 * s + 13.0);
  EXPECT_LT(std::abs(response(closed, 0.6)(0, 0) - expected), 1e-15);
}

TEST(StateSpace, FeedbackAroundTheDirectTransmission) {
  const StateSpace ss = three_channels();
  MatrixXd F(3, 3);
  F << 1e-7, 0.2, 0, 0, 0.1, 2e4, -1e-7, 0, 3e5;
  const MatrixXcd G = response(ss, 2.0), one = MatrixXcd::Identity(3, 3);
  const MatrixXcd expected = (one - G * F).lu().solve(G);
  EXPECT_LT(difference(expected, response(feedback(ss, F), 2.0)), 1e-13);
}

TEST(StateSpace, FeedbackWithoutSolutionIsRefused) {
  StateSpace gain = oscillator();
  gain.D(0, 0) = 0.5;
  EXPECT_THROW(feedback(gain, MatrixXd::Constant(1, 1, 2.0)), NumericalError);  // 1 − 0.5·2 = 0
}

TEST(StateSpace, AppendAndSubsystemAreInverse) {
  const StateSpace a = oscillator(), b = three_channels(), both = append({a, b});
  EXPECT_LT(difference(response(b, 0.3), response(subsystem(both, {1, 2, 3}, {1, 2, 3}), 0.3)), 1e-15);
  EXPECT_LT(response(subsystem(both, {0}, {1, 2, 3}), 0.3).norm(), 1e-300);
  EXPECT_EQ(both.inputs[1].name, "u1");
}

TEST(StateSpace, SizesAreChecked) {
  StateSpace ss = oscillator();
  ss.inputs.clear();
  EXPECT_THROW(check(ss), ModelError);
}

TEST(Inversion, OfAllChannelsIsTheInverseResponse) {
  const StateSpace ss = three_channels();
  const Inversion inverse = invert_channels(ss, {0, 1, 2});
  EXPECT_LT(difference(response(ss, 0.9).inverse(), response(inverse.ss, 0.9)), 1e-13);
  EXPECT_LT(inverse.condition, 10.0);  // the units of 1e±6 do not count
  EXPECT_EQ(inverse.ss.inputs[2].name, "y3");
  EXPECT_EQ(inverse.ss.outputs[2].name, "u3");
}

TEST(Inversion, OfABlockIsTheSuccessionInAnyOrder) {  // eq (28)
  const StateSpace ss = three_channels();
  const MatrixXcd block = response(invert_channels(ss, {2, 0}).ss, 1.3);
  const StateSpace first = invert_channels(ss, {0}).ss, second = invert_channels(ss, {2}).ss;
  EXPECT_LT(difference(block, response(invert_channels(first, {2}).ss, 1.3)), 1e-13);
  EXPECT_LT(difference(block, response(invert_channels(second, {0}).ss, 1.3)), 1e-13);
}

TEST(Inversion, TwiceIsTheSystemItself) {
  const StateSpace ss = three_channels();
  const StateSpace twice = invert_channels(invert_channels(ss, {0, 1}).ss, {0, 1}).ss;
  EXPECT_LT((twice.A - ss.A).norm(), 1e-13 * ss.A.norm());
  EXPECT_LT(difference(response(ss, 0.2), response(twice, 0.2)), 1e-13);
}

TEST(Inversion, OfChannelsOfAWideSystem) {
  const StateSpace ss = subsystem(three_channels(), {0}, {0, 1, 2});
  const MatrixXcd G = response(ss, 0.7), inverse = response(invert_channels(ss, {0}).ss, 0.7);
  EXPECT_LT(std::abs(inverse(0, 0) * G(0, 0) - 1.0), 1e-14);  // u1 = (y1 − G12 u2 − G13 u3)/G11
  EXPECT_LT(std::abs(inverse(0, 1) + G(0, 1) / G(0, 0)), 1e-14 * std::abs(inverse(0, 1)));
}

TEST(Inversion, OfAChannelWithoutTransmissionNamesItAndTheCure) {
  StateSpace ss = three_channels();
  ss.D.row(1).setZero();
  try {
    invert_channels(ss, {0, 1});
    FAIL() << "inverted a channel with D(i, i) = 0";
  } catch (const NumericalError& e) {
    EXPECT_THAT(e.what(), ::testing::HasSubstr("'u2' → 'y2'"));
    EXPECT_THAT(e.what(), ::testing::Not(::testing::HasSubstr("'u1'")));
    EXPECT_THAT(e.what(), ::testing::HasSubstr("second-order route"));
  }
}

TEST(Inversion, OfDependentChannelsNamesBoth) {
  StateSpace ss = three_channels();
  ss.D.row(1) = 2e-6 * ss.D.row(0);
  EXPECT_THROW(invert_channels(ss, {0, 1}), NumericalError);
  EXPECT_THROW(invert_channels(ss, {0, 0}), ModelError);
  EXPECT_THROW(invert_channels(ss, {3}), ModelError);
}
