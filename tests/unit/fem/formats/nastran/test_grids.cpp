#include <cmath>

#include "tests/unit/fem/formats/nastran/deck_file.hpp"

using namespace tenon;
using namespace tenon::fem;
using ::testing::HasSubstr;

namespace {

/// Sum over the terms: coefficient · motion, for the motion of one node.
double applied(const LinearConstraint& constraint, const Vec6& motion) {
  double sum = 0.0;
  for (const auto& term : constraint.terms) sum += term.coefficient * motion[term.dof.direction];
  return sum;
}

Vec6 translation(const Vec3& v) {
  Vec6 u;
  u << v, Vec3::Zero();
  return u;
}

}  // namespace

// x′ = y, y′ = z, z′ = x, origin at (1, 2, 3)
constexpr const char* cyclic = "CORD2R,5,,1.,2.,3.,2.,2.,3.\n,1.,3.,3.\n";

TEST(NastranGrids, RectangularSystem) {
  const auto mesh = read_deck(std::string(cyclic) + "GRID,1,5,10.,20.,30.\n").mesh;
  EXPECT_LT((mesh.points[0] - Vec3(1.0 + 30.0, 2.0 + 10.0, 3.0 + 20.0)).norm(), 1e-13);
}

TEST(NastranGrids, CylindricalAndSphericalSystems) {
  const auto mesh = read_deck(
                        "CORD2C,1,,0.,0.,1.,0.,0.,2.\n,1.,0.,1.\nCORD2S,2,,0.,0.,0.,0.,0.,1.\n,1.,0.,0.\n"
                        "GRID,1,1,2.,30.,4.\nGRID,2,2,2.,60.,90.\n")
                        .mesh;
  EXPECT_LT((mesh.points[0] - Vec3(std::sqrt(3.0), 1.0, 5.0)).norm(), 1e-14);
  EXPECT_LT((mesh.points[1] - Vec3(0.0, std::sqrt(3.0), 1.0)).norm(), 1e-14);  // 60° from z, 90° about it
}

TEST(NastranGrids, SystemsInSystemsInAnyOrder) {
  // 7 hangs on 6 hangs on 5: three cyclic renamings come back to the basic axes; the origin moves once each time
  const auto mesh = read_deck(
                        "GRID,1,7,10.,20.,30.\nCORD2R,7,6,0.,0.,0.,1.,0.,0.\n,0.,1.,0.\n"
                        "CORD2R,6,5,0.,0.,0.,1.,0.,0.\n,0.,1.,0.\n" +
                        std::string(cyclic))
                        .mesh;
  EXPECT_LT((mesh.points[0] - Vec3(11.0, 22.0, 33.0)).norm(), 1e-13);
}

TEST(NastranGrids, SystemsThroughGrids) {
  const auto mesh = read_deck(
                        "CORD1R,3,11,12,13,4,11,13,12\nGRID,11,,1.,1.,1.\nGRID,12,,1.,1.,5.\nGRID,13,,7.,1.,1.\n"
                        "GRID,1,3,1.,2.,3.\nGRID,2,4,1.,2.,3.\n")
                        .mesh;
  EXPECT_LT((mesh.points[3] - Vec3(2.0, 3.0, 4.0)).norm(), 1e-14);
  // z along +x, x along +z, so y = z × x = −y
  EXPECT_LT((mesh.points[4] - Vec3(4.0, -1.0, 2.0)).norm(), 1e-14);
}

TEST(NastranGrids, GrdsetFillsBlanks) {
  const auto deck = read_deck(std::string(cyclic) + "GRDSET,,5,,,,,1\nGRID,1,,10.,20.,30.\nGRID,2,0,10.,20.,30.,,4\n");
  EXPECT_LT((deck.mesh.points[0] - Vec3(31.0, 12.0, 23.0)).norm(), 1e-13);
  EXPECT_EQ(deck.mesh.points[1], Vec3(10.0, 20.0, 30.0));
  ASSERT_EQ(deck.model.supports.size(), 2U);  // PS of the two grids, applied without any SPC set
  EXPECT_EQ(deck.model.supports[0].dof.direction, 0);
  EXPECT_EQ(deck.model.supports[1].dof.direction, 3);
}

