#include <gtest/gtest.h>

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
