#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "fem/structure.hpp"
#include "tests/unit/fem/formats/nastran/deck_file.hpp"

using namespace tenon;
using namespace tenon::fem;
using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::HasSubstr;

namespace {

/// Corners 1..4, middles 5..8; 9..11 are those of the triangle 1, 2, 3.
constexpr const char* grids =
    "MAT1,1,7.+10,,.25,2700.\nGRID,1\nGRID,2,,2.\nGRID,3,,2.,1.\nGRID,4,,0.,1.\n"
    "GRID,5,,1.\nGRID,6,,2.,.5\nGRID,7,,1.1,1.\nGRID,8,,0.,.5\nGRID,11,,1.,.5\n";
constexpr const char* skin = "PSHELL,5,1,.01,1,,1,,3.\n";
constexpr const char* quad8 = "CQUAD8,31,5,1,2,3,4,5,6\n,7,8,,,,,,.1\n";

NastranDeck deck(const std::string& cards) { return read_deck(std::string(grids) + cards); }
std::string fault(const std::string& cards) { return refusal(std::string(grids) + cards); }

double mass_of_points(const Model& model) {
  double sum = 0.0;
  for (const PointMass& p : elements_of<PointMass>(model)) sum += p.mass;
  return sum;
}

}  // namespace

TEST(NastranShells, WithDrillingAreReadAsTheOthers) {
  const Model r = deck(std::string(skin) + "CQUADR,1,5,1,2,3,4\nCTRIAR,2,5,1,2,3,,.2\n").model;
  EXPECT_EQ(elements_of<Quad4>(r).at(0).nodes, (std::array{0, 1, 2, 3}));
  EXPECT_EQ(elements_of<Tria3>(r).at(0).nodes, (std::array{0, 1, 2}));
  EXPECT_EQ(elements_of<Tria3>(r).at(0).offset, 0.2);
}

TEST(NastranShells, OfEightNodesAreSplit) {
  const NastranDeck d = deck(std::string(skin) + quad8);
  const auto quads = elements_of<Quad4>(d.model);
  ASSERT_EQ(quads.size(), 4U);
  const int centre = quads[0].nodes[2];
  EXPECT_LT(d.model.node_ids[static_cast<std::size_t>(centre)], 0);
  // ½ (1 + 2 + 1.1 + 0) − ¼ (0 + 2 + 2 + 0), ½ (0 + .5 + 1 + .5) − ¼ (0 + 0 + 1 + 1)
  EXPECT_LT((d.model.nodes[static_cast<std::size_t>(centre)] - Vec3(1.05, 0.5, 0.0)).norm(), 1e-14);
  EXPECT_EQ(quads[0].nodes, (std::array{0, 4, centre, 7}));
  EXPECT_EQ(quads[2].nodes, (std::array{centre, 5, 2, 6}));
  for (const Quad4& q : quads) {
    EXPECT_EQ(q.id, 31);
    EXPECT_EQ(q.offset, 0.1);
  }
  EXPECT_NEAR(mass_of_points(d.model), (27.0 + 3.0) * 2.0, 1e-11);
  ASSERT_EQ(d.mesh.cells.size(), 1U);  // the mesh is the file's
  EXPECT_EQ(d.mesh.cells[0].type, CellType::quad8);
  EXPECT_THAT(d.mesh.cells[0].nodes, ElementsAre(0, 1, 2, 3, 4, 5, 6, 7));
  EXPECT_EQ(d.mesh.points.size() + 1, d.model.nodes.size());
  EXPECT_EQ(lost(d.mesh, "CQUAD8"), 1);
}

TEST(NastranShells, OfSixNodesAreSplit) {
  const NastranDeck d = deck(std::string(skin) + "CTRIA6,31,5,1,2,3,5,6,11\n,,.1\n");
  const auto parts = elements_of<Tria3>(d.model);
  ASSERT_EQ(parts.size(), 4U);
  EXPECT_EQ(parts[0].nodes, (std::array{0, 4, 8}));
  EXPECT_EQ(parts[3].nodes, (std::array{4, 5, 8}));
  EXPECT_EQ(parts[3].offset, 0.1);
  EXPECT_NEAR(mass_of_points(d.model), 30.0, 1e-11);
  EXPECT_EQ(d.mesh.cells.at(0).type, CellType::triangle6);
}

