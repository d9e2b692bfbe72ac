#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "fem/formats/matrices/abaqus.hpp"
#include "tests/refusal.hpp"
#include "tests/unit/fem/formats/scratch.hpp"

using namespace tenon::fem;
using namespace tenon::fem::testing;
using ::testing::HasSubstr;

namespace {

const std::string stiffness =
    "** MATRIX INPUT\n5,1, 5,1, 4.0e+00\n2,6, 5,1, -1.5\n2,6,2,6, 3.\n2,1,2,1, 1.0e+36\n2,1,5,1,-7.\n";
const std::string mass = "5,1, 5,1, 2.0\n2,1, 2,1, 9.0\n";

MatrixData read(const std::string& k, const std::string& m) {
  const Scratch folder;
  return read_abaqus_matrices(folder.write("k.mtx", k), folder.write("m.mtx", m));
}

std::string refused(const std::string& k, const std::string& m = mass) {
  return tenon::tests::refusal([&] { read(k, m); });
}

}  // namespace

/// Node 2 ux is held (1e36): its row goes, with what couples it.
TEST(AbaqusMatrices, RowsRiseAndHeldOnesAreLeftOut) {
  const MatrixData data = read(stiffness, mass);
  ASSERT_EQ(data.rows.size(), 2U);
  EXPECT_EQ(data.rows[0].node, 2);
  EXPECT_EQ(data.rows[0].direction, 5);
  EXPECT_EQ(data.rows[1].node, 5);
  EXPECT_EQ(Eigen::MatrixXd(data.K), (Eigen::Matrix2d() << 3.0, 0.0, -1.5, 4.0).finished());
  EXPECT_EQ(Eigen::MatrixXd(data.M), (Eigen::Matrix2d() << 0.0, 0.0, 0.0, 2.0).finished());
  ASSERT_EQ(data.losses.size(), 1U);
  EXPECT_EQ(data.losses[0].count, 1);
}

TEST(AbaqusMatrices, BothTrianglesAreReadWhenTheyAgree) {
  const MatrixData data = read(stiffness + "5,1,2,6,-1.5\n", mass);
  EXPECT_EQ(Eigen::MatrixXd(data.K), (Eigen::Matrix2d() << 3.0, 0.0, -1.5, 4.0).finished());
  EXPECT_THAT(refused(stiffness + "5,1,2,6,-1.4\n"), HasSubstr("the stiffness matrix is not symmetric"));
  EXPECT_THAT(refused(stiffness + "2,6,5,1,-1.5\n"), HasSubstr("stands twice"));
}

TEST(AbaqusMatrices, FaultsAreNamedByLineAndColumn) {
  EXPECT_THAT(refused("1,1,1,1,2.\n-3,1,1,1,2.\n"), HasSubstr("k.mtx:2:1: found row node -3: internal nodes"));
  EXPECT_THAT(refused("1,1,1,11,2.\n"), HasSubstr("k.mtx:1:7: found column dof 11"));
  EXPECT_THAT(refused("1,1,1,1\n"), HasSubstr("k.mtx:1:8: found the end of the line, expected a number"));
  EXPECT_THAT(refused("1,1,1,1,2.,3\n"), HasSubstr("found '3', expected the end of the line"));
  EXPECT_THAT(refused("1 1 2.0\n"), HasSubstr("k.mtx:1:5: found '2.0', expected column node"));  // FORMAT=COORDINATE
  EXPECT_THAT(refused("*MATRIX INPUT\n"), HasSubstr("found '*MATRIX INPUT'"));
  EXPECT_THAT(refused("1,1,1,1,1e36\n", "1,1,1,1,1.\n"), HasSubstr("every dof is held"));
  EXPECT_THAT(refused("** nothing\n"), HasSubstr("holds no matrix entry"));
  EXPECT_THAT(refused("1,1,1,1,2."), HasSubstr("no line end"));
  EXPECT_THAT(refused(stiffness, "5,1,5,1,inf\n"), HasSubstr("m.mtx:1:9: found 'inf'"));
}

TEST(AbaqusMatrices, AreFoundByTheJob) {
  const Scratch folder;
  const std::string job = folder.file("frame").string();
  const auto refused_job = [&] { return tenon::tests::refusal([&] { read_abaqus_matrices(job); }); };
  EXPECT_THAT(refused_job(), HasSubstr("found no pair of files frame_STIFn.mtx and frame_MASSn.mtx"));
  folder.write("frame_STIF2.mtx", stiffness);
  folder.write("frame_MASS1.mtx", mass);
  EXPECT_THAT(refused_job(), HasSubstr("found no pair"));
  folder.write("frame_MASS2.mtx", mass);
  EXPECT_EQ(read_abaqus_matrices(job).rows.size(), 2U);
  folder.write("frame_STIF1.mtx", stiffness);
  EXPECT_THAT(refused_job(), HasSubstr("found the matrices of 2 steps"));
}
