#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "tests/unit/fem/formats/nastran/reference_decks.hpp"
#include "tests/unit/interfaces/program.hpp"

// Bodies that are given as matrices, through the program.
namespace {

using testing::HasSubstr;

class MatrixScene : public Program {
 protected:
  /// SDLD02: 8 masses of 10 kg between 9 springs of 1e5 N/m, without places.
  MatrixScene() {
    std::string K = banner_ + "8 8 15\n", M = banner_ + "8 8 8\n", rows;
    for (int i = 1; i <= 8; ++i) {
      const std::string k = std::to_string(i);
      K += k + " " + k + " 2e5\n";
      if (i > 1) K += k + " " + std::to_string(i - 1) + " -1e5\n";
      M += k + " " + k + " 10\n";
      rows += k + " ux\n";
    }
    folder_.write("k.mtx", K);
    folder_.write("m.mtx", M);
    folder_.write("rows.txt", rows);
    folder_.write("chain.yaml", scene("", ""));
  }
  static std::string scene(const std::string& more, const std::string& end) {
    return "units: SI\nbodies:\n  chain:\n    matrices: {K: k.mtx, M: m.mtx, labels: rows.txt}\n" + more + end;
  }
  std::string refused(const std::string& text) {
    folder_.write("changed.yaml", text);
    const Ended run = tenon("modes changed.yaml");
    EXPECT_NE(run.status, 0);
    return run.err;
  }

  const std::string banner_ = "%%MatrixMarket matrix coordinate real symmetric\n";
};

TEST_F(MatrixScene, GivesTheChainItsFrequencies) {
  const json modes = object("modes chain.yaml --count 8");
  ASSERT_EQ(modes["frequencies_hz"].size(), 8U);
  for (int j = 1; j <= 8; ++j) {
    const double hertz = 100.0 * std::sin(j * std::numbers::pi / 18.0) / std::numbers::pi;  // √(k/m) = 100
    EXPECT_NEAR(modes["frequencies_hz"][static_cast<std::size_t>(j - 1)].get<double>() / hertz, 1.0, 1e-12);
  }
}

TEST_F(MatrixScene, IsCheckedAsFarAsItsFilesTell) {
  const json check = object("check chain.yaml");
  EXPECT_EQ(check["bodies"][0]["kind"], "matrices");
  EXPECT_EQ(check["bodies"][0]["dofs"], 8);
  EXPECT_THAT(check["checks"].dump(), HasSubstr("places of nodes are not known"));
}

TEST_F(MatrixScene, SaysWhatItCannotDo) {
  EXPECT_THAT(refused(scene("    sections: {a: {shell: 1}}\n", "")), HasSubstr("matrices, which hold all stiffness"));
  EXPECT_THAT(refused(scene("    ports: {p: {node: 3}}\n", "ground: [chain.p]\n")),
              HasSubstr("the place of node 3 is not known"));
  EXPECT_THAT(refused("units: SI\nbodies: {b: {matrices: {K: k.mtx, M: m.mtx}}}\n"),
              HasSubstr("matrices without 'labels'"));
  EXPECT_THAT(refused("units: SI\nbodies: {b: {matrices: {K: kk.mtx, M: m.mtx, labels: rows.txt}}}\n"),
              HasSubstr("Did you mean"));
  folder_.write("k.mtx", banner_ + "8 8 2\n1 1 1\n");
  EXPECT_THAT(refused(scene("", "")), HasSubstr("k.mtx:4:1: the file ends after 1 of 2 entries"));
}

// The two superelements of a truss with booms, as NX Nastran wrote them, joined at their four nodes: a tree and three
// closures. Its printed eigenvalues of the assembly have seven digits.
TEST_F(MatrixScene, JoinsTheSuperelementsOfATruss) {
  const fs::path inboard = tenon::fem::shared_deck("inboard.asm"), outboard = tenon::fem::shared_deck("outboard.asm");
  if (!fs::exists(inboard)) GTEST_SKIP() << "no decks: set TENON_SHARED";  // Nastran's, not to be copied here
  std::string text = "units: SI\nbodies:\n", joints = "joints:\n";
  for (const auto& [body, file] : {std::pair("inboard", inboard), std::pair("outboard", outboard)}) {
    text +=
        std::string("  ") + body + ":\n    matrices: {nastran: '" + fs::absolute(file).string() + "'}\n    ports:\n";
    for (const char* node : {"3", "11", "19", "27"}) text += std::string("      p") + node + ": {node: " + node + "}\n";
    text += "    parent_port: p3\n";
  }
  for (const char* node : {"3", "11", "19", "27"})
    joints +=
        std::string("  j") + node + ": {parent: inboard.p" + node + ", child: outboard.p" + node + ", weld: true}\n";
  folder_.write("truss.yaml", text + joints);

  std::vector<double> printed;
  std::ifstream file(tenon::fem::shared_deck("eigenvalues.csv"));
  for (std::string line; std::getline(file, line);) {
    if (line.rfind("assemble,", 0) != 0) continue;
    std::istringstream row(line);
    std::string field;
    for (int i = 0; i < 3; ++i) std::getline(row, field, ',');
    printed.push_back(std::sqrt(std::max(0.0, std::stod(field))) / (2.0 * std::numbers::pi));
  }
  ASSERT_EQ(printed.size(), 54U);
  const json modes = object("modes truss.yaml --full --count 30");
  for (std::size_t k = 6; k < 30; ++k)
    EXPECT_NEAR(modes["frequencies_hz"][k].get<double>() / printed[k], 1.0, 1e-5) << "mode " << k + 1;
}

}  // namespace
