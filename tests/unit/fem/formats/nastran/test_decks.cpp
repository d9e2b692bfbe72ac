#include "tests/unit/fem/formats/nastran/deck_file.hpp"
#include "tests/unit/fem/formats/nastran/reference_decks.hpp"

using namespace tenon;
using namespace tenon::fem;
using ::testing::ElementsAre;

namespace {

std::vector<long> ids(const Model& model, const std::vector<int>& nodes) {
  std::vector<long> result;
  for (const int node : nodes) result.push_back(model.node_ids[static_cast<std::size_t>(node)]);
  return result;
}

/// Mass of the bars, ρ A L summed.
double bar_mass(const Model& model) {
  double mass = 0.0;
  for (const Beam& bar : elements_of<Beam>(model)) {
    const auto at = [&](int end) {
      return model.nodes[static_cast<std::size_t>(bar.nodes[static_cast<std::size_t>(end)])];
    };
    mass += model.materials[static_cast<std::size_t>(bar.material)].rho *
            model.beam_sections[static_cast<std::size_t>(bar.section)].A * (at(1) - at(0)).norm();
  }
  return mass;
}

}  // namespace

TEST_F(NastranDecks, TheWholeStructure) {
  const NastranDeck deck = read_nastran(shared_deck("full.dat"));
  EXPECT_EQ(deck.title, "System Modes");
  EXPECT_EQ(deck.mesh.points.size(), 49U);
  ASSERT_EQ(deck.mesh.cells.size(), 1U);
  EXPECT_EQ(deck.mesh.cells[0].size(), 117);
  EXPECT_TRUE(deck.coupled_mass);
  EXPECT_EQ(deck.mesh.cell_sets.at("pbar 102")[0].size(), 16U);
  EXPECT_TRUE(deck.boundary_nodes.empty());
  EXPECT_TRUE(deck.model.supports.empty());
  ASSERT_EQ(deck.model.rigid_links.size(), 1U);  // joins the coincident grids 330 and 33
  const RigidLink& link = deck.model.rigid_links[0];
  EXPECT_EQ(deck.model.node_ids[static_cast<std::size_t>(link.independent)], 330);
  EXPECT_THAT(ids(deck.model, link.dependents), ElementsAre(33));
  EXPECT_EQ(deck.model.materials.at(0).E, 6.894e7);
  EXPECT_NEAR(deck.model.materials.at(0).nu, 6.894 / (2.0 * 2.62) - 1.0, 1e-14);
  for (const Beam& bar : elements_of<Beam>(deck.model)) EXPECT_EQ(bar.mass, BeamMass::nastran);
}

TEST_F(NastranDecks, TheOutboardPart) {
  const NastranDeck deck = read_nastran(shared_deck("outboard.dat"));
  EXPECT_EQ(deck.mesh.points.size(), 27U);
  EXPECT_EQ(deck.mesh.cells.at(0).size(), 51);
  EXPECT_THAT(ids(deck.model, deck.boundary_nodes), ElementsAre(3, 11, 19, 27));
  EXPECT_EQ(deck.mesh.points[5], Vec3(600.0, 300.0, 300.0));  // GRID 11: CD 10, coordinates in the basic system
  // GRID 60 recovers motions in a renamed frame (x′ = y, y′ = z, z′ = x) and carries nothing
  ASSERT_EQ(deck.model.rigid_links.size(), 1U);
  EXPECT_EQ(deck.model.rigid_links[0].directions, 0b000010);
  ASSERT_EQ(deck.model.average_links.size(), 1U);
  EXPECT_EQ(deck.model.average_links[0].directions, 0b001100);
  ASSERT_EQ(deck.model.constraints.size(), 1U);
  const auto& terms = deck.model.constraints[0].terms;
  ASSERT_EQ(terms.size(), 2U);
  EXPECT_EQ(deck.model.node_ids[static_cast<std::size_t>(terms[0].dof.node)], 60);
  EXPECT_EQ(terms[0].dof.direction, 4);  // about x′ = y
  EXPECT_EQ(deck.model.node_ids[static_cast<std::size_t>(terms[1].dof.node)], 1995003);
  EXPECT_EQ(deck.model.nodes.size(), 28U);  // one node for the scalar point the equation names, none for the other 21
}

TEST_F(NastranDecks, TheTwoPartsWeighWhatTheWholeDoes) {
  const NastranDeck inboard = read_nastran(shared_deck("inboard.dat"));
  EXPECT_EQ(inboard.mesh.points.size(), 26U);
  EXPECT_EQ(inboard.mesh.cells.at(0).size(), 66);
  EXPECT_THAT(ids(inboard.model, inboard.boundary_nodes), ElementsAre(3, 11, 19, 27));
  EXPECT_EQ(lost(inboard.mesh, "TLOAD1"), 30);
  EXPECT_EQ(lost(inboard.mesh, "FORCE"), 60);
  const double whole = bar_mass(read_nastran(shared_deck("full.dat")).model);
  const double parts = bar_mass(inboard.model) + bar_mass(read_nastran(shared_deck("outboard.dat")).model);
  EXPECT_NEAR(parts, whole, 1e-12 * whole);
}

TEST_F(NastranDecks, TheAssemblyOfSuperelementsIsRefused) {
  EXPECT_THROW(read_nastran(shared_deck("assemble.dat")), InputError);
}