TEST(NastranGrids, ADisplacementFrameThatRenamesAxesRenamesDirections) {
  const auto deck = read_deck(std::string(cyclic) + "GRID,1,,0.,0.,0.,5\nSPC1,1,15,1\n",
                              {.allow_losses = false, .spc_set = 1, .mpc_set = {}});
  ASSERT_EQ(deck.model.supports.size(), 2U);
  EXPECT_EQ(deck.model.supports[0].dof.direction, 1);  // x′ = y
  EXPECT_EQ(deck.model.supports[1].dof.direction, 5);  // about y′ = z
  EXPECT_TRUE(deck.model.constraints.empty());
}

TEST(NastranGrids, ASkewDisplacementFrameMakesEquations) {
  // 30° about z
  const std::string skew = "CORD2R,5,,0.,0.,0.,0.,0.,1.\n,.8660254037844387,.5,0.\nGRID,1,,0.,0.,0.,5\n";
  const NastranOptions set_one{.allow_losses = false, .spc_set = 1, .mpc_set = {}};
  const Vec3 x(std::sqrt(3.0) / 2.0, 0.5, 0.0), y(-0.5, std::sqrt(3.0) / 2.0, 0.0);

  const auto one = read_deck(skew + "SPC1,1,1,1\n", set_one).model;
  ASSERT_EQ(one.constraints.size(), 1U);
  EXPECT_TRUE(one.supports.empty());
  EXPECT_EQ(one.constraints[0].terms[0].dof.direction, 0);  // led by the largest part
  EXPECT_NEAR(applied(one.constraints[0], translation(y)), 0.0, 1e-15);
  EXPECT_GT(std::abs(applied(one.constraints[0], translation(x))), 0.5);

  // two directions held: only the third moves, and the equations lead with different dofs
  const auto two = read_deck(skew + "SPC1,1,13,1\n", set_one).model;
  ASSERT_EQ(two.constraints.size() + two.supports.size(), 2U);
  for (const auto& c : two.constraints) EXPECT_NEAR(applied(c, translation(y)), 0.0, 1e-15);

  // a whole half needs no equation
  const auto three = read_deck(skew + "SPC1,1,123,1\n", set_one).model;
  EXPECT_EQ(three.supports.size(), 3U);
  EXPECT_TRUE(three.constraints.empty());
}

TEST(NastranGrids, TwoSkewDirectionsLeaveOnlyTheThird) {
  const std::string skew = "CORD2R,5,,0.,0.,0.,1.,1.,1.\n,1.,-1.,0.\nGRID,1,,0.,0.,0.,5\nSPC1,1,12,1\n";
  const auto model = read_deck(skew, {.allow_losses = false, .spc_set = 1, .mpc_set = {}}).model;
  ASSERT_EQ(model.constraints.size(), 2U);
  Eigen::Matrix<double, 2, 3> rows = Eigen::Matrix<double, 2, 3>::Zero();
  for (int k = 0; k < 2; ++k)
    for (const auto& term : model.constraints[static_cast<std::size_t>(k)].terms)
      rows(k, term.dof.direction) = term.coefficient;
  EXPECT_LT((rows * Vec3(1.0, 1.0, 1.0)).norm(), 1e-14);
  EXPECT_GT((rows * rows.transpose()).determinant(), 0.1);
  const int first = model.constraints[0].terms[0].dof.direction, second = model.constraints[1].terms[0].dof.direction;
  EXPECT_NE(first, second);
  EXPECT_NEAR(rows(0, second), 0.0, 1e-15);  // neither uses the other's eliminated dof
  EXPECT_NEAR(rows(1, first), 0.0, 1e-15);
}

