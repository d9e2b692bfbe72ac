#include <cmath>
#include <numbers>
#include <numeric>

#include "tests/unit/fem/formats/nastran/deck_file.hpp"

using namespace tenon;
using namespace tenon::fem;
using ::testing::ElementsAre;
using ::testing::HasSubstr;

namespace {

constexpr const char* bar_cards =
    "MAT1,1,2.1+11,,.3,7800.\nPBAR,10,1,4.-4,1.-8,2.-8,3.-8,1.5\nGRID,1\nGRID,2,,2.\nGRID,3,,0.,0.,1.\n";
constexpr const char* plate_cards = "MAT1,1,7.+10,,.25,2700.\nGRID,1\nGRID,2,,2.\nGRID,3,,2.,1.\nGRID,4,,0.,1.\n";

Beam only_bar(const std::string& cards) {
  const auto bars = elements_of<Beam>(read_deck(bar_cards + cards).model);
  EXPECT_EQ(bars.size(), 1U);
  return bars.at(0);
}

ShellSection shell_section(const std::string& pshell) {
  return read_deck(plate_cards + pshell + "\nCQUAD4,1,5,1,2,3,4\nPARAM,COUPMASS,1\n").model.shell_sections.at(0);
}

double total_mass(const Model& model) {
  double sum = 0.0;
  for (const PointMass& p : elements_of<PointMass>(model)) sum += p.mass;
  return sum;
}

}  // namespace

TEST(NastranElements, PinFlagsReleaseTheEndsOfABar) {
  EXPECT_THAT(only_bar("CBAR,5,10,1,2,3\n").releases, ElementsAre(0, 0));
  EXPECT_THAT(only_bar("CBAR,5,10,1,2,3\n,456,5\n").releases, ElementsAre(0b111000, 0b010000));
  EXPECT_THAT(only_bar("CBAR,5,10,1,2,3\n,,61\n").releases, ElementsAre(0, 0b100001));
}

TEST(NastranElements, MaterialFromAnyTwoConstants) {
  const auto model =
      read_deck("GRID,1\nMAT1,1,2.+11,,.25,7800.\nMAT1,2,2.+11,8.+10\nMAT1,3,,8.+10,.25\nMAT1,4,2.+11\nMAT1,5,,8.+10\n")
          .model;
  for (int i = 0; i < 3; ++i) {
    const Material& m = model.materials[static_cast<std::size_t>(i)];
    EXPECT_DOUBLE_EQ(m.E, 2e11) << m.name;
    EXPECT_DOUBLE_EQ(m.G, 8e10) << m.name;
    EXPECT_DOUBLE_EQ(m.nu, 0.25) << m.name;
  }
  EXPECT_EQ(model.materials[0].rho, 7800.0);
  EXPECT_EQ(model.materials[3].G, 0.0);  // E alone
  EXPECT_EQ(model.materials[4].E, 0.0);  // G alone
  EXPECT_THAT(refusal("GRID,1\nMAT1,1,,,.3\n"), HasSubstr("MAT1 field E is blank"));
  EXPECT_THAT(refusal("GRID,1\nMAT1,1,-1.,,.3\n"), HasSubstr("not negative"));
  EXPECT_THAT(refusal("GRID,1\nMAT1,1,1.+7,-4.\n"), HasSubstr("MAT1 field G is '-4.'"));
  EXPECT_THAT(refusal("GRID,1\nMAT1,1,1.+7,,.3,-1.\n"), HasSubstr("MAT1 field RHO is '-1.'"));
  for (const char* nu : {".7", "-1.", ".51"})
    EXPECT_THAT(refusal(fmt::format("GRID,1\nMAT1,1,1.+7,,{}\n", nu)), HasSubstr("MAT1 field NU is"));
  EXPECT_EQ(read_deck("GRID,1\nMAT1,1,1.+7,,.5\n").model.materials[0].nu, 0.5);
}

