#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>
#include <numbers>

#include "fem/error.hpp"
#include "titop/balance.hpp"
#include "titop/compose.hpp"
#include "titop/minimal.hpp"
#include "titop/poles_zeros.hpp"

using namespace tenon;
using namespace tenon::titop;
using Eigen::MatrixXd;
using Eigen::VectorXcd;
using Eigen::VectorXd;
using Complex = std::complex<double>;
using testing::HasSubstr;

namespace {

StateSpace system(const MatrixXd& A, const MatrixXd& B, const MatrixXd& C, const MatrixXd& D) {
  StateSpace ss{A, B, C, D, {}, {}};
  for (Eigen::Index j = 0; j < B.cols(); ++j) ss.inputs.push_back({"u" + std::to_string(j), "N"});
  for (Eigen::Index i = 0; i < C.rows(); ++i) ss.outputs.push_back({"y" + std::to_string(i), "m"});
  return ss;
}

StateSpace system(const MatrixXd& A, const MatrixXd& B, const MatrixXd& C) {
  return system(A, B, C, MatrixXd::Zero(C.rows(), B.cols()));
}

// (s + z)/(s + p)
StateSpace first_order(double z, double p) {
  StateSpace ss =
      system(MatrixXd::Constant(1, 1, -p), MatrixXd::Ones(1, 1), MatrixXd::Constant(1, 1, z - p), MatrixXd::Ones(1, 1));
  ss.outputs[0].unit = "N";
  return ss;
}

// equal masses m in a row with springs k between them, at the left wall `left`, at the right wall `right`; forces and
// displacements of all masses
StateSpace chain(int n, double m, double k, double left, double right) {
  MatrixXd A = MatrixXd::Zero(2 * n, 2 * n), B = MatrixXd::Zero(2 * n, n), C = MatrixXd::Zero(n, 2 * n);
  for (int i = 0; i < n; ++i) {
    A(i, n + i) = 1.0;
    const double before = i == 0 ? left : k, after = i == n - 1 ? right : k;
    A(n + i, i) = -(before + after) / m;
    if (i > 0) A(n + i, i - 1) = k / m;
    if (i < n - 1) A(n + i, i + 1) = k / m;
    B(n + i, i) = 1.0 / m;
    C(i, i) = 1.0;
  }
  return system(A, B, C);
}

// every expected root once among those found, relative to the largest
void expect_roots(const VectorXcd& found, std::vector<Complex> expected, double tolerance) {
  ASSERT_EQ(found.size(), static_cast<Eigen::Index>(expected.size()));
  std::vector<Complex> left(found.begin(), found.end());
  for (const Complex& e : expected) {
    const auto nearest = std::min_element(left.begin(), left.end(), [&](const Complex& a, const Complex& b) {
      return std::abs(a - e) < std::abs(b - e);
    });
    EXPECT_LT(std::abs(*nearest - e), tolerance) << e;
    left.erase(nearest);
  }
}

void expect_same_response(const StateSpace& a, const StateSpace& b, double tolerance) {
  for (const double omega : {0.013, 0.7, 3.3, 41.0, 5200.0}) {
    const Eigen::MatrixXcd Ga = response(a, omega), Gb = response(b, omega);
    EXPECT_LT((Ga - Gb).norm(), tolerance * Ga.norm()) << omega;
  }
}

}  // namespace

TEST(Compose, SeriesMultipliesAndParallelAdds) {
  const StateSpace a = first_order(3.0, 1.0), b = first_order(-2.0, 5.0);
  for (const double omega : {0.0, 2.0}) {
    const Complex s(0.0, omega), Ga = (s + 3.0) / (s + 1.0), Gb = (s - 2.0) / (s + 5.0);
    EXPECT_LT(std::abs(response(series(a, b), omega)(0, 0) - Ga * Gb), 1e-14);
    EXPECT_LT(std::abs(response(parallel(a, b), omega)(0, 0) - (Ga + Gb)), 1e-14);
  }
}

