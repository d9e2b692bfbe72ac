#include <cmath>

#include "tests/unit/fem/formats/nastran/deck_file.hpp"

using namespace tenon;
using namespace tenon::fem;
using ::testing::ElementsAre;
using ::testing::HasSubstr;

namespace {

constexpr const char* five_grids = "GRID,1\nGRID,2,,1.\nGRID,3,,2.\nGRID,4,,3.\nGRID,5,,4.\n";
// z′ = x, x′ = y, y′ = z; 30° about z
constexpr const char* cyclic_and_skew =
    "CORD2R,8,,0.,0.,0.,1.,0.,0.\n,0.,1.,0.\nCORD2R,9,,0.,0.,0.,0.,0.,1.\n,.8660254037844387,.5,0.\n"
    "GRID,18,,7.,0.,0.,8\nGRID,19,,8.,0.,0.,9\n";

const NastranOptions first_sets{.allow_losses = false, .spc_set = 1, .mpc_set = {}};
const NastranOptions mpc_one{.allow_losses = false, .spc_set = {}, .mpc_set = 1};

Model read_model(const std::string& cards, const NastranOptions& options = {}) {
  return read_deck(std::string(five_grids) + cyclic_and_skew + cards, options).model;
}

std::string refused(const std::string& cards, const NastranOptions& options = {}) {
  return refusal(std::string(five_grids) + cyclic_and_skew + cards, options);
}

}  // namespace

TEST(NastranLinks, RigidLinkTakesTheDirectionsOfItsDependents) {
  const auto links = read_model("RBE2,7,1,13,2,3,18,19,4\n,1.2-5\n").rigid_links;
  ASSERT_EQ(links.size(), 4U);  // one for each frame in turn; the real at the end is ALPHA
  EXPECT_THAT(links[0].dependents, ElementsAre(1, 2));
  EXPECT_EQ(links[0].directions, 0b000101);
  EXPECT_TRUE(links[0].axes.isIdentity());
  EXPECT_EQ(links[1].directions, 0b000011);  // x′ = y and z′ = x
  EXPECT_TRUE(links[1].axes.isIdentity());
  EXPECT_EQ(links[2].directions, 0b000101);
  EXPECT_LT((links[2].axes.col(0) - Vec3(std::sqrt(3.0) / 2.0, 0.5, 0.0)).norm(), 1e-14);
  EXPECT_THAT(links[3].dependents, ElementsAre(3));
  for (const auto& link : links) EXPECT_EQ(link.independent, 0);
}

TEST(NastranLinks, AFullRigidLinkNeedsNoAxes) {
  const auto links = read_model("RBE2,7,1,123456,2,THRU,19\n").rigid_links;
  ASSERT_EQ(links.size(), 1U);
  EXPECT_THAT(links[0].dependents, ElementsAre(1, 2, 3, 4, 5, 6));
  EXPECT_EQ(links[0].directions, all_six);
}

TEST(NastranLinks, AverageLinkWithGroups) {
  const auto links = read_model("RBE3,7,,5,123456,1.,123,1,2\n,,.5,123456,3,18\n,UM,1,123,2,123\n").average_links;
  ASSERT_EQ(links.size(), 1U);
  EXPECT_EQ(links[0].reference, 4);
  EXPECT_EQ(links[0].directions, all_six);
  ASSERT_EQ(links[0].nodes.size(), 4U);
  EXPECT_EQ(links[0].nodes[1].node, 1);
  EXPECT_EQ(links[0].nodes[1].weight, 1.0);
  EXPECT_EQ(links[0].nodes[1].directions, 0b000111);
  EXPECT_EQ(links[0].nodes[3].node, 5);
  EXPECT_EQ(links[0].nodes[3].weight, 0.5);
  EXPECT_EQ(links[0].nodes[3].directions, all_six);
}

TEST(NastranLinks, AverageLinkOntoAReferenceInAnotherFrame) {
  const auto renamed = read_model("RBE3,7,,18,26,1.,123456,1,2\n").average_links;
  EXPECT_EQ(renamed.at(0).directions, 0b001100);  // y′ = z, about z′ = x

  const auto skew = read_model("RBE3,7,,19,1,1.,123456,1,2\n");
  ASSERT_EQ(skew.nodes.size(), 8U);  // a node for the whole average beside the seven grids
  EXPECT_EQ(skew.nodes[7], skew.nodes[6]);
  EXPECT_LT(skew.node_ids[7], 0);
  EXPECT_EQ(skew.average_links.at(0).reference, 7);
  EXPECT_EQ(skew.average_links.at(0).directions, all_six);
  ASSERT_EQ(skew.rigid_links.size(), 1U);
  EXPECT_EQ(skew.rigid_links[0].independent, 7);
  EXPECT_THAT(skew.rigid_links[0].dependents, ElementsAre(6));
  EXPECT_EQ(skew.rigid_links[0].directions, 0b000001);
  EXPECT_NEAR(skew.rigid_links[0].axes(1, 0), 0.5, 1e-15);
}