TEST(NastranElements, BarSectionMapsPlaneOneToIz) {
  const auto model = read_deck(
                         "GRID,1\nMAT1,1,2.+11,,.25\nPBAR,7,1,1.,2.,3.,4.,5.\n,1.,1.,-1.,1.\n,.8,.9\nPBAR,8,1,1.,2.,3.,"
                         "4.\n,\n,.8,.9,.5\n")
                         .model;
  const BeamSection& s = model.beam_sections.at(0);
  EXPECT_EQ(s.A, 1.0);
  EXPECT_EQ(s.Iz, 2.0);
  EXPECT_EQ(s.Iy, 3.0);
  EXPECT_EQ(s.J, 4.0);
  EXPECT_EQ(s.nsm, 5.0);
  EXPECT_EQ(s.kappa_y, 0.8);
  EXPECT_EQ(s.kappa_z, 0.9);
  EXPECT_EQ(s.name, "pbar 7");
  EXPECT_EQ(model.beam_sections.at(1).Iyz, 0.5);
  EXPECT_EQ(model.beam_sections.at(1).kappa_y, 0.0);  // K1, K2 are ignored beside I12
  EXPECT_THAT(refusal("GRID,1\nMAT1,1,2.+11,,.25\nPBAR,8,1,1.,2.,3.,4.\n,\n,,,3.\n"), HasSubstr("I12"));
  EXPECT_THAT(refusal("GRID,1\nPBAR,8,4,1.,2.,3.,4.\n"), HasSubstr("names material 4"));
}

TEST(NastranElements, BarOrientationByGridAndByVector) {
  EXPECT_EQ(only_bar("CBAR,5,10,1,2,3\n").orientation, Vec3(0.0, 0.0, 1.0));
  EXPECT_EQ(only_bar("CBAR,5,10,2,1,3\n").orientation, Vec3(-2.0, 0.0, 1.0));  // from GA towards G0
  EXPECT_EQ(only_bar("CBAR,5,10,1,2,.5,1.,-1.\n").orientation, Vec3(0.5, 1.0, -1.0));
  EXPECT_EQ(only_bar("CBAR,5,10,1,2,,1.\n").orientation, Vec3(0.0, 1.0, 0.0));
  EXPECT_EQ(only_bar("BAROR,,10,,,0.,0.,1.\nCBAR,5,,1,2\n").orientation, Vec3(0.0, 0.0, 1.0));
}

TEST(NastranElements, BarVectorsAreInTheDisplacementFrame) {
  // x′ = y, y′ = z, z′ = x at end A, the basic frame at end B
  const std::string cards = "CORD2R,5,,0.,0.,0.,1.,0.,0.\n,0.,1.,0.\nGRID,11,,0.,0.,0.,5\n";
  const Beam bar = only_bar(cards + "CBAR,5,10,11,2,1.,0.,0.\n,,,.1,.2,.3,.4,.5,.6\n");
  EXPECT_LT((bar.orientation - Vec3::UnitY()).norm(), 1e-15);
  EXPECT_LT((bar.offsets[0] - Vec3(0.3, 0.1, 0.2)).norm(), 1e-15);
  EXPECT_EQ(bar.offsets[1], Vec3(0.4, 0.5, 0.6));
  EXPECT_EQ(only_bar(cards + "CBAR,5,10,11,2,0.,0.,1.,BGG\n").orientation, Vec3(0.0, 0.0, 1.0));
}

TEST(NastranElements, CoupledMassGivesNastransBars) {
  const auto model = read_deck(std::string(bar_cards) + "CBAR,5,10,1,2,3\nPARAM,COUPMASS,1\nPARAM,WTMASS,.5\n").model;
  EXPECT_EQ(elements_of<Beam>(model).at(0).mass, BeamMass::nastran);
  EXPECT_TRUE(elements_of<PointMass>(model).empty());
  EXPECT_EQ(model.materials.at(0).rho, 3900.0);  // WTMASS
  EXPECT_EQ(model.beam_sections.at(0).nsm, 0.75);
}

