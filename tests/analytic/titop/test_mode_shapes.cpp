// Mode shapes by eq (22) against closed forms.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <array>

#include "reduction/reduce.hpp"
#include "tests/analytic/titop/beams.hpp"
#include "tests/unit/reduction/beams.hpp"
#include "titop/clamped_free.hpp"
#include "titop/constrain.hpp"
#include "titop/mode_shapes.hpp"

using namespace tenon;
using namespace tenon::titop;
using Eigen::VectorXd;
using reference::in_bending;
using reference::unit_beam;

namespace {

// transverse displacements at the samples, the largest one 1
VectorXd transverse(const reduction::ReducedBody& beam, const Eigen::MatrixXd& reference, const Eigen::MatrixXd& eta,
                    int mode) {
  const Eigen::MatrixXd u = node_motions(beam, reference, eta);
  VectorXd v(u.rows() / 6);
  for (Eigen::Index k = 0; k < v.size(); ++k) v[k] = u(6 * k + 1, mode);
  Eigen::Index largest = 0;
  v.cwiseAbs().maxCoeff(&largest);
  return v / v[largest];
}

// eq (13) as printed, for small β
double printed(double beta, double x) {
  const double ratio = (std::cos(beta) + std::cosh(beta)) / (std::sin(beta) + std::sinh(beta));
  return std::cos(beta * x) - std::cosh(beta * x) - ratio * (std::sin(beta * x) - std::sinh(beta * x));
}

}  // namespace

TEST(ClampedFreeMode, IsThePrintedFormWhereThatDoesNotOverflow) {
  for (int i = 1; i <= 3; ++i) {
    const ClampedFreeMode mode = clamped_free_mode(i);
    EXPECT_NEAR(mode.beta, reference::ends('c', 'f').roots[static_cast<std::size_t>(i - 1)], 1e-12);
    for (const double x : {0.0, 0.1, 0.37, 0.5, 0.93, 1.0})
      EXPECT_NEAR(std::abs(mode.value(x)), std::abs(printed(mode.beta, x)), 1e-11) << i;  // cosh β = 1e3 cancels there
  }
}

// ∫φ² = 1, ∫φ, ∫ξφ by Simpson's rule, error O(h⁴)
TEST(ClampedFreeMode, HasItsClosedIntegralsUpToTheHundredthMode) {
  for (const int i : {1, 2, 3, 10, 37, 64, 100}) {
    const ClampedFreeMode mode = clamped_free_mode(i);
    EXPECT_LT(std::abs(std::cos(mode.beta) + 1.0 / std::cosh(mode.beta)), 1e-13 * (1.0 + i));
    const int panels = 4000 * 2;
    double square = 0.0, mean = 0.0, moment = 0.0;
    for (int k = 0; k <= panels; ++k) {
      const double x = static_cast<double>(k) / panels, w = (k == 0 || k == panels ? 1.0
                                                             : k % 2               ? 4.0
                                                                                   : 2.0) /
                                                            (3.0 * panels);
      const double phi = mode.value(x);
      square += w * phi * phi, mean += w * phi, moment += w * x * phi;
    }
    const double simpson = std::pow(mode.beta / panels, 4) * 0.2 + 1e-13;  // h⁴β⁴/180 of each, generous
    EXPECT_NEAR(square, 1.0, 16 * simpson) << i;
    EXPECT_NEAR(mean, mode.mean(), simpson) << i;
    EXPECT_NEAR(moment, mode.moment(), simpson) << i;
    EXPECT_NEAR(mode.value(1.0), mode.tip(), 1e-12) << i;
    EXPECT_NEAR(mode.slope(1.0), mode.tip_slope(), 1e-11 * mode.beta) << i;
    EXPECT_NEAR(mode.value(0.0), 0.0, 1e-14) << i;
    EXPECT_NEAR(mode.slope(0.0), 0.0, 1e-11 * mode.beta) << i;
  }
}

// Fig. 9: the free-clamped beam against (13) with l − x for x, both one at the free end. The quintic's own errors,
// 4.822e-5 and 1.989e-2, by Ritz' method with (1−x)² P_j(2x−1), j = 0..3, P_j Legendre's polynomials, in 200 Gauss
// points, eigenvectors 1 at the free end, against the exact mode at the 21 nodes (by numpy); 0.5 %: the digits given.
TEST(ModeShapes, OfTheFreeClampedBeamAreTheMirroredClosedForm) {
  const reduction::ReducedBody beam = unit_beam(BeamModel::polynomial);
  const InvertedModes inverted = inverted_modes(beam, {1, 5, 7, 11});
  const ConstrainedModes modes = constrained_modes(beam, in_bending(beam, 'f', 'c'));
  for (int i = 0; i < 2; ++i) {
    const ClampedFreeMode exact = clamped_free_mode(i + 1);
    const VectorXd psi = transverse(beam, inverted.reference, inverted.eta, i);
    const VectorXd other = transverse(beam, modes.reference, modes.eta, i);
    double worst = 0.0;
    for (Eigen::Index k = 0; k < psi.size(); ++k)
      worst = std::max(
          worst,
          std::abs(psi[k] - exact.value(1.0 - beam.node_positions[static_cast<std::size_t>(k)].x()) / exact.tip()));
    fmt::print("free-clamped mode {}: largest error {:.2e} of the tip\n", i + 1, worst);
    EXPECT_NEAR(worst / (i == 0 ? 4.822e-5 : 1.989e-2), 1.0, 5e-3);
    EXPECT_LT((psi - other).cwiseAbs().maxCoeff(), 1e-11);
  }
}

