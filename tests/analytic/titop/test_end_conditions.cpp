// Uniform beams under every pair of ends: the tables of the TITOP paper, closed-form roots, counts of rigid modes and
// of removed states, by channel inversion and by the null space of the constraints.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>
#include <cstring>

#include "tests/analytic/titop/beams.hpp"
#include "tests/reference/beams.hpp"
#include "titop/mode_shapes.hpp"

using namespace tenon;
using namespace tenon::titop;
using reference::in_bending;
using reference::unit_beam;

namespace {

const char letters[] = {'c', 'f', 'p', 's'};

// internal state constraints in the plane, appendix 2 and its missing case
int constraints(char P, char C) {
  if (P == 'f' || C == 'f') return 0;
  if (P == 'c' && C == 'c') return 2;
  return P == 'c' || C == 'c' || (P == 's' && C == 's') ? 1 : 0;
}

class QuinticBeam : public ::testing::TestWithParam<reference::QuinticTable> {};

}  // namespace

TEST_P(QuinticBeam, ReproducesThePrintedFrequenciesByBothRoutes) {
  const reference::QuinticTable& t = GetParam();
  const reduction::ReducedBody beam = unit_beam(BeamModel::polynomial);
  const Boundary boundary = in_bending(beam, t.P, t.C);

  const std::array<int, 4> channels{1, 5, 7, 11};  // of 1 .. 4 among the twelve
  std::vector<int> I;
  for (const int i : t.inverted)
    if (i > 0) I.push_back(channels[static_cast<std::size_t>(i - 1)]);
  EXPECT_EQ(inverted_channels(port_model(beam), boundary), I);

  const InvertedModes inverted = inverted_modes(beam, I);
  const ConstrainedModes modes = constrained_modes(beam, boundary);
  for (const Eigen::VectorXd& omega : {inverted.omega, modes.omega}) {
    ASSERT_EQ(omega.size(), 4 - t.r);
    EXPECT_NEAR(omega[0], t.first, 0.5 * t.digit_first);
    EXPECT_NEAR(omega[1], t.second, 0.5 * t.digit_second);
  }
  EXPECT_LT((inverted.omega - modes.omega).cwiseQuotient(modes.omega).cwiseAbs().maxCoeff(), 1e-11);
  EXPECT_LT(inverted.largest_real, 1e-10 * modes.omega[0]);
  EXPECT_EQ(modes.removed, t.r);
  EXPECT_EQ(modes.rigid.cols(), t.rigid);
}

INSTANTIATE_TEST_SUITE_P(Tables, QuinticBeam, ::testing::ValuesIn(reference::quintic_tables),
                         [](const auto& info) { return info.param.name; });

TEST(ClampedFreeBeam, InverseHasTheCorrectedFrequenciesByBothRoutes) {
  for (const auto& row : reference::clamped_free_inverse) {
    const reduction::ReducedBody beam = unit_beam(BeamModel::clamped_free, row.modes);
    const InvertedModes inverted = inverted_modes(beam, {1, 5, 7, 11});
    const ConstrainedModes modes = constrained_modes(beam, in_bending(beam, 'f', 'c'));
    for (const Eigen::VectorXd& omega : {inverted.omega, modes.omega}) {
      ASSERT_EQ(omega.size(), row.modes);
      EXPECT_NEAR(omega[0], row.first, 0.5e-5) << row.modes;
      EXPECT_NEAR(omega[1], row.second, 0.5e-4) << row.modes;
    }
  }
}

// Rayleigh-Ritz with nested bases: every frequency falls towards the exact one, as 1/n.
TEST(ClampedFreeBeam, InverseConvergesMonotonicallyAsOneOverN) {
  const double exact = std::pow(reference::ends('f', 'c').roots[0], 2);
  double before = 1e300;
  for (const int n : {2, 4, 8, 16, 32, 64, 100}) {
    const reduction::ReducedBody beam = unit_beam(BeamModel::clamped_free, n);
    const ConstrainedModes modes = constrained_modes(beam, in_bending(beam, 'f', 'c'));
    ASSERT_TRUE(modes.omega.allFinite());
    EXPECT_LT(modes.omega[0], before);
    EXPECT_GT(modes.omega[0], exact);
    const double scaled = n * (modes.omega[0] / exact - 1.0);  // tends to 0.82
    if (n >= 8) {
      EXPECT_NEAR(scaled, 0.85, 0.06) << n;
    }
    before = modes.omega[0];
    const double difference = inverted_modes(beam, {1, 5, 7, 11}).omega[0] / modes.omega[0] - 1.0;
    EXPECT_LT(std::abs(difference), 1e-15 * std::pow(n, 5)) << n;  // digits that the inversion loses
  }
}