TEST(NastranLinks, BadLinksAreRefused) {
  EXPECT_THAT(refused("RBE2,7,1,123456,1,2\n"), HasSubstr("makes GRID 1 follow itself"));
  EXPECT_THAT(refused("RBE2,7,1,1237,2\n"), HasSubstr("directions as digits 1 to 6"));
  EXPECT_THAT(refused("RBE2,7,1,,2\n"), HasSubstr("RBE2 field CM is blank"));
  EXPECT_THAT(refused("RBE2,7,1,123\n"), HasSubstr("RBE2 field ID is blank"));
  EXPECT_THAT(refused("RBE2,7,1,123,99\n"), HasSubstr("names GRID 99"));
  EXPECT_THAT(refused("RBE2,7,44,123,2\n"), HasSubstr("field GN names GRID 44"));
  EXPECT_THAT(refused("RBE3,7,,5,123,1,123,1,2\n"), HasSubstr("a weight with a decimal point"));
  EXPECT_THAT(refused("RBE3,7,,5,123,1.,123,5\n"), HasSubstr("over itself"));
  EXPECT_THAT(refused("RBE3,7,,5,123,1.,123\n"), HasSubstr("averages no grid"));
  EXPECT_THAT(refused("RBE3,7,,5,123,1.,1,19\n"), HasSubstr("skew"));
}

TEST(NastranLinks, SupportsOfTheSelectedSetOnly) {
  const std::string cards =
      "SPC1,1,12,2,THRU,99999999\nSPC,1,1,3,0.\nSPC1,2,123456,1\nSPC,2,1,1,,2,1,.5\nSPCADD,3,1,2\n";
  const auto directions = [&](long set) {
    std::map<int, int> bits;
    for (const Support& s : read_model(cards, {.allow_losses = false, .spc_set = set, .mpc_set = {}}).supports)
      bits[s.dof.node] |= 1 << s.dof.direction;
    return bits;
  };
  const auto one = directions(1);
  EXPECT_EQ(one.at(0), 0b000100);
  EXPECT_EQ(one.at(4), 0b000011);
  EXPECT_EQ(one.at(5), 0b000110);  // GRID 18: x′ = y, y′ = z
  EXPECT_EQ(directions(2).size(), 2U);
  EXPECT_EQ(directions(3).at(0), 0b111111);
  EXPECT_THAT(refused(cards, {.allow_losses = false, .spc_set = 4, .mpc_set = {}}),
              HasSubstr("SPC set 4 is selected, but no SPC card"));
  EXPECT_THAT(refused("SPC1,1,12,100,THRU,99999999\n", first_sets), HasSubstr("none of which is defined"));
  EXPECT_THAT(refused("SPC1,1,12,9,THRU,2\n", first_sets), HasSubstr("at least 9"));
}

TEST(NastranLinks, CaseControlSelects) {
  const std::string bulk = std::string("BEGIN BULK\n") + five_grids +
                           "SPC1,1,1,1\nSPC1,2,2,2\nMPC,5,1,1,1.,2,1,-1.\nMPC,6,1,2,1.,2,2,-1.\nENDDATA\n";
  const auto none = read_deck("CEND\n" + bulk);
  EXPECT_TRUE(none.model.supports.empty());
  EXPECT_TRUE(none.model.constraints.empty());
  EXPECT_EQ(lost(none.mesh, "SPC set 1"), 1);
  EXPECT_EQ(lost(none.mesh, "MPC set 6"), 1);
  const auto some = read_deck("CEND\nSPC = 2\nMPC=6\nSUBCASE 1\n METHOD=1\nSUBCASE 2\n SPC=2\n" + bulk);
  ASSERT_EQ(some.model.supports.size(), 1U);
  EXPECT_EQ(some.model.supports[0].dof.node, 1);
  ASSERT_EQ(some.model.constraints.size(), 1U);
  EXPECT_EQ(some.model.constraints[0].terms[0].dof.direction, 1);
  EXPECT_THAT(refusal("CEND\nSUBCASE 1\nSPC=1\nSUBCASE 2\nSPC=2\n" + bulk),
              HasSubstr("deck.bdf:5: the subcases select different SPC sets"));
  EXPECT_THAT(refusal("CEND\nSUBC 1\nSPC=1\nSUBCAS 2\nSPC=2\n" + bulk),
              HasSubstr("deck.bdf:5: the subcases select different SPC sets"))
      << "the first four letters";
  EXPECT_THAT(refusal("CEND\nSPC=ALL\n" + bulk), HasSubstr("expected the number of a set"));
  EXPECT_THAT(refusal("CEND\nMPC=9\n" + bulk), HasSubstr("deck.bdf:2: MPC set 9 is selected"));
  EXPECT_THAT(refusal("CEND\nK2GG=STIF\n" + bulk), HasSubstr("K2GG"));
  EXPECT_EQ(read_deck("CEND\nSPC=1\n" + bulk, {.allow_losses = false, .spc_set = 2, .mpc_set = {}})
                .model.supports[0]
                .dof.node,
            1);
}

