#include <fmt/format.h>
#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <numbers>

#include "tests/analytic/fem/shell_course.hpp"

// Modes of a thin cylinder between rigid diaphragms, where membrane and bending have equal parts: elements that bend
// too easily by giving up membrane strain come out low, those that lock high. An eighth of it: m odd, n even.
using namespace tenon::fem;
using namespace tenon::fem::testing;

namespace {

constexpr double pi = std::numbers::pi, length = 4.0, nu = 0.3;  // R = E = ρ = 1

/// ω² of the lowest branch with m half waves along and n waves around, u = U cos λx cos nθ, v = V sin λx sin nθ,
/// w = W sin λx cos nθ in Sanders' strains (Leissa, Vibration of Shells, NASA SP-288).
double sanders(double t, int m, int n) {
  const double l = m * pi / length, k = n;
  Eigen::Matrix<double, 6, 3> B;
  B << -l, 0, 0, 0, k, 1, -k, l, 0, 0, 0, l * l, 0, k, k * k, 0.5 * k, 1.5 * l, 2 * l * k;
  Eigen::Matrix3d plane;
  plane << 1, nu, 0, nu, 1, 0, 0, 0, 0.5 * (1 - nu);
  plane /= 1 - nu * nu;
  Eigen::Matrix<double, 6, 6> C = Eigen::Matrix<double, 6, 6>::Zero();
  C.topLeftCorner<3, 3>() = t * plane;
  C.bottomRightCorner<3, 3>() = t * t * t / 12 * plane;
  return Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(Eigen::Matrix3d(B.transpose() * C * B)).eigenvalues()[0] / t;
}

/// Largest relative error of the first four frequencies; recorded.
double error(const Cover& c, double t) {
  std::vector<double> exact;
  for (int m = 1; m < 8; m += 2)
    for (int n = 0; n < 40; n += 2) exact.push_back(sanders(t, m, n));
  std::sort(exact.begin(), exact.end());
  const SmallAssembly a = cover(c, t, elastic(1.0, nu), [](double u, double v) {
    return Vec3(std::sin(0.5 * pi * u), 0.5 * length * v, std::cos(0.5 * pi * u));
  });
  const System s = restrict_to(a, [](const Vec3& x, int d) {
    const auto at = [](double coordinate) { return std::abs(coordinate) < 1e-9; };
    for (int axis = 0; axis < 3; ++axis)  // symmetry
      if (at(x[axis]) && (d < 3 ? d == axis : d - 3 != axis)) return false;
    return !(at(x.y() - 0.5 * length) && (d == 0 || d == 2));
  });
  const Eigen::VectorXd lambda = lowest(s, 4);
  double worst = 0.0;
  for (int k = 0; k < 4; ++k)
    worst = std::max(worst, std::abs(std::sqrt(lambda[k] / exact[static_cast<std::size_t>(k)]) - 1.0));
  ::testing::Test::RecordProperty(fmt::format("{}_{}_t{:.0e}", name(c), c.N, t), fmt::format("{:.1e}", worst));
  return worst;
}

}  // namespace

// Mindlin's shear and rotary inertia are not in the reference: t²n²-small here.
TEST(CylinderModes, OfQuads) {
  EXPECT_LT(error({}, 5e-3), 1e-3);
  EXPECT_LT(error({}, 1e-3), 4e-3);
  EXPECT_LT(error({}, 1e-4), 2e-2);  // six cells a wave
  for (const Grid g : skewed) {
    EXPECT_LT(error({g}, 5e-3), 3e-2);
    EXPECT_LT(error({g, 32}, 5e-3), 1e-2);
    EXPECT_LT(error({g}, 1e-3), 6e-2);
    EXPECT_LT(error({g, 32}, 1e-3), 1.2e-2);
  }
}

TEST(CylinderModes, OfTriangles) {
  for (const Cells cells : triangles) {
    EXPECT_LT(error({Grid::regular, 16, cells}, 1e-3), 7e-3);
    EXPECT_LT(error({Grid::regular, 16, cells}, 1e-4), 2e-2);
    for (const Grid g : skewed) {
      EXPECT_LT(error({g, 16, cells}, 1e-3), 7e-2);
      EXPECT_LT(error({g, 32, cells}, 1e-3), 2e-2);
    }
  }
}
