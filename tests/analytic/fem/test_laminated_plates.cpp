#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <numbers>

#include "fem/elements/laminate.hpp"
#include "tests/unit/fem/elements/small_assembly.hpp"

// Simply supported cross-ply squares against Navier's solution of first-order shear theory (Reddy, Mechanics of
// Laminated Composite Plates and Shells (2004), 7.2): u, φ_x = cos αx sin βy, v, φ_y = sin αx cos βy, w = sin αx sin
// βy.
using namespace tenon::fem;
using namespace tenon::fem::testing;

namespace {

constexpr double pi = std::numbers::pi;

Ply graphite(double thickness, double angle) {
  return {.thickness = thickness,
          .angle = angle,
          .E1 = 25.0,
          .E2 = 1.0,
          .nu12 = 0.25,
          .G12 = 0.5,
          .G13 = 0.5,
          .G23 = 0.2,
          .rho = 1.0};
}

ShellSection cross_ply(double t, bool symmetric) {
  if (symmetric) return {.name = "0/90/0", .plies = {graphite(t / 3, 0), graphite(t / 3, pi / 2), graphite(t / 3, 0)}};
  return {.name = "0/90", .plies = {graphite(t / 2, 0), graphite(t / 2, pi / 2)}};
}

/// Lowest ω² of the wave (m, n) in the unit square.
double navier(const ShellSection& section, int m, int n) {
  const LaminateStiffness l = laminate(section);
  const double a = m * pi, b = n * pi;
  Eigen::Matrix<double, 8, 5> E = Eigen::Matrix<double, 8, 5>::Zero();  // ε, κ, γ of (U V W X Y)
  E(0, 0) = E(3, 3) = -a;
  E(1, 1) = E(4, 4) = -b;
  E(2, 0) = E(5, 3) = b;
  E(2, 1) = E(5, 4) = a;
  E(6, 2) = a;
  E(7, 2) = b;
  E(6, 3) = E(7, 4) = 1.0;
  Eigen::Matrix<double, 8, 8> C = Eigen::Matrix<double, 8, 8>::Zero();
  C.topLeftCorner<3, 3>() = l.A;
  C.block<3, 3>(0, 3) = C.block<3, 3>(3, 0) = l.B;
  C.block<3, 3>(3, 3) = l.D;
  C.bottomRightCorner<2, 2>() = l.shear;
  const Eigen::Matrix<double, 5, 5> K = E.transpose() * C * E;
  const Eigen::Vector<double, 5> M(l.mass, l.mass, l.mass, l.second_moment, l.second_moment);
  const Eigen::Matrix<double, 5, 5> scaled =
      M.cwiseSqrt().cwiseInverse().asDiagonal() * K * M.cwiseSqrt().cwiseInverse().asDiagonal();
  return Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(scaled).eigenvalues()[0];
}

/// Lowest ω² of n×n quads: w, the displacement along an edge and the rotation about its normal held on it.
Eigen::VectorXd finite_elements(const ShellSection& section, int n, int count) {
  SmallAssembly a;
  for (int j = 0; j <= n; ++j)
    for (int i = 0; i <= n; ++i) a.nodes.emplace_back(double(i) / n, double(j) / n, 0.0);
  ElementMatrices e;
  for (int j = 0; j < n; ++j)
    for (int i = 0; i < n; ++i) {
      const int k = j * (n + 1) + i;
      const std::array<int, 4> q{k, k + 1, k + n + 2, k + n + 1};
      quad4_matrices({.nodes = q}, section, {}, a.nodes, e);
      a.add(q, e);
    }
  return lowest(restrict_to(a,
                            [](const Vec3& p, int d) {
                              const bool x = p.x() < 1e-9 || p.x() > 1 - 1e-9, y = p.y() < 1e-9 || p.y() > 1 - 1e-9;
                              if (x && (d == 1 || d == 2 || d == 3)) return false;
                              return !(y && (d == 0 || d == 2 || d == 4));
                            }),
                count);
}

}  // namespace

// Second order; at 16 × 16, 1 % of the frequency. A pair of t/L = 1e-4 is left out: round-off of membrane against
// bending, (L/t)² N⁴ ε, is 1 % there.
TEST(LaminatedPlate, SimplySupportedCrossPlyFrequencies) {
  for (const bool symmetric : {true, false})
    for (const double t : {0.1, 0.01, 1e-3, 1e-4}) {
      if (!symmetric && t < 1e-3) continue;
      const ShellSection section = cross_ply(t, symmetric);
      std::vector<double> exact;
      for (int m = 1; m < 6; ++m)
        for (int n = 1; n < 6; ++n) exact.push_back(navier(section, m, n));
      const LaminateStiffness l = laminate(section);  // waves in the plane alone, m or n = 0
      for (int m = 1; m < 6; ++m) exact.insert(exact.end(), 2, l.A(2, 2) * pi * pi * m * m / l.mass);
      std::sort(exact.begin(), exact.end());
      const auto error = [&](int n) {
        const Eigen::VectorXd lambda = finite_elements(section, n, 3);
        double worst = 0.0;
        for (int k = 0; k < 3; ++k)
          worst = std::max(worst, std::abs(std::sqrt(lambda[k] / exact[static_cast<std::size_t>(k)]) - 1.0));
        return worst;
      };
      const double e8 = error(8), e16 = error(16);
      EXPECT_LT(e16, 1e-2) << symmetric << " t = " << t;
      EXPECT_GT(std::log2(e8 / e16), 1.8) << symmetric << " t = " << t;
    }
}

// Thin, wave (1, 1): B11 = −B22 drives U = −V against A11 − A12, which takes 2 B11²/(A11 − A12) off the bending.
TEST(LaminatedPlate, CouplingSoftensAnAntisymmetricPair) {
  const double t = 1e-3;
  const ShellSection pair = cross_ply(t, false);
  const LaminateStiffness l = laminate(pair);
  const double p4 = std::pow(pi, 4);
  const double uncoupled = p4 * (l.D(0, 0) + 2 * (l.D(0, 1) + 2 * l.D(2, 2)) + l.D(1, 1)) / l.mass;
  const double B = l.B(0, 0), coupled = uncoupled - p4 * 2 * B * B / (l.A(0, 0) - l.A(0, 1)) / l.mass;
  EXPECT_LT(coupled, 0.6 * uncoupled);
  EXPECT_NEAR(std::sqrt(finite_elements(pair, 16, 1)[0] / coupled), 1.0, 5e-3);
}
