#include <fmt/format.h>
#include <gtest/gtest.h>

#include <Eigen/SparseCholesky>
#include <array>
#include <cmath>
#include <functional>
#include <numbers>
#include <string>

#include "tests/unit/fem/elements/small_assembly.hpp"

// The shell obstacle course on regular and on badly distorted meshes, 16×16 quads. Bounds: what MITC4+ reaches, |1 −
// ratio| (Ko, Lee, Lee, Bathe, Comput. Struct. 192 (2017) 34), and .002 for what their references leave open. The
// distorted mesh has edges divided 1 : 2 : … : N, opposite edges from opposite ends, its nodes where the lines that
// join them cross. It has two corners of small and two of large cells: both ways round are tested. `--gtest_output`
// records the ratios.
using namespace tenon::fem;
using namespace tenon::fem::testing;

namespace {

constexpr double pi = std::numbers::pi;
constexpr double margin = 0.002;

enum class Grid { regular, distorted, mirrored };
constexpr std::array<Grid, 2> skewed{Grid::distorted, Grid::mirrored};

using Surface = std::function<Vec3(double, double)>;
using Free = std::function<bool(const Vec3&, int)>;

/// Where node (i, j) of a grid lies in the unit square.
Eigen::Vector2d grid_point(Grid grid, int N, int i, int j) {
  if (grid == Grid::regular) return {double(i) / N, double(j) / N};
  if (grid == Grid::mirrored) {
    const Eigen::Vector2d p = grid_point(Grid::distorted, N, N - i, j);
    return {1.0 - p.x(), p.y()};
  }
  const auto divide = [N](int k) { return double(k * (k + 1)) / (N * (N + 1)); };
  const double bottom = divide(i), top = 1.0 - divide(N - i), left = divide(j), right = 1.0 - divide(N - j);
  const double u = (bottom + (top - bottom) * left) / (1.0 - (top - bottom) * (right - left));
  return {u, left + (right - left) * u};
}

SmallAssembly quads(Grid grid, int N, double t, const Material& material, const Surface& at) {
  SmallAssembly a;
  for (int j = 0; j <= N; ++j)
    for (int i = 0; i <= N; ++i) {
      const Eigen::Vector2d p = grid_point(grid, N, i, j);
      a.nodes.push_back(at(p.x(), p.y()));
    }
  const ShellSection section{.name = "s", .thickness = t};
  ElementMatrices e;
  for (int j = 0; j < N; ++j)
    for (int i = 0; i < N; ++i) {
      const int k = j * (N + 1) + i;
      const std::array<int, 4> q{k, k + 1, k + N + 2, k + N + 1};
      quad4_matrices({.nodes = q}, section, material, a.nodes, e);
      a.add(q, e);
    }
  return a;
}

Material elastic(double E, double nu) { return {"m", E, E / (2 * (1 + nu)), nu, 1.0}; }

Eigen::VectorXd no_load(const SmallAssembly& a) {
  return Eigen::VectorXd::Zero(6 * static_cast<Eigen::Index>(a.nodes.size()));
}

/// Loads of a unit force per area along `direction`, consistent with the mass of density 1.
Eigen::VectorXd pressure(const SmallAssembly& a, double t, int direction) {
  Eigen::VectorXd along = no_load(a);
  for (Eigen::Index i = direction; i < along.size(); i += 6) along[i] = 1.0;
  Sparse M(along.size(), along.size());
  M.setFromTriplets(a.M.begin(), a.M.end());
  return M * along / t;
}

/// All displacements under `load` with the dofs for which `free` holds.
Eigen::VectorXd displacements(const SmallAssembly& a, const Free& free, const Eigen::VectorXd& load) {
  const System s = restrict_to(a, free);
  Eigen::VectorXd f(s.K.rows()), all = Eigen::VectorXd::Zero(load.size());
  for (std::size_t i = 0; i < s.index.size(); ++i)
    if (s.index[i] >= 0) f[s.index[i]] = load[static_cast<Eigen::Index>(i)];
  const Eigen::VectorXd u = Eigen::SimplicialLDLT<Sparse>(s.K).solve(f);
  for (std::size_t i = 0; i < s.index.size(); ++i)
    if (s.index[i] >= 0) all[static_cast<Eigen::Index>(i)] = u[s.index[i]];
  return all;
}

bool zero(double x) { return std::abs(x) < 1e-9; }

/// The plane normal to `axis` through the origin is one of symmetry: u along it and both rotations in it are held.
bool held_by_symmetry(const Vec3& x, int d, int axis) { return zero(x[axis]) && (d < 3 ? d == axis : d - 3 != axis); }

/// R = 300, L = 600, t = 3, E = 3e6, ν = .3, rigid diaphragms, pinched by a pair of unit forces: an eighth of it.
/// Deflection under the force [1.8248e-5].
double pinched_cylinder(Grid grid, int N = 16) {
  const SmallAssembly a = quads(grid, N, 3.0, elastic(3e6, 0.3), [](double u, double v) {
    return Vec3(300 * std::sin(0.5 * pi * u), 300 * v, 300 * std::cos(0.5 * pi * u));
  });
  Eigen::VectorXd load = no_load(a);
  load[2] = -0.25;
  return -displacements(
      a,
      [](const Vec3& x, int d) {
        for (int axis = 0; axis < 3; ++axis)
          if (held_by_symmetry(x, d, axis)) return false;
        return !(zero(x.y() - 300) && (d == 0 || d == 2));
      },
      load)[2];
}

/// R = 25, L = 50, 80°, t = .25, E = 4.32e8, ν = 0, weight 90 per area, diaphragms: a quarter. Free edge [.3024].
double scordelis_lo(Grid grid, int N = 16) {
  const double t = 0.25;
  const SmallAssembly a = quads(grid, N, t, elastic(4.32e8, 0.0), [](double u, double v) {
    const double angle = 40.0 / 180.0 * pi * u;
    return Vec3(25 * std::sin(angle), 25 * v, 25 * std::cos(angle));
  });
  return -displacements(
      a,
      [](const Vec3& x, int d) {
        return !held_by_symmetry(x, d, 0) && !held_by_symmetry(x, d, 1) && !(zero(x.y() - 25) && (d == 0 || d == 2));
      },
      -90.0 * pressure(a, t, 2))[6 * N + 2];
}

/// R = 10, 18° hole, E = 6.825e7, ν = .3, unit forces in pairs: a quarter. Radial deflection times (t/.04)³ [.093].
double hemisphere(Grid grid, double t, int N = 16) {
  const SmallAssembly a = quads(grid, N, t, elastic(6.825e7, 0.3), [](double u, double v) {
    const double around = 0.5 * pi * u, up = 0.4 * pi * v;
    return Vec3(10 * std::cos(up) * std::cos(around), 10 * std::cos(up) * std::sin(around), 10 * std::sin(up));
  });
  Eigen::VectorXd load = no_load(a);
  load[0] = 1.0;
  load[6 * N + 1] = -1.0;
  return std::pow(t / 0.04, 3) * displacements(
                                     a,
                                     [](const Vec3& x, int d) {
                                       return !held_by_symmetry(x, d, 0) && !held_by_symmetry(x, d, 1) &&
                                              !(d == 2 && zero(x.y()) && zero(x.z()));  // u_z at one node
                                     },
                                     load)[0];
}

/// Clamped unit square under a unit pressure, a quarter: centre deflection times D [.00126532].
double clamped_plate(Grid grid, double t, int N = 16) {
  const SmallAssembly a =
      quads(grid, N, t, elastic(1.0, 0.3), [](double u, double v) { return Vec3(0.5 * u, 0.5 * v, 0.0); });
  return t * t * t / (12 * 0.91) *
         displacements(
             a,
             [](const Vec3& x, int d) {
               return d > 1 && d < 5 && !zero(x.x() - 0.5) && !zero(x.y() - 0.5) && !held_by_symmetry(x, d, 0) &&
                      !held_by_symmetry(x, d, 1);
             },
             pressure(a, t, 2))[2];
}

/// Records the ratio and holds it against what MITC4+ reaches.
void expect_as_good_as(double quoted, double ratio, const char* what, Grid grid) {
  const char* const names[] = {"regular", "distorted", "mirrored"};
  const std::string key = fmt::format("{}_{}", what, names[static_cast<int>(grid)]);
  ::testing::Test::RecordProperty(key, fmt::format("{:.5f}", ratio));
  EXPECT_LE(std::abs(1.0 - ratio), std::abs(1.0 - quoted) + margin) << key << ": " << ratio;
}

}  // namespace

