#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "tests/analytic/fem/shell_course.hpp"

// No drift with the thickness and the order in h, on a curved shell that bends without membrane strain, where locking
// shows. A ring of radius 1 under two opposite forces P is symmetric: N = ½ P cos φ, Q = ½ P sin φ and M = ½ P
// (cos φ − 2/π) from the section under 90°, so that the diameter grows by (Castigliano, Timoshenko, Strength of
// Materials)
//   P [(π/4 − 2/π)/D + (π/4)(1/(E t) + 1/(κ G t))]
using namespace tenon::fem::testing;

namespace {

constexpr std::array<Grid, 3> grids{Grid::regular, Grid::distorted, Grid::mirrored};

double ring_ratio(const Cover& c, double t) {
  constexpr double pi = std::numbers::pi;
  const double D = t * t * t / 12.0, shear = 5.0 / 6.0 * 0.5 * t;
  return ring(c, t) / ((0.25 * pi - 2.0 / pi) / D + 0.25 * pi * (1.0 / t + 1.0 / shear));
}

/// Width of the largest cell: the divided meshes have 1 + 2 + … + N parts, of which it takes N.
double largest(const Cover& c) { return c.grid == Grid::regular ? 1.0 / c.N : 2.0 / (c.N + 1); }

/// Order in the largest cell of a ratio to the exact value, from c.N to 2 c.N; recorded.
template <typename Ratio>
double order(const std::string& what, const Cover& c, const Ratio& ratio) {
  const Cover fine{c.grid, 2 * c.N, c.cells};
  const double p = std::log(std::abs((ratio(c) - 1.0) / (ratio(fine) - 1.0))) / std::log(largest(c) / largest(fine));
  ::testing::Test::RecordProperty(fmt::format("{}_{}_{}", what, name(c), c.N), fmt::format("{:.2f}", p));
  return p;
}

}  // namespace

// N = 16, from t/R = .1 to 1e-5: triangles, and regular quads, do not drift; skew quads stiffen where elements do not
// resolve √(R t), by 5 % at most. At 1e-6 membrane and bending stiffness differ by 12/t² ~ 1e13, and the numbers of K
// keep two to three digits of bending.
TEST(ShellRates, ThicknessSweepOfARing) {
  for (const Cells cells : {Cells::quads, Cells::diagonal_13, Cells::diagonal_24})
    for (const Grid g : grids) {
      const Cover c{g, 16, cells};
      const double drift = cells != Cells::quads ? 4e-3 : g == Grid::regular ? 3e-3 : 0.05;
      const double thick = ring_ratio(c, 1e-2);
      EXPECT_NEAR(thick, 1.0, cells == Cells::quads ? 5e-3 : 0.012) << name(c);
      for (const double t : {1e-1, 1e-3, 1e-4, 1e-5}) {
        const double ratio = ring_ratio(c, t);
        RecordProperty(fmt::format("{}_t{:.0e}", name(c), t), fmt::format("{:.5f}", ratio));
        EXPECT_NEAR(ratio / thick, 1.0, drift) << name(c) << " " << t;
      }
      EXPECT_NEAR(ring_ratio(c, 1e-6) / thick, 1.0, drift + 0.025) << name(c);
    }
}

// Curved both ways, quads: from t/R = 4e-4 to 4e-6 the deflection times t³ stays what it is but for 1.5 %.
TEST(ShellRates, ThicknessSweepOfAHemisphere) {
  for (const Grid g : grids) {
    const double thin = hemisphere({g}, 0.004) / 0.093, thinnest = hemisphere({g}, 0.00004) / 0.093;
    RecordProperty(name(Cover{g}), fmt::format("{:.5f} {:.5f}", thin, thinnest));
    EXPECT_NEAR(thinnest / thin, 1.0, 0.015) << name(Cover{g});
  }
}

// Second order on any mesh: of quads that resolve √(R t), of triangles thin as well.
TEST(ShellRates, OfTheRing) {
  for (const Cells cells : {Cells::quads, Cells::diagonal_13, Cells::diagonal_24})
    for (const Grid g : grids) {
      const Cover c{g, 16, cells};
      const double t = cells == Cells::quads ? 5e-2 : 1e-4;
      EXPECT_GT(order("ring", c, [t](const Cover& at) { return ring_ratio(at, t); }), 1.8) << name(c);
    }
}

// Thin clamped plate under pressure, .00126532 printed to 4e-6 of it. Skew meshes leave the quad's fourth order for the
// second, which triangles have on all; it shows late where the error changes its sign.
TEST(ShellRates, OfThePlate) {
  const auto ratio = [](const Cover& c) { return clamped_plate(c, 1e-4, PlateLoad::pressure) / 0.00126532; };
  EXPECT_NEAR(order("plate", {Grid::regular, 4}, ratio), 4.0, 0.2);
  for (const Grid g : skewed) EXPECT_GT(order("plate", {g, 32}, ratio), 1.8) << name(Cover{g});
  for (const Cells cells : triangles) {
    EXPECT_NEAR(order("plate", {Grid::regular, 16, cells}, ratio), 2.0, 0.05) << name(Cover{.cells = cells});
    for (const Grid g : skewed) {
      EXPECT_GT(order("plate", {g, 16, cells}, ratio), 1.7) << name(Cover{g, 16, cells});
    }
  }
}
