// A rigid mass at the tip of a beam, from nothing to 10¹² times the beam.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include "fem/error.hpp"
#include "tests/analytic/titop/beams.hpp"
#include "titop/attach.hpp"
#include "titop/mode_shapes.hpp"

using namespace tenon;
using namespace tenon::titop;
using reference::in_bending;
using reference::unit_beam;

namespace {

reduction::ReducedBody loaded(BeamModel model, int modes, double mass) {
  return attach_mass(unit_beam(model, modes), 1, mass, {1.0, 0.0, 0.0});
}

}  // namespace

// The flexibility that n clamped-free modes leave out at the tip, Σ_{i>n} 4/β⁴ ≈ 4/(3π⁴n³), raises ω_i² by itself times
// the square of the force on the mass, √2 β³ at most as at a pinned end: ω_i by ω_i of it, from above.
TEST(TipMass, OfTheMassOfTheBeam) {
  for (const int n : {16, 32, 64}) {
    const reduction::ReducedBody beam = loaded(BeamModel::clamped_free, n, 1.0);
    const double left_out = 4.0 / (3.0 * std::pow(reference::pi, 4) * std::pow(n, 3));
    for (std::size_t i = 0; i < 5; ++i) {
      const double error = beam.omega[static_cast<Eigen::Index>(i)] / reference::tip_mass_one[i] - 1.0;
      EXPECT_GT(error, -4e-7) << i;  // last digit of the table
      EXPECT_LT(error, 4e-7 + 1.1 * reference::tip_mass_one[i] * left_out) << n << " modes, mode " << i + 1;
      if (n == 64) {
        EXPECT_LT(error, 1e-5);
      }
    }
  }
  const reduction::ReducedBody quintic = loaded(BeamModel::polynomial, 0, 1.0);
  const double first = quintic.omega[0] / reference::tip_mass_one[0] - 1.0;
  const double second = quintic.omega[1] / reference::tip_mass_one[1] - 1.0;
  fmt::print("quintic beam with its own mass at the tip: {:.1e}, {:.1e} too high\n", first, second);
  EXPECT_GT(first, -4e-7);
  EXPECT_LT(first, 1e-6);
  EXPECT_GT(second, 0.0);
  EXPECT_LT(second, 5e-3);
}

TEST(TipMass, OverTwentyFourDecades) {
  for (const double ratio : {1e-12, 1e-8, 1e8, 1e10, 1e12}) {
    const reduction::ReducedBody beam = loaded(BeamModel::clamped_free, 64, ratio);
    const Eigen::VectorXd omega = constrained_modes(beam, in_bending(beam, 'c', 'f')).omega;
    // limits: clamped-free; √(3 EI/(m l³)) with the beam's share 33/140 of ρAl, and clamped-pinned
    const double first = ratio < 1.0 ? 3.516015 : std::sqrt(3.0 / (ratio + 33.0 / 140.0));
    EXPECT_NEAR(omega[0] / first, 1.0, 1e-6) << ratio;
    EXPECT_NEAR(beam.omega[0] / first, 1.0, 1e-6) << ratio;
    if (ratio > 1.0) {
      EXPECT_NEAR(omega[1] / 15.418206, 1.0, 1e-5) << ratio;
    }
  }
}

// A heavy mass at P, the body hung by C: the mirror image of the same mass at C, whose modes attach_mass() finds by
// another decomposition; √(3 EI/(m l³)) with the beam's share 33/140.
TEST(TipMass, HeavyParentEndKeepsItsDigitsWhenHungByTheOther) {
  double worst = 0.0;
  for (double ratio = 1e-4; ratio < 2e12; ratio *= 1e2) {
    const reduction::ReducedBody heavy = attach_mass(unit_beam(BeamModel::polynomial), 0, ratio, {0.0, 0.0, 0.0});
    const reduction::ReducedBody hung = reduction::rebase(heavy, 1), mirror = loaded(BeamModel::polynomial, 0, ratio);
    ASSERT_EQ(hung.n(), mirror.n());
    worst = std::max(worst, (hung.omega.array() / mirror.omega.array() - 1.0).abs().maxCoeff());
    if (ratio > 1e3) {  // the share's own error is of order 1/ratio²
      EXPECT_NEAR(hung.omega[0] / std::sqrt(3.0 / (ratio + 33.0 / 140.0)), 1.0, 1.0 / (ratio * ratio) + 3e-10) << ratio;
    }
    // what a wrench does to P statically: l³/3EI
    const double sag = hung.ports[0].Phi.row(1) * hung.omega.cwiseAbs2().cwiseInverse().asDiagonal() *
                       hung.ports[0].Phi.row(1).transpose();
    EXPECT_NEAR(sag, 1.0 / 3.0, 1e-9) << ratio;
    EXPECT_NO_THROW(reduction::check(hung)) << ratio;
  }
  fmt::print("hung by the other end under 1e-4 .. 1e12 of its mass: frequencies {:.1e} from the mirror image\n", worst);
  EXPECT_LT(worst, 3e-10);  // ε √ratio, 2.2e-10 at 1e12
}

