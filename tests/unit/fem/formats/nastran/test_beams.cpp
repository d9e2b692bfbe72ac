#include <fmt/format.h>

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <cmath>
#include <numbers>

#include "fem/section_shapes.hpp"
#include "fem/structure.hpp"
#include "tests/unit/fem/formats/nastran/deck_file.hpp"

using namespace tenon;
using namespace tenon::fem;
using ::testing::HasSubstr;

namespace {

const std::string steel_deck = "MAT1,1,2.+11,,.3,7800.\n";
constexpr double steel_E = 2e11, steel_G = 2e11 / 2.6, steel_rho = 7800.0;

Eigen::MatrixXd both_triangles(const SparseMatrix& lower) {
  return Eigen::MatrixXd(lower).selfadjointView<Eigen::Lower>();
}

/// One beam along x from a held grid to grid 2, with the cards of its property.
std::string cantilever(const std::string& property, const std::string& element) {
  return steel_deck + "GRID,1,,0.,0.,0.,,123456\nGRID,2,,2.\n" + property + element;
}

/// Displacement of grid 2 under a unit load on one of its directions.
Eigen::VectorXd tip_under(const std::string& deck, int direction) {
  const Structure s = assemble(read_deck(deck).model);
  return both_triangles(s.K).llt().solve(Eigen::VectorXd(Eigen::VectorXd::Unit(s.n(), direction)));
}

/// The section as read, before its mass is lumped.
BeamSection first_section(const NastranDeck& deck) { return deck.model.beam_sections.at(0); }

}  // namespace

// A beam without offsets is the bar of the same constants.
TEST(NastranBeams, WithoutOffsetsAreBars) {
  const auto matrices = [](const std::string& deck) {
    const Structure s = assemble(read_deck("PARAM,COUPMASS,1\n" + deck).model);
    return std::pair(both_triangles(s.K), both_triangles(s.M));
  };
  const auto [K, M] = matrices(cantilever("PBAR,5,1,4.-4,1.-8,2.-8,3.-8,1.5\n,\n,.8,.9\n", "CBAR,1,5,1,2,0.,1.,.2\n"));
  const auto [K_b, M_b] = matrices(
      cantilever("PBEAM,5,1,4.-4,1.-8,2.-8,,3.-8,1.5\n,.1,.1\n,YES,1.\n,.1,.1\n,.8,.9\n", "CBEAM,1,5,1,2,0.,1.,.2\n"));
  EXPECT_LT((K_b - K).norm(), 1e-12 * K.norm());
  EXPECT_LT((M_b - M).norm(), 1e-12 * M.norm());
}

// K1 and K2 are 1 where they are blank; 0 means rigid in shear
TEST(NastranBeams, ShearCoefficientsOfPbeam) {
  const auto kappa = [](const std::string& rest) {
    return first_section(read_deck(cantilever("PBEAM,5,1,4.,1.,2.\n" + rest, "CBEAM,1,5,1,2,0.,1.,0.\n"))).kappa_y;
  };
  EXPECT_EQ(kappa(""), 1.0);
  EXPECT_EQ(kappa(",,,,,,,,\n,NO,1.\n,0.\n"), 0.0);
  EXPECT_EQ(kappa(",,,,,,,,\n,.7\n"), 0.7);
  EXPECT_EQ(kappa(",YESA,1.\n,.6\n"), 0.6);
}

