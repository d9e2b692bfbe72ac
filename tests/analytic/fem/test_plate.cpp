#include <gtest/gtest.h>

#include <Eigen/SparseCholesky>
#include <cmath>
#include <numbers>

#include "tests/unit/fem/elements/small_assembly.hpp"

using namespace tenon::fem;
using namespace tenon::fem::testing;

namespace {

constexpr double pi = std::numbers::pi;
const Material unit{"unit", 1.0, 1.0 / 2.6, 0.3, 1.0};

enum class Cells { quads, distorted_quads, triangles };

/// The unit square in the x-y plane, n×n cells of thickness t; distortion: inner nodes off by up to a quarter cell.
SmallAssembly square_plate(int n, double t, Cells mesh) {
  SmallAssembly a;
  for (int j = 0; j <= n; ++j)
    for (int i = 0; i <= n; ++i) {
      const bool inner = i > 0 && i < n && j > 0 && j < n;
      const double off = mesh == Cells::distorted_quads && inner ? 0.125 / n : 0.0;
      a.nodes.emplace_back(double(i) / n + off * ((7 * i + 13 * j) % 5 - 2),
                           double(j) / n + off * ((11 * i + 3 * j) % 5 - 2), 0.0);
    }
  const ShellSection section{.name = "plate", .thickness = t};
  ElementMatrices e;
  for (int j = 0; j < n; ++j)
    for (int i = 0; i < n; ++i) {
      const int k = j * (n + 1) + i;
      const std::array<int, 4> q{k, k + 1, k + n + 2, k + n + 1};
      if (mesh == Cells::triangles) {
        const bool turn = (i + j) % 2 == 1;
        for (const auto& c : {turn ? std::array<int, 3>{q[0], q[1], q[2]} : std::array<int, 3>{q[0], q[1], q[3]},
                              turn ? std::array<int, 3>{q[0], q[2], q[3]} : std::array<int, 3>{q[1], q[2], q[3]}}) {
          tria3_matrices({.nodes = c}, section, unit, a.nodes, e);
          a.add(c, e);
        }
      } else {
        quad4_matrices({.nodes = q}, section, unit, a.nodes, e);
        a.add(q, e);
      }
    }
  return a;
}

enum class Edges { simply_supported, clamped, free, cantilever };

/// Bending dofs only (a flat plate's membrane is apart). Simple support is hard: no tangential rotation.
System bending(const SmallAssembly& a, Edges edges) {
  return restrict_to(a, [edges](const Vec3& p, int d) {
    if (d < 2 || d > 4) return false;
    const bool x = p.x() < 1e-9 || p.x() > 1 - 1e-9, y = p.y() < 1e-9 || p.y() > 1 - 1e-9;
    switch (edges) {
      case Edges::simply_supported:
        return d == 2 ? !x && !y : d == 3 ? !x : !y;
      case Edges::clamped:
        return !x && !y;
      case Edges::cantilever:
        return p.x() > 1e-9;
      default:
        return true;
    }
  });
}

double flexural_rigidity(double t) { return t * t * t / (12 * 0.91); }

/// ω a² √(ρt/D) of the first modes.
Eigen::VectorXd parameters(Cells mesh, int n, double t, Edges edges, int count) {
  const System s = bending(square_plate(n, t, mesh), edges);
  const double unit2 = flexural_rigidity(t) / t;
  const int rigid = edges == Edges::free ? 3 : 0;
  const Eigen::VectorXd lambda = lowest(s, count + rigid, rigid > 0 ? -50 * unit2 : 0.0);
  for (int k = 0; k < rigid; ++k) EXPECT_LT(std::abs(lambda[k]), 1e-8 * lambda[rigid]);
  return (lambda.tail(count) / unit2).array().sqrt();
}

/// w(½, ½) D / q under a uniform load q = ρt·1, loads consistent with the element's mass.
double centre_deflection(Cells mesh, int n, double t, Edges edges) {
  const SmallAssembly a = square_plate(n, t, mesh);
  const System s = bending(a, edges);
  const System all = restrict_to(a, [](const Vec3&, int) { return true; });
  Eigen::VectorXd up = Eigen::VectorXd::Zero(all.M.rows());
  for (Eigen::Index i = 2; i < up.size(); i += 6) up[i] = 1.0;
  const Eigen::VectorXd full = all.M * up / t;
  Eigen::VectorXd load(s.K.rows());
  for (std::size_t i = 0; i < s.index.size(); ++i)
    if (s.index[i] >= 0) load[s.index[i]] = full[static_cast<Eigen::Index>(i)];
  const Eigen::VectorXd u = Eigen::SimplicialLDLT<Sparse>(s.K).solve(load);
  const std::size_t centre = static_cast<std::size_t>(6 * ((n / 2) * (n + 1) + n / 2) + 2);
  return u[s.index[centre]] * flexural_rigidity(t);
}

}  // namespace