// Seen from a released parent port a heavy load leaves the beam the last digits of the sum: right to 1e-6, or refused.
// Free at P, the load a pin at C: 15.4450956844 is the quintic basis in 50 digits, 0.07/ratio below a finite load.
TEST(TipMass, HeavyLoadIsRightOrRefusedAtAFreeParentPort) {
  for (const double ratio : {1e2, 1e4, 1e5, 1e6, 1e7, 1e8, 1e9, 1e10, 1e11, 1e12, 1e14}) {
    const reduction::ReducedBody beam = loaded(BeamModel::polynomial, 0, ratio);
    for (const bool inverted : {false, true}) {
      bool refused = false;
      try {
        const Boundary free = in_bending(beam, 'f', 'f');
        const double first = inverted ? inverted_modes(beam, inverted_channels(port_model(beam), free)).omega[0]
                                      : constrained_modes(beam, free).omega[0];
        EXPECT_NEAR(first / 15.4450956844, 1.0, 1e-6 + 0.1 / ratio) << ratio << inverted;
      } catch (const NumericalError&) {
        refused = true;
      }
      if (ratio <= 1e6) {
        EXPECT_FALSE(refused) << ratio << inverted;
      } else if (ratio >= 1e9) {
        EXPECT_TRUE(refused) << ratio << inverted;
      }
    }
  }
}

// A mass at the parent port is D only; a mass at C equals the mass matrix solved dense.
TEST(TipMass, IsTheDenseGeneralisedEigenproblem) {
  const BeamProperties b{
      .length = 2.0, .E = 7e10, .G = 2.7e10, .rho = 2700.0, .A = 1e-3, .Iy = 3e-8, .Iz = 2e-8, .J = 4e-8, .Ip = 5e-8};
  const reduction::ReducedBody beam = beam_body("beam", b, {.zeta = 0.01});
  fem::Mat3 J;
  J << 0.3, 0.02, -0.01, 0.02, 0.2, 0.03, -0.01, 0.03, 0.25;
  const fem::Vec3 centre(2.1, 0.2, -0.1);
  const reduction::ReducedBody load = attach_mass(beam, 1, 3.0, centre, J);
  const fem::Mat6 m = fem::rigid_mass(3.0, centre - fem::Vec3(2.0, 0.0, 0.0), J);
  const fem::Mat6 tau = reduction::tau(beam, 1);
  const Eigen::MatrixXd Phi = beam.ports[1].Phi;
  const Eigen::MatrixXd K = beam.omega.cwiseAbs2().asDiagonal();
  const Eigen::MatrixXd M = Eigen::MatrixXd::Identity(10, 10) + Phi.transpose() * m * Phi;
  const Eigen::VectorXd lambda = Eigen::GeneralizedSelfAdjointEigenSolver<Eigen::MatrixXd>(K, M).eigenvalues();
  EXPECT_LT((load.omega - lambda.cwiseSqrt()).cwiseQuotient(load.omega).cwiseAbs().maxCoeff(), 1e-10);
  EXPECT_LT((load.D - beam.D - tau.transpose() * m * tau).norm(), 1e-14 * load.D.norm());
  EXPECT_NO_THROW(reduction::check(load));
  // what does not depend on the choice of modes: L's effective mass LᵀL = Mᵀ_zP M⁻¹ M_zP, ΦΦᵀ = Φ M⁻¹ Φᵀ, Φ L
  const Eigen::MatrixXd M_zP = beam.L + Phi.transpose() * m * tau, W = M.inverse();
  EXPECT_LT((load.L.transpose() * load.L - M_zP.transpose() * W * M_zP).norm(), 1e-11 * load.D.norm());
  const Eigen::MatrixXd mobility = Phi * W * Phi.transpose();
  EXPECT_LT((load.ports[1].Phi * load.ports[1].Phi.transpose() - mobility).norm(), 1e-11 * mobility.norm());
  const Eigen::MatrixXd damping = reduction::damping(load), Phi_C = load.ports[1].Phi;
  const Eigen::MatrixXd dense = Phi * W * reduction::damping(beam) * W * Phi.transpose();
  EXPECT_LT((Phi_C * damping * Phi_C.transpose() - dense).norm(), 1e-10 * dense.norm());

  const reduction::ReducedBody root = attach_mass(beam, 0, 3.0, {0.1, 0.0, 0.0}, J);
  EXPECT_EQ(root.omega, beam.omega);
  EXPECT_EQ(root.L, beam.L);
  EXPECT_LT((root.D - beam.D - fem::rigid_mass(3.0, {0.1, 0.0, 0.0}, J)).norm(), 1e-14 * root.D.norm());
}
