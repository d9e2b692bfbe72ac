#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/unit/interfaces/program.hpp"

// `tenon check` of meshes, decks and scenes: what it finds, how it ends.
namespace {

using testing::HasSubstr;

const char* const plate = R"(CEND
BEGIN BULK
PARAM,COUPMASS,1
GRID,101,,0.,0.,0.
GRID,102,,1.,0.,0.
GRID,103,,1.,1.,0.
GRID,104,,0.,1.,0.
GRID,201,,5.,0.,0.
GRID,202,,6.,0.,0.
MAT1,1,7.+10,,.3,2700.
PSHELL,1,1,.01,1,,1
PBAR,2,1,1.-4,1.-8,1.-8,2.-8
CQUAD4,11,1,101,102,103,104
)";

class Check : public Program {
 protected:
  json deck(const std::string& more, int status) {
    return object("check " + folder_.write("part.bdf", plate + more + "ENDDATA\n").string(), status);
  }
  static json found(const json& report, const std::string& check) {
    for (const json& finding : report["checks"])
      if (finding["check"] == check) return finding;
    return {};
  }
};

TEST_F(Check, ASoundDeckPasses) {
  const json report = deck("", 0);
  EXPECT_TRUE(report["good"].get<bool>());
  EXPECT_NEAR(report["mass_file_units"].get<double>(), 27.0, 1e-12);
  EXPECT_EQ(found(report, "free_nodes")["count"], 2);
  EXPECT_LT(found(report, "grounding")["value"].get<double>(), 1e-12);
}

TEST_F(Check, PartsAreNamedAndEndWithStatusOne) {
  const json parts = found(deck("CBAR,12,2,201,202,0.,0.,1.\n", 1), "parts");
  EXPECT_EQ(parts["severity"], "error");
  EXPECT_EQ(parts["where"], json({"node 101 (4 nodes)", "node 201 (2 nodes)"}));
}

TEST_F(Check, DuplicatesAndFoldedElementsEndWithStatusOne) {
  EXPECT_EQ(found(deck("CQUAD4,13,1,102,103,104,101\n", 1), "duplicate_elements")["where"],
            json({"elements 11 and 13"}));
}

TEST_F(Check, AGroundingEquationIsNamedBesideTheDofsItLoads) {
  const json report = deck("MPC,3,102,3,1.,104,3,-1.\n", 0);
  EXPECT_TRUE(report["good"].get<bool>());  // not selected: no part of the model
  const std::string held =
      folder_.write("held.bdf", "CEND\nMPC=3\n" + std::string(plate).substr(5) + "MPC,3,102,3,1.,104,3,-1.\nENDDATA\n")
          .string();
  const json judged = object("check " + held, 1);
  EXPECT_EQ(found(judged, "constraints_hold")["where"], json({"linear constraint 3 (node 102 uz)"}));
  EXPECT_FALSE(found(judged, "grounding")["good"].get<bool>());
}

TEST_F(Check, AMeshAloneIsLookedAtForItsGeometry) {
  const fs::path mesh = fs::path(TENON_SOURCE_DIR) / "data/reference/fv12.msh";
  const json report = object("check " + mesh.string());
  EXPECT_EQ(found(report, "free_edges")["count"], 96);  // 24 quads a side
  EXPECT_TRUE(found(report, "grounding").empty());
  const Ended run = tenon("check " + mesh.string());
  EXPECT_THAT(run.out, HasSubstr("a mesh alone"));
}

TEST_F(Check, AHeldBodyIsCheckedWithoutBeingJoined) {
  const json report = object("check " + (fs::path(TENON_SOURCE_DIR) / "data/reference/fv16.yaml").string());
  EXPECT_TRUE(found(report, "grounding")["good"].get<bool>());
}

}  // namespace
