#include <gtest/gtest.h>

#include <Eigen/SparseCholesky>
#include <array>
#include <cmath>
#include <numbers>
#include <string>

#include "tests/unit/fem/elements/small_assembly.hpp"

using namespace tenon::fem;
using namespace tenon::fem::testing;

namespace {

/// A straight beam along `direction` from the origin, n equal elements.
SmallAssembly straight_beam(int n, double L, const BeamSection& section, const Material& material, BeamMass mass,
                            bool rotary, const Vec3& direction = Vec3::UnitX(), const Vec3& v = Vec3::UnitY()) {
  SmallAssembly a;
  for (int i = 0; i <= n; ++i) a.nodes.push_back(direction * (L * i / n));
  Beam b;
  b.orientation = v;
  b.mass = mass;
  b.rotary_inertia = rotary;
  ElementMatrices e;
  for (int i = 0; i < n; ++i) {
    b.nodes = {i, i + 1};
    beam_matrices(b, section, material, a.nodes, e);
    a.add(b.nodes, e);
  }
  return a;
}

const Material unit{"unit", 1.0, 1.0 / 2.6, 0.3, 1.0};
const BeamSection slender{.name = "s", .A = 1.0, .Iy = 1.0, .Iz = 1.0, .J = 1.0};  // no shear: scale is free

/// First three (βL) of a beam without shear and rotary inertia, L = EI = m = 1. End letters: C, F, P, S(liding).
Eigen::Vector3d beta_L(const std::string& ends, int n, BeamMass mass) {
  const SmallAssembly a = straight_beam(n, 1.0, slender, unit, mass, false);
  const System s = restrict_to(a, [&ends](const Vec3& x, int d) {
    if (d != 1 && d != 5) return false;
    const bool end = x.x() < 1e-9 || x.x() > 1 - 1e-9;
    if (!end) return true;
    const char c = ends[x.x() < 0.5 ? 0 : 1];
    return c == 'F' || (c == 'P' && d == 5) || (c == 'S' && d == 1);
  });
  const Eigen::GeneralizedSelfAdjointEigenSolver<Eigen::MatrixXd> modes(Eigen::MatrixXd(s.K), Eigen::MatrixXd(s.M),
                                                                        Eigen::EigenvaluesOnly);
  Eigen::Index first = 0;
  while (modes.eigenvalues()[first] < 0.1) ++first;  // rigid modes: λ = 0, the first flexible one exceeds 5
  return modes.eigenvalues().segment<3>(first).array().sqrt().sqrt();
}

struct Ends {
  std::string letters;
  std::array<double, 3> beta_L;  // roots of the characteristic equations, REFERENCES "Beams"
};

std::vector<Ends> ten_pairs() {
  constexpr double pi = std::numbers::pi;
  const std::array<double, 3> cc{4.730040744863, 7.853204624096, 10.995607838002};
  const std::array<double, 3> cp{3.926602312048, 7.068582745629, 10.210176122813};
  const std::array<double, 3> cs{2.365020372431, 5.497803919001, 8.639379828700};
  const std::array<double, 3> whole{pi, 2 * pi, 3 * pi}, half{0.5 * pi, 1.5 * pi, 2.5 * pi};
  return {{"CF", {1.875104068712, 4.694091132974, 7.854757438238}},
          {"CC", cc},
          {"FF", cc},
          {"CP", cp},
          {"FP", cp},
          {"PP", whole},
          {"SS", whole},
          {"PS", half},
          {"CS", cs},
          {"FS", cs}};
}

}  // namespace

// λ_h = λ (1 + (kh)⁴/720 + O(kh)⁶), for any ends; twice the elements, 2⁴ times less.
TEST(BeamModes, ConsistentMassHasThePredictedError) {
  for (const Ends& ends : ten_pairs())
    for (std::size_t k = 0; k < 3; ++k) {
      const auto error = [&](int n) {
        return std::pow(beta_L(ends.letters, n, BeamMass::consistent)[static_cast<Eigen::Index>(k)] / ends.beta_L[k],
                        4) -
               1;
      };
      const double kh4 = std::pow(ends.beta_L[k] / 16, 4), e16 = error(16), e32 = error(32);
      EXPECT_NEAR(e16, kh4 / 720, 0.05 * kh4 / 720 + 1e-10) << ends.letters << " mode " << k + 1;
      if (kh4 / 720 > 1e-6) {  // the dense eigenvalues' round-off is about 1e-9 at 32 elements
        EXPECT_NEAR(std::log2(e16 / e32), 4.0, 0.1) << ends.letters << " mode " << k + 1;
      }
    }
}

