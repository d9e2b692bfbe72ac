// What `tenon beam` prints: exact roots, and bases of a bending beam under the eleven cases of the TITOP paper.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include "tests/reference/values.hpp"
#include "titop/beam_roots.hpp"
#include "titop/beam_study.hpp"

using namespace tenon;
using namespace tenon::titop;

namespace {

End end_of(char c) {
  switch (c) {
    case 'c':
      return End::clamped;
    case 'f':
      return End::free;
    case 'p':
      return End::pinned;
    default:
      return End::sliding;
  }
}

}  // namespace

TEST(BeamRoots, AreThePublishedOnes) {
  for (const reference::EndConditions& ends : reference::euler_bernoulli_roots) {
    const std::vector<double> found = beam_roots(end_of(ends.left), end_of(ends.right), 3);
    const std::vector<double> turned = beam_roots(end_of(ends.right), end_of(ends.left), 3);
    for (std::size_t k = 0; k < 3; ++k) {
      EXPECT_NEAR(found[k], ends.roots[k], 1e-11) << ends.left << ends.right;
      EXPECT_EQ(found[k], turned[k]);
    }
  }
}

TEST(BeamRoots, GoOnWithoutOverflow) {
  for (const End a : {End::clamped, End::free, End::pinned, End::sliding})
    for (const End b : {End::clamped, End::free, End::pinned, End::sliding}) {
      const std::vector<double> roots = beam_roots(a, b, 400);
      for (std::size_t k = 1; k < roots.size(); ++k)
        EXPECT_NEAR(roots[k] - roots[k - 1], reference::pi, k < 4 ? 0.35 : 1e-3) << name(a) << name(b) << k;
    }
}

// By Rayleigh-Ritz: the quintic shapes lie in the span of constraint and inertia-relief shapes of a uniform beam. 64
// elements leave 1e-8 of their own.
TEST(BeamStudy, InertiaReliefIsNeverWorseThanTheQuinticShapes) {
  const std::vector<Ends> cases = paper_cases();
  const auto quintic = beam_frequencies({BeamBasis::Kind::polynomial}, cases, 2);
  const auto relief = beam_frequencies({BeamBasis::Kind::craig_bampton_inertia_relief, 2, 64}, cases, 2);
  const auto eight = beam_frequencies({BeamBasis::Kind::craig_bampton_inertia_relief, 4, 128}, cases, 2);
  double worst = 0.0;
  for (std::size_t k = 0; k < cases.size(); ++k)
    for (int mode = 1; mode <= 2; ++mode) {
      const double reference = exact_frequency(cases[k], mode);
      ASSERT_TRUE(quintic[k] && relief[k] && eight[k]) << short_name(cases[k]);
      EXPECT_GT((*relief[k])[mode - 1], reference * (1.0 - 1e-8)) << short_name(cases[k]) << mode;
      EXPECT_LT((*relief[k])[mode - 1], (*quintic[k])[mode - 1] * (1.0 + 1e-8)) << short_name(cases[k]) << mode;
      worst = std::max(worst, std::abs((*eight[k])[mode - 1] / reference - 1.0));
    }
  fmt::print("eight shapes (constraint, inertia relief, 4 fixed-interface): worst error of two modes {:.1e} %\n",
             100.0 * worst);
  EXPECT_LT(100.0 * worst, 1e-3);
}

// Cubic elements with consistent mass: ω is (βh)⁴/1440 too high, the leading term of their dispersion; round-off of the
// eigen-solve is 1e-10.
TEST(BeamStudy, ErrorOfTheElementsIsTheirDispersion) {
  const BeamConvergence c = convergence_with_elements({End::clamped, End::free}, 16);
  ASSERT_EQ(c.number.back(), 32.0);
  for (std::size_t k = 1; k < c.number.size(); ++k)
    for (std::size_t m = 0; m < 2; ++m) {
      const double bh = beam_roots(End::clamped, End::free, 2)[m] / c.number[k], leading = std::pow(bh, 4) / 1440.0;
      if (bh > 0.7) continue;
      EXPECT_NEAR(c.error[m][k], leading, 0.5 * bh * bh * leading + 1e-10) << c.number[k] << " mode " << m + 1;
    }
}

TEST(BeamStudy, ErrorFallsWithTheModesKept) {
  const BeamConvergence c = convergence_with_modes({End::free, End::clamped}, 2);
  ASSERT_EQ(c.number.size(), 8u);
  for (const auto& error : c.error)
    for (std::size_t k = 1; k < error.size(); ++k)  // Rayleigh-Ritz, down to the error of the elements
      EXPECT_TRUE(std::isnan(error[k - 1]) || error[k] < error[k - 1] + 1e-9) << k;
  EXPECT_LT(c.error[0].back(), 1e-7);
}
