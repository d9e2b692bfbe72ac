#include <Eigen/Eigenvalues>
#include <cmath>
#include <numbers>

#include "fem/structure.hpp"
#include "tests/unit/fem/formats/nastran/deck_file.hpp"

using namespace tenon;
using namespace tenon::fem;
using ::testing::ElementsAre;
using ::testing::HasSubstr;

namespace {

constexpr double pi = std::numbers::pi;

/// Eigenvalues of K − λ M with a definite M.
Eigen::VectorXd eigenvalues(const Model& model) {
  const Structure s = assemble(model);
  const Eigen::MatrixXd K = Eigen::MatrixXd(s.K).selfadjointView<Eigen::Lower>(),
                        M = Eigen::MatrixXd(s.M).selfadjointView<Eigen::Lower>();
  return Eigen::GeneralizedSelfAdjointEigenSolver<Eigen::MatrixXd>(K, M, Eigen::EigenvaluesOnly).eigenvalues();
}

constexpr const char* pair = "GRID,1,,1.,2.,-.5\nGRID,2,,1.9,2.7,.4\nGRID,3,,1.,2.,-.5\n";
constexpr const char* skew_frame = "CORD2R,7,,0.,0.,0.,1.,2.,2.\n,3.,0.,1.\n";

Bush only_bush(const std::string& cards) {
  const auto all = elements_of<Bush>(read_deck(pair + cards).model);
  EXPECT_EQ(all.size(), 1U);
  return all.at(0);
}

}  // namespace

// SDLD02: eight masses of 10 kg between nine springs of 1e5 N/m and two walls, ω_j = 2 √(k/m) sin(jπ/18).
TEST(NastranSprings, AChainOfMassesHasItsClosedForm) {
  std::string scalar = "PELAS,3,1.+5\n", grids;
  for (int i = 1; i <= 8; ++i) {
    grids += fmt::format("GRID,{0},,{0}.,,,,23456\nCONM2,{1},{0},,10.\n", i, 100 + i);
    if (i < 8) scalar += fmt::format("CELAS{},{},{},{},1,{},1\n", i % 2 ? 1 : 2, i, i % 2 ? "3" : "1.+5", i, i + 1);
  }
  scalar += "CELAS1,20,3,1,1\nCELAS2,21,1.+5,,,8,1\n";  // to ground at either end of the card
  const Eigen::VectorXd lambda = eigenvalues(read_deck(grids + scalar).model);
  ASSERT_EQ(lambda.size(), 8);
  for (int j = 1; j <= 8; ++j) EXPECT_NEAR(std::sqrt(lambda[j - 1]), 200.0 * std::sin(j * pi / 18.0), 1e-12 * 200.0);
}

TEST(NastranSprings, ScalarPointsAndTheirSprings) {
  const NastranDeck deck = read_deck(
      "GRID,1,,,,,,23456\nSPOINT,10,11,12\nPELAS,3,2.+3,,,4,5.+3\nCELAS3,1,3,10,11\nCELAS4,2,7.+3,11\n"
      "CELAS1,3,4,1,1,10\nCELAS2,4,1.,12,,1,1\nSPC1,1,1,12\nCONM2,9,1,,1.\nPARAM,COUPMASS,1\n",
      {.spc_set = 1, .mpc_set = {}});
  const auto springs = elements_of<Spring>(deck.model);
  ASSERT_EQ(springs.size(), 4U);
  EXPECT_EQ(springs[0].k, 5e3);  // CELAS1 comes first
  EXPECT_EQ(springs[2].k, 2e3);
  EXPECT_EQ(springs[3].k, 7e3);
  EXPECT_EQ(deck.model.scalar_points.size(), 3U);
  ASSERT_EQ(deck.model.supports.size(), 6U);  // PS of the grid and point 12
  const Structure s = assemble(deck.model);
  EXPECT_EQ(s.n(), 3);
}

