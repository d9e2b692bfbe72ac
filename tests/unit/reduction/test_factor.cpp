#include <gtest/gtest.h>

#include "fem/error.hpp"
#include "reduction/factor.hpp"
#include "reduction/sparse.hpp"
#include "tests/unit/reduction/structures.hpp"

using namespace tenon;
using namespace tenon::reduction;
using namespace tenon::tests;

TEST(Factor, SolvesManyRightSidesOfAGrid) {
  const Pencil p = grid(60, 50);
  const Factor factor = factorize(p.K);
  const Eigen::MatrixXd X = Eigen::MatrixXd::Random(p.K.rows(), 19);  // two full panels and a part of one
  const Eigen::MatrixXd B = symmetric_product(p.K, X);
  EXPECT_LT((factor.solve(B) - X).norm(), 1e-11 * X.norm());  // condition number 1.5e3
  EXPECT_GT(factor.report().nonzeros, static_cast<double>(p.K.nonZeros()));
  EXPECT_GT(factor.report().flops, factor.report().nonzeros);
  EXPECT_FALSE(factor.report().long_indices);
}

TEST(Factor, TwoThreadsAgreeWithOneOnAFactorLargeEnoughToSplit) {
  const Pencil p = grid(400, 400);
  const Factor factor = factorize(p.K);
  const Eigen::MatrixXd X = Eigen::MatrixXd::Random(p.K.rows(), 8);
  EXPECT_LT((factor.solve(symmetric_product(p.K, X)) - X).norm(), 1e-10 * X.norm());  // condition number 6.5e4
}

TEST(Factor, HalfSolvesAreTransposesWhoseProductIsTheInverse) {
  const Pencil p = grid(23, 17);
  const Factor factor = factorize(p.K);
  const Eigen::MatrixXd B = Eigen::MatrixXd::Random(p.K.rows(), 3), C = Eigen::MatrixXd::Random(p.K.rows(), 2);
  const Eigen::MatrixXd HB = factor.half_solve(B), HC = factor.half_solve(C);
  EXPECT_LT((HC.transpose() * HB - C.transpose() * factor.solve(B)).norm(), 1e-12 * HB.norm() * HC.norm());
  EXPECT_LT((factor.half_solve_transposed(HB) - factor.solve(B)).norm(), 1e-13 * HB.norm());
}

TEST(Factor, NamesTheRowThatIsNotPositive) {
  // the last dof of a chain hangs by a negative spring: K is indefinite there and nowhere else
  Pencil p = chain({2.0, 1.0, -0.5}, {1.0, 1.0});
  p.K.coeffRef(1, 1) = -3.0;
  try {
    factorize(p.K, {"node 1 ux", "node 2 ux"});
    FAIL() << "an indefinite matrix was factored";
  } catch (const NumericalError& error) {
    EXPECT_NE(std::string(error.what()).find("node 2 ux"), std::string::npos) << error.what();
  }
}

TEST(Factor, ReportsDigitsLostInAPivot) {
  // pivots of the chain: k(1 + e) − k/(1 + e) ~ 2 e k, so a soft spring of ratio 1e-8 to ground costs about 8 digits
  const Pencil p = chain({1e-8, 1.0, 0.0}, {1.0, 1.0});
  const Factor factor = factorize(p.K);
  EXPECT_GT(factor.report().lost_digits, 7.0);
  EXPECT_LT(factor.report().lost_digits, 9.0);
}

TEST(Factor, FactorsTheNextMatrixOfOnePattern) {
  const Pencil p = grid(15, 15);
  Factor factor(p.K);
  factor.factorize(p.K);
  const fem::SparseMatrix twice = 2.0 * p.K;
  factor.factorize(twice);
  const Eigen::MatrixXd X = Eigen::MatrixXd::Random(p.K.rows(), 1);
  EXPECT_LT((factor.solve(symmetric_product(twice, X)) - X).norm(), 1e-12 * X.norm());
}