TEST(Compose, RefusesChannelsThatDoNotFit) {
  const StateSpace force = first_order(1.0, 2.0);
  StateSpace length = force;
  length.outputs[0].unit = "m";
  EXPECT_NO_THROW(series(force, length));
  for (const auto& wrong : {std::function<void()>([&] { series(length, force); }),
                            std::function<void()>([&] { parallel(force, length); })}) {
    try {
      wrong();
      ADD_FAILURE() << "metres taken for newtons";
    } catch (const ModelError& error) {
      EXPECT_THAT(error.what(), HasSubstr("'y0' in"));
    }
  }
  EXPECT_THROW(series(chain(2, 1, 1, 1, 1), force), ModelError);
}

// Two masses, k₁ to the wall, k₂ between them. Force and motion of the first mass: while its motion is zero the second
// swings on k₂, s² = −k₂/m. From the first to the second: no zeros.
TEST(Zeros, OfATwoMassChain) {
  const double m = 2.0, k = 50.0;
  const StateSpace both = chain(2, m, k, 30.0, 0.0);
  const Complex j(0.0, std::sqrt(k / m));
  expect_roots(zeros(subsystem(both, {0}, {0})), {j, -j}, 1e-13 * std::abs(j));
  EXPECT_EQ(zeros(subsystem(both, {1}, {0})).size(), 0);
  EXPECT_EQ(zeros(both).size(), 0);
  EXPECT_EQ(zeros(subsystem(both, {0, 1}, {0})).size(), 0);
  EXPECT_EQ(zeros(subsystem(both, {1}, {0, 1})).size(), 0);
  // acceleration of the first mass: y = C A² x + C A B u has D ≠ 0 and two more zeros at the origin, a double one
  StateSpace acceleration = subsystem(both, {0}, {0});
  acceleration.D = acceleration.C * acceleration.A * acceleration.B;
  acceleration.C = (acceleration.C * acceleration.A * acceleration.A).eval();
  expect_roots(zeros(acceleration), {j, -j, 0.0, 0.0}, 1e-6 * std::abs(j));
}

TEST(Zeros, DoNotDependOnUnits) {
  const double m = 2e-6, k = 5e9;
  StateSpace first = subsystem(chain(2, m, k, 3e9, 0.0), {0}, {0});
  first.B *= 1e-9;
  first.C *= 1e7;
  const Complex j(0.0, std::sqrt(k / m));
  expect_roots(zeros(first), {j, -j}, 1e-12 * std::abs(j));
}

// (s + 2)[1/((s + 1)(s + 3)); 1/((s + 1)(s + 4))]: one input, two outputs, one zero. Its dual has it as well.
TEST(Zeros, OfSystemsThatAreNotSquare) {
  MatrixXd C(2, 3);
  C << 0.5, 0.5, 0.0, 1.0 / 3.0, 0.0, 2.0 / 3.0;
  const MatrixXd A = Eigen::Vector3d(-1.0, -3.0, -4.0).asDiagonal();
  expect_roots(zeros(system(A, MatrixXd::Ones(3, 1), C)), {-2.0}, 1e-13);
  expect_roots(zeros(system(A, C.transpose(), MatrixXd::Ones(1, 3))), {-2.0}, 1e-13);
}

// Channels that repeat one another lower the normal rank and leave the zeros as they are.
TEST(Zeros, OfDependentChannels) {
  const StateSpace both = chain(2, 2.0, 50.0, 30.0, 0.0);
  const Complex j(0.0, 5.0);
  expect_roots(zeros(subsystem(both, {0, 0}, {0, 0})), {j, -j}, 1e-12);
}

// Two inputs, two outputs with D ≠ 0 of rank one and of rank two: det G known. G = diag((s + 1)/(s + 3), 1/(s + 4)),
// mixed by constant invertible matrices.
TEST(Zeros, OfSeveralChannelsWithFeedThrough) {
  Eigen::Matrix2d mix, turn;
  mix << 1.0, 2.0, -1.0, 3.0;
  turn << 0.6, -0.8, 0.8, 0.6;
  const MatrixXd A = Eigen::Vector2d(-3.0, -4.0).asDiagonal(), C = Eigen::Vector2d(-2.0, 1.0).asDiagonal();
  const MatrixXd D = Eigen::Vector2d(1.0, 0.0).asDiagonal();
  expect_roots(zeros(system(A, turn, mix * C, mix * D * turn)), {-1.0}, 1e-12);
  const MatrixXd full = Eigen::Vector2d(1.0, 0.5).asDiagonal();  // second channel 0.5 + 1/(s + 4): zero at −6
  expect_roots(zeros(system(A, turn, mix * C, mix * full * turn)), {-1.0, -6.0}, 1e-12);
}