// All parts of a split element have the laminate's direction that the element has.
TEST(NastranShells, PartsKeepTheMaterialDirection) {
  const std::string cards = "MAT8,2,1.4+11,1.+10,.3,5.+9,4.+9,3.+9,1600.\nPSHELL,5,2,.01,2,,2\n";
  for (const Tria3& t : elements_of<Tria3>(deck(cards + "CTRIA6,31,5,1,2,3,5,6,11\n").model))
    EXPECT_LT(t.material_axis.normalized().cross(Vec3::UnitX()).norm(), 1e-14);
  for (const Quad4& q : elements_of<Quad4>(deck(cards + "CQUAD8,31,5,1,2,3,4,5,6\n,7,8,,,,,30.\n").model))
    EXPECT_LT((q.material_axis - Vec3(std::sqrt(0.75), 0.5, 0.0)).norm(), 1e-14);
}

TEST(NastranShells, FaultsOfSecondOrder) {
  const auto refused = [](const std::string& card) { return fault(skin + card); };
  EXPECT_THAT(refused("CQUAD8,31,5,1,2,3,4,5,6\n,7\n"),
              AllOf(HasSubstr("CQUAD8 field G8 is blank"), HasSubstr("CQUAD4")));
  EXPECT_THAT(refused("CTRIA6,31,5,1,2,3,5,,11\n"), AllOf(HasSubstr("CTRIA6 field G5 is blank"), HasSubstr("CTRIA3")));
  EXPECT_THAT(refused("CQUAD8,31,5,1,2,3,4,5,6\n,7,7\n"), HasSubstr("31 names GRID 7 twice"));
  EXPECT_THAT(refused("CQUAD8,31,5,1,2,3,4,5,6\n,7,8,.01,.01,.01,.02\n"), HasSubstr("thickness at the corners"));
  EXPECT_THAT(refused("CTRIA6,31,5,1,2,5,8,6,11\n"), HasSubstr("31 has no area"));
  EXPECT_THAT(refused("CTRIA6,31,5,1,2,3,5,6,12\n"), HasSubstr("12"));
  EXPECT_THAT(refused("CSHEAR,31,5,1,2,3,4\n"), HasSubstr("CSHEAR"));
}

TEST(NastranShells, OrthotropicSingleLayer) {
  const std::string mat8 = "MAT8,2,1.4+11,1.+10,.3,5.+9,4.+9,3.+9,1600.\n", quad = "CQUAD4,1,5,1,2,3,4,30.\n";
  const auto section = [&](const std::string& cards) {
    return deck(cards + quad + "PARAM,COUPMASS,1\n").model.shell_sections.at(0);
  };
  const ShellSection usual = section(mat8 + "PSHELL,5,2,.01,2,,2,,3.\n");
  ASSERT_EQ(usual.plies.size(), 1U);
  EXPECT_EQ(usual.thickness, 0.01);
  EXPECT_EQ(usual.nsm, 3.0);
  EXPECT_EQ(usual.plies[0].E1, 1.4e11);
  EXPECT_EQ(usual.plies[0].rho, 1600.0);
  EXPECT_DOUBLE_EQ(usual.plies[0].G13, 4e9);
  EXPECT_DOUBLE_EQ(usual.plies[0].G23, 3e9);
  EXPECT_EQ(section(mat8 + "PSHELL,5,2,.01,2\n").plies[0].G13, 0.0);                        // no MID3: rigid in shear
  EXPECT_DOUBLE_EQ(section(mat8 + "PSHELL,5,2,.01,2,,1,.5\n").plies[0].G23, 2.8e10 * 0.6);  // of MAT1, TS/T = .6·5/6
  EXPECT_NEAR(mass_of_points(deck(mat8 + "PSHELL,5,2,.01,2,,2,,3.\n" + quad).model), (16.0 + 3.0) * 2.0, 1e-11);

  // [120 20 .; . 50 .; . . 8] GPa: E1 = 120 − 400/50, E2 = 50 − 400/120, ν12 = 20/50
  const std::string mat2 = "MAT2,3,1.2+11,2.+10,,5.+10,,8.+9,1500.\n";
  const Ply ply = section(mat2 + "MAT2,4,3.+9,,,2.+9\nPSHELL,5,3,.01,3,,4\n").plies.at(0);
  EXPECT_DOUBLE_EQ(ply.E1, 112e9);
  EXPECT_DOUBLE_EQ(ply.E2, 50e9 - 400e18 / 120e9);
  EXPECT_DOUBLE_EQ(ply.nu12, 0.4);
  EXPECT_DOUBLE_EQ(ply.G12, 8e9);
  EXPECT_DOUBLE_EQ(ply.G13, 3e9);
  EXPECT_DOUBLE_EQ(ply.G23, 2e9);
  EXPECT_EQ(ply.rho, 1500.0);
}

