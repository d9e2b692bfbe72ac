#include <fmt/format.h>

#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>
#include <cmath>
#include <numbers>

#include "fem/structure.hpp"
#include "tests/unit/fem/formats/nastran/deck_file.hpp"

using namespace tenon;
using namespace tenon::fem;
using ::testing::HasSubstr;

namespace {

/// ω² of a deck, rising.
Eigen::VectorXd eigenvalues(const Structure& s) {
  const Eigen::MatrixXd K = Eigen::MatrixXd(s.K).selfadjointView<Eigen::Lower>(),
                        M = Eigen::MatrixXd(s.M).selfadjointView<Eigen::Lower>();
  return Eigen::GeneralizedSelfAdjointEigenSolver<Eigen::MatrixXd>(K, M, Eigen::EigenvaluesOnly).eigenvalues();
}

Eigen::VectorXd eigenvalues(const std::string& deck) { return eigenvalues(assemble(read_deck(deck).model)); }

/// n rods along a line of length 2 in a direction that is no axis, held at one end; they move along the line alone.
std::string axial_rods(int n, const std::string& rest) {
  const Vec3 x = Vec3(2.0, -1.0, 2.0) / 3.0;
  std::string deck = "MAT1,1,2.1+11,,.3,7800.\nPROD,1,1,1.-4\nCORD2R,7,0,0.,0.,0.,1.,2.,0.,\n,2.,-1.,2.\n" + rest;
  for (int i = 0; i <= n; ++i) {
    const Vec3 p = x * (2.0 * i / n);
    // system 7: its x axis lies along the line
    deck += fmt::format("GRID,{},,{:.15g},{:.15g},{:.15g},7,{}\n", i + 1, p.x(), p.y(), p.z(), i == 0 ? 123456 : 23456);
  }
  for (int i = 0; i < n; ++i) deck += fmt::format("CROD,{},1,{},{}\n", i + 1, i + 1, i + 2);
  return deck;
}

constexpr double c2 = 2.1e11 / 7800.0;  // E/ρ

}  // namespace

// [−1 2 −1] (EA/h) against the masses ρAh on a line: ω² = c²/h² (2 − 2 cos θ), θ = (2k − 1) π/2N of the fixed-free bar
TEST(NastranLines, LumpedAxialFrequenciesOfTheDifferenceEquation) {
  const int n = 8;
  const std::string deck = axial_rods(n, "");
  const Eigen::VectorXd lambda = eigenvalues(deck);
  ASSERT_EQ(lambda.size(), n);
  const double h = 2.0 / n;
  for (int k = 0; k < n; ++k) {
    const double theta = (2 * k + 1) * std::numbers::pi / (2 * n);
    EXPECT_NEAR(lambda[k] / (c2 / (h * h) * (2.0 - 2.0 * std::cos(theta))), 1.0, 1e-10) << k;
  }
}

// the same with masses [5 1; 1 5]/12: (2 − 2 cos θ) / ((5 + cos θ)/6)
TEST(NastranLines, CoupledAxialFrequencies) {
  const int n = 8;
  const std::string deck = axial_rods(n, "PARAM,COUPMASS,1\n");
  const Eigen::VectorXd lambda = eigenvalues(deck);
  ASSERT_EQ(lambda.size(), n);
  const double h = 2.0 / n;
  for (int k = 0; k < n; ++k) {
    const double theta = (2 * k + 1) * std::numbers::pi / (2 * n);
    EXPECT_NEAR(lambda[k] / (c2 / (h * h) * (2.0 - 2.0 * std::cos(theta)) * 6.0 / (5.0 + std::cos(theta))), 1.0, 1e-10)
        << k;
  }
}

// two masses m, M on a spring between different directions of two grids: λ = 0 and k (1/m + 1/M)
TEST(NastranLines, BetweenTwoDirections) {
  const std::string deck =
      "CORD2R,7,0,0.,0.,0.,0.,0.,1.,\n,.6,.8,0.\nGRID,1,,1.,2.,3.,7,13456\nGRID,2,,0.,0.,0.,,12456\n"
      "CONM2,8,1,,4.\nCONM2,9,2,,1.\nCELAS2,5,100.,1,2,2,3\n";
  const Eigen::VectorXd lambda = eigenvalues(deck);
  ASSERT_EQ(lambda.size(), 2);
  EXPECT_NEAR(lambda[0], 0.0, 1e-12);
  EXPECT_NEAR(lambda[1], 125.0, 1e-11);
}

// Statics of a bush: k times the relative displacement at its point, carried to the nodes by the arms, f and a × f.
TEST(NastranLines, ABushActsAtItsPoint) {
  const auto model = read_deck(
                         "PBUSH,3,K,10.,20.,30.,40.,50.,60.\nGRID,1,,1.,2.,3.\nGRID,2,,3.,3.,5.\n"
                         "CBUSH,5,3,1,2,0.,1.,0.\n,.25\n")
                         .model;
  const Bush bush = elements_of<Bush>(model).at(0);
  const Vec3 a(1, 2, 3), b(3, 3, 5), p = a + 0.25 * (b - a);
  const Structure s = assemble(model);
  const Eigen::MatrixXd K = Eigen::MatrixXd(s.K).selfadjointView<Eigen::Lower>();
  ASSERT_EQ(K.rows(), 12);
  EXPECT_LT((K * rigid_motions(s, Vec3(0.3, -2.0, 1.0))).norm(), 1e-12 * K.norm());
  EXPECT_NEAR((bush.axes.col(0) - (b - a).normalized()).norm(), 0.0, 1e-15);
  Eigen::VectorXd q = Eigen::VectorXd::LinSpaced(12, -1.0, 2.0).array().sin();
  const Vec3 at_a = q.segment<3>(0) + Vec3(q.segment<3>(3)).cross(p - a),
             at_b = q.segment<3>(6) + Vec3(q.segment<3>(9)).cross(p - b);
  const Vec3 f = bush.axes * Vec3(10, 20, 30).asDiagonal() * bush.axes.transpose() * (at_b - at_a);
  const Vec3 t =
      bush.axes * Vec3(40, 50, 60).asDiagonal() * bush.axes.transpose() * (q.segment<3>(9) - q.segment<3>(3));
  Eigen::VectorXd forces(12);
  forces << -f, -t - (p - a).cross(f), f, t + (p - b).cross(f);
  EXPECT_LT((K * q - forces).norm(), 1e-12 * forces.norm());
}
