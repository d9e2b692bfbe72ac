#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <fstream>
#include <numbers>
#include <sstream>

#include "fem/structure.hpp"
#include "tests/unit/fem/formats/nastran/deck_file.hpp"
#include "tests/unit/fem/formats/nastran/reference_decks.hpp"

using namespace tenon;
using namespace tenon::fem;

// NX Nastran's own eigenvalues of the reference decks: the cards mean what Nastran takes them to mean. The printed
// values have seven digits, half a unit of the last is at most 5e-7 of the value; 1e-6 is twice that.
namespace {

constexpr double printed_digits = 1e-6;

/// Eigenvalues that Nastran printed for a model, in its order. Lines: model,mode,eigenvalue,radians_per_s,hertz.
std::vector<double> printed(const std::string& model) {
  std::ifstream file(shared_deck("eigenvalues.csv"));
  std::vector<double> values;
  for (std::string line; std::getline(file, line);) {
    std::istringstream fields(line);
    std::string name, mode, value;
    std::getline(std::getline(std::getline(fields, name, ','), mode, ','), value, ',');
    if (name == model) values.push_back(std::stod(value));
  }
  return values;
}

/// λ of K x = λ M x, rising. M may be singular, so M x = μ (K + σM) x is solved and λ = 1/μ − σ.
std::vector<double> eigenvalues(const Structure& structure, double shift) {
  const Eigen::MatrixXd M = Eigen::MatrixXd(structure.M).selfadjointView<Eigen::Lower>();
  const Eigen::MatrixXd K = Eigen::MatrixXd(structure.K).selfadjointView<Eigen::Lower>();
  const Eigen::GeneralizedSelfAdjointEigenSolver<Eigen::MatrixXd> solver(M, K + shift * M, Eigen::EigenvaluesOnly);
  const Eigen::VectorXd mu = solver.eigenvalues().reverse();
  std::vector<double> lambda;
  for (const double m : mu)
    if (m > 1e-12 * mu[0]) lambda.push_back(1.0 / m - shift);
  return lambda;
}

/// The part with its boundary nodes held.
Structure held_at_boundary(NastranDeck deck) {
  for (const int node : deck.boundary_nodes)
    for (int direction = 0; direction < 6; ++direction) deck.model.supports.push_back({{node, direction}});
  return assemble(deck.model);
}

}  // namespace

using NastranReferenceModes = NastranDecks;

TEST_F(NastranReferenceModes, TheWholeStructureIsFreeAndHasNastransFlexibleModes) {
  const std::vector<double> expected = printed("full");
  ASSERT_GE(expected.size(), 274U);
  const std::vector<double> lambda = eigenvalues(assemble(read_nastran(shared_deck("full.dat")).model), 50.0);
  ASSERT_GE(lambda.size(), 274U);
  for (std::size_t i = 0; i < 6; ++i) EXPECT_LT(std::abs(lambda[i]), 1e-8 * expected[6]);
  for (std::size_t i = 6; i < 274; ++i) EXPECT_NEAR(lambda[i] / expected[i], 1.0, printed_digits) << "mode " << i + 1;
}

TEST_F(NastranReferenceModes, ThePartsHaveNastransFixedInterfaceModes) {
  for (const auto& [model, count] : {std::pair{"inboard", 3U}, std::pair{"outboard", 16U}}) {
    const std::vector<double> expected = printed(model);
    ASSERT_EQ(expected.size(), count);
    const auto lambda = eigenvalues(held_at_boundary(read_nastran(shared_deck(std::string(model) + ".dat"))), 0.0);
    for (std::size_t i = 0; i < count; ++i)
      EXPECT_NEAR(lambda[i] / expected[i], 1.0, printed_digits) << model << " mode " << i + 1;
    EXPECT_GT(lambda[count], std::pow(2.0 * std::numbers::pi * 50.0, 2));  // the deck's own cut at 50 Hz ends the list
  }
}

TEST_F(NastranReferenceModes, AScalarOfTheQSetStaysOutOfTheStructure) {
  const Structure structure = held_at_boundary(read_nastran(shared_deck("outboard.dat")));
  const bool dropped = std::ranges::any_of(structure.dofs.unused, [&](const Dof& dof) {
    return structure.node_ids[static_cast<std::size_t>(dof.node)] == 1995003 && dof.direction == 0;
  });
  EXPECT_TRUE(dropped);
}