TEST(Poles, OfAChainAndOfRigidMotions) {
  const int n = 9;
  const double m = 10.0, k = 1e5;
  std::vector<Complex> expected;
  for (int i = 1; i <= n; ++i) {
    const double omega = 2.0 * std::sqrt(k / m) * std::sin(i * std::numbers::pi / (2.0 * (n + 1)));
    expected.emplace_back(0.0, omega);
    expected.emplace_back(0.0, -omega);
  }
  expect_roots(poles(chain(n, m, k, k, k)), expected, 1e-11 * 200.0);
  // a free motion beside a mode of 1e6 rad/s: blocks of their own, so zeros are exact zeros
  MatrixXd A = MatrixXd::Zero(4, 4);
  A(0, 1) = 1.0;
  A(2, 3) = 1e6;
  A(3, 2) = -1e6;
  const VectorXcd p = poles(system(A, MatrixXd::Ones(4, 1), MatrixXd::Ones(1, 4)));
  EXPECT_EQ(p[0], Complex(0.0));
  EXPECT_EQ(p[1], Complex(0.0));
  EXPECT_NEAR(std::abs(p[3]), 1e6, 1e-6);
}

TEST(Balance, KeepsTheResponseAndEvensTheStates) {
  const StateSpace good = chain(3, 1.0, 20.0, 20.0, 0.0);
  const VectorXd T = (VectorXd(6) << 1e8, 1e-7, 1.0, 1e3, 1e-9, 1e5).finished();
  StateSpace bad = good;
  bad.A = T.asDiagonal() * good.A * T.cwiseInverse().asDiagonal();
  bad.B = T.asDiagonal() * good.B;
  bad.C = good.C * T.cwiseInverse().asDiagonal();
  const Balanced b = balance(bad);
  expect_same_response(good, b.ss, 1e-12);
  const auto spread = [](const MatrixXd& A) {
    double low = 1e300, high = 0.0;
    for (const double x : A.reshaped())
      if (x != 0.0) low = std::min(low, std::abs(x)), high = std::max(high, std::abs(x));
    return high / low;
  };
  EXPECT_LT(spread(b.ss.A), 100.0);
  EXPECT_GT(spread(bad.A), 1e15);
  for (const double s : b.scale) EXPECT_EQ(std::exp2(std::round(std::log2(s))), s);
  EXPECT_EQ(b.ss.inputs[1].name, "u1");
}

// (s + 1)/(s + 2) · (s + 2)/(s + 3): a zero meets a pole, on either side.
TEST(Minimal, TakesOutPoleZeroCancellations) {
  const StateSpace a = first_order(1.0, 2.0), b = first_order(2.0, 3.0);
  const Minimal hidden = minimal(series(a, b)), unmoved = minimal(series(b, a));
  EXPECT_EQ(hidden.ss.order(), 1);
  EXPECT_EQ(unmoved.ss.order(), 1);
  expect_roots(hidden.unobservable, {-2.0}, 1e-13);
  expect_roots(unmoved.uncontrollable, {-2.0}, 1e-13);
  expect_same_response(hidden.ss, series(a, b), 1e-13);
  expect_roots(zeros(hidden.ss), {-1.0}, 1e-12);
  EXPECT_EQ(hidden.ss.inputs[0].name, "u0");
  EXPECT_EQ(hidden.ss.outputs[0].unit, "N");
}

TEST(Minimal, TakesOutTheDoubleOfASystem) {
  const StateSpace both = chain(4, 1.0, 30.0, 10.0, 0.0);
  const Minimal m = minimal(parallel(both, both));
  EXPECT_EQ(m.ss.order(), 8);
  EXPECT_LT(m.largest_dropped, 1e-13);
  EXPECT_GT(m.least_kept, 1e-3);
  expect_same_response(m.ss, parallel(both, both), 1e-10);
}

