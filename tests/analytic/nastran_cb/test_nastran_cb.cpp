// A truss with two booms as two substructures, against NX Nastran's printed eigenvalues (data of pyYeti, read where it
// lies).
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <numbers>
#include <sstream>

#include "assembly/second_order.hpp"
#include "fem/formats/nastran.hpp"
#include "fem/structure.hpp"
#include "reduction/modes.hpp"
#include "reduction/reduce.hpp"
#include "tests/unit/fem/formats/nastran/reference_decks.hpp"

using namespace tenon;

namespace {

const std::filesystem::path folder = fem::shared_deck("");

/// Eigenvalues [rad²/s²] that Nastran printed for one of the decks.
std::vector<double> printed(const std::string& deck) {
  std::vector<double> values;
  std::ifstream file(folder / "eigenvalues.csv");
  for (std::string line; std::getline(file, line);) {
    if (line.rfind(deck + ",", 0) != 0) continue;
    std::istringstream row(line);
    std::string field;
    for (int i = 0; i < 3; ++i) std::getline(row, field, ',');
    values.push_back(std::stod(field));
  }
  return values;
}

class NastranCb : public fem::NastranDecks {
 protected:
  static fem::Model with_ports(const std::string& deck) {
    fem::NastranDeck read = fem::read_nastran(folder / (deck + ".dat"));
    for (const int node : read.boundary_nodes)
      read.model.ports.push_back({fmt::format("{}", read.model.node_ids[static_cast<std::size_t>(node)]), node});
    return read.model;
  }

  /// A part by Craig-Bampton on its four interface nodes.
  static reduction::ReducedBody part(const std::string& deck, reduction::ReduceOptions options) {
    options.basis = reduction::Basis::craig_bampton;  // as the decks' own reduction
    reduction::ReducedBody body = reduction::reduce(fem::assemble(with_ports(deck)), "3", options);
    body.name = deck;
    return body;
  }

  /// Both parts welded at the four nodes: one joint places the outboard part, three close loops.
  static assembly::SystemModes joined(const reduction::ReduceOptions& inboard,
                                      const reduction::ReduceOptions& outboard) {
    assembly::Network network;
    network.bodies = {part("inboard", inboard), part("outboard", outboard)};
    for (const char* node : {"3", "11", "19", "27"})
      network.joints.push_back({.name = fmt::format("node {}", node),
                                .parent = {0, reduction::port_index(network.bodies[0], node)},
                                .child = {1, reduction::port_index(network.bodies[1], node)}});
    return assembly::modes(assembly::second_order(network));
  }

  /// Worst relative error in frequency of the first `count` flexible modes against the unreduced deck.
  static double worst_error(const assembly::SystemModes& modes, int count) {
    const reduction::Modes full =
        reduction::solve_modes(fem::assemble(fem::read_nastran(folder / "full.dat").model), {.count = count + 6});
    double worst = 0.0;
    for (int i = 0; i < count; ++i)
      worst = std::max(worst, std::abs(modes.omega(modes.rigid + i) / std::sqrt(full.lambda(full.rigid + i)) - 1.0));
    return worst;
  }
};

}  // namespace

TEST_F(NastranCb, WholeModelHasNastransFrequencies) {
  const reduction::Modes modes =
      reduction::solve_modes(fem::assemble(fem::read_nastran(folder / "full.dat").model), {.count = 50});
  EXPECT_EQ(modes.rigid, 6);
  const std::vector<double> nastran = printed("full");
  ASSERT_EQ(modes.lambda.size(), 50);
  for (int i = 6; i < 50; ++i)
    EXPECT_NEAR(std::sqrt(modes.lambda(i) / nastran[static_cast<std::size_t>(i)]), 1.0, 1e-6) << "mode " << i + 1;
}

TEST_F(NastranCb, PartsHaveNastransFixedInterfaceFrequencies) {
  for (const auto& [deck, count] : {std::pair<std::string, int>{"inboard", 3}, {"outboard", 16}}) {
    fem::Model model = fem::read_nastran(folder / (deck + ".dat")).model;
    for (const int node : fem::read_nastran(folder / (deck + ".dat")).boundary_nodes)
      for (int d = 0; d < 6; ++d) model.supports.push_back({{node, d}});
    const reduction::Modes modes = reduction::solve_modes(fem::assemble(model), {.count = count});
    const std::vector<double> nastran = printed(deck);
    ASSERT_EQ(static_cast<int>(nastran.size()), count);
    for (int i = 0; i < count; ++i)
      EXPECT_NEAR(std::sqrt(modes.lambda(i) / nastran[static_cast<std::size_t>(i)]), 1.0, 1e-6)
          << deck << " mode " << i + 1;
    // the decks' own cut at 50 Hz keeps exactly these
    const double cut = 2.0 * std::numbers::pi * 50.0;
    EXPECT_EQ(reduction::solve_modes(fem::assemble(model), {.band = cut}).lambda.size(), count);
  }
}

/// The tolerances are those of Craig-Bampton's truncation at each cut; the mass matrix of both parts is singular
/// (Nastran's bars carry no torsional inertia).
TEST_F(NastranCb, JoinedPartsConvergeToTheWhole) {
  const double hertz = 2.0 * std::numbers::pi;
  const assembly::SystemModes at_50 = joined({.band = 50.0 * hertz}, {.band = 50.0 * hertz});
  EXPECT_EQ(at_50.rigid, 6);
  EXPECT_LT(worst_error(at_50, 6), 1e-4);

  const assembly::SystemModes at_200 = joined({.band = 200.0 * hertz}, {.band = 200.0 * hertz});
  EXPECT_EQ(at_200.rigid, 6);
  EXPECT_LT(worst_error(at_200, 20), 5e-5);

  const assembly::SystemModes all = joined({.all_modes = true}, {.all_modes = true});
  EXPECT_EQ(all.rigid, 6);
  EXPECT_LT(worst_error(all, 44), 1e-6);
}

TEST_F(NastranCb, CutsKeepTheModesThatTheDecksKeep) {
  const double hertz = 2.0 * std::numbers::pi;
  EXPECT_EQ(part("inboard", {.band = 50.0 * hertz}).certificate.modes_found, 3);
  EXPECT_EQ(part("outboard", {.band = 50.0 * hertz}).certificate.modes_found, 16);
  EXPECT_EQ(part("inboard", {.band = 200.0 * hertz}).certificate.modes_found, 44);
  EXPECT_EQ(part("outboard", {.band = 200.0 * hertz}).certificate.modes_found, 31);
}