// .00406235 qa⁴/D simply supported, .00126532 clamped (Timoshenko, Woinowsky-Krieger). On a rectangular mesh the quad
// converges with the fourth power of h, distorted and the triangle with the second.
TEST(Plate, CentreDeflectionUnderUniformLoad) {
  for (const auto& [edges, exact] : {std::pair{Edges::simply_supported, 0.00406235}, {Edges::clamped, 0.00126532}}) {
    const auto error = [&](Cells cells, int n) {
      return std::abs(centre_deflection(cells, n, 1e-4, edges) / exact - 1);
    };
    const double e8 = error(Cells::quads, 8), e16 = error(Cells::quads, 16);
    EXPECT_LT(e16, 2e-4);
    EXPECT_GT(std::log2(e8 / e16), 3.4);  // the published constants have six digits
    EXPECT_LT(error(Cells::distorted_quads, 16), 2e-3);
    const double t8 = error(Cells::triangles, 8), t16 = error(Cells::triangles, 16);
    EXPECT_LT(t16, 8e-3);
    EXPECT_NEAR(std::log2(t8 / t16), 2.0, 0.2);
  }
}

// Reissner-Mindlin, t/a = 0.1: .00427284 qa⁴/D.
TEST(Plate, ThickCentreDeflection) {
  for (const Cells cells : {Cells::quads, Cells::distorted_quads, Cells::triangles})
    EXPECT_NEAR(centre_deflection(cells, 16, 0.1, Edges::simply_supported) / 0.00427284, 1.0, 5e-3);
}

// From t/L = 1e-3 on, shear deformation is below 1e-5 of bending: the normalised deflection may not move any more.
TEST(Plate, NoLockingDownToAMillionth) {
  for (const Cells cells : {Cells::quads, Cells::distorted_quads, Cells::triangles}) {
    const double thin = centre_deflection(cells, 8, 1e-3, Edges::clamped);
    EXPECT_NEAR(thin / 0.00126532, 1.0, cells == Cells::triangles ? 3e-2 : 5e-3);
    for (const double t : {1e-4, 1e-5, 1e-6})
      EXPECT_NEAR(centre_deflection(cells, 8, t, Edges::clamped) / thin, 1.0, 5e-5) << t;
    for (const double t : {1e-1, 1e-2})  // shear only adds deflection
      EXPECT_GT(centre_deflection(cells, 8, t, Edges::clamped), thin) << t;
  }
}

// Navier: ω a² √(ρt/D) = π² (i² + j²).
TEST(Plate, SimplySupportedFrequencies) {
  const Vec6 exact = pi * pi * (Vec6() << 2, 5, 5, 8, 10, 10).finished();
  const auto error = [&](Cells cells, int n) {
    return (parameters(cells, n, 1e-4, Edges::simply_supported, 6).cwiseQuotient(exact).array() - 1).abs().maxCoeff();
  };
  const double q8 = error(Cells::quads, 8), q16 = error(Cells::quads, 16);
  EXPECT_LT(q16, 5e-4);
  EXPECT_NEAR(std::log2(q8 / q16), 4.0, 0.2);
  EXPECT_LT(error(Cells::distorted_quads, 16), 3e-3);
  const double t8 = error(Cells::triangles, 8), t16 = error(Cells::triangles, 16);
  EXPECT_LT(t16, 6e-3);
  EXPECT_GT(std::log2(t8 / t16), 1.2);
}

// Leissa's parameters, ν = 0.3, six digits (FV12, FV16 and the clamped plate).
TEST(Plate, FreeCantileverAndClampedFrequencies) {
  const Vec6 free = (Vec6() << 13.4682, 19.5961, 24.2702, 34.8009, 34.8009, 61.0932).finished();
  const Vec6 cantilever = (Vec6() << 3.47107, 8.50671, 21.2850, 27.1989, 30.9563, 54.1872).finished();
  const Vec6 clamped = (Vec6() << 35.9852, 73.3938, 73.3938, 108.2165, 131.581, 132.205).finished();
  for (const Cells cells : {Cells::quads, Cells::distorted_quads, Cells::triangles}) {
    const auto worst = [&](Edges edges, const Vec6& exact) {
      return (parameters(cells, 16, 1e-4, edges, 6).cwiseQuotient(exact).array() - 1).abs().maxCoeff();
    };
    EXPECT_LT(worst(Edges::free, free), 3e-3);
    EXPECT_LT(worst(Edges::cantilever, cantilever), 5e-3);
    EXPECT_LT(worst(Edges::clamped, clamped), cells == Cells::triangles ? 1e-2 : 5e-3);
  }
}

// Test 21, t/a = 0.1 with rotary inertia, against the closed form of Mindlin's plate:
// (D k² + S − ρIω²)(S k² − ρtω²) = S² k², S = κGt, k² = π² (i² + j²).
TEST(Plate, ThickFrequenciesAreMindlins) {
  const double t = 0.1, D = flexural_rigidity(t), S = 5.0 / 6 * unit.G * t, I = t * t * t / 12;
  Vec6 exact;
  const std::array<double, 6> squares{2, 5, 5, 8, 10, 10};
  for (int m = 0; m < 6; ++m) {
    const double k2 = pi * pi * squares[static_cast<std::size_t>(m)];
    const double a = I * t, b = t * (D * k2 + S) + I * S * k2, c = D * S * k2 * k2;
    exact[m] = std::sqrt(2 * c / (b + std::sqrt(b * b - 4 * a * c)) * t / D);
  }
  for (const Cells cells : {Cells::quads, Cells::distorted_quads, Cells::triangles}) {
    const Vec6 ratio = parameters(cells, 16, t, Edges::simply_supported, 6).cwiseQuotient(exact);
    EXPECT_LT((ratio.array() - 1).abs().maxCoeff(), 1e-2);
  }
}