// Double integrators stay when they are seen and go, as two zeros, when only relative motion is seen.
TEST(Minimal, KeepsRigidMotionsThatAreSeen) {
  const StateSpace free = chain(2, 1.0, 8.0, 0.0, 0.0);
  EXPECT_EQ(minimal(subsystem(free, {0}, {0})).ss.order(), 4);
  expect_same_response(minimal(free).ss, free, 1e-10);
  StateSpace relative = subsystem(free, {0}, {0});
  relative.C = (free.C.row(0) - free.C.row(1)).eval();
  const Minimal m = minimal(relative);
  EXPECT_EQ(m.ss.order(), 2);
  expect_roots(m.unobservable, {0.0, 0.0}, 1e-7);
  expect_roots(poles(m.ss), {Complex(0.0, 4.0), Complex(0.0, -4.0)}, 1e-12);
  expect_same_response(m.ss, relative, 1e-10);
}

// One Jordan block: what lies above the entry that is driven cannot be told apart by eigenvalues, only by the chain.
TEST(Minimal, CutsAJordanBlockWhereItsChainEnds) {
  for (const double lambda : {-1.0, 0.0, 2.0}) {
    MatrixXd A = lambda * MatrixXd::Identity(3, 3);
    A(0, 1) = A(1, 2) = 1.0;
    const Eigen::RowVector3d C(1.0, 0.0, 0.0);
    EXPECT_EQ(minimal(system(A, Eigen::Vector3d(0, 0, 1), C)).ss.order(), 3);
    const Minimal two = minimal(system(A, Eigen::Vector3d(0, 1, 0), C));
    EXPECT_EQ(two.ss.order(), 2);
    expect_roots(two.uncontrollable, {lambda}, 1e-13);
    expect_same_response(two.ss, system(A, Eigen::Vector3d(0, 1, 0), C), 1e-12);
  }
}

// Fifteen masses between two walls, force and motion in the middle: the seven modes with a node there go.
TEST(Minimal, TakesOutTheModesWithANodeAtTheForce) {
  const int n = 15;
  const StateSpace middle = subsystem(chain(n, 1.0, 100.0, 100.0, 100.0), {7}, {7});
  const Minimal m = minimal(middle);
  EXPECT_EQ(m.ss.order(), 16);
  std::vector<Complex> expected;
  for (int i = 1; i <= n; i += 2) {
    const double omega = 20.0 * std::sin(i * std::numbers::pi / (2.0 * (n + 1)));
    expected.emplace_back(0.0, omega);
    expected.emplace_back(0.0, -omega);
  }
  expect_roots(poles(m.ss), expected, 1e-10);
  expect_same_response(m.ss, middle, 1e-10);
}

// A modal system of four decades, some modes without participation at the input, others at the output; an unstable one
// among those kept.
TEST(Minimal, OfAModalSystem) {
  const int n = 12;
  MatrixXd A = MatrixXd::Zero(2 * n, 2 * n), B = MatrixXd::Zero(2 * n, 1), C = MatrixXd::Zero(1, 2 * n);
  for (int i = 0; i < n; ++i) {
    const double omega = std::pow(10.0, 4.0 * i / (n - 1));
    A(2 * i, 2 * i + 1) = 1.0;
    A(2 * i + 1, 2 * i) = -omega * omega;
    A(2 * i + 1, 2 * i + 1) = (i == 1 ? 0.02 : -0.01) * omega;
    B(2 * i + 1, 0) = i % 3 == 0 ? 0.0 : 1.0;
    C(0, 2 * i) = i % 4 == 0 ? 0.0 : 1.0;
  }
  const StateSpace given = system(A, B, C);
  const Minimal m = minimal(given);
  EXPECT_EQ(m.uncontrollable.size(), 8);  // i = 0, 3, 6, 9
  EXPECT_EQ(m.unobservable.size(), 4);    // i = 4, 8
  EXPECT_EQ(m.ss.order(), 12);
  expect_same_response(m.ss, given, 1e-10);
}

TEST(Minimal, LeavesAnEmptyOrAMinimalSystemAlone) {
  const StateSpace gain = system(MatrixXd(0, 0), MatrixXd(0, 1), MatrixXd(1, 0), MatrixXd::Ones(1, 1));
  EXPECT_EQ(minimal(gain).ss.order(), 0);
  EXPECT_EQ(zeros(gain).size(), 0);
  EXPECT_EQ(poles(gain).size(), 0);
  const StateSpace end = subsystem(chain(20, 1.0, 1.0, 1.0, 0.0), {19}, {19});
  EXPECT_EQ(minimal(end).ss.order(), 40);
}