TEST(NastranElements, WithoutCoupledMassBarsAreLumpedHalfAndHalf) {
  const auto model =
      read_deck(std::string(bar_cards) + "CBAR,5,10,1,2,3\n,,,0.,0.,.25,0.,0.,.25\nCONM2,6,2,,3.\nPARAM,WTMASS,.5\n")
          .model;
  const auto masses = elements_of<PointMass>(model);
  ASSERT_EQ(masses.size(), 3U);
  const double bar = (7800.0 * 4e-4 + 1.5) * 2.0;  // (ρA + nsm) L
  EXPECT_NEAR(total_mass(model), 0.5 * (bar + 3.0), 1e-12);
  EXPECT_NEAR(masses[1].mass, 0.25 * bar, 1e-12);
  EXPECT_EQ(masses[1].offset, Vec3(0.0, 0.0, 0.25));  // at the bar's end, not at the grid
  const Beam beam = elements_of<Beam>(model).at(0);
  EXPECT_EQ(model.materials.at(static_cast<std::size_t>(beam.material)).rho, 0.0);
  EXPECT_EQ(model.materials.at(static_cast<std::size_t>(beam.material)).E, 2.1e11);
  EXPECT_EQ(model.beam_sections.at(static_cast<std::size_t>(beam.section)).nsm, 0.0);
  EXPECT_EQ(model.materials.at(0).rho, 3900.0);  // the deck's own material stays
}

TEST(NastranElements, LumpedShellsKeepMassAndCentre) {
  // a trapezoid: area 1.5, centroid at y = 4/9 (parallel sides 2 and 1)
  const auto model = read_deck(
                         "MAT1,1,7.+10,,.25,2700.\nGRID,1\nGRID,2,,2.\nGRID,3,,1.,1.\nGRID,4,,0.,1.\n"
                         "PSHELL,5,1,.01,1,,1,,3.\nCQUAD4,1,5,1,2,3,4\n")
                         .model;
  const double mass = (2700.0 * 0.01 + 3.0) * 1.5;
  EXPECT_NEAR(total_mass(model), mass, 1e-12 * mass);
  double moment = 0.0;
  for (const PointMass& p : elements_of<PointMass>(model))
    moment += p.mass * model.nodes[static_cast<std::size_t>(p.node)].y();
  EXPECT_NEAR(moment / mass, 4.0 / 9.0, 1e-12);

  const auto triangle = read_deck(std::string(plate_cards) + "PSHELL,5,1,.01,1,,1\nCTRIA3,1,5,1,2,3\n").model;
  EXPECT_NEAR(total_mass(triangle), 27.0, 1e-12);
  EXPECT_EQ(elements_of<Tria3>(triangle).size(), 1U);
}

TEST(NastranElements, ShellSections) {
  const ShellSection usual = shell_section("PSHELL,5,1,.02,1,,1,,4.");
  EXPECT_EQ(usual.thickness, 0.02);
  EXPECT_EQ(usual.nsm, 4.0);
  EXPECT_EQ(usual.bending_ratio, 1.0);
  EXPECT_DOUBLE_EQ(usual.shear_ratio, 5.0 / 6.0);
  const ShellSection membrane = shell_section("PSHELL,5,1,.02");
  EXPECT_EQ(membrane.bending_ratio, 0.0);
  EXPECT_EQ(membrane.shear_ratio, 0.0);
  const ShellSection sandwich = shell_section("MAT1,2,1.4+11,,.25\nPSHELL,5,1,.02,2,3.,2,.5");
  EXPECT_DOUBLE_EQ(sandwich.bending_ratio, 6.0);                     // 12I/T³ · E2/E1
  EXPECT_DOUBLE_EQ(sandwich.shear_ratio, 1.0);                       // TS/T · G3/G1
  EXPECT_GE(shell_section("PSHELL,5,1,.02,1").shear_ratio, 1000.0);  // no MID3: rigid in shear
  EXPECT_THAT(refusal(std::string(plate_cards) + "PSHELL,5,,.02,1\n"), HasSubstr("MID1"));
  EXPECT_THAT(refusal(std::string(plate_cards) + "PSHELL,5,1,0.,1\n"), HasSubstr("PSHELL field T is '0.'"));
  EXPECT_THAT(refusal(std::string(plate_cards) + "MAT1,2,7.+10,,.3\nPSHELL,5,1,.1,2\n"), HasSubstr("Poisson"));
  EXPECT_THAT(refusal(std::string(plate_cards) + "PSHELL,5,1,.1,1,,1\n,,,2\n"), HasSubstr("PSHELL MID4"));
}