TEST(NastranLinks, RigidBarsAreLinksOfTwoGrids) {
  const auto link = [](const std::string& card) {
    const auto links = read_model(card).rigid_links;
    EXPECT_EQ(links.size(), 1U);
    return std::tuple(links.at(0).independent, links.at(0).dependents, links.at(0).directions, links.at(0).id);
  };
  const auto from_1 = link("RBE2,7,1,123456,3\n"), from_3 = link("RBE2,7,3,123456,1\n");
  for (const char* card :
       {"RBAR,7,1,3,123456\n", "RBAR,7,1,3,123456,,,123456\n", "RBAR1,7,1,3,123456\n", "RBAR1,7,1,3\n"})
    EXPECT_EQ(link(card), from_1) << card;
  EXPECT_EQ(link("RBAR,7,1,3,,123456\n"), from_3);
  EXPECT_EQ(link("RBAR,7,1,3,123456,,,123\n"), link("RBE2,7,1,123,3\n"));
  EXPECT_EQ(link("RBAR1,7,1,3,246\n"), link("RBE2,7,1,246,3\n"));
  EXPECT_THAT(refused("RBAR,7,1,3,123,456\n"), HasSubstr("has independent directions at both ends"));
  EXPECT_THAT(refused("RBAR,7,1,3,12345\n"), HasSubstr("or fewer than six"));
  EXPECT_THAT(refused("RBAR,7,1,1,123456\n"), HasSubstr("makes GRID 1 follow itself"));
}

TEST(NastranLinks, SetsAreAddedOneByOne) {
  const std::string bulk = "BEGIN BULK\nGRID,1\nGRID,2,,1.\nSPC1,1,1,1\nSPC1,2,2,1\nSPCADD,7,1,";
  EXPECT_EQ(read_deck("CEND\nSPC=7\n" + bulk + "2\nENDDATA\n").model.supports.size(), 2U);
  EXPECT_THAT(refusal("CEND\nSPC=7\n" + bulk + "THRU,2\nENDDATA\n"),
              HasSubstr("deck.bdf:8:12: SPCADD field S is 'THRU'"));
}

TEST(NastranLinks, WithoutCaseControlASetMustBeChosen) {
  EXPECT_THAT(refused("SPC1,1,123,1\n"), HasSubstr("no case control selects it: write"));
  EXPECT_THAT(refused("MPC,1,1,1,1.,2,1,-1.\n"), HasSubstr("no case control selects it: write"));
  EXPECT_TRUE(read_model("SPC1,1,123,1\n", {.allow_losses = true, .spc_set = {}, .mpc_set = {}}).supports.empty());
}

TEST(NastranLinks, EquationsWithContinuations) {
  const auto constraints = read_model("MPC,1,1,1,1.,2,1,-2.\n,,3,2,.5,4,6,4.\n,,5,3,-1.\n", mpc_one).constraints;
  ASSERT_EQ(constraints.size(), 1U);
  const auto& terms = constraints[0].terms;
  ASSERT_EQ(terms.size(), 5U);
  EXPECT_EQ(terms[0].dof.node, 0);
  EXPECT_EQ(terms[1].coefficient, -2.0);
  EXPECT_EQ(terms[3].dof.node, 3);
  EXPECT_EQ(terms[3].dof.direction, 5);
  EXPECT_EQ(terms[4].dof.direction, 2);
  EXPECT_EQ(terms[4].coefficient, -1.0);
}

TEST(NastranLinks, TheFirstDofOfAnEquationIsTheDependentOne) {
  const auto terms = read_model("MPC,1,2,1,1.,2,2,-50.\n,,2,1,2.\n", mpc_one).constraints.at(0).terms;
  ASSERT_EQ(terms.size(), 2U);  // equal dofs are added up
  EXPECT_EQ(terms[0].dof.direction, 0);
  EXPECT_EQ(terms[0].coefficient, 3.0);
  EXPECT_EQ(terms[1].coefficient, -50.0);
}

TEST(NastranLinks, EquationsInOtherFrames) {
  const auto renamed = read_model("MPC,1,18,1,1.,1,1,-1.\n", mpc_one).constraints.at(0);
  ASSERT_EQ(renamed.terms.size(), 2U);
  EXPECT_EQ(renamed.terms[0].dof.direction, 1);
  const auto skew = read_model("MPC,1,19,2,2.,1,1,-1.\n", mpc_one).constraints.at(0);
  ASSERT_EQ(skew.terms.size(), 3U);  // 2 (−sin 30° ux + cos 30° uy) − ux(1)
  EXPECT_EQ(skew.terms[0].dof.direction, 1);
  EXPECT_NEAR(skew.terms[0].coefficient, std::sqrt(3.0), 1e-14);
  EXPECT_NEAR(skew.terms[1].coefficient, -1.0, 1e-14);
}