TEST(NastranSprings, SpringsActAlongDisplacementFrames) {
  const auto model =
      read_deck(std::string(skew_frame) + "GRID,1,,,,,7\nGRID,2,,1.\nCELAS2,1,5.+3,1,3,2,6\nCONM2,9,1,,1.\n").model;
  const Spring spring = elements_of<Spring>(model).at(0);
  EXPECT_LT((spring.axis_a - Vec3(1.0, 2.0, 2.0) / 3.0).norm(), 1e-15);  // z of the frame
  EXPECT_EQ(spring.axis_b, Vec3::Zero());
  EXPECT_EQ(spring.dof_b, 5);
}

TEST(NastranBush, AxesFromLineVectorGridAndSystem) {
  const std::string p = "PBUSH,5,K,1.,2.,3.,4.,5.,6.\n";
  const Vec3 x = Vec3(0.9, 0.7, 0.9).normalized();
  const Bush by_vector = only_bush(p + "CBUSH,8,5,1,2,0.,0.,1.\n");
  EXPECT_THAT(by_vector.k, ElementsAre(1.0, 2.0, 3.0, 4.0, 5.0, 6.0));
  EXPECT_LT((by_vector.axes.col(0) - x).norm(), 1e-15);
  EXPECT_NEAR(by_vector.axes.col(2).z(), 0.0, 1e-15);  // v = z lies in the x-y plane
  EXPECT_GT(by_vector.axes.col(1).z(), 0.0);
  EXPECT_LT((by_vector.offset - 0.5 * Vec3(0.9, 0.7, 0.9)).norm(), 1e-15);
  const Bush by_grid = only_bush("GRID,4,,1.,2.,3.\n" + p + "CBUSH,8,5,1,2,4\n");
  EXPECT_LT((by_grid.axes - by_vector.axes).norm(), 1e-15);
  const Bush line = only_bush("PBUSH,5,K,1.,,,4.\nCBUSH,8,5,1,2\n,.25\n");
  EXPECT_LT((line.axes.col(0) - x).norm(), 1e-15);
  EXPECT_LT((line.offset - 0.25 * Vec3(0.9, 0.7, 0.9)).norm(), 1e-15);
  const Bush by_system = only_bush(skew_frame + p + "CBUSH,8,5,1,3,,,,7\n,,7,3.,0.,3.\n");
  EXPECT_LT((by_system.axes.col(2) - Vec3(1.0, 2.0, 2.0) / 3.0).norm(), 1e-15);
  EXPECT_LT((by_system.offset - by_system.axes * Vec3(3.0, 0.0, 3.0)).norm(), 1e-14);
  const Bush ground = only_bush(p + "CBUSH,8,5,1,,,,,0\n");
  EXPECT_EQ(ground.node_b, -1);
  EXPECT_EQ(ground.axes, Mat3::Identity());
}

TEST(NastranBush, DampersAndRecoveryAreNamedLosses) {
  const NastranDeck deck = read_deck(pair + std::string("PBUSH,5,K,1.,2.,3.,4.,5.,6.\n,,B,1.,1.\n,,GE,.02\n,,RCV,1.,1."
                                                        "\nCBUSH,8,5,1,3,,,,0\nCDAMP1,1,1,1,1\nPDAMP,1,5.\n"
                                                        "CVISC,2,1,1,2\nPVISC,1,6.\n"));
  for (const char* name : {"PBUSH B", "PBUSH GE", "PBUSH RCV", "CDAMP1", "PDAMP", "CVISC", "PVISC"})
    EXPECT_EQ(lost(deck.mesh, name), 1) << name;
}