TEST(NastranElements, ExtraShellFieldsWithoutEffectAreRead) {
  const auto model = read_deck(std::string(plate_cards) +
                               "PSHELL,5,1,.02,1,,1\nCQUAD4,1,5,1,2,3,4,30.,0.\n,,,.02,.02,.02,.02\n"
                               "CTRIA3,2,5,1,2,3,30.\n,,1,1.,1.,1.\n")
                         .model;
  EXPECT_EQ(elements_of<Quad4>(model).at(0).nodes, (std::array{0, 1, 2, 3}));
  EXPECT_EQ(elements_of<Tria3>(model).at(0).nodes, (std::array{0, 1, 2}));
}

TEST(NastranElements, ShellOffsets) {
  const std::string deck =
      std::string(plate_cards) + "PSHELL,5,1,.02,1,,1\nCQUAD4,1,5,1,2,3,4,,.5\nCTRIA3,2,5,1,2,3,,-.25\n";
  const auto model = read_deck(deck).model;
  EXPECT_EQ(elements_of<Quad4>(model).at(0).offset, 0.5);
  EXPECT_EQ(elements_of<Tria3>(model).at(0).offset, -0.25);
  for (const PointMass& p : elements_of<PointMass>(model)) EXPECT_EQ(std::abs(p.offset.z()), p.id == 1 ? 0.5 : 0.25);
}

TEST(NastranElements, Laminates) {
  const std::string deck = std::string(plate_cards) +
                           "MAT8,2,1.4+11,1.+10,.3,5.+9,4.+9,3.+9,1600.\n"
                           "PCOMP,5,-.005,7.,,,,,SYM\n,2,.002,45.,YES,,,-45.\n,1,.001\n"
                           "PCOMP,6\n,2,.004,90.\n"
                           "CQUAD4,1,5,1,2,3,4,30.,.1\nCQUAD4,2,6,1,2,3,4,0\nCTRIA3,3,6,1,2,3\n"
                           "PARAM,COUPMASS,1\n";
  const auto model = read_deck(deck).model;
  const auto quads = elements_of<Quad4>(model);
  const ShellSection& sym = model.shell_sections.at(static_cast<std::size_t>(quads.at(0).section));
  ASSERT_EQ(sym.plies.size(), 6U);
  EXPECT_DOUBLE_EQ(sym.thickness, 0.010);
  EXPECT_EQ(sym.nsm, 7.0);
  EXPECT_DOUBLE_EQ(sym.plies[1].angle, -std::numbers::pi / 4);  // material and thickness of the ply before
  EXPECT_EQ(sym.plies[1].E1, 1.4e11);
  EXPECT_EQ(sym.plies[1].thickness, 0.002);
  EXPECT_EQ(sym.plies[2].E2, 7e10);  // of MAT1
  EXPECT_EQ(sym.plies[5].angle, sym.plies[0].angle);
  EXPECT_EQ(sym.plies[0].G23, 3e9);
  EXPECT_NEAR(quads[0].offset, 0.1, 1e-15);  // Z0 = −T/2 is the default
  EXPECT_LT((quads[0].material_axis - Vec3(std::sqrt(0.75), 0.5, 0.0)).norm(), 1e-15);
  EXPECT_LT((quads[1].material_axis - Vec3::UnitX()).norm(), 1e-15);  // an integer is a coordinate system
  EXPECT_TRUE(elements_of<Tria3>(model).at(0).material_axis.isZero());

  const auto lumped = read_deck(deck.substr(0, deck.find("PARAM"))).model;
  EXPECT_NEAR(total_mass(lumped), (8e-3 * 1600 + 2e-3 * 2700 + 7.0) * 2.0 + 1600 * 0.004 * 3.0, 1e-12);
  EXPECT_NEAR(total_mass(read_deck(deck.substr(0, deck.find("PARAM")) + "PARAM,WTMASS,.5\n").model),
              0.5 * total_mass(lumped), 1e-12);

  const auto composite = [](const std::string& cards) { return refusal(plate_cards + cards); };
  EXPECT_THAT(composite("PCOMP,5,,,,,,,MEM\n,1,.1\n"), HasSubstr("PCOMP field LAM is 'MEM'"));
  EXPECT_THAT(composite("PCOMP,5\n,9,.1\n"), HasSubstr("names material 9, which is not defined by a MAT8 or MAT1"));
  EXPECT_THAT(composite("PCOMP,5\n,1\n"), HasSubstr("field Ti is blank"));
  EXPECT_THAT(composite("PCOMP,5\n"), HasSubstr("MID1"));
  EXPECT_THAT(composite("MAT8,2,1.+10,1.+10,1.2,5.+9\n"), HasSubstr("NU12"));
  EXPECT_THAT(composite("MAT8,2,1.+10,1.+10,.2,5.+9,1.+9\n"), HasSubstr("G2Z"));
  EXPECT_THAT(composite("PSHELL,5,1,.1\nPCOMP,5\n,1,.1\n"), HasSubstr("number of a PSHELL"));
}

