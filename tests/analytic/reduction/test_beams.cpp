#include <gtest/gtest.h>

#include "reduction/modes.hpp"
#include "reduction/reduce.hpp"
#include "tests/unit/reduction/beams.hpp"

using namespace tenon;
using namespace tenon::reduction;
using namespace tenon::tests;

namespace {

// (βL)² of uniform Euler-Bernoulli beams
constexpr double clamped_free[] = {3.516015268500, 22.034491564668, 61.697214413547};
constexpr double clamped_clamped[] = {22.373285448061, 61.672822868};

// entries of `all` that are bending modes in uy: those with participation or shape there
Eigen::VectorXd in_uy(const ReducedBody& body) {
  std::vector<double> found;
  for (int k = 0; k < body.n(); ++k)
    if (std::abs(body.L(k, 1)) > 1e-6 * std::sqrt(body.D(1, 1))) found.push_back(body.omega[k]);
  return Eigen::Map<Eigen::VectorXd>(found.data(), static_cast<Eigen::Index>(found.size()));
}

}  // namespace

// Effective masses of the clamped-free beam. The consistent mass matrix of 40 elements errs by (βh)⁴/720 < 2e-6 in the
// fourth frequency; the shape's error is of the same order: 1e-5.
TEST(Beams, EffectiveMassesOfTheClampedFreeBeam) {
  BeamData data;
  data.elements = 40;
  const ReducedBody body = reduce(fem::assemble(beam(data, {{"root", 0}, {"tip", 40}})), "root",
                                  {.basis = Basis::clamped_free, .modes = 20});
  const EffectiveMass table = effective_mass(body);
  const double m = data.mass_total(), J = m * data.length * data.length / 3.0;
  const double masses[] = {0.613076, 0.188300, 0.064732, 0.033087}, inertias[] = {0.970688, 0.024716};
  int found = 0;
  for (int k = 0; k < body.n() && found < 4; ++k) {
    const double share = table.per_mode(k, 1) / m;
    if (share < 1e-6) continue;  // bending in uz, torsion, stretching
    EXPECT_NEAR(share, masses[found], 1e-5) << "mode " << found;
    if (found < 2) {
      EXPECT_NEAR(table.per_mode(k, 5) / J, inertias[found], 1e-5);
    }
    ++found;
  }
  EXPECT_EQ(found, 4);
  EXPECT_GT(table.remainder.minCoeff(), 0.0);
  EXPECT_NEAR((table.total + table.remainder)[1], m, 1e-12 * m);
}

// Three ports on one beam. Clamped at P alone, clamped at both ends: from one reduced body, NUMERICS 4a.
TEST(Beams, ThreePortsClampedAndFree) {
  BeamData data;
  data.elements = 32;
  const fem::Structure structure = fem::assemble(beam(data, {{"P", 0}, {"C1", 16}, {"C2", 32}}));
  const ReducedBody body = reduce(structure, "P", {.basis = Basis::craig_bampton, .modes = 16});
  const double unit = data.bending(data.section.Iz);
  // with four fixed-interface modes a bending plane (two a bay) Craig-Bampton is good to 1e-5 in the first
  const Eigen::VectorXd uy = in_uy(body) / unit;
  EXPECT_NEAR(uy[0], clamped_free[0], 1e-5 * clamped_free[0]);
  EXPECT_NEAR(uy[1], clamped_free[1], 1e-3 * clamped_free[1]);
  EXPECT_NEAR(uy[0], 3.51603, 2e-5);
  const Eigen::VectorXd both = frequencies(body, {0, 2}) / unit;
  const auto nearest = [&](double target) { return (both.array() - target).abs().minCoeff(); };
  EXPECT_LT(nearest(clamped_clamped[0]), 1e-3 * clamped_clamped[0]);
  EXPECT_LT(nearest(clamped_clamped[1]), 1e-3 * clamped_clamped[1]);
  // static shapes and one fixed-interface mode a bay and plane reproduce the coarser printed 22.384 and 61.714 or
  // better
  EXPECT_LT(nearest(clamped_clamped[0]), 22.384 - 22.3733);
  EXPECT_LT(nearest(clamped_clamped[1]), 61.714 - 61.6728);
}

// The error of the first clamped frequency falls with the fourth power of the element size.
TEST(Beams, FrequenciesConvergeWithTheFourthPower) {
  double error[2];
  for (int k = 0; k < 2; ++k) {
    BeamData data;
    data.elements = 4 << k;
    const ReducedBody body = reduce(fem::assemble(beam(data, {{"root", 0}})), "root", {.modes = 8});
    error[k] = in_uy(body)[1] / data.bending(data.section.Iz) / clamped_free[1] - 1.0;
  }
  EXPECT_GT(error[1], 0.0);  // Rayleigh-Ritz: from above
  EXPECT_NEAR(std::log2(error[0] / error[1]), 4.0, 0.3);
}

// Six rigid modes of a free beam, then bending at 4.730², 7.853² in both planes.
TEST(Beams, FreeBeamHasSixRigidModes) {
  BeamData data;
  data.elements = 30;
  const Modes modes = solve_modes(fem::assemble(beam(data, {})), {.count = 8});
  EXPECT_EQ(modes.rigid, 6);
  EXPECT_EQ(modes.counted, modes.found);
  EXPECT_EQ(modes.lambda[5], 0.0);
  const double free_free = 22.373285448061;
  EXPECT_NEAR(std::sqrt(modes.lambda[6]), free_free * data.bending(data.section.Iy), 1e-5 * std::sqrt(modes.lambda[6]));
  EXPECT_NEAR(std::sqrt(modes.lambda[7]), free_free * data.bending(data.section.Iz), 1e-5 * std::sqrt(modes.lambda[7]));
}