// A rigid body of the two grids on a bush between coincident ones: through the file K R = 0 stays.
TEST(NastranBush, RigidMotionsStayFree) {
  const Model model =
      read_deck(pair + std::string("PBUSH,5,K,1.+6,2.+6,3.+6,4.+4,5.+4,6.+4\nCBUSH,8,5,1,2,1.,0.,0.\n,.2\n"
                                   "CONM2,9,1,,2.\n,1.,,1.,,,1.\nCONM2,10,2,,2.\n,1.,,1.,,,1.\n"))
          .model;
  const Eigen::VectorXd lambda = eigenvalues(model);
  ASSERT_EQ(lambda.size(), 12);
  EXPECT_LT(std::abs(lambda[5]), 1e-12 * lambda[11]);
  EXPECT_GT(lambda[6], 1e-4 * lambda[11]);
}

TEST(NastranSprings, FaultsAreRefusedByNameAndPlace) {
  const auto says = [](const std::string& cards) { return refusal(pair + cards); };
  const std::string p = "PBUSH,5,K,1.,2.\n", b = "PELAS,3,1.+5\n";
  EXPECT_THAT(says(b + "CELAS1,1,3,1\n"), HasSubstr("deck.bdf:5"));
  EXPECT_THAT(says(b + "CELAS1,1,3,1,12\n"), HasSubstr("one digit 1 to 6"));
  EXPECT_THAT(says(b + "CELAS1,1,4,1,1\n"), HasSubstr("property 4, which is not defined by a PELAS"));
  EXPECT_THAT(says(b + "PELAS,3,2.+5\n"), HasSubstr("stands already with K = 100000"));
  EXPECT_THAT(says("CELAS2,1,-5.,1,1\n"), HasSubstr("CELAS2 field K is '-5.'"));
  EXPECT_THAT(says("CELAS2,1,5.\n"), HasSubstr("joins ground to ground"));
  EXPECT_THAT(says("CELAS2,1,5.,1,1,1,1\n"), HasSubstr("joins a dof to itself"));
  EXPECT_THAT(says("CELAS4,1,5.,1\n"), HasSubstr("a scalar point, which no GRID is"));
  EXPECT_THAT(says("SPOINT,20\nQSET1,,20\nCELAS4,1,5.,20\n"), HasSubstr("q-set"));
  EXPECT_THAT(says(p + "CBUSH,8,5,1,2\n"), HasSubstr("K2, K3, K5 and K6 need axes"));
  EXPECT_THAT(says(p + "CBUSH,8,5,1,3\n"), HasSubstr("coincident grids and ground give no axes"));
  EXPECT_THAT(says(p + "CBUSH,8,5,1,1,,,,0\n"), HasSubstr("joins GRID 1 to itself"));
  EXPECT_THAT(says(p + "CBUSH,8,5,1,2,.9,.7,.9\n"), HasSubstr("along its own axis"));
  EXPECT_THAT(says(p + "CBUSH,8,5,1,2,0.,0.,1.\n,1.5\n"), HasSubstr("a number from 0 to 1"));
  EXPECT_THAT(says(p + "CBUSH,8,6,1,2,0.,0.,1.\n"), HasSubstr("not defined by a PBUSH"));
  EXPECT_THAT(says("PBUSH,5,K,1.,-2.\n"), HasSubstr("not negative"));
  EXPECT_THAT(says("PBUSH,5,K,RIGID\n"), HasSubstr("RBE2"));
  EXPECT_THAT(says("PBUSH,5,X,1.\n"), HasSubstr("K, B, GE, M or RCV"));
  EXPECT_THAT(says("PBUSH,5,K,1.\n,,M,4.\n"), HasSubstr("PBUSH M (1 found"));
}

