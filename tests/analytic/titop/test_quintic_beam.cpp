// The tables of the TITOP paper for the quintic beam G_f,pol, every printed digit, by channel inversion.
#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>
#include <algorithm>

#include "tests/reference/beams.hpp"
#include "titop/port_model.hpp"

using namespace tenon;

namespace {

struct Case {
  const char* name;
  std::vector<int> inverted;  // channels of (8): 1 F_C / v_C, 2 T_C / α_C, 3 F_P / v_P, 4 T_P / α_P
  int prescribed;             // r: deformations that the prescribed port motions determine; 2r poles are zero
  double first, second;       // printed
  double digit_first, digit_second;
};

// Channels 1..4 of the planar model among the twelve of the spatial one.
titop::StateSpace planar_model() {
  const std::vector<int> channels{1, 5, 7, 11};
  return titop::subsystem(titop::port_model(reference::polynomial_beam("beam")).ss, channels, channels);
}

std::vector<double> pole_sizes(const titop::StateSpace& ss) {
  const Eigen::VectorXcd poles = Eigen::EigenSolver<Eigen::MatrixXd>(ss.A, false).eigenvalues();
  std::vector<double> sizes;
  for (const auto& p : poles) sizes.push_back(std::abs(p));
  std::sort(sizes.begin(), sizes.end());
  return sizes;
}

class QuinticBeam : public ::testing::TestWithParam<Case> {};

}  // namespace

TEST_P(QuinticBeam, ReproducesThePrintedFrequencies) {
  const Case& c = GetParam();
  std::vector<int> channels;
  for (const int i : c.inverted) channels.push_back(i - 1);
  const titop::Inversion inverse = titop::invert_channels(planar_model(), channels);
  const std::vector<double> poles = pole_sizes(inverse.ss);
  ASSERT_EQ(poles.size(), 8u);
  const auto zeros = static_cast<std::size_t>(2 * c.prescribed);
  for (std::size_t i = 0; i < zeros; ++i) EXPECT_LT(poles[i], 1e-3);  // double zeros split by the root of round-off
  EXPECT_NEAR(poles[zeros], c.first, 0.5 * c.digit_first);
  EXPECT_NEAR(poles[zeros + 2], c.second, 0.5 * c.digit_second);
  EXPECT_LT(inverse.condition, 1e4);
}

INSTANTIATE_TEST_SUITE_P(Tables, QuinticBeam,
                         ::testing::Values(Case{"Table1ClampedFree", {}, 0, 3.5160, 22.158, 1e-4, 1e-3},
                                           Case{"Table1FreeClamped", {1, 2, 3, 4}, 0, 3.5160, 22.158, 1e-4, 1e-3},
                                           Case{"Table3FreeFree", {3, 4}, 0, 22.564, 63.537, 1e-3, 1e-3},
                                           Case{"Table4ClampedClamped", {1, 2}, 2, 22.45, 62.929, 1e-2, 1e-3},
                                           Case{"Table5PinnedFree", {4}, 0, 15.445, 51.206, 1e-3, 1e-3},
                                           Case{"Table6PinnedClamped", {1, 2, 4}, 1, 15.433, 50.724, 1e-3, 1e-3},
                                           Case{"Table7PinnedPinned", {1, 4}, 0, 9.8725, 39.646, 1e-4, 1e-3},
                                           Case{"Table8SlidingFree", {3}, 0, 5.5934, 30.734, 1e-4, 1e-3},
                                           Case{"Table9SlidingClamped", {1, 2, 3}, 1, 5.5933, 30.561, 1e-4, 1e-3},
                                           Case{"Table10SlidingPinned", {1, 3}, 0, 2.4674, 22.272, 1e-4, 1e-3},
                                           Case{"Table11SlidingSliding", {2, 3}, 1, 9.8697, 40.988, 1e-4, 1e-3}),
                         [](const auto& info) { return info.param.name; });

// ERRATA, last row: the inverse of the clamped-free model with n modes.
TEST(ClampedFreeBeam, InverseHasTheCorrectedFrequencies) {
  const struct {
    int modes;
    double first, second;
  } rows[] = {{4, 4.38953, 28.0194}, {8, 3.90783, 24.5951}, {16, 3.70260, 23.2275}};
  for (const auto& row : rows) {
    const titop::StateSpace all = titop::port_model(reference::clamped_free_beam("beam", row.modes)).ss;
    const std::vector<int> channels{1, 5, 7, 11};
    const auto inverse = titop::invert_channels(titop::subsystem(all, channels, channels), {0, 1, 2, 3});
    const std::vector<double> poles = pole_sizes(inverse.ss);
    EXPECT_NEAR(poles[0], row.first, 0.5e-5) << row.modes;
    EXPECT_NEAR(poles[2], row.second, 0.5e-4) << row.modes;
  }
}
