#include <gtest/gtest.h>

#include "reduction/count.hpp"
#include "reduction/eigenpairs.hpp"
#include "reduction/shift.hpp"
#include "tests/unit/reduction/structures.hpp"

using namespace tenon;
using namespace tenon::reduction;
using namespace tenon::tests;

namespace {

ModesOptions sparse_search(int count) { return {.count = count, .dense_below = 0}; }

// λ = 0.1, 0.2, … of a shift-invert operator at s = 0, all with one relative residual
RitzValues ritz_values(int count, double residual) {
  RitzValues ritz;
  ritz.theta = Eigen::VectorXd::LinSpaced(count, 0.1, 0.1 * count).cwiseInverse();
  ritz.residual = residual * ritz.theta;
  return ritz;
}

}  // namespace

TEST(Count, IsForeseenInTheGapThatTheFinalValuesHave) {
  const Pencil p = grid(40, 37);
  const std::vector<double> exact = grid_eigenvalues(40, 37);
  const ShiftedFactor at = choose_shift(p.K, p.M, Eigen::MatrixXd(p.K.rows(), 0));
  const ShiftInvert op(at.factor, p.M);
  const Eigen::MatrixXd unlocked(p.K.rows(), 0);
  std::optional<double> sigma;
  int steps = 0, step = 0;
  const auto watch = [&](const RitzValues& ritz) {
    ++steps;
    if (sigma) return;
    sigma = foresee_cut(ritz, 9, 0.0);
    step = steps;
  };
  const LanczosResult run = find_pairs(op, sparse_search(9), unlocked, 9, 8, 1, 0.0, std::nullopt, watch);
  ASSERT_TRUE(sigma);
  EXPECT_LT(step, run.steps - 1);  // time is left to count in
  EXPECT_GT(*sigma, exact[8]);
  EXPECT_LT(*sigma, exact[9]);
  EXPECT_TRUE(clear_of_modes(run.ritz, 9, 0.0, *sigma));
  EXPECT_FALSE(clear_of_modes(run.ritz, 8, 0.0, *sigma));
  EXPECT_FALSE(clear_of_modes(run.ritz, 10, 0.0, *sigma));
}

TEST(Count, IsNotForeseenFromRoughValuesOrInACluster) {
  EXPECT_FALSE(foresee_cut(ritz_values(12, 0.2), 9, 0.0));  // error 4 %, gap 10 %, a quarter of it is asked for
  const double sigma = foresee_cut(ritz_values(12, 0.01), 9, 0.0).value();
  EXPECT_GT(sigma, 0.9);
  EXPECT_LT(sigma, 1.0);
  RitzValues ritz = ritz_values(12, 1e-5);
  ritz.theta[9] = ritz.theta[8] * (1.0 - 1e-7);
  EXPECT_GT(foresee_cut(ritz, 9, 0.0).value(), 1.0 / ritz.theta[9]);  // above both
  EXPECT_FALSE(foresee_cut(ritz_values(9, 1e-5), 9, 0.0));            // nothing is known above
}

TEST(Count, NearAnEigenvalueIsNotClear) {
  const RitzValues ritz = ritz_values(12, 0.0);
  for (const double away : {1e-12, 1e-5, -1e-12}) {
    EXPECT_FALSE(clear_of_modes(ritz, 9, 0.0, 0.9 * (1.0 + away)));
    EXPECT_FALSE(clear_of_modes(ritz, 9, 0.0, 1.0 - away));
  }
  EXPECT_TRUE(clear_of_modes(ritz, 9, 0.0, 0.9 * (1.0 + 1e-4)));
  EXPECT_FALSE(clear_of_modes(ritz_values(12, 0.2), 9, 0.0, 0.95));  // the tenth value may reach down to 0.83
}

TEST(Count, AWrongForesightIsCountedAnew) {
  // below the third mode; above the twelfth; on the ninth itself, where no factor is to be believed
  const Pencil p = grid(40, 37);
  const std::vector<double> exact = grid_eigenvalues(40, 37);
  const Eigen::MatrixXd none(p.K.rows(), 0);
  for (const double wrong : {0.99 * exact[2], 1.001 * exact[11], exact[8]}) {
    Count count;
    const ShiftedFactor at =
        choose_shift(p.K, p.M, none, {}, [&](const Factor& ordered) { count.prepare(p.K, p.M, ordered); });
    count.foresee(p.K, p.M, wrong);
    const Modes modes = solve_modes(p.K, p.M, at, none, sparse_search(9), &count);
    EXPECT_EQ(modes.counted, 9);
    EXPECT_GT(modes.count_shift, exact[8]);
    EXPECT_LT(modes.count_shift, exact[9]);
  }
}

TEST(Count, TheForeseenCountIsThatOfItsOwnShift) {
  const Pencil p = grid(40, 37);
  const std::vector<double> exact = grid_eigenvalues(40, 37);
  const ShiftedFactor at = choose_shift(p.K, p.M, Eigen::MatrixXd(p.K.rows(), 0));
  Count count;
  count.prepare(p.K, p.M, at.factor);
  const double low = 0.5 * (exact[2] + exact[3]), high = 0.5 * (exact[9] + exact[10]);
  count.foresee(p.K, p.M, low);
  count.foresee(p.K, p.M, high);  // too late
  EXPECT_EQ(count.foreseen(), low);
  EXPECT_EQ(count.below(p.K, p.M, low).negative, 3);
  EXPECT_EQ(count.below(p.K, p.M, high).negative, 10);
}
