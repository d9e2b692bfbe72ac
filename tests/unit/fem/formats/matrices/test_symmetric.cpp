#include "fem/formats/matrices/symmetric.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>

using namespace tenon::fem;
using namespace tenon::fem::matrices;

namespace {

constexpr int n = 60;

/// A symmetric matrix, a tenth of it filled, and its entries in any order.
struct Shuffled {
  Eigen::MatrixXd A = Eigen::MatrixXd::Zero(n, n);
  std::vector<Entry> entries;

  explicit Shuffled(Stored stored) {
    std::mt19937 random(7);
    std::uniform_real_distribution<double> value(-1.0, 1.0);
    for (int j = 0; j < n; ++j)
      for (int i = j; i < n; ++i) {
        if (i != j && random() % 10 != 0) continue;
        A(i, j) = A(j, i) = value(random);
        const bool upper = random() % 2 != 0;
        if (stored == Stored::both || !upper || i == j) entries.emplace_back(i, j, A(i, j));
        if (i != j && (stored == Stored::both || upper || (stored == Stored::either && random() % 3 == 0)))
          entries.emplace_back(j, i, A(i, j));
      }
    std::ranges::shuffle(entries, random);
  }
};

TEST(SymmetricEntries, InAnyOrderAreTheMatrix) {
  for (const Stored stored : {Stored::both, Stored::either, Stored::one}) {
    const Shuffled given(stored);
    const auto result = lower_triangle(n, given.entries, stored, 0.0);
    ASSERT_TRUE(std::holds_alternative<SparseMatrix>(result));
    const auto& lower = std::get<SparseMatrix>(result);
    EXPECT_TRUE(lower.isCompressed());
    EXPECT_EQ(Eigen::MatrixXd(lower),
              Eigen::MatrixXd(given.A.triangularView<Eigen::Lower>()));  // copies, no arithmetic
    for (int j = 0; j < n; ++j)
      for (int at = lower.outerIndexPtr()[j] + 1; at < lower.outerIndexPtr()[j + 1]; ++at)
        EXPECT_LT(lower.innerIndexPtr()[at - 1], lower.innerIndexPtr()[at]) << "column " << j;
  }
}

TEST(SymmetricEntries, TakeTheMeanAndLeaveZerosOut) {
  const auto result =
      lower_triangle(3, {{2, 0, 1.0}, {0, 2, 1.5}, {1, 1, 0.0}, {1, 0, 0.0}, {0, 0, 2.0}}, Stored::both, 0.3);
  const auto& lower = std::get<SparseMatrix>(result);
  EXPECT_EQ(lower.nonZeros(), 2);
  EXPECT_EQ(lower.coeff(2, 0), 1.25);
}

TEST(SymmetricEntries, NameTheWorstDifferenceAndWhatStandsTwice) {
  Shuffled given(Stored::both);
  given.entries.emplace_back(given.entries[5]);
  auto result = lower_triangle(n, given.entries, Stored::both, 1e-12);
  const Asymmetry twice = std::get<Asymmetry>(result);
  EXPECT_TRUE(twice.twice);
  EXPECT_EQ(twice.row, given.entries[5].row());
  EXPECT_EQ(twice.column, given.entries[5].col());

  result =
      lower_triangle(3, {{0, 0, 1.}, {1, 1, 1.}, {2, 2, 1.}, {1, 0, .1}, {2, 0, .5}, {0, 2, .1}}, Stored::both, 0.05);
  const Asymmetry worst = std::get<Asymmetry>(result);
  EXPECT_FALSE(worst.twice);
  EXPECT_EQ(worst.row, 2);
  EXPECT_EQ(worst.column, 0);
  EXPECT_EQ(worst.lower, 0.5);
  EXPECT_EQ(worst.upper, 0.1);

  result = lower_triangle(2, {{1, 0, 1.}, {0, 1, 1.}}, Stored::one, 1e-12);
  EXPECT_TRUE(std::get<Asymmetry>(result).twice);
}

}  // namespace