TEST(NastranElements, PointMassWithOffsetInertiaAndFrame) {
  const std::string frame = "CORD2R,5,,9.,9.,9.,10.,9.,9.\n,9.,10.,9.\n";  // x′ = y, y′ = z, z′ = x
  const auto masses =
      elements_of<PointMass>(read_deck(frame + "GRID,1,,1.,1.,1.\nCONM2,1,1,5,3.,.1,.2,.3\n,11.,21.,22.,31.,32.,33.\n"
                                               "CONM2,2,1,-1,3.,1.5,1.,1.\nCONM2,3,1,,2.\n,1.,.5,2.\n")
                                 .model);
  ASSERT_EQ(masses.size(), 3U);
  EXPECT_LT((masses[0].offset - Vec3(0.3, 0.1, 0.2)).norm(), 1e-15);
  EXPECT_NEAR(masses[0].inertia(1, 1), 11.0, 1e-13);                  // about x′ = y
  EXPECT_NEAR(masses[0].inertia(0, 0), 33.0, 1e-13);                  // about z′ = x
  EXPECT_NEAR(masses[0].inertia(1, 2), -21.0, 1e-13);                 // x′y′ = yz
  EXPECT_NEAR(masses[0].inertia(0, 1), -31.0, 1e-13);                 // z′x′ = xy
  EXPECT_LT((masses[1].offset - Vec3(0.5, 0.0, 0.0)).norm(), 1e-15);  // CID −1: position of the centre
  EXPECT_EQ(masses[2].inertia(0, 1), -0.5);
}

TEST(NastranElements, ImpossibleValuesAreRefusedAtTheirField) {
  const auto says = [](const std::string& cards) { return refusal(plate_cards + cards); };
  EXPECT_THAT(says("CONM2,5,1,,-2.\n"), HasSubstr("CONM2 field M is '-2.'"));
  EXPECT_THAT(says("CONM2,5,1,,-2.\n"), HasSubstr("take it off the mass that it corrects"));
  EXPECT_THAT(says("PBAR,10,1,-4.,1.,1.\n"), HasSubstr("PBAR field A is '-4.'"));
  EXPECT_THAT(says("PBAR,10,1,4.,-1.,1.\n"), HasSubstr("PBAR field I1"));
  EXPECT_THAT(says("PBAR,10,1,4.,1.,1.,1.,-1.\n"), HasSubstr("PBAR field NSM"));
  EXPECT_THAT(says("PSHELL,10,1,-.1\n"), HasSubstr("PSHELL field T is '-.1'"));
  EXPECT_THAT(says("PSHELL,10,1,.1,1,,1,,-3.\n"), HasSubstr("PSHELL field NSM"));
}