TEST(NastranGrids, CylindricalDisplacementFrameTurnsWithTheGrid) {
  const auto model = read_deck(
                         "CORD2C,1,,0.,0.,0.,0.,0.,1.\n,1.,0.,0.\nGRID,1,,0.,3.,0.,1\nGRID,2,,1.,1.,0.,1\n"
                         "SPC1,1,2,1,2\n",
                         {.allow_losses = false, .spc_set = 1, .mpc_set = {}})
                         .model;
  ASSERT_EQ(model.supports.size(), 1U);  // at (0, 3): the circumferential direction is −x
  EXPECT_EQ(model.supports[0].dof.direction, 0);
  ASSERT_EQ(model.constraints.size(), 1U);  // at (1, 1): radial motion stays free
  EXPECT_NEAR(applied(model.constraints[0], translation(Vec3(1.0, 1.0, 0.0))), 0.0, 1e-15);
  EXPECT_NEAR(applied(model.constraints[0], translation(Vec3(0.0, 0.0, 1.0))), 0.0, 1e-15);
}

TEST(NastranGrids, BadSystemsAreRefused) {
  EXPECT_THAT(refusal("GRID,1,9\n"), HasSubstr("deck.bdf:1:8: GRID field CP names coordinate system 9"));
  EXPECT_THAT(refusal("GRID,1,,0.,0.,0.,9\n"), HasSubstr("GRID field CD names coordinate system 9"));
  EXPECT_THAT(refusal("GRID,1,1\nCORD2R,1,2,0.,0.,0.,0.,0.,1.\n,1.,0.,0.\nCORD2R,2,1,0.,0.,0.,0.,0.,1.\n,1.,0.,0.\n"),
              HasSubstr("closes a circle"));
  EXPECT_THAT(refusal("GRID,1,1\nGRID,2,,1.\nGRID,3,,,1.\nCORD1R,1,1,2,3\n"), HasSubstr("closes a circle"));
  EXPECT_THAT(refusal("GRID,1,1\nCORD2R,1,,0.,0.,0.,0.,0.,1.\n,0.,0.,2.\n"),
              HasSubstr("deck.bdf:2: CORD2R is no coordinate system"));
  EXPECT_THAT(refusal("GRID,1,,0.,0.,4.,1\nCORD2C,1,,0.,0.,0.,0.,0.,1.\n,1.,0.,0.\n"), HasSubstr("polar axis"));
  EXPECT_THAT(refusal("GRID,1\nCORD1R,1,1,2,3\n"), HasSubstr("CORD1R field G2 names GRID 2"));
  EXPECT_THAT(refusal("GRID,1,,0.,0.,0.,-1\n"), HasSubstr("fluid"));
}

TEST(NastranGrids, AnEndlessChainOfSystemsIsRefusedNotFollowed) {
  std::string deck = "GRID,1,1\n";
  for (int i = 1; i < 20000; ++i)
    deck += "CORD2R," + std::to_string(i) + "," + std::to_string(i + 1) + ",0.,0.,0.,0.,0.,1.\n,1.,0.,0.\n";
  deck += "CORD2R,20000,,0.,0.,0.,0.,0.,1.\n,1.,0.,0.\n";
  EXPECT_THAT(refusal(deck), HasSubstr("a chain of more than"));
}

TEST(NastranGrids, RepeatedGrids) {
  const auto mesh = read_deck("GRID,1,,1.,0.,0.\nGRID,1,,1.0,0.,0.\n").mesh;
  EXPECT_EQ(mesh.points.size(), 1U);
  EXPECT_EQ(lost(mesh, "GRID"), 1);
  const std::string message = refusal("GRID,1,,1.,0.,0.\nGRID,1,,2.,0.,0.\n");
  EXPECT_THAT(message, HasSubstr("deck.bdf:2:6: "));
  EXPECT_THAT(message, HasSubstr("deck.bdf:1, with other values"));
  EXPECT_THAT(refusal("GRID,-1\n"), HasSubstr("GRID field ID is '-1', expected an integer above zero"));
  EXPECT_THAT(refusal("GRID,,,1.\n"), HasSubstr("GRID field ID is blank"));
}