// Frequencies above the exact ones by at most the error of the quintic Ritz basis, computed outside this project
// (percent).
TEST(QuinticBeam, IsAnUpperBoundUnderAllSixteenPairsOfEnds) {
  const struct {
    const char* ends;
    double first, second;
  } errors[] = {{"cf", .00015, .560}, {"ff", .853, 3.02}, {"cc", .343, 2.04},  {"fp", .174, 2.48},
                {"cp", .097, 1.52},   {"pp", .030, .423}, {"fs", .0014, 1.68}, {"cs", .0001, 1.11},
                {"ps", .0001, .296},  {"ss", .0008, 3.82}};
  const reduction::ReducedBody beam = unit_beam(BeamModel::polynomial);
  for (const char P : letters)
    for (const char C : letters) {
      const ConstrainedModes modes = constrained_modes(beam, in_bending(beam, P, C));
      const reference::EndConditions& exact = reference::ends(P, C);
      EXPECT_EQ(modes.rigid.cols(), exact.rigid) << P << C;
      EXPECT_EQ(modes.removed, constraints(P, C)) << P << C;
      EXPECT_EQ(modes.omega.size(), 4 - constraints(P, C)) << P << C;
      for (const auto& e : errors)
        if (std::strchr(e.ends, P) && std::strchr(e.ends, C) && (P != C || e.ends[0] == e.ends[1])) {
          const double one = 100 * (modes.omega[0] / std::pow(exact.roots[0], 2) - 1.0);
          const double two = 100 * (modes.omega[1] / std::pow(exact.roots[1], 2) - 1.0);
          EXPECT_GE(one, 0.0) << P << C;
          EXPECT_LE(one, 1.01 * e.first + 5e-5) << P << C;  // one digit of the figures
          EXPECT_NEAR(two, e.second, 0.01 * e.second) << P << C;
        }
    }
}

// Poles of both state spaces: exact double integrators, no spurious poles, nothing real.
TEST(Constrain, PolesAreImaginaryAndRigidModesExactUnderAllPairs) {
  const reduction::ReducedBody beam = unit_beam(BeamModel::polynomial);
  double worst = 0.0;
  for (const char P : letters)
    for (const char C : letters) {
      const Boundary boundary = in_bending(beam, P, C);
      const double first = constrained_modes(beam, boundary).omega[0];
      const int rigid = reference::ends(P, C).rigid, order = 8 - 2 * constraints(P, C) + 2 * rigid;
      for (const ConstrainedModel& model : {constrain(beam, boundary), constrain_by_inversion(beam, boundary)}) {
        ASSERT_EQ(model.ss.order(), order) << P << C;
        EXPECT_EQ(model.rigid, rigid);
        EXPECT_EQ(model.removed_states, 2 * constraints(P, C));
        EXPECT_LT(model.condition, 1e4);
        // rigid positions are fed back to nothing
        int zero_columns = 0;
        for (Eigen::Index j = 0; j < order; ++j) zero_columns += model.ss.A.col(j).isZero(0.0);
        EXPECT_EQ(zero_columns, rigid) << P << C;
        const Eigen::VectorXcd poles = Eigen::EigenSolver<Eigen::MatrixXd>(model.ss.A, false).eigenvalues();
        int zeros = 0;
        for (const auto& pole : poles) {
          worst = std::max(worst, std::abs(pole.real()) / first);
          zeros += std::abs(pole) == 0.0;
          if (std::abs(pole) > 0.0) {
            EXPECT_GT(std::abs(pole), 0.99 * first) << P << C;
          }
        }
        EXPECT_EQ(zeros, 2 * rigid) << P << C;
      }
    }
  fmt::print("largest |Re λ| / ω₁: {:.1e}\n", worst);
  EXPECT_LT(worst, 1e-10);
}