// c K_e removes that error; what stays is of sixth order in βL. (Below 1e-8 the twelve digits of the roots and
// round-off blur the order.)
TEST(BeamModes, HighOrderMassOnAllTenEndConditions) {
  for (const Ends& ends : ten_pairs())
    for (std::size_t k = 0; k < 3; ++k) {
      const auto error = [&](int n) {
        return std::abs(beta_L(ends.letters, n, BeamMass::high_order)[static_cast<Eigen::Index>(k)] / ends.beta_L[k] -
                        1);
      };
      const double e16 = error(16), e8 = error(8);
      EXPECT_LT(e16, 1e-5) << ends.letters << " mode " << k + 1;
      if (e16 > 1e-8) {
        EXPECT_NEAR(std::log2(e8 / e16), 6.0, 0.2) << ends.letters << " mode " << k + 1;
      }
    }
}

namespace {

/// Frequency equation of a clamped-free Timoshenko beam with rotary inertia. Motions e^{αx}: with σ = ρω²/κG and
/// β² = ρω²/E, w'' + σw = θ' and EIθ'' + κGA(w' − θ) + ρIω²θ = 0 give α⁴ + (σ + β²)α² + σβ² − ρAω²/EI = 0 and
/// θ = (α + σ/α) w; determinant of w(0), θ(0), θ'(L), (w' − θ)(L) over cosh ax, sinh ax, cos bx, sin bx.
double cantilever_determinant(double omega, double L, const BeamSection& s, const Material& m) {
  const double w2 = omega * omega, sigma = m.rho * w2 / (s.kappa_y * m.G), beta2 = m.rho * w2 / m.E;
  const double p = 0.5 * (sigma + beta2), root = std::sqrt(p * p - sigma * beta2 + m.rho * s.A * w2 / (m.E * s.Iz));
  const double a = std::sqrt(root - p), b = std::sqrt(root + p), ta = a + sigma / a, tb = b - sigma / b;
  const double C = std::cosh(a * L), S = std::sinh(a * L), c = std::cos(b * L), d = std::sin(b * L);
  Eigen::Matrix4d D;
  D << 1, 0, 1, 0,                                             // w(0)
      0, ta, 0, tb,                                            // θ(0): cos bx → −tb sin bx, sin bx → tb cos bx
      ta * a * C, ta * a * S, -tb * b * c, -tb * b * d,        // θ'(L)
      (a - ta) * S, (a - ta) * C, (tb - b) * d, (b - tb) * c;  // (w' − θ)(L)
  return D.determinant();
}

/// The first `count` roots: bracketed in small steps, then bisected.
std::vector<double> cantilever_frequencies(int count, double L, const BeamSection& s, const Material& m) {
  const double step = 0.05 * 3.516 / (L * L) * std::sqrt(m.E * s.Iz / (m.rho * s.A));
  std::vector<double> roots;
  double lower = 0.2 * step, at_lower = cantilever_determinant(lower, L, s, m);
  while (static_cast<int>(roots.size()) < count) {
    const double upper = lower + step, at_upper = cantilever_determinant(upper, L, s, m);
    if (at_lower * at_upper < 0.0) {
      double x = lower, y = upper;
      for (int k = 0; k < 60; ++k) {
        const double middle = 0.5 * (x + y);
        (cantilever_determinant(middle, L, s, m) * at_lower > 0.0 ? x : y) = middle;
      }
      roots.push_back(0.5 * (x + y));
    }
    lower = upper;
    at_lower = at_upper;
  }
  return roots;
}

/// Square section of side d, κ = 5/6.
BeamSection square_section(double d) {
  const double I = d * d * d * d / 12;
  return {.name = "square",
          .A = d * d,
          .Iy = I,
          .Iz = I,
          .J = 0.1406 * d * d * d * d,
          .kappa_y = 5.0 / 6,
          .kappa_z = 5.0 / 6};
}

}  // namespace