// E = 7e10, ν = 1/4 written as MAT1 and as MAT2: the same matrices.
TEST(NastranShells, AnIsotropicMat2IsAMat1) {
  const double plane = 7e10 / (1 - 0.0625);
  const std::string triangle = "CTRIA3,1,5,1,2,3\nPARAM,COUPMASS,1\n";
  const std::string mat2 =
      fmt::format("MAT2*,3,{:.14e},{:.14e},\n*,{:.14e},,{:.14e},2700.\n", plane, plane / 4, plane, 2.8e10);
  const Structure a = assemble(deck("PSHELL,5,1,.1,1,,1\n" + triangle).model);
  const Structure b = assemble(deck(mat2 + "PSHELL,5,3,.1,3,,1\n" + triangle).model);
  const Eigen::MatrixXd K = a.K, M = a.M;
  EXPECT_LT((K - Eigen::MatrixXd(b.K)).cwiseAbs().maxCoeff(), 1e-12 * K.cwiseAbs().maxCoeff());
  EXPECT_LT((M - Eigen::MatrixXd(b.M)).cwiseAbs().maxCoeff(), 1e-12 * M.cwiseAbs().maxCoeff());
}

TEST(NastranShells, FaultsOfOrthotropicLayers) {
  const auto refused = [](const std::string& cards) {
    return fault("MAT8,2,1.4+11,1.+10,.3,5.+9,4.+9,3.+9,1600.\n" + cards);
  };
  EXPECT_THAT(refused("PSHELL,5,2,.01\n"), HasSubstr("PSHELL field MID2 is blank"));
  EXPECT_THAT(refused("PSHELL,5,2,.01,1\n"), HasSubstr("homogeneous plate"));
  EXPECT_THAT(refused("PSHELL,5,2,.01,2,3.\n"), HasSubstr("PSHELL field 12I/T**3 is '3.'"));
  EXPECT_THAT(refused("PSHELL,5,2,.01,2,,9\n"), HasSubstr("MID3 names material 9"));
  EXPECT_THAT(refused("PSHELL,5,2,.01,2,,2\n,,,1\n"), HasSubstr("PSHELL MID4"));
  EXPECT_THAT(refused("MAT2,3,1.+10,,1.+9,1.+10,,5.+9\nPSHELL,5,3,.01,3\n"), HasSubstr("G13 and G23 zero"));
  EXPECT_THAT(refused("MAT2,3,1.+10,2.+10,,1.+10,,5.+9\nPSHELL,5,3,.01,3\n"), HasSubstr("stiffness is positive"));
  EXPECT_THAT(refused("MAT2,3,1.+9,1.+8,,1.+9\nPSHELL,5,2,.01,2,,3\n"), HasSubstr("G12 zero"));
  EXPECT_THAT(refused("MAT2,3,-1.+9,,,1.+9\nPSHELL,5,2,.01,2,,3\n"), HasSubstr("transverse shear moduli"));
}