// The two routes are one system: positions, accelerations and reactions at several frequencies.
TEST(Constrain, BothRoutesHaveTheSameResponse) {
  reduction::ReducedBody beam = unit_beam(BeamModel::polynomial);
  beam.zeta.setConstant(0.01);
  double worst = 0.0;
  for (const char P : letters)
    for (const char C : letters) {
      const Boundary boundary = in_bending(beam, P, C);
      const StateSpace a = constrain(beam, boundary).ss, b = constrain_by_inversion(beam, boundary).ss;
      ASSERT_EQ(a.outputs.size(), b.outputs.size());
      for (std::size_t i = 0; i < a.outputs.size(); ++i) EXPECT_EQ(a.outputs[i].name, b.outputs[i].name);
      // reactions of the rigid axial direction at P are determined; those of the planes that do not bend too
      for (const double omega : {0.7, 7.0, 70.0}) {
        const Eigen::MatrixXcd x = response(a, omega), y = response(b, omega);
        worst = std::max(worst, (x - y).norm() / x.norm());
      }
    }
  fmt::print("routes differ by {:.1e}\n", worst);
  EXPECT_LT(worst, 1e-9);
}

// The spatial beam: the end conditions act in one plane, the other plane, traction and torsion are held or free as
// said.
TEST(Constrain, CountsOfTheSpatialBeam) {
  const BeamProperties b{
      .length = 2.0, .E = 7e10, .G = 2.7e10, .rho = 2700.0, .A = 1e-3, .Iy = 3e-8, .Iz = 2e-8, .J = 4e-8, .Ip = 5e-8};
  const reduction::ReducedBody beam = beam_body("beam", b);
  ASSERT_EQ(beam.n(), 10);
  for (const BendingPlane plane : {BendingPlane::xy, BendingPlane::xz}) {
    const double EI = b.E * (plane == BendingPlane::xy ? b.Iz : b.Iy);
    const double unit = std::sqrt(EI / (b.rho * b.A)) / (b.length * b.length);
    for (const char P : letters)
      for (const char C : letters) {
        const auto both = boundary(beam, {reference::end(P), reference::end(C)}, Scope::spatial, plane);
        const ConstrainedModes modes = constrained_modes(beam, both);
        const bool held = P != 'f' && C != 'f';
        EXPECT_EQ(modes.rigid.cols(), P == 'f' && C == 'f' ? 6 : reference::ends(P, C).rigid) << P << C;
        EXPECT_EQ(modes.removed, constraints(P, C) + (held ? 4 : 0)) << P << C;
        const auto planar =
            constrained_modes(beam, boundary(beam, {reference::end(P), reference::end(C)}, Scope::bending, plane));
        double nearest = 1e300;  // the first in-plane frequency of Table 1, 3 .. 11 is among the spatial ones
        const double first =
            constrained_modes(unit_beam(BeamModel::polynomial), in_bending(unit_beam(BeamModel::polynomial), P, C))
                .omega[0] *
            unit;
        for (const double omega : modes.omega) nearest = std::min(nearest, std::abs(omega / first - 1.0));
        EXPECT_LT(nearest, 1e-12) << P << C;
        EXPECT_EQ(planar.removed, constraints(P, C)) << P << C;
      }
  }
}

// The closed forms of the tests, written apart from the library, give the same bodies.
TEST(Beam, EqualsTheIndependentClosedForms) {
  const auto same = [](const reduction::ReducedBody& a, const reduction::ReducedBody& b) {
    EXPECT_LT((a.omega - b.omega).cwiseQuotient(a.omega).cwiseAbs().maxCoeff(), 1e-12);
    EXPECT_LT((a.L.cwiseAbs() - b.L.cwiseAbs()).cwiseAbs().maxCoeff(), 1e-11);
    EXPECT_LT((a.ports[1].Phi.cwiseAbs() - b.ports[1].Phi.cwiseAbs()).cwiseAbs().maxCoeff(),
              1e-11 * b.ports[1].Phi.cwiseAbs().maxCoeff());
    EXPECT_LT((a.D - b.D).cwiseAbs().maxCoeff(), 1e-15);
  };
  same(unit_beam(BeamModel::polynomial), reference::polynomial_beam("beam"));
  same(unit_beam(BeamModel::clamped_free, 64), reference::clamped_free_beam("beam", 64));
}
