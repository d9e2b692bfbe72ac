#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>

#include "tests/analytic/fem/shell_course.hpp"

// The obstacle course with triangles, cut by either diagonal, N = 16. Three nodes reach less than four: each bound is
// the element's own error there, stated in full. Without directors the thin hemisphere stays at .12 on regular and .01
// on distorted meshes.
using namespace tenon::fem::testing;

namespace {

void expect_within(double bound, double ratio, const std::string& what, const Cover& c) {
  const std::string key = what + "_" + name(c);
  ::testing::Test::RecordProperty(key, fmt::format("{:.5f}", ratio));
  EXPECT_LE(std::abs(1.0 - ratio), bound) << key << ": " << ratio;
}

}  // namespace

TEST(TriangleObstacles, PinchedCylinder) {
  for (const Cells cells : triangles) {
    expect_within(0.03, pinched_cylinder({.cells = cells}) / 1.8248e-5, "ratio", {.cells = cells});
    for (const Grid g : skewed)
      expect_within(0.06, pinched_cylinder({g, 16, cells}) / 1.8248e-5, "ratio", {g, 16, cells});
  }
}

TEST(TriangleObstacles, ScordelisLoRoof) {
  for (const Cells cells : triangles) {
    expect_within(1e-3, scordelis_lo({.cells = cells}) / 0.3006, "ratio", {.cells = cells});
    for (const Grid g : skewed) {
      expect_within(0.02, scordelis_lo({g, 16, cells}) / 0.3006, "ratio", {g, 16, cells});
    }
  }
}

// Thin and skew 2.3 % stiff.
TEST(TriangleObstacles, HemisphereWithHole) {
  for (const Cells cells : triangles) {
    const Cover regular{.cells = cells};
    expect_within(7e-3, hemisphere(regular, 0.04) / 0.093, "thick", regular);
    expect_within(0.02, hemisphere(regular, 0.004) / 0.093, "thin", regular);
    for (const Grid g : skewed) {
      const Cover c{g, 16, cells};
      expect_within(0.012, hemisphere(c, 0.04) / 0.093, "thick", c);
      expect_within(0.023, hemisphere(c, 0.004) / 0.093, "thin", c);
      if (cells == Cells::diagonal_13) expect_within(0.02, hemisphere({g, 32, cells}, 0.004) / 0.093, "thin_32", c);
    }
  }
}

// Three patches of 8×8, twice the triangles of a quarter with a hole.
TEST(TriangleObstacles, FullHemisphere) {
  for (const Cells cells : triangles) {
    const Cover c{.N = 8, .cells = cells};
    expect_within(8e-3, full_hemisphere(c, 0.04) / 0.0924, "thick", c);
    expect_within(0.025, full_hemisphere(c, 0.004) / 0.0924, "thin", c);
  }
}

TEST(TriangleObstacles, TwistedBeam) {
  for (const Cells cells : triangles) {
    const Cover c{.N = 8, .cells = cells};
    expect_within(3e-3, twisted_beam(c, 0.32, 0) / 5.424535e-3, "thick_in_plane", c);
    expect_within(3e-3, twisted_beam(c, 0.32, 1) / 1.753248e-3, "thick_out_of_plane", c);
    expect_within(3e-3, twisted_beam(c, 0.0032, 0) / 5.256e3, "thin_in_plane", c);
    expect_within(3e-3, twisted_beam(c, 0.0032, 1) / 1.294e3, "thin_out_of_plane", c);
  }
}

TEST(TriangleObstacles, ClampedPlate) {
  for (const Cells cells : triangles)
    for (const Grid g : {Grid::regular, Grid::distorted, Grid::mirrored})
      for (const double t : {1e-3, 1e-4}) {
        const Cover c{g, 16, cells};
        expect_within(g == Grid::regular ? 4e-3 : 1e-2, clamped_plate(c, t, PlateLoad::pressure) / 0.00126532,
                      fmt::format("t{:.0e}", t), c);
      }
}

// Cut into triangles with angles up to 170°, the distorted panel is 14 % stiff.
TEST(TriangleObstacles, CooksMembrane) {
  for (const Cells cells : triangles) {
    expect_within(0.025, cooks_membrane({.cells = cells}) / 23.97, "ratio", {.cells = cells});
    for (const Grid g : skewed) expect_within(0.14, cooks_membrane({g, 16, cells}) / 23.97, "ratio", {g, 16, cells});
  }
}