// A stocky cantilever (L/d = 10), three bending modes: the consistent error is λ c/2 in ω with
// c = m h⁴ (1 + 5Φ)/(720 EI), the high-order mass leaves less than a tenth of it.
TEST(BeamModes, TimoshenkoCantilever) {
  const BeamSection s = square_section(0.1);
  const std::vector<double> exact = cantilever_frequencies(3, 1.0, s, unit);
  EXPECT_LT(exact[2], 0.97 * 61.6972 * std::sqrt(s.Iz / s.A));  // well below Euler-Bernoulli: shear matters here
  const auto errors = [&](int n, BeamMass mass) {
    const SmallAssembly a = straight_beam(n, 1.0, s, unit, mass, true);
    const System planar = restrict_to(a, [](const Vec3& x, int d) { return (d == 1 || d == 5) && x.x() > 1e-9; });
    const Eigen::GeneralizedSelfAdjointEigenSolver<Eigen::MatrixXd> modes(
        Eigen::MatrixXd(planar.K), Eigen::MatrixXd(planar.M), Eigen::EigenvaluesOnly);
    Vec3 e;
    for (int k = 0; k < 3; ++k) e[k] = std::sqrt(modes.eigenvalues()[k]) / exact[static_cast<std::size_t>(k)] - 1;
    return e;
  };
  for (const int n : {8, 16, 32}) {
    const Vec3 consistent = errors(n, BeamMass::consistent), high = errors(n, BeamMass::high_order);
    const double h = 1.0 / n, phi = 12 * s.Iz / (s.kappa_y * unit.G * s.A * h * h);
    const double c = s.A * std::pow(h, 4) * (1 + 5 * phi) / (720 * s.Iz);
    for (int k = 0; k < 3; ++k) {
      const double predicted = 0.5 * c * exact[static_cast<std::size_t>(k)] * exact[static_cast<std::size_t>(k)];
      EXPECT_NEAR(consistent[k] / predicted, 1.0, 0.15) << n << " elements, mode " << k + 1;
      EXPECT_LT(std::abs(high[k]), predicted / 10) << n << " elements, mode " << k + 1;
    }
  }
}

// P L³/3EI + P L/κGA, whatever the number of elements, the slenderness and the direction in space.
TEST(BeamStatics, TipDeflectionIsExact) {
  for (const double slenderness : {1e1, 1e2, 1e3, 1e4, 1e5, 1e6})
    for (const bool askew : {false, true}) {
      const BeamSection s = square_section(1.0 / slenderness);
      const Vec3 x = askew ? Vec3(Vec3(1.0, 2.0, -2.0) / 3.0) : Vec3(1.0, 0.0, 0.0);
      const Vec3 y = askew ? Vec3(Vec3(2.0, 1.0, 2.0) / 3.0) : Vec3(0.0, 1.0, 0.0);
      const int n = 4;
      const SmallAssembly a = straight_beam(n, 1.0, s, unit, BeamMass::consistent, true, x, y);
      const System clamped = restrict_to(a, [](const Vec3& p, int) { return p.norm() > 1e-9; });
      Eigen::VectorXd load = Eigen::VectorXd::Zero(clamped.K.rows());
      load.segment<3>(6 * (n - 1)) = y;
      const Eigen::VectorXd u = Eigen::SimplicialLDLT<Sparse>(clamped.K).solve(load);
      const double exact = 1 / (3 * s.Iz) + 1 / (unit.G * s.A * s.kappa_y);
      // askew, the axial stiffness's round-off ε (h/r)² shows in the bending terms
      const double tolerance = 1e-12 + (askew ? 1e-15 * slenderness * slenderness : 0.0);
      EXPECT_NEAR(u.segment<3>(6 * (n - 1)).dot(y) / exact, 1.0, tolerance) << slenderness << (askew ? " askew" : "");
    }
}
