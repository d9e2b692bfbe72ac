#include "fem/formats/deck.hpp"
#include "fem/formats/read_mesh.hpp"
#include "tests/unit/fem/formats/nastran/deck_file.hpp"

using namespace tenon;
using namespace tenon::fem;
using ::testing::AllOf;
using ::testing::HasSubstr;

namespace {

// a cylindrical system, large and small fields, a blank property: as mesh generators write
const std::string part_grids =
    "CORD2C,3,0,0.,0.,0.,0.,0.,1.\n,1.,0.,0.\nGRID,1,3,2.,0.,0.\nGRID,2,3,2.,90.,0.\n"
    "GRID    3       0       -2.     0.      0.\nGRID*   4                                             0.             "
    "-2.\n*                     0.\n";
const std::string part_cells =
    "CQUAD4  7       2       1       2       3       4\nCTRIA3,8,,1,2,3\n"
    "CBAR    9       4       1       2       0.      0.      0.\n";

Mesh mesh_of(const std::string& content) {
  const fem::testing::Scratch folder;
  return read_mesh(folder.write("part.bdf", content));
}

bool is_read_as_deck(const std::string& content) {
  const fem::testing::Scratch folder;
  return is_deck(folder.write("part.bdf", content));
}

std::string message(const std::string& content) {
  try {
    mesh_of(content);
  } catch (const InputError& error) {
    return error.what();
  }
  return {};
}

}  // namespace

TEST(NastranMesh, GridsAndElementsWithoutPropertiesAreOne) {
  const Mesh mesh = mesh_of("$ made by a mesh generator\n" + part_grids + part_cells + "ENDDATA\n");
  ASSERT_EQ(mesh.points.size(), 4U);
  EXPECT_LT((mesh.points[1] - Vec3(0.0, 2.0, 0.0)).norm(), 1e-15);
  EXPECT_LT((mesh.points[3] - Vec3(0.0, -2.0, 0.0)).norm(), 1e-15);
  ASSERT_EQ(mesh.cells.size(), 3U);
  EXPECT_EQ(mesh.cells[0].type, CellType::line);
  EXPECT_EQ(mesh.cells[1].nodes, (std::vector{0, 1, 2, 3}));
  EXPECT_EQ(mesh.cells[2].ids, std::vector{8L});
  EXPECT_EQ(mesh.cell_sets.size(), 2U);
  EXPECT_EQ(mesh.cell_sets.at("property 2")[1], std::vector{0});
  EXPECT_EQ(mesh.cell_sets.at("property 4")[0], std::vector{0});
  EXPECT_TRUE(mesh.losses.empty());
}

TEST(NastranMesh, WhateverElseTheFileSaysMakesItADeck) {
  EXPECT_FALSE(is_read_as_deck(part_grids + part_cells));
  EXPECT_FALSE(
      is_read_as_deck("CEND\nbegin bulk\n" + part_grids + "ctria3,8,,1,2,3\nchexa,9,1,1,2,3,4\nPARAM,POST,-1\n"));
  EXPECT_TRUE(is_read_as_deck(part_grids));
  for (const char* card : {"PSHELL,2,1,.1", "pshell,2,1,.1", "MAT1,1,7e10,,.3", "CONM2,1,1,,5.", "SPC1,1,123,1",
                           "RBE2,5,1,123,2", "CELAS2,6,1.,1,1", "INCLUDE 'rest.bdf'", "ASET1,123456,1", "SOL 103"})
    EXPECT_TRUE(is_read_as_deck(part_grids + part_cells + card + "\n")) << card;
  EXPECT_THAT(message(part_grids + part_cells + "PSHELL,2,1,.1\n"), HasSubstr("a whole model"));
}

TEST(NastranMesh, WhatWouldChangeStiffnessIsALoss) {
  const Mesh mesh = mesh_of(part_grids + "GRID,5,,1.,1.,1.,,123\nCHEXA,1,1,1,2,3,4,5\n" +
                            "CQUAD4,2,2,1,2,3,4,45.\nCQUAD4,3,2,1,2,3,4,,.1\nCBAR,4,4,1,2,0.,0.,1.\n,456\n");
  EXPECT_EQ(lost(mesh, "CQUAD4 axes"), 1);
  EXPECT_EQ(lost(mesh, "CBAR axes"), 1);
  std::vector<std::string> physical;
  for (const Loss& loss : mesh.losses)
    if (loss.changes_physics) physical.push_back(loss.name);
  EXPECT_THAT(physical,
              ::testing::UnorderedElementsAre("CHEXA", "CQUAD4 behind its grids", "CBAR behind its grids", "GRID PS"));
}

TEST(NastranMesh, FaultsNameTheirPlace) {
  EXPECT_THAT(message(part_grids + "CTRIA3,8,1,1,2,9\n"), AllOf(HasSubstr("part.bdf:8:"), HasSubstr("GRID 9")));
  EXPECT_THAT(message(part_grids + "CTRIA3,8,1,1,2,2\n"), AllOf(HasSubstr("part.bdf:8:"), HasSubstr("twice")));
  EXPECT_THAT(message(part_grids + "CTRIA3,8,x,1,2,3\n"), AllOf(HasSubstr("part.bdf:8:10"), HasSubstr("PID")));
  EXPECT_THAT(message(part_grids + "CTRIA3,8,1,1,2,3\nCTRIA3,8,1,1,2,4\n"), HasSubstr("stands already"));
}