TEST(ShellObstacles, PinchedCylinder) {
  expect_as_good_as(0.9313, pinched_cylinder(Grid::regular) / 1.8248e-5, "ratio", Grid::regular);
  for (const Grid g : skewed) expect_as_good_as(0.9321, pinched_cylinder(g) / 1.8248e-5, "ratio", g);
}

// Against the thin shell's limit .30060, to which the element converges; MITC4+ at .9973 of .3024 is .33 % above it.
// Skew, this mesh is 1.4 to 1.7 % off at N = 16, where MITC4+ is quoted with .6 % of .3024 on a mesh whose orientation
// is not given: what holds is the second order.
TEST(ShellObstacles, ScordelisLoRoof) {
  expect_as_good_as(0.9973 * 0.3024 / 0.3006, scordelis_lo(Grid::regular) / 0.3006, "ratio", Grid::regular);
  for (const Grid g : skewed) {
    const auto error = [g](int n) { return std::abs(scordelis_lo(g, n) / 0.3006 - 1.0); };
    const double e8 = error(8), e16 = error(16), e32 = error(32);
    ::testing::Test::RecordProperty(g == Grid::distorted ? "e16_distorted" : "e16_mirrored",
                                    fmt::format("{:.5f}", e16));
    EXPECT_LT(e32, 5e-3);
    EXPECT_GT(std::log2(e8 / e16), 1.6);
    EXPECT_GT(std::log2(e16 / e32), 1.6);
  }
}