// Grids lie at the shear centre: a force across acts without twist, a force along it bends the neutral axis beside it.
TEST(NastranBeams, GridsLieAtTheShearCentre) {
  const double A = 4e-4, I1 = 1e-8, I2 = 2e-8, N1 = 0.03, N2 = -0.02, L = 2.0;
  const std::string deck =
      cantilever("PBEAM,5,1,4.-4,1.-8,2.-8,,3.-8\n,\n,0.,0.\n,,,,,.03,-.02,.03,-.02\n", "CBEAM,1,5,1,2,0.,1.,0.\n");
  const Eigen::VectorXd across = tip_under(deck, 1);
  EXPECT_NEAR(across[1] / (L * L * L / (3.0 * steel_E * I1)), 1.0, 1e-10);
  EXPECT_NEAR(across[3], 0.0, 1e-12 * across[1]);
  const Eigen::VectorXd axial = tip_under(deck, 0);  // the neutral axis at N: moments −N1 about z, N2 about −y
  EXPECT_NEAR(axial[0] / (L / (steel_E * A) + N1 * N1 * L / (steel_E * I1) + N2 * N2 * L / (steel_E * I2)), 1.0, 1e-10);
  EXPECT_NEAR(axial[5] / (N1 * L / (steel_E * I1)), 1.0, 1e-10);
  EXPECT_NEAR(axial[4] / (-N2 * L / (steel_E * I2)), 1.0, 1e-10);
}

// A channel by its sizes: DIM1 = flange, open towards +z, the centroid at N2 = z_c + e from the shear centre (middle
// lines, thin wall: O(t/b)); y stands along the web.
TEST(NastranBeams, ChannelsTwistAboutTheirShearCentre) {
  const double b = 0.05, h = 0.1, t = 1e-4, e = 3.0 * b * b / (6.0 * b + h), centroid = b * b / (2.0 * b + h);
  const std::string beam = cantilever(fmt::format("PBEAML,5,1,,CHAN\n,{:.6f},{:.6f},{},{}\n", b + 0.5 * t, h + t, t, t),
                                      "CBEAM,1,5,1,2,0.,1.,0.\n");
  const NastranDeck deck = read_deck(beam);
  const BeamSection s = first_section(deck);
  EXPECT_NEAR(s.shear_z, -(e + centroid), 1e-3 * e);
  EXPECT_EQ(s.shear_y, 0.0);
  EXPECT_NEAR(s.Iz, t * h * h * h / 12.0 + 2.0 * b * t * h * h / 4.0, 1e-2 * s.Iz);  // up and down
  const Eigen::VectorXd across = tip_under(beam, 1);
  EXPECT_NEAR(across[3], 0.0, 1e-10 * across[1]);
  // a bar takes no notice of the shear centre
  EXPECT_EQ(first_section(read_deck(cantilever(fmt::format("PBARL,5,1,,CHAN\n,{},{},{},{}\n", b, h, t, t),
                                               "CBAR,1,5,1,2,0.,1.,0.\n")))
                .shear_z,
            0.0);
}

// Widths lie along z, heights along y, the element's plane 1.
TEST(NastranBeams, ShapesStandAsInTheFigures) {
  const auto section = [](const std::string& shape) {
    return first_section(read_deck(cantilever("PBARL,5,1,," + shape + "\n", "CBAR,1,5,1,2,0.,1.,0.\n")));
  };
  const BeamSection bar = section("BAR\n,.1,.2,7.");
  EXPECT_NEAR(bar.Iz, 0.1 * 0.008 / 12.0, 1e-18);
  EXPECT_NEAR(bar.Iy, 0.2 * 0.001 / 12.0, 1e-18);
  EXPECT_EQ(bar.nsm, 7.0);
  EXPECT_NEAR(section("ROD\n,.1").A, std::numbers::pi * 0.01, 1e-16);
  EXPECT_NEAR(section("TUBE\n,.1,.08").A, std::numbers::pi * 0.0036, 1e-16);
  EXPECT_NEAR(section("TUBE2\n,.1,.02").A, std::numbers::pi * 0.0036, 1e-16);
  const BeamSection box = section("BOX\n,.1,.2,.02,.01");  // .02 above and below
  EXPECT_NEAR(box.A, 0.02 - 0.08 * 0.16, 1e-16);
  EXPECT_NEAR(box.Iz, (0.1 * 0.008 - 0.08 * 0.16 * 0.16 * 0.16) / 12.0, 1e-18);
  const BeamSection i = section("I\n,.2,.1,.1,.006,.01,.01"), i1 = section("I1\n,.094,.006,.18,.2");
  EXPECT_NEAR(i.Iz, (0.1 * 0.008 - 0.094 * 0.18 * 0.18 * 0.18) / 12.0, 1e-17);
  EXPECT_NEAR(i1.Iz, i.Iz, 1e-17);
  EXPECT_NEAR(i1.Iy, i.Iy, 1e-18);
  const BeamSection l = section("L\n,.1,.1,.001,.001");  // legs in the second and fourth quadrant
  EXPECT_NEAR(l.Iyz / (-0.1 * 0.1 * 0.1 * 0.001 / 8.0), 1.0, 3e-2);
  EXPECT_NEAR(section("T\n,.1,.11,.01,.01").Iz, (0.1 * 1e-6 + 0.01 * 1e-3) / 12.0 + 0.002 * 0.0275 * 0.0275, 1e-17);
}

