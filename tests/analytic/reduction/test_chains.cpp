#include <gtest/gtest.h>

#include "reduction/modes.hpp"
#include "tests/unit/reduction/structures.hpp"

using namespace tenon;
using namespace tenon::reduction;
using namespace tenon::tests;

namespace {

const Eigen::MatrixXd none;
constexpr double pi = std::numbers::pi;

}  // namespace

// Nine springs of 1e5 N/m, eight masses of 10 kg between two walls (SDLD02): ω_j = 2√(k/m) sin(jπ/2(N+1))
TEST(Chains, Sdld02) {
  const Pencil p = uniform_chain(8, 1e5, 10.0, true, true);
  const double published[] = {5.5274, 10.8868, 15.9155, 20.4606, 24.3840, 27.5664, 29.9113, 31.3474};  // Hz
  const Modes modes = solve_modes(p.K, p.M, none, {.count = 8});
  ASSERT_EQ(modes.lambda.size(), 8);
  EXPECT_EQ(modes.counted, 8);
  for (int j = 1; j <= 8; ++j) {
    const double omega = std::sqrt(modes.lambda[j - 1]);
    const double exact = 2.0 * std::sqrt(1e5 / 10.0) * std::sin(j * pi / 18.0);
    EXPECT_NEAR(omega, exact, 1e-12 * exact);
    EXPECT_NEAR(omega / (2.0 * pi), published[j - 1], 5e-5);
  }
}

// 1000 masses from a wall to a free end: ω_j = 2√(k/m) sin((2j−1)π/2(2N+1))
TEST(Chains, AThousandMassesFixedFree) {
  const int n = 1000;
  const Pencil p = uniform_chain(n, 1e5, 10.0, true, false);
  for (const int dense_below : {0, 2000}) {
    const Modes modes = solve_modes(p.K, p.M, none, {.count = 25, .dense_below = dense_below});
    ASSERT_EQ(modes.lambda.size(), 25);
    EXPECT_EQ(modes.counted, modes.found);
    for (int j = 1; j <= 25; ++j) {
      const double exact = 2.0 * std::sqrt(1e4) * std::sin((2 * j - 1) * pi / (2.0 * (2 * n + 1)));
      EXPECT_NEAR(std::sqrt(modes.lambda[j - 1]), exact, 1e-10 * exact);
    }
  }
}

// a free chain: one rigid mode, exactly zero, then ω_j = 2√(k/m) sin(jπ/2N)
TEST(Chains, FreeFree) {
  const int n = 800;
  const Pencil p = uniform_chain(n, 3e4, 2.0, false, false);
  const Eigen::MatrixXd candidates = Eigen::MatrixXd::Ones(n, 1);
  for (const Eigen::MatrixXd& rigid : {candidates, none})  // without the candidate it is found all the same
    for (const int dense_below : {0, 2000}) {
      const Modes modes = solve_modes(p.K, p.M, rigid, {.count = 12, .dense_below = dense_below});
      EXPECT_EQ(modes.rigid, 1);
      EXPECT_EQ(modes.lambda[0], 0.0);
      EXPECT_EQ(modes.counted, modes.found);
      for (int j = 1; j < 12; ++j) {
        const double s = std::sin(j * pi / (2.0 * n)), exact = 4.0 * 1.5e4 * s * s;
        EXPECT_NEAR(modes.lambda[j], exact, 1e-10 * exact) << "mode " << j;
      }
    }
}

// a candidate outside null(K) is dropped: the fixed chain has no rigid mode
TEST(Chains, ACandidateThatStrainsIsDropped) {
  const Pencil p = uniform_chain(700, 1.0, 1.0, true, false);
  const Modes modes = solve_modes(p.K, p.M, Eigen::MatrixXd::Ones(700, 1), {.count = 3});
  EXPECT_EQ(modes.rigid, 0);
  const double s = std::sin(pi / 2802.0);
  EXPECT_NEAR(modes.lambda[0], 4.0 * s * s, 1e-10 * 4.0 * s * s);
}

// two loose chains: two zero modes, one of which is no common translation
TEST(Chains, TwoPiecesHaveTwoZeroModes) {
  const Pencil p = repeated(uniform_chain(400, 1.0, 1.0, false, false), 2);
  for (const int dense_below : {0, 1000}) {
    const Modes modes = solve_modes(p.K, p.M, Eigen::MatrixXd::Ones(800, 1), {.count = 8, .dense_below = dense_below});
    EXPECT_EQ(modes.rigid, 2);
    EXPECT_EQ(modes.lambda[1], 0.0);
    EXPECT_EQ(modes.counted, modes.found);
    const double s = std::sin(pi / 800.0);
    EXPECT_NEAR(modes.lambda[2], 4.0 * s * s, 1e-10 * 4.0 * s * s);
    EXPECT_NEAR(modes.lambda[3], modes.lambda[2], 1e-12);
  }
}

// a soft hinge inside a free chain is no mechanism: stiffness ratio 1e-9, λ ≈ 2 k_soft / (mass of half the chain)
TEST(Chains, ASoftHingeIsNotARigidMode) {
  const int n = 100;
  std::vector<double> springs(n + 1, 1.0);
  springs.front() = springs.back() = 0.0;
  springs[n / 2] = 1e-9;
  const Pencil p = chain(springs, std::vector<double>(n, 1.0));
  const Modes modes = solve_modes(p.K, p.M, Eigen::MatrixXd::Ones(n, 1), {.count = 3});
  EXPECT_EQ(modes.rigid, 1);
  // two rigid halves of mass 50 on a spring; K holds 1e-9 beside 1 with 7 digits, the halves' own flexibility adds 3e-8
  EXPECT_NEAR(modes.lambda[1] / (1e-9 * 2.0 / 50.0), 1.0, 1e-6);
}

// square grid: eigenvalues in pairs (i,j), (j,i)
TEST(Chains, MembraneWithPairs) {
  const Pencil p = grid(40, 40);
  const std::vector<double> exact = grid_eigenvalues(40, 40);
  const Modes modes = solve_modes(p.K, p.M, none, {.count = 30});
  EXPECT_EQ(modes.counted, modes.found);
  for (int k = 0; k < 30; ++k) EXPECT_NEAR(modes.lambda[k], exact[static_cast<std::size_t>(k)], 1e-12);
}

// seven equal grids: multiplicity 7 and, for the pairs, 14
TEST(Chains, MultiplicitySevenAndFourteen) {
  const Pencil p = repeated(grid(13, 13), 7);
  std::vector<double> exact;
  for (const double x : grid_eigenvalues(13, 13)) exact.insert(exact.end(), 7, x);
  const Modes modes = solve_modes(p.K, p.M, none, {.count = 21});
  EXPECT_EQ(modes.counted, modes.found);
  ASSERT_EQ(modes.lambda.size(), 21);
  for (int k = 0; k < 21; ++k) EXPECT_NEAR(modes.lambda[k], exact[static_cast<std::size_t>(k)], 1e-12);
}