TEST(NastranRods, PropertiesOfProdTubeAndConrod) {
  const NastranDeck deck = read_deck(
      pair +
      std::string("MAT1,1,2.+11,8.+10,,7800.\nPROD,4,1,3.-4,5.-8,,1.5\nPTUBE,5,1,.1,.01\nPTUBE,6,1,.1\n"
                  "CROD,11,4,1,2\nCTUBE,12,5,1,2\nCTUBE,13,6,1,2\nCONROD,14,1,2,1,2.-4,,,.5\nPARAM,COUPMASS,1\n"));
  const auto rods = elements_of<Rod>(deck.model);
  ASSERT_EQ(rods.size(), 4U);
  const auto section = [&](std::size_t i) {
    return deck.model.beam_sections[static_cast<std::size_t>(rods[i].section)];
  };
  EXPECT_EQ(section(0).A, 3e-4);
  EXPECT_EQ(section(0).J, 5e-8);
  EXPECT_EQ(section(0).nsm, 1.5);
  EXPECT_NEAR(section(1).A, pi * (0.1 * 0.1 - 0.08 * 0.08) / 4.0, 1e-15);
  EXPECT_NEAR(section(1).J, pi * (std::pow(0.1, 4) - std::pow(0.08, 4)) / 32.0, 1e-18);
  EXPECT_NEAR(section(2).A, pi * 0.01 / 4.0, 1e-15);  // no T: solid
  EXPECT_EQ(section(3).A, 2e-4);
  EXPECT_EQ(section(3).nsm, 0.5);
  EXPECT_EQ(rods[0].mass, BeamMass::nastran);
  EXPECT_TRUE(deck.mesh.cell_sets.contains("prod 4"));
}

TEST(NastranRods, LumpedHalfAndHalf) {
  const Model model =
      read_deck(pair + std::string("MAT1,1,2.+11,8.+10,,7800.\nPROD,4,1,3.-4,5.-8,,1.5\nCROD,11,4,1,2\n")).model;
  const double half = 0.5 * (7800.0 * 3e-4 + 1.5) * Vec3(0.9, 0.7, 0.9).norm();
  const auto points = elements_of<PointMass>(model);
  ASSERT_EQ(points.size(), 2U);
  for (const PointMass& p : points) EXPECT_NEAR(p.mass, half, 1e-14 * half);
  const Rod rod = elements_of<Rod>(model).at(0);
  EXPECT_EQ(model.materials[static_cast<std::size_t>(rod.material)].rho, 0.0);
  EXPECT_EQ(model.beam_sections[static_cast<std::size_t>(rod.section)].nsm, 0.0);
}

TEST(NastranRods, FaultsAreRefusedByNameAndPlace) {
  const auto says = [](const std::string& cards) {
    return refusal(pair + ("MAT1,1,2.+11,,.3\nMAT1,2,2.+11\n" + cards));
  };
  EXPECT_THAT(says("CROD,1,4,1,2\n"), HasSubstr("property 4, which is not defined by a PROD"));
  EXPECT_THAT(says("PROD,4,1\n"), HasSubstr("above zero here or in field J"));
  EXPECT_THAT(says("PROD,4,1,-1.\n"), HasSubstr("PROD field A is '-1.'"));
  EXPECT_THAT(says("PROD,4,2,1.,1.\n"), HasSubstr("a material with G (for J)"));
  EXPECT_THAT(says("PROD,4,9,1.\n"), HasSubstr("names material 9"));
  EXPECT_THAT(says("PROD,4,1,1.\nCROD,1,4,1,3\n"), HasSubstr("has no length"));
  EXPECT_THAT(says("PROD,4,1,1.\nCROD,1,4,1,2\nCROD,1,4,2,1\n"), HasSubstr("with other values"));
  EXPECT_THAT(says("PTUBE,5,1,.1,.06\n"), HasSubstr("at most half of OD"));
  EXPECT_THAT(says("PTUBE,5,1,.1,.01,,.2\n"), HasSubstr("PTUBE OD2"));
  EXPECT_THAT(says("CONROD,5,1,2,1\n"), HasSubstr("above zero here or in field J"));
}

TEST(NastranSprings, WhatTheyNameIsAScalarPointWithoutACard) {
  const Model model = read_deck("GRID,1\nCELAS4,1,5.,1001\nCELAS4,2,3.,1001,1002\n").model;
  EXPECT_EQ(model.scalar_points.size(), 2U);
  EXPECT_EQ(elements_of<Spring>(model).size(), 2U);
}