// SDLL09, case 1: 30 tapered elements of exact constants at both ends, rigid in shear, no rotary inertia (COUPMASS).
TEST(NastranBeams, TaperedCantilever) {
  const int n = 30;
  std::string deck = "PARAM,COUPMASS,1\n" + steel_deck + "GRDSET,,,,,,,1246\n";
  const auto a = [](double t) { return 0.04 - 0.03 * t; };
  for (int k = 0; k <= n; ++k)
    deck += fmt::format("GRID,{},,{:.12g}{}\n", k + 1, static_cast<double>(k) / n, k == 0 ? ",,,,123456" : "");
  for (int k = 0; k < n; ++k) {
    const double p = a(static_cast<double>(k) / n), q = a((k + 1.0) / n);
    const auto I = [](double x) { return std::pow(x, 4) / 12.0; };
    deck +=
        fmt::format("PBEAM,{0},1,{1:.9e},{2:.9e},{2:.9e},,{2:.9e}\n,NO,1.,{3:.9e},{4:.9e},{4:.9e},,{4:.9e}\n,0.,0.\n",
                    k + 1, p * p, I(p), q * q, I(q));
    deck += fmt::format("CBEAM,{0},{0},{0},{1},0.,1.,0.\n", k + 1, k + 2);
  }
  const Structure s = assemble(read_deck(deck).model);
  const Eigen::VectorXd lambda = Eigen::GeneralizedSelfAdjointEigenSolver<Eigen::MatrixXd>(
                                     both_triangles(s.K), both_triangles(s.M), Eigen::EigenvaluesOnly)
                                     .eigenvalues();
  int k = 0;
  for (const double f : {54.189, 171.970, 384.53, 697.43, 1112.47})
    EXPECT_NEAR(std::sqrt(lambda[k++]) / (2.0 * std::numbers::pi * f), 1.0, 1e-3) << f;
}

// What is blank between the ends lies on the straight line from A to B.
TEST(NastranBeams, BlanksOfAStationAreInterpolated) {
  const NastranDeck deck = read_deck(cantilever(
      "PBEAM,5,1,4.,1.,2.,,3.\n,YES,.25,,1.1\n,.1,.2\n,NO,1.,8.,3.,2.,,3.\n,0.,0.\n", "CBEAM,1,5,1,2,0.,1.,0.\n"));
  ASSERT_EQ(deck.model.tapers.size(), 1U);
  ASSERT_EQ(deck.model.tapers[0].size(), 3U);
  EXPECT_EQ(deck.model.tapers[0][1].at, 0.25);
  const BeamSection& s = deck.model.beam_sections[static_cast<std::size_t>(deck.model.tapers[0][1].section)];
  EXPECT_DOUBLE_EQ(s.A, 5.0);
  EXPECT_DOUBLE_EQ(s.Iz, 1.1);
  EXPECT_DOUBLE_EQ(s.Iy, 2.0);
  EXPECT_EQ(s.kappa_y, 0.0);
  EXPECT_EQ(lost(deck.mesh, "PBEAM taper"), 1);
}