TEST(NastranLinks, AScalarPointIsDefinedByItsFirstEquation) {
  const auto model =
      read_model("SPOINT,101,THRU,110\nMPC,1,1,1,1.,2,1,-1.\n,,105,0,1.\nMPC,1,3,1,1.,105,,1.\n", mpc_one);
  ASSERT_EQ(model.nodes.size(), 8U);
  EXPECT_EQ(model.node_ids[7], 105);
  EXPECT_EQ(model.constraints.at(0).terms[0].dof.node, 7);
  EXPECT_EQ(model.constraints.at(1).terms[0].dof.node, 2);
  EXPECT_EQ(model.constraints.at(1).terms[1].dof.node, 7);
}

TEST(NastranLinks, AScalarOfTheQSetRecoversButDoesNotLoad) {
  const std::string q =
      "MAT1,1,2.+11,,.3\nPBAR,1,1,1.,1.,1.,1.\nCBAR,1,1,1,2,0.,0.,1.\nSPOINT,101,THRU,110\nQSET1,,101,THRU,110\n"
      "RBE2,7,1,123,4\n";
  const auto model = read_model(q + "MPC,1,4,4,1.,103,0,1.\n", mpc_one);
  ASSERT_EQ(model.constraints.size(), 1U);
  EXPECT_EQ(model.constraints[0].terms[0].dof.node, 3);  // the grid follows the generalised coordinate
  EXPECT_EQ(model.constraints[0].terms[1].dof.node, 7);
  EXPECT_THAT(refused(q + "MPC,1,2,4,1.,103,0,1.\n", mpc_one), HasSubstr("q-set"));  // a bar ends there
  EXPECT_THAT(refused(q + "MPC,1,4,1,1.,103,0,1.\n", mpc_one), HasSubstr("q-set"));  // the RBE2 holds it
}

TEST(NastranLinks, BadEquationsAreRefused) {
  EXPECT_THAT(refused("MPC,1,1,12,1.,2,1,-1.\n", mpc_one), HasSubstr("MPC field C is '12', expected one digit"));
  EXPECT_THAT(refused("MPC,1,1,1,0.,2,1,-1.\n", mpc_one), HasSubstr("other than zero"));
  EXPECT_THAT(refused("MPC,1,1,1,1.,77,1,-1.\n", mpc_one), HasSubstr("names GRID 77"));
  EXPECT_THAT(refused("MPC,1,1,1,1.,1,1,-1.\n", mpc_one), HasSubstr("0 = 0"));
  EXPECT_THAT(refused("SPOINT,101\nMPC,1,101,3,1.,1,1,-1.\n", mpc_one), HasSubstr("scalar point"));
  EXPECT_THAT(refused("SPOINT,101\nMPC,1,1,1,1.,101,0,0.\n,,1,1,-1.\n", mpc_one), HasSubstr("0 = 0"));
  EXPECT_THAT(refused("SPOINT,1\n"), HasSubstr("which is a GRID"));
}

TEST(NastranLinks, BoundaryInTheOrderOfTheCards) {
  const std::string grids = std::string(five_grids) + "SPOINT,101,102\n";
  const auto boundary = [&](const std::string& cards) { return read_deck(grids + cards).boundary_nodes; };
  EXPECT_THAT(boundary("BSET1,123456,4,2,3\n"), ElementsAre(3, 1, 2));
  EXPECT_THAT(boundary("ASET1,123456,2,THRU,4\n"), ElementsAre(1, 2, 3));
  EXPECT_THAT(boundary("ASET,5,123,1,123456\nASET,5,456\n"), ElementsAre(4, 0));
  EXPECT_THAT(boundary("ASET1,123456,5,101,1\n"), ElementsAre(4, 0));
  const auto deck = read_deck(grids + "BSET1,123,4,2\nSUPORT,4,123\nQSET1,0,101,102\n");
  EXPECT_THAT(deck.mesh.point_sets.at("boundary"), ElementsAre(3, 1));
  EXPECT_EQ(lost(deck.mesh, "ASET/BSET"), 2);
  EXPECT_EQ(lost(deck.mesh, "SUPORT"), 1);
  EXPECT_EQ(lost(deck.mesh, "QSET1"), 1);
  EXPECT_EQ(lost(deck.mesh, "SPOINT"), 2);
  EXPECT_THAT(refusal(grids + "BSET1,123456,4,20\n"), HasSubstr("names GRID 20"));
}
