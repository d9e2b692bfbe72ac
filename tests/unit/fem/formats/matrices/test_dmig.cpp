#include "fem/formats/matrices/dmig.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "fem/formats/matrices/superelement.hpp"
#include "tests/refusal.hpp"
#include "tests/unit/fem/formats/scratch.hpp"

using namespace tenon::fem;
using namespace tenon::fem::testing;
using ::testing::HasSubstr;

namespace {

// grid 3 has the frame x' = y, y' = z, z' = x; scalar point 20 is a mode
const std::string grids = "CORD2R,6,,0.,0.,0.,1.,0.,0.\n,0.,1.,0.\nGRID,2,,1.,0.,0.\nGRID,3,,2.,0.,0.,6\nSPOINT,20\n";
const std::string matrices =
    "DMIG    KAAX           0       6       2       0\n"
    "DMIG*   KAAX                           2               1\n"
    "*                      2               1 4.000000000D+00\n"
    "*                      3               3-4.000000000D+00\n"
    "DMIG    KAAX           3       3               3       3      4.\n"
    "             20       0     .25\n"
    "DMIG,KAAX,20,0,,20,0,9.\n"
    "DMIG,MAAX,0,1,1,0\n"
    "DMIG,MAAX,2,1,,2,1,1.5\n"
    "DMIG,MAAX,20,0,,20,0,1.\n";

MatrixData read(const std::string& text, const std::string& stiffness = "") {
  const Scratch folder;
  return read_nastran_dmig(folder.write("part.bdf", text).string(), stiffness);
}

std::string refused(const std::string& text, const std::string& stiffness = "") {
  return tenon::tests::refusal([&] { read(text, stiffness); });
}

}  // namespace

TEST(Dmig, RowsRiseAndAreTurnedToTheBasicFrame) {
  const MatrixData data = read(grids + matrices);
  ASSERT_EQ(data.rows.size(), 3U);
  EXPECT_EQ(data.rows[0].node, 2);
  EXPECT_EQ(data.rows[1].node, 3);
  EXPECT_EQ(data.rows[1].direction, 0);  // z' = x
  EXPECT_TRUE(data.rows[2].scalar);
  EXPECT_EQ(data.rows[2].node, 20);
  EXPECT_EQ(Eigen::MatrixXd(data.K), (Mat3() << 4.0, 0.0, 0.0, -4.0, 4.0, 0.0, 0.0, 0.25, 9.0).finished());
  EXPECT_EQ(Eigen::MatrixXd(data.M), (Mat3() << 1.5, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 1.0).finished());
  EXPECT_EQ(data.positions.at(3), Vec3(2.0, 0.0, 0.0));
}

TEST(Dmig, AreTakenFromAPunchFileWithoutMatricesBesideIt) {
  const Scratch folder;
  const auto file = folder.write("part.pch", "BEGIN SUPER=7\nEXTRN,2,1,3,3,20,0\n" + grids + matrices);
  EXPECT_EQ(read_nastran_superelement(file.string()).rows.size(), 3U);
}

TEST(Dmig, OtherMatricesAreLosses) {
  const MatrixData data = read(grids + matrices + "DMIG,K4AAX,0,6,2,0\nDMIG,K4AAX,2,1,,2,1,.1\n");
  ASSERT_EQ(data.losses.size(), 1U);
  EXPECT_EQ(data.losses[0].name, "DMIG K4AAX");
}

TEST(Dmig, FaultsAreNamedByField) {
  EXPECT_THAT(refused(grids + matrices, "KAX"), HasSubstr("Did you mean KAAX?"));
  EXPECT_THAT(refused(grids + matrices + "DMIG,K2,0,6,2,0\n"), HasSubstr("could be KAAX or K2"));
  EXPECT_THAT(refused(grids + "DMIG,KAAX,0,2,2,0\n"), HasSubstr("part.bdf:6:13: DMIG KAAX has the form 2"));
  EXPECT_THAT(refused(grids + "DMIG,KAAX,0,6,3,0\n"), HasSubstr("KAAX is complex"));
  EXPECT_THAT(refused(grids + "DMIG,KAAX,2,1,,2,1,1.\n"), HasSubstr("KAAX has no header"));
  EXPECT_THAT(refused(grids + matrices + "DMIG,KAAX,2,2,,5,2,1.\n"), HasSubstr("names 5, which is neither a GRID nor"));
  EXPECT_THAT(refused(grids + matrices + "DMIG,KAAX,2,2,,3,7,1.\n"), HasSubstr("field C is '7'"));
  EXPECT_THAT(refused(grids + matrices + "DMIG,KAAX,2,2,,3,2,one\n"), HasSubstr("field A is 'one'"));
  EXPECT_THAT(refused(grids + matrices + "DMIG,KAAX,2,2,,3,2,1.,2.\n"), HasSubstr("imaginary part"));
  EXPECT_THAT(refused(grids + matrices + "DMIG,KAAX,2,1,,2,1,4.\n"),
              HasSubstr("(node 2 ux, node 2 ux) of KAAX stands twice"));
  EXPECT_THAT(refused(grids + matrices + "DMIG,MAAX,2,2,,2,1,4.\n"), HasSubstr("MAAX is not symmetric"));
  EXPECT_THAT(refused(grids + matrices + "PARAM,CK2,2.\n"), HasSubstr("PARAM CK2 (1 found"));
  EXPECT_THAT(refused(grids + matrices + "CROD,1,1,2,3\n"), HasSubstr("CROD (1 found"));
}