// Without COUPMASS masses stand at the ends: mass, centre and offset of the non-structural mass are kept.
TEST(NastranBeams, LumpedMassesKeepTheFirstMoment) {
  const double a0 = 0.04, a1 = 0.02, L = 2.0, nsm = 5.0;
  const NastranDeck deck = read_deck(steel_deck +
                                     "GRID,1\nGRID,2,,2.\nPBEAML,5,1,,BAR\n,.04,.04,5.,NO,1.,.02,.02,5.\n"
                                     "CBEAM,1,5,1,2,0.,1.,0.\n");
  const MassProperties m = mass_properties(assemble(deck.model));
  const double structural = steel_rho * L * (a0 * a0 + a0 * a1 + a1 * a1) / 3.0;
  const double moment = steel_rho * L * L * (a0 * a0 + 2.0 * a0 * a1 + 3.0 * a1 * a1) / 12.0;  // ∫ x a² dx
  EXPECT_NEAR(m.mass / (structural + nsm * L), 1.0, 1e-12);
  EXPECT_NEAR(m.centre.x() / ((moment + nsm * L * 0.5 * L) / (structural + nsm * L)), 1.0, 1e-12);
  const NastranDeck beside = read_deck(steel_deck +
                                       "GRID,1\nGRID,2,,2.\nPBEAM,5,1,4.-4,1.-8,2.-8,,3.-8,5.\n,\n,\n,.3,,.3\n"
                                       "CBEAM,1,5,1,2,0.,1.,0.\n");
  const MassProperties off = mass_properties(assemble(beside.model));
  EXPECT_NEAR(off.centre.y() / (0.3 * nsm / (nsm + steel_rho * 4e-4)), 1.0, 1e-12);
}

TEST(NastranBeams, WhatIsNotModelledIsRefused) {
  const auto says = [](const std::string& property, const std::string& element = "CBEAM,1,5,1,2,0.,1.,0.\n") {
    return refusal(cantilever(property, element));
  };
  EXPECT_THAT(says("PBEAML,5,1,,HAT\n,1.,.1,1.,1.\n"), HasSubstr("'HAT', which is not read"));
  EXPECT_THAT(says("PBEAML,5,1,,I\n,.1,.2,.2,.01,.06,.06\n"), HasSubstr("an I has height 0.1"));
  EXPECT_THAT(says("PBEAML,5,1,,BAR\n,.1\n"), HasSubstr("DIM"));
  EXPECT_THAT(says("PBEAM,5,1,4.,1.,1.,2.\n"), HasSubstr("I12² below"));
  EXPECT_THAT(says("PBEAM,5,1,4.,1.,1.\n,NO,1.5\n"), HasSubstr("X/XB"));
  EXPECT_THAT(says("PBEAM,5,1,4.,1.,1.\n,NO,.5\n,NO,.5\n"), HasSubstr("there is a section already"));
  EXPECT_THAT(says("PBEAM,5,1,4.,1.,1.\n,\n,,,.1\n"), HasSubstr("S1, S2"));
  EXPECT_THAT(says("PBEAM,5,1,4.,1.,1.\n,\n,,,,,.1\n"), HasSubstr("NSI"));
  EXPECT_THAT(says("PBEAM,5,1,4.,1.,1.\n,\n,,,,,,,.1\n", "CBEAM,1,5,1,2,0.,1.,0.\n,,,,,,,,\n,7,8\n"),
              HasSubstr("SA, SB"));
  EXPECT_THAT(says("PBAR,5,1,4.,1.,1.\n"), HasSubstr("not defined by a PBEAM or PBEAML"));
  EXPECT_THAT(says("PBEAM,5,1,4.,1.,1.\n", "CBEAM,1,5,1,2\n"), HasSubstr("BEAMOR"));
  EXPECT_THAT(says("PBEAM,5,1,4.,1.,1.,,1.\n,\n,\n,,,,,.1\n", "CBEAM,1,5,1,2,0.,1.,0.\n,45\n"), HasSubstr("pin flags"));
}