// Fig. 9 with the default basis: a beam of 64 elements, ρA = EI = l = 1, stiff out of the plane, with 2 and 4
// fixed-interface modes beside constraint and inertia-relief shapes: below 1 % of the tip from two modes on. The
// figures of the basis itself by Ritz' method as above, the polynomials and the exact clamped-clamped modes together,
// at the 65 nodes: 1.545e-6 and 2.019e-4, 1.698e-7 and 2.364e-5.
TEST(ModeShapes, OfTheFreeClampedBeamByTheDefaultBasis) {
  constexpr double I = 4e-8;
  tests::BeamData data;
  data.length = 1.0;
  data.elements = 64;
  data.material = {.name = "unit", .E = 1.0 / I, .G = 0.4 / I, .nu = 0.25, .rho = 1.0};
  data.section = {.name = "unit", .A = 1.0, .Iy = 1e6 * I, .Iz = I, .J = 1e6 * I};
  const fem::Structure structure = fem::assemble(tests::beam(data, {{"P", 0}, {"C", data.elements}}));
  for (const auto& [kept, own] :
       {std::pair<int, std::array<double, 2>>{2, {1.545e-6, 2.019e-4}}, {4, {1.698e-7, 2.364e-5}}}) {
    const reduction::ReducedBody beam = reduction::reduce(structure, "P", {.modes = kept});
    Boundary held = boundary(beam, {End::free, End::clamped}, Scope::bending);
    for (const std::size_t d : {0u, 2u, 3u, 4u})
      for (PortCondition& port : held.ports) port.fixed[d] = true;
    const ConstrainedModes modes = constrained_modes(beam, held);
    for (int i = 0; i < 2; ++i) {
      const ClampedFreeMode exact = clamped_free_mode(i + 1);
      const VectorXd psi = transverse(beam, modes.reference, modes.eta, i);
      double worst = 0.0;
      for (Eigen::Index k = 0; k < psi.size(); ++k) {
        const double x = beam.node_positions[static_cast<std::size_t>(k)].x();
        worst = std::max(worst, std::abs(psi[k] - exact.value(1.0 - x) / exact.tip()));
      }
      fmt::print("free-clamped mode {}, inertia relief and {} modes: largest error {:.2e} of the tip\n", i + 1, kept,
                 worst);
      EXPECT_LT(worst, 1e-2) << kept << " modes kept, mode " << i + 1;
      EXPECT_NEAR(worst / own[static_cast<std::size_t>(i)], 1.0, 5e-3) << kept;
    }
  }
}

// sin(πx) of the pinned-pinned beam, whose frequency is .030 % high: √(2·.0003) = 2.4 % in the norm of the energy
// bounds the shape, displacements are well inside. The clamped-free modes themselves come back exactly.
TEST(ModeShapes, OfOtherEnds) {
  const reduction::ReducedBody quintic = unit_beam(BeamModel::polynomial);
  const InvertedModes pinned = inverted_modes(quintic, {1, 11});
  const VectorXd psi = transverse(quintic, pinned.reference, pinned.eta, 0);
  double worst = 0.0;
  for (Eigen::Index k = 0; k < psi.size(); ++k)
    worst = std::max(worst, std::abs(psi[k] - std::sin(reference::pi * static_cast<double>(k) / 20.0)));
  fmt::print("pinned-pinned mode 1: largest error {:.2e}\n", worst);
  EXPECT_LT(worst, 1e-2);

  const reduction::ReducedBody exact = unit_beam(BeamModel::clamped_free, 5);
  const ConstrainedModes clamped = constrained_modes(exact, in_bending(exact, 'c', 'f'));
  for (int i = 0; i < 5; ++i) {
    const VectorXd v = transverse(exact, clamped.reference, clamped.eta, i);
    for (Eigen::Index k = 0; k < v.size(); ++k)
      EXPECT_NEAR(v[k], clamped_free_mode(i + 1).value(0.05 * static_cast<double>(k)) / 2.0, 1e-11);
  }
}