TEST(ShellObstacles, HemisphereWithHole) {
  expect_as_good_as(1.003, hemisphere(Grid::regular, 0.04) / 0.093, "thick", Grid::regular);
  expect_as_good_as(0.9834, hemisphere(Grid::regular, 0.004) / 0.093, "thin", Grid::regular);
  for (const Grid g : skewed) {
    expect_as_good_as(0.9958, hemisphere(g, 0.04) / 0.093, "thick", g);
    expect_as_good_as(0.9736, hemisphere(g, 0.004) / 0.093, "thin", g);
  }
}

// Kirchhoff's deflection: shear adds 1.2e-3 of it at t/L = 1e-2.
TEST(ShellObstacles, ClampedPlate) {
  expect_as_good_as(0.9984, clamped_plate(Grid::regular, 1e-2) / 0.00126532, "t1e2", Grid::regular);
  for (const Grid g : skewed) expect_as_good_as(1.002, clamped_plate(g, 1e-2) / 0.00126532, "t1e2", g);
  expect_as_good_as(0.9980, clamped_plate(Grid::regular, 1e-3) / 0.00126532, "t1e3", Grid::regular);
  expect_as_good_as(0.9979, clamped_plate(Grid::regular, 1e-4) / 0.00126532, "t1e4", Grid::regular);
  for (const Grid g : skewed)
    for (const double t : {1e-3, 1e-4})
      expect_as_good_as(1.001, clamped_plate(g, t) / 0.00126532, t > 5e-4 ? "t1e3" : "t1e4", g);
}

// Simply supported, a unit force at the centre of a quarter: .01160 P a²/D, printed to 4e-4 of it; second order.
TEST(ShellObstacles, PlateUnderAPointLoad) {
  const double t = 1e-4;
  const auto ratio = [t](Grid grid, int N) {
    const SmallAssembly a =
        quads(grid, N, t, elastic(1.0, 0.3), [](double u, double v) { return Vec3(0.5 * u, 0.5 * v, 0.0); });
    Eigen::VectorXd load = no_load(a);
    load[2] = 0.25;
    const double w = displacements(
        a,
        [](const Vec3& x, int d) {
          if (d < 2 || d > 4 || held_by_symmetry(x, d, 0) || held_by_symmetry(x, d, 1)) return false;
          const bool edge_x = zero(x.x() - 0.5), edge_y = zero(x.y() - 0.5);
          return d == 2 ? !edge_x && !edge_y : d == 3 ? !edge_x : !edge_y;
        },
        load)[2];
    return w * t * t * t / (12 * 0.91) / 0.01160;
  };
  EXPECT_NEAR(ratio(Grid::regular, 16), 1.0, 2e-3);
  for (const Grid g : skewed) EXPECT_NEAR(ratio(g, 16), 1.0, 6e-3);
}

// Cook's panel, E = 1, ν = 1/3, a unit shear force on the free side: deflection of its middle [23.97]. The corner at
// the clamp is singular, so the order is below two.
TEST(ShellObstacles, CooksMembrane) {
  const auto error = [](int N) {
    const SmallAssembly a = quads(Grid::regular, N, 1.0, elastic(1.0, 1.0 / 3.0),
                                  [](double u, double v) { return Vec3(48 * u, 44 * u + v * (44 - 28 * u), 0.0); });
    Eigen::VectorXd load = no_load(a);
    for (int j = 0; j <= N; ++j) load[6 * (j * (N + 1) + N) + 1] = (j == 0 || j == N ? 0.5 : 1.0) / N;
    const Eigen::VectorXd u = displacements(
        a, [](const Vec3& x, int d) { return (d < 2 || d == 5) && !zero(x.x()); }, load);
    return std::abs(u[6 * (N / 2 * (N + 1) + N) + 1] / 23.97 - 1.0);
  };
  const double e8 = error(8), e16 = error(16);
  EXPECT_LT(e16, 5e-3);
  EXPECT_GT(std::log2(e8 / e16), 1.4);
}
