#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>

#include "tests/analytic/fem/shell_course.hpp"

// The obstacle course with quadrilaterals, N = 16. Bounds: what MITC4+ reaches, |1 − ratio| (Ko, Lee, Lee, Bathe,
// Comput. Struct. 192 (2017) 34), and .002 for what their references leave open. `--gtest_output` records the ratios.
using namespace tenon::fem::testing;

namespace {

constexpr double margin = 0.002;

/// Records the ratio and holds it against what MITC4+ reaches.
void expect_as_good_as(double quoted, double ratio, const std::string& what, Grid grid = Grid::regular) {
  const std::string key = what + "_" + name(Cover{grid});
  ::testing::Test::RecordProperty(key, fmt::format("{:.5f}", ratio));
  EXPECT_LE(std::abs(1.0 - ratio), std::abs(1.0 - quoted) + margin) << key << ": " << ratio;
}

}  // namespace

TEST(ShellObstacles, PinchedCylinder) {
  expect_as_good_as(0.9313, pinched_cylinder({}) / 1.8248e-5, "ratio");
  for (const Grid g : skewed) expect_as_good_as(0.9321, pinched_cylinder({g}) / 1.8248e-5, "ratio", g);
}

// The quoted errors, but against the thin shell's limit .30060, to which elements converge, where MITC4+ is quoted with
// parts of .3024: a solution without any error is .9941 of that. The orientation of its skew mesh is not given.
TEST(ShellObstacles, ScordelisLoRoof) {
  expect_as_good_as(0.9973, scordelis_lo({}) / 0.3006, "ratio");
  for (const Grid g : skewed) {
    expect_as_good_as(0.9942, scordelis_lo({g}) / 0.3006, "ratio", g);
    EXPECT_NEAR(scordelis_lo({g, 32}) / 0.3006, 1.0, 2e-3) << name(Cover{g});
  }
}

TEST(ShellObstacles, HemisphereWithHole) {
  expect_as_good_as(1.003, hemisphere({}, 0.04) / 0.093, "thick");
  expect_as_good_as(0.9834, hemisphere({}, 0.004) / 0.093, "thin");
  for (const Grid g : skewed) {
    expect_as_good_as(0.9958, hemisphere({g}, 0.04) / 0.093, "thick", g);
    expect_as_good_as(0.9736, hemisphere({g}, 0.004) / 0.093, "thin", g);
  }
}

// Three patches of 8×8, and of 16×16.
TEST(ShellObstacles, FullHemisphere) {
  for (const int n : {8, 16}) {
    const Cover patch{Grid::regular, n};
    expect_as_good_as(0.9960, full_hemisphere(patch, 0.04) / 0.0924, fmt::format("thick_{}", n));
    expect_as_good_as(0.9798, full_hemisphere(patch, 0.004) / 0.0924, fmt::format("thin_{}", n));
  }
}

TEST(ShellObstacles, TwistedBeam) {
  expect_as_good_as(0.9971, twisted_beam({}, 0.32, 0) / 5.424535e-3, "thick_in_plane");
  expect_as_good_as(0.9973, twisted_beam({}, 0.32, 1) / 1.753248e-3, "thick_out_of_plane");
  expect_as_good_as(0.9978, twisted_beam({}, 0.0032, 0) / 5.256e3, "thin_in_plane");  // the published load is 1e-6
  expect_as_good_as(0.9982, twisted_beam({}, 0.0032, 1) / 1.294e3, "thin_out_of_plane");
}

// Kirchhoff's deflection: shear adds 1.2e-3 of it at t/L = 1e-2.
TEST(ShellObstacles, ClampedPlate) {
  const auto ratio = [](Grid g, double t) { return clamped_plate({g}, t, PlateLoad::pressure) / 0.00126532; };
  expect_as_good_as(0.9984, ratio(Grid::regular, 1e-2), "t1e2");
  expect_as_good_as(0.9980, ratio(Grid::regular, 1e-3), "t1e3");
  expect_as_good_as(0.9979, ratio(Grid::regular, 1e-4), "t1e4");
  for (const Grid g : skewed) {
    expect_as_good_as(1.002, ratio(g, 1e-2), "t1e2", g);
    for (const double t : {1e-3, 1e-4}) expect_as_good_as(1.001, ratio(g, t), t > 5e-4 ? "t1e3" : "t1e4", g);
  }
}

// .0056 P a²/D is printed with two digits: ±9e-3 of it (Timoshenko, Woinowsky-Krieger, Theory of Plates and Shells,
// table 37).
TEST(ShellObstacles, ClampedPlateUnderAPointLoad) {
  for (const Grid g : {Grid::regular, Grid::distorted, Grid::mirrored})
    for (const double t : {1e-3, 1e-4}) EXPECT_NEAR(clamped_plate({g}, t, PlateLoad::force) / 0.0056, 1.0, 9e-3);
}

// Simply supported: .01160 P a²/D, printed to 4e-4 of it; second order.
TEST(ShellObstacles, PlateUnderAPointLoad) {
  EXPECT_NEAR(supported_plate({}, 1e-4) / 0.01160, 1.0, 2e-3);
  for (const Grid g : skewed) EXPECT_NEAR(supported_plate({g}, 1e-4) / 0.01160, 1.0, 6e-3);
}

// The corner at the clamp is singular, so the order is below two.
TEST(ShellObstacles, CooksMembrane) {
  const auto error = [](Grid g, int N) { return std::abs(cooks_membrane({g, N}) / 23.97 - 1.0); };
  for (const Grid g : {Grid::regular, Grid::distorted, Grid::mirrored}) EXPECT_LT(error(g, 16), 5e-3) << name(Cover{g});
  EXPECT_GT(std::log2(error(Grid::regular, 8) / error(Grid::regular, 16)), 1.4);
}