TEST(NastranElements, MeshHasBlocksIdsAndSets) {
  const Mesh mesh =
      read_deck(std::string(plate_cards) +
                "PSHELL,5,1,.02,1,,1\nPSHELL,6,1,.03,1,,1\nPBAR,7,1,1.,1.,1.,1.\n"
                "CTRIA3,31,6,1,2,3\nCQUAD4,21,5,1,2,3,4\nCQUAD4,22,6,4,3,2,1\nCBAR,11,7,1,2,4\nCONM2,41,3,,1.\n")
          .mesh;
  ASSERT_EQ(mesh.cells.size(), 4U);
  EXPECT_EQ(mesh.cells[0].type, CellType::line);
  EXPECT_EQ(mesh.cells[1].type, CellType::quad);
  EXPECT_EQ(mesh.cells[2].type, CellType::triangle);
  EXPECT_EQ(mesh.cells[3].type, CellType::vertex);
  EXPECT_THAT(mesh.cells[1].ids, ElementsAre(21, 22));
  EXPECT_THAT(mesh.cells[1].nodes, ElementsAre(0, 1, 2, 3, 3, 2, 1, 0));
  EXPECT_THAT(mesh.cell_sets.at("pshell 6"), ElementsAre(ElementsAre(), ElementsAre(1), ElementsAre(0), ElementsAre()));
  EXPECT_THAT(mesh.cell_sets.at("pbar 7")[0], ElementsAre(0));
  EXPECT_THAT(points_of_set(mesh, "pbar 7"), ElementsAre(0, 1));
}

TEST(NastranElements, BadElementsAreRefusedByNameAndPlace) {
  const auto bar = [](const std::string& cards) { return refusal(bar_cards + cards); };
  EXPECT_THAT(bar("CBAR,5,99,1,2,3\n"), HasSubstr("deck.bdf:6:8: CBAR field PID names property 99"));
  EXPECT_THAT(bar("CBAR,5,10,1,8,3\n"), HasSubstr("CBAR field GB names GRID 8"));
  EXPECT_THAT(bar("CBAR,5,10,1,2\n"), HasSubstr("orientation of the section"));
  EXPECT_THAT(bar("CBAR,5,10,1,2,1.,0.,0.\n"), HasSubstr("along its own axis"));
  EXPECT_THAT(bar("CBAR,5,10,1,2,0.,0.,0.\n"), HasSubstr("along its own axis"));
  EXPECT_THAT(bar("GRID,4,,2.\nCBAR,5,10,2,4,3\n"), HasSubstr("has no length"));
  EXPECT_THAT(bar("CBAR,5,10,1,2,3\n,456\nPARAM,COUPMASS,1\n"),
              HasSubstr("deck.bdf:7:2: reading on would change stiffness or mass: CBAR pin flags"));
  EXPECT_THAT(bar("CBAR,5,10,1,2,3,,,GOO\n,,,1.\n"), HasSubstr("offsets in the element's own frame"));
  EXPECT_THAT(bar("CBAR,5,10,1,2,3,,,XYZ\n"), HasSubstr("OFFT"));
  EXPECT_THAT(bar("CBAR,5,10,1,2,3\nCBAR,5,10,2,1,3\n"), HasSubstr("stands already"));
  const auto shell = [](const std::string& cards) {
    return refusal(plate_cards + std::string("PSHELL,5,1,.02,1,,1\n") + cards);
  };
  EXPECT_THAT(shell("CQUAD4,1,5,1,2,3,3\n"), HasSubstr("names GRID 3 at two corners"));
  EXPECT_THAT(shell("GRID,5,,1.\nCTRIA3,1,5,1,2,5\n"), HasSubstr("has no area"));
  EXPECT_THAT(shell("CQUAD4,1,5,1,2,3,4\n,,,.02,.02,.02,.03\n"), HasSubstr("thickness at the corners"));
  EXPECT_THAT(shell("CQUAD4,1,5,1,2,3\n"), HasSubstr("CQUAD4 field G4 is blank"));
  EXPECT_THAT(shell("CONM2,1,9,,1.\n"), HasSubstr("CONM2 field G names GRID 9"));
}
