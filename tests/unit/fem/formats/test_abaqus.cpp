#include "fem/formats/abaqus.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <map>
#include <numbers>

#include "fem/error.hpp"
#include "fem/formats/deck.hpp"
#include "fem/formats/read_mesh.hpp"
#include "fem/structure.hpp"
#include "tests/support/temporary_folder.hpp"

using namespace tenon;
using namespace tenon::fem;
using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::ThrowsMessage;

namespace {

class Abaqus : public testing::Test {
 protected:
  AbaqusDeck read(const std::string& text, bool allow = false) {
    return read_abaqus(folder.write("deck.inp", text), {.allow_losses = allow});
  }
  void refused(const std::string& text, const std::string& place, const std::string& what) {
    EXPECT_THAT([&] { read(text); }, ThrowsMessage<InputError>(AllOf(HasSubstr(place), HasSubstr(what)))) << text;
  }
  TemporaryFolder folder;
};

const Loss* loss(const Model& model, const std::string& name) {
  for (const Loss& l : model.losses)
    if (l.name == name) return &l;
  return nullptr;
}

// a cantilever of two beams along x with a mass at its tip
const std::string cantilever = R"(*HEADING
 A cantilever
** a comment
*NODE, NSET=all
1, 0., 0., 0.
2, 1., 0., 0.
*node, nset=All
3, 2.0E0, 0.
*ELEMENT, TYPE=B31, ELSET=boom
10, 1, 2
11, 2, 3
*ELEMENT, TYPE=MASS, ELSET=tip
20, 3
*MATERIAL, NAME=Steel
*ELASTIC
2.1D11, 0.3
*DENSITY
7800.
*BEAM SECTION, ELSET=boom, MATERIAL=STEEL, SECTION=RECT
0.02, 0.03
0., 1., 0.
*MASS, ELSET=tip
5.
*BOUNDARY
1, 1, 6
)";

}  // namespace

TEST_F(Abaqus, ReadsACantilever) {
  const AbaqusDeck deck = read(cantilever);
  EXPECT_EQ(deck.title, "A cantilever");
  EXPECT_TRUE(deck.has_sections);
  ASSERT_EQ(deck.mesh.points.size(), 3U);  // the second *NODE block adds to the first
  EXPECT_THAT(deck.mesh.point_sets.at("all"), ElementsAre(0, 1, 2));
  EXPECT_EQ(deck.model.elements.size(), 3U);
  const auto& beam = std::get<Beam>(deck.model.elements[0]);
  const BeamSection& s = deck.model.beam_sections[0];
  EXPECT_EQ(beam.orientation, Vec3::UnitY());
  EXPECT_DOUBLE_EQ(s.Iz, 0.03 * std::pow(0.02, 3) / 12.0);  // I22: the section is .02 wide along n1 = y
  EXPECT_DOUBLE_EQ(s.Iy, 0.02 * std::pow(0.03, 3) / 12.0);
  EXPECT_DOUBLE_EQ(deck.model.materials[0].E, 2.1e11);
  EXPECT_EQ(deck.model.supports.size(), 6U);
  EXPECT_NEAR(geometric_mass_properties(deck.model).mass, 5.0 + 2.0 * 6e-4 * 7800.0, 1e-12);
  EXPECT_TRUE(deck.model.losses.empty());
}

TEST_F(Abaqus, WindowsLineEndsTabsAndSpacesChangeNothing) {
  std::string text;
  for (const char c : cantilever) c == '\n' ? text += "\r\n" : c == ',' ? text += "\t,  " : text += c;
  const Structure a = assemble(read(cantilever).model), b = assemble(read(text).model);
  EXPECT_EQ((a.K - b.K).norm(), 0.0);
  EXPECT_EQ((a.M - b.M).norm(), 0.0);
}

TEST_F(Abaqus, SetsOfSetsAndRanges) {
  const AbaqusDeck deck = read(R"(*NODE
1,0.,0.,0.
2,1.,0.,0.
3,2.,0.,0.
7,3.,0.,0.
*ELEMENT,TYPE=B31,ELSET=first
1,1,2
*ELEMENT,TYPE=B31,ELSET=second
2,2,3
3,3,7
*NSET,NSET=odd,GENERATE
1,100000000,2
*NSET,NSET=some
2,3
*NSET,NSET=both
odd,SOME
*ELSET,ELSET=whole
first,
second
*NSET,NSET=of_second,ELSET=second
)");
  EXPECT_FALSE(deck.has_sections);
  EXPECT_THAT(deck.mesh.point_sets.at("odd"), ElementsAre(0, 2, 3));
  EXPECT_THAT(deck.mesh.point_sets.at("both"), ElementsAre(0, 1, 2, 3));
  EXPECT_THAT(deck.mesh.point_sets.at("of_second"), ElementsAre(1, 2, 3));
  EXPECT_THAT(deck.mesh.cell_sets.at("whole")[0], ElementsAre(0, 1, 2));
}

TEST_F(Abaqus, IncludedDataGoToTheKeywordBefore) {
  folder.write("nodes.txt", "1,0.,0.,0.\n2,1.,0.,0.\n");
  const AbaqusDeck deck = read("*NODE\n*INCLUDE, INPUT=nodes.txt\n*ELEMENT,TYPE=B31\n1,1,2\n");
  EXPECT_EQ(deck.mesh.points.size(), 2U);
  refused("*NODE\n*INCLUDE, INPUT=deck.inp\n", "deck.inp:2", "includes itself");
  refused("*NODE\n*INCLUDE, INPUT=none.inp\n", "deck.inp:2", "does not exist");
}

TEST_F(Abaqus, SecondOrderElementsAreSplitWithANotice) {
  const AbaqusDeck deck = read(R"(*NODE
1,0.,0.,0.
2,2.,0.,0.
3,2.,2.,0.
4,0.,2.,0.
5,1.,0.,0.
6,2.,1.,0.
7,1.,2.,0.
8,0.,1.,0.
9,4.,0.,0.
10,3.,0.,0.
*ELEMENT,TYPE=S8R,ELSET=plate
1,1,2,3,4,5,6,7,8
*ELEMENT,TYPE=B32,ELSET=bar
2,2,10,9
*MATERIAL,NAME=M
*ELASTIC
7E10,.3
*DENSITY
2700.
*SHELL SECTION,ELSET=plate,MATERIAL=M
.01
*BEAM SECTION,ELSET=bar,MATERIAL=M,SECTION=PIPE
.05,.01
)");
  EXPECT_EQ(deck.model.elements.size(), 7U);
  EXPECT_EQ(loss(deck.model, "S8R")->count, 1);
  EXPECT_EQ(loss(deck.model, "B32")->count, 1);
  EXPECT_FALSE(loss(deck.model, "S8R")->changes_physics);
  const double pipe = std::numbers::pi * (.05 * .05 - .04 * .04) * 2.0;
  EXPECT_NEAR(geometric_mass_properties(deck.model).mass, 2700.0 * (4.0 * .01 + pipe), 1e-9);
}

TEST_F(Abaqus, RoundAndSquareSectionsOfBothPrograms) {
  const auto area = [&](const std::string& data) {
    std::string text = cantilever;
    text.replace(text.find("SECTION=RECT\n0.02, 0.03"), 23, "SECTION=CIRC\n" + data);
    return read(text).model.beam_sections[0].A;
  };
  EXPECT_DOUBLE_EQ(area("0.05"), std::numbers::pi * 0.05 * 0.05);          // a radius
  EXPECT_DOUBLE_EQ(area("0.05, 0.05"), std::numbers::pi * 0.025 * 0.025);  // two diameters
  std::string text = cantilever;
  text.replace(text.find("0.02, 0.03"), 10, "0.02");
  EXPECT_DOUBLE_EQ(read(text).model.beam_sections[0].A, 4e-4) << "a square";
}

TEST_F(Abaqus, AnISectionOffItsNodes) {
  std::string text = cantilever;
  text.replace(text.find("SECTION=RECT\n0.02, 0.03"), 23, "SECTION=I\n0., .1, .06, .06, .01, .01, .005");
  const Model model = read(text).model;
  const BeamSection& s = model.beam_sections[0];
  EXPECT_NEAR(s.A, 2 * .06 * .01 + .08 * .005, 1e-15);
  EXPECT_NEAR(s.Iy, (.06 * 1e-3 - .055 * std::pow(.08, 3)) / 12.0, 1e-18);
  // n2 = t × n1 = x × y = z: the nodes lie at the bottom, the centroid .05 above them
  EXPECT_NEAR((std::get<Beam>(model.elements[0]).offsets[0] - Vec3(0, 0, .05)).norm(), 0.0, 1e-15);
}

// ∫ N dA: a third of a triangle, a quarter of a rectangle; of any flat quadrilateral they hold its area and centroid.
TEST_F(Abaqus, DistributingWeighsByArea) {
  const std::string sheet = R"(*NODE
1, 0., 0., 0.
2, 2., 0., 0.
3, 2., 1., 0.
4, 0., 1., 0.
5, 5., 0., 0.
6, 4., 2., 0.
7, 0., 3., 0.
99, 1., 1., 4.
*ELEMENT, TYPE=S4, ELSET=SKIN
1, 1, 2, 3, 4
2, 2, 5, 6, 3
*ELEMENT, TYPE=S3, ELSET=SKIN
3, 4, 3, 7
*MATERIAL, NAME=M
*ELASTIC
2e11, 0.3
*SHELL SECTION, ELSET=SKIN, MATERIAL=M
0.01
)";
  const auto weights = [&](const std::string& surface) {
    const Model model =
        read(sheet + surface + "*COUPLING, REF NODE=99, SURFACE=S, CONSTRAINT NAME=C\n*DISTRIBUTING\n1, 6\n").model;
    std::map<long, double> result;
    for (const AverageLink::Group& group : model.average_links.at(0).nodes)
      result[model.node_ids[static_cast<std::size_t>(group.node)]] = group.weight;
    return result;
  };
  const auto ends = weights("*SURFACE, NAME=S\n1, SPOS\n3, SNEG\n");
  for (const auto& [node, weight] :
       std::map<long, double>{{1, 0.5}, {2, 0.5}, {3, 0.5 + 2.0 / 3.0}, {4, 0.5 + 2.0 / 3.0}, {7, 2.0 / 3.0}})
    EXPECT_NEAR(ends.at(node), weight, 1e-15) << node;
  const auto trapeze =
      weights("*SURFACE, NAME=S\n2, SPOS\n");  // (2, 0), (5, 0), (4, 2), (2, 1): ∫ 1, x, y dA by Green's theorem
  const double two = trapeze.at(2), five = trapeze.at(5), six = trapeze.at(6), three = trapeze.at(3);
  EXPECT_NEAR(two + five + six + three, 4.0, 1e-14);
  EXPECT_NEAR(2.0 * two + 5.0 * five + 4.0 * six + 2.0 * three, 41.0 / 3.0, 1e-14);
  EXPECT_NEAR(2.0 * six + three, 3.0, 1e-14);
  const auto listed = weights("*SURFACE, NAME=S, TYPE=NODE\n1, 2.5\n3,\n7, .5\n");
  EXPECT_THAT(listed, ElementsAre(testing::Pair(1, 2.5), testing::Pair(3, 1.0), testing::Pair(7, 0.5)));
}

TEST_F(Abaqus, RigidBodiesCouplingsEquationsAndSprings) {
  const std::string nodes = cantilever + R"(*NODE
30, 2., 1., 0.
31, 2., 0., 1.
32, 3., 0., 0.
)";
  const Model rigid = read(nodes + "*NSET,NSET=rim\n30,31\n*RIGID BODY,NSET=rim,REF NODE=3\n").model;
  ASSERT_EQ(rigid.rigid_links.size(), 1U);
  EXPECT_THAT(rigid.rigid_links[0].dependents, ElementsAre(3, 4));
  EXPECT_EQ(rigid.rigid_links[0].directions, 0b000111) << "NSET, of CalculiX alone: as PIN NSET";
  const Model tied = read(nodes + "*NSET,NSET=rim\n30,31\n*RIGID BODY,TIE NSET=rim,REF NODE=3\n").model;
  EXPECT_EQ(tied.rigid_links.at(0).directions, all_six);
  const Model kinematic = read(nodes + R"(*SURFACE,NAME=rim,TYPE=NODE
30,
31,
*COUPLING,REF NODE=3,SURFACE=RIM,CONSTRAINT NAME=c
*KINEMATIC
1,3
)")
                              .model;
  ASSERT_EQ(kinematic.rigid_links.size(), 1U);
  EXPECT_EQ(kinematic.rigid_links[0].directions, 0b000111);
  const Model average = read(nodes + R"(*SURFACE,NAME=rim,TYPE=NODE
1
2
3
*COUPLING,REF NODE=32,SURFACE=rim,CONSTRAINT NAME=c
*DISTRIBUTING
)")
                            .model;
  ASSERT_EQ(average.average_links.size(), 1U);
  EXPECT_EQ(average.average_links[0].nodes.size(), 3U);
  const Model equation = read(nodes + "*EQUATION\n3\n30,1,1.,3,1,-1.,\n3,6,1.\n").model;
  ASSERT_EQ(equation.constraints.size(), 1U);
  EXPECT_EQ(equation.constraints[0].terms.size(), 3U);
  const Model spring = read(nodes + R"(*ELEMENT,TYPE=SPRING2,ELSET=k
40,3,32
*SPRING,ELSET=k
2,2
1000.
)")
                           .model;
  const auto& k = std::get<Spring>(spring.elements.back());
  EXPECT_EQ(k.dof_a, 1);
  EXPECT_EQ(k.k, 1000.0);
}

TEST_F(Abaqus, TrussesAreRods) {
  const std::string nodes =
      "*NODE\n1,0.,0.,0.\n2,1.,0.,1.\n3,2.,0.,2.\n4,0.,1.,0.\n*MATERIAL,NAME=AL\n*ELASTIC\n7e10,.3\n"
      "*DENSITY\n2700.\n";
  const Model two =
      read(nodes + "*ELEMENT,TYPE=T3D2,ELSET=bars\n5,1,2\n6,1,4\n*SOLID SECTION,ELSET=bars,MATERIAL=AL\n1e-4\n").model;
  ASSERT_EQ(two.elements.size(), 2U);
  EXPECT_THAT(std::get<Rod>(two.elements[1]).nodes, ElementsAre(0, 3));
  EXPECT_EQ(two.beam_sections.at(0).A, 1e-4);
  EXPECT_EQ(two.beam_sections.at(0).J, 0.0);
  EXPECT_EQ(read(nodes + "*ELEMENT,TYPE=T3D2,ELSET=bars\n5,1,2\n*SOLID SECTION,ELSET=bars,MATERIAL=AL\n")
                .model.beam_sections.at(0)
                .A,
            1.0);  // the area that a blank stands for

  // Three nodes on a line: the middle one moves across with the ends, and along on its own.
  const Model three =
      read(nodes + "*ELEMENT,TYPE=T3D3,ELSET=bars\n5,1,2,3\n*SOLID SECTION,ELSET=bars,MATERIAL=AL\n1e-4\n").model;
  EXPECT_EQ(three.elements.size(), 2U);
  ASSERT_EQ(three.constraints.size(), 2U);
  EXPECT_EQ(loss(three, "T3D3")->count, 1);
  const Structure s = assemble(three);
  EXPECT_EQ(s.n(), 7);
  const Eigen::MatrixXd K = Eigen::MatrixXd(s.K).selfadjointView<Eigen::Lower>(), R = rigid_motions(s, Vec3::Zero());
  EXPECT_LT((K * R).cwiseAbs().maxCoeff(), 1e-14 * K.cwiseAbs().maxCoeff());
  EXPECT_NEAR(mass_properties(s).mass, 2700.0 * 1e-4 * std::sqrt(8.0), 1e-14);
}

TEST_F(Abaqus, SpringsAlongTheirLineAndTheirOwnAxes) {
  const std::string nodes = "*NODE\n1,0.,0.,0.\n2,1.,2.,2.\n3,0.,0.,0.\n";
  const std::string axial = nodes + "*ELEMENT,TYPE=SPRINGA,ELSET=k\n5,1,2\n*SPRING,ELSET=k\n";
  for (const char* lines : {"\n10.\n", "1,1\n10.\n", "10.\n"}) {
    const auto bush = std::get<Bush>(read(axial + lines).model.elements.at(0));
    EXPECT_THAT(bush.k, ElementsAre(10.0, 0.0, 0.0, 0.0, 0.0, 0.0));
    EXPECT_LT((bush.axes.col(0) - Vec3(1.0, 2.0, 2.0) / 3.0).norm(), 1e-15);
  }
  const auto own =
      std::get<Spring>(read(nodes + "*ELEMENT,TYPE=SPRING2,ELSET=k\n5,1,3\n*SPRING,ELSET=k,ORIENTATION=o\n2,2\n7.\n"
                                    "*ORIENTATION,NAME=O\n0.,0.,2.,3.,0.,1.\n3,90.\n")
                           .model.elements.at(0));
  // x along z, y along x; then by 90° about the third: y → −x
  EXPECT_LT((own.axis_a - Vec3(0.0, 0.0, -1.0)).norm(), 1e-15);
  EXPECT_EQ(own.axis_b, own.axis_a);
  refused(axial + "-5.\n", "deck.inp:8:1", "a stiffness that is not negative");
  refused(axial + "10.\n11.,,30.\n", "deck.inp:7", "temperature or frequency");
  refused(nodes + "*ELEMENT,TYPE=SPRINGA,ELSET=k\n5,1,3\n*SPRING,ELSET=k\n10.\n", "deck.inp:7", "has no length");
  refused(nodes +
              "*ELEMENT,TYPE=SPRING2,ELSET=k\n5,1,3\n*SPRING,ELSET=k,ORIENTATION=mont\n2,2\n7.\n*ORIENTATION,"
              "NAME=mount\n1.,0.,0.,0.,1.,0.\n",
          "deck.inp:7", "Did you mean 'mount'?");
  refused(nodes +
              "*ELEMENT,TYPE=SPRING1,ELSET=k\n5,1\n*SPRING,ELSET=k,ORIENTATION=o\n2\n7.\n*ORIENTATION,"
              "NAME=o\n1.,0.,0.,2.,0.,0.\n",
          "deck.inp:11:1", "they fix no axes");
}

TEST_F(Abaqus, SupportsInTurnedFrames) {
  const std::string text =
      cantilever + "*NSET,NSET=tip\n3\n*TRANSFORM,NSET=tip,TYPE=R\n1.,1.,0.,-1.,1.,0.\n*BOUNDARY\ntip,1\n";
  const Model model = read(text).model;
  ASSERT_EQ(model.constraints.size(), 1U);  // (u_x + u_y)/√2 = 0
  ASSERT_EQ(model.constraints[0].terms.size(), 2U);
  EXPECT_NEAR(model.constraints[0].terms[1].coefficient, std::sqrt(0.5), 1e-15);
}

TEST_F(Abaqus, WhatCarriesStiffnessIsRefusedByName) {
  std::string solid = cantilever + R"(*NODE
51,0.,1.,1.
52,1.,1.,1.
53,1.,2.,1.
54,1.,1.,2.
*ELEMENT,TYPE=C3D4,ELSET=block
60,51,52,53,54
*SOLID SECTION,ELSET=block,MATERIAL=STEEL
)";
  refused(solid, "deck.inp", "C3D4 (1 found");
  refused(solid, "matrices", "would change stiffness or mass");
  EXPECT_TRUE(loss(read(solid, true).model, "C3D4")->changes_physics);
  refused(cantilever + "*TIE,NAME=t\na,b\n", "deck.inp:26", "*TIE");
  refused(cantilever + "*FANCY NEW THING\n", "deck.inp:26", "*FANCY NEW THING");
  EXPECT_EQ(loss(read(cantilever + "*STEP\n*FREQUENCY\n10\n*END STEP\n").model, "*STEP")->count, 1);
}

TEST_F(Abaqus, FaultsAreSaidWithTheirPlace) {
  const auto with = [](const std::string& old, const std::string& now) {
    std::string text = cantilever;
    return text.replace(text.find(old), old.size(), now);
  };
  refused("", "deck.inp", "the file is empty");
  refused("1,2,3\n", "deck.inp:1:1", "before any keyword");
  refused("nothing\n", "deck.inp:1:1", "before any keyword");
  refused(std::string("*NODE\n1,0.,\0,0.\n", 16), "deck.inp:2", "expected text");
  refused("*HEADING\nonly\n", "deck.inp", "defines no node");
  refused(with("2, 1., 0., 0.", "2, 1.x, 0., 0."), "deck.inp:6:4", "expected x (a number)");
  refused(with("2, 1., 0., 0.", "1, 1., 0., 0."), "deck.inp:6:1", "defined a second time");
  refused(with("2, 1., 0., 0.", "2, nan, 0., 0."), "deck.inp:6:4", "expected x");
  refused(with("11, 2, 3", "11, 2, 4"), "deck.inp:11:8", "node 4 is not defined");
  refused(with("11, 2, 3", "10, 2, 3"), "deck.inp:11:1", "element 10 is defined a second time");
  refused(with("11, 2, 3", "11, 2"), "deck.inp", "has 1 nodes, expected 2");
  refused(with("11, 2, 3", "11, 2, 3, 1"), "deck.inp:11", "has 3 nodes, expected 2");
  refused(with("ELSET=boom, MATERIAL=STEEL", "ELSET=bom, MATERIAL=STEEL"), "deck.inp:19", "Did you mean 'boom'");
  refused(with("MATERIAL=STEEL", "MATERIAL=STEAL"), "deck.inp:19", "Did you mean 'STEEL'");
  refused(with("2.1D11, 0.3", "-1, 0.3"), "deck.inp:16:1", "above zero");
  refused(with("2.1D11, 0.3", "1e9, 0.7"), "deck.inp:16", "Poisson");
  refused(with("0.02, 0.03", ", 0.03"), "deck.inp:20", "expected a");
  refused(with("0., 1., 0.", "1., 0., 0."), "deck.inp:19", "lies along it");
  refused(with("1, 1, 6", "9, 1, 6"), "deck.inp:25:1", "node 9 is not defined");
  refused(with("1, 1, 6", "root, 1, 6"), "deck.inp:25:1", "there is no node set 'root'");
  refused(with("*MASS, ELSET=tip", "*MASS, ELSET=boom"), "deck.inp:22", "has a section already");
  refused(with("TYPE=B31", "TIPE=B31"), "deck.inp:9", "has no TYPE");
}

TEST_F(Abaqus, AMeshOrADeckByItsSections) {
  const auto deck = folder.write("a.inp", cantilever);
  const auto mesh = folder.write("b.inp", "*NODE\n1,0.,0.,0.\n2,1.,0.,0.\n*ELEMENT,TYPE=T3D2,ELSET=line\n1,1,2\n");
  EXPECT_TRUE(is_deck(deck));
  EXPECT_FALSE(is_deck(mesh));
  EXPECT_EQ(read_deck(deck, false).model.elements.size(), 3U);
  EXPECT_EQ(read_mesh(mesh).cells.size(), 1U);
}

namespace {

/// A square of one shell along x and y with a section, its materials and orientations behind it.
std::string shell_deck(const std::string& section, const std::string& nodes = "1, 2, 3, 4") {
  return "*NODE\n1, 0, 0, 0\n2, 1, 0, 0\n3, 1, 1, 0\n4, 0, 1, 0\n*ELEMENT, TYPE=S4, ELSET=SKIN\n7, " + nodes +
         "\n*MATERIAL, NAME=PLY\n*ELASTIC, TYPE=LAMINA\n130E9, 9E9, .3, 5E9, 4E9, 3E9\n*DENSITY\n1600.\n"
         "*MATERIAL, NAME=FOAM\n*ELASTIC\n1E8, .25\n*DENSITY\n50.\n"
         "*MATERIAL, NAME=BLOCK\n*ELASTIC, TYPE=ENGINEERING CONSTANTS\n"
         "130E9, 9E9, 8E9, .3, .31, .4, 5E9, 4E9\n3E9\n*DENSITY\n1600.\n"
         "*MATERIAL, NAME=FULL\n*ELASTIC, TYPE=ANISOTROPIC\n1., 1., 1.\n"
         "*ORIENTATION, NAME=PROJECTED\n0., 1., 0., -1., 0., 0.\n3, 90.\n"
         "*ORIENTATION, NAME=FIRST\n1., 0., 0., 0., 1., 0.\n1, 0.\n"
         "*ORIENTATION, NAME=ALONG\n1., 0., 0., 0., 1., 0.\n*ORIENTATION, NAME=ACROSS\n0., 1., 0., -1., 0., 0.\n"
         "*ORIENTATION, NAME=UP\n1., 0., 0., 0., 0., 1.\n*SHELL SECTION, ELSET=SKIN, " +
         section + "\n";
}

}  // namespace

TEST_F(Abaqus, LayersWithAnglesAboutAProjectedDirection) {
  const Model model =
      read(shell_deck("COMPOSITE, ORIENTATION=PROJECTED, SYMMETRIC\n.001, 3, PLY, 30.\n.01,, FOAM")).model;
  const ShellSection& section = model.shell_sections.at(0);
  ASSERT_EQ(section.plies.size(), 4U);
  EXPECT_DOUBLE_EQ(section.thickness, 0.022);
  for (const std::size_t k : {0U, 3U}) {
    const Ply& ply = section.plies[k];
    EXPECT_EQ((std::array{ply.thickness, ply.E1, ply.E2, ply.nu12, ply.G12, ply.G13, ply.G23, ply.rho}),
              (std::array{0.001, 130e9, 9e9, 0.3, 5e9, 4e9, 3e9, 1600.0}));
    EXPECT_DOUBLE_EQ(ply.angle, std::numbers::pi / 6.0);
  }
  EXPECT_EQ(section.plies[1].E1, 1e8);
  EXPECT_EQ(section.plies[1].G13, 1e8 / 2.5);
  EXPECT_EQ(section.plies[2].rho, 50.0);
  const auto& quad = std::get<Quad4>(model.elements.at(0));
  EXPECT_LT((quad.material_axis - Vec3(-1, 0, 0)).norm(), 1e-15) << "y, turned by 90° about z";
}

TEST_F(Abaqus, LayersWithOrientationsOfTheirOwn) {
  const auto plies = [&](const std::string& layers) {
    return read(shell_deck("COMPOSITE\n" + layers)).model.shell_sections.at(0).plies;
  };
  const std::vector<Ply> both = plies(".001,, PLY, ACROSS\n.002,, BLOCK, ALONG\n.01,, FOAM, UP");
  ASSERT_EQ(both.size(), 3U);
  EXPECT_EQ(both[0].angle, 0.0) << "the first of them is the section's direction";
  EXPECT_DOUBLE_EQ(both[1].angle, -std::numbers::pi / 2.0);
  EXPECT_EQ((std::array{both[1].E2, both[1].nu12, both[1].G12, both[1].G13, both[1].G23}),
            (std::array{9e9, 0.3, 5e9, 4e9, 3e9}));
  refused(shell_deck("COMPOSITE\n.001,, PLY, ACROSS", "4, 3, 2, 1"), "deck.inp:39",
          "element 7 does not have axis 3 of its ORIENTATION as its normal");
}

TEST_F(Abaqus, OneLayerAlongAnOrientation) {
  const Model model = read(shell_deck("MATERIAL=PLY, ORIENTATION=PROJECTED\n.003", "4, 3, 2, 1")).model;
  ASSERT_EQ(model.shell_sections.at(0).plies.size(), 1U);
  EXPECT_EQ(model.shell_sections[0].plies[0].thickness, 0.003);
  EXPECT_EQ(model.shell_sections[0].plies[0].E2, 9e9);
}

TEST_F(Abaqus, ShellsWhoseDirectionsAreNotKnown) {
  const std::string place = "deck.inp:39";
  refused(shell_deck("MATERIAL=PLY\n.003"), place, "without ORIENTATION");
  refused(shell_deck("MATERIAL=PLY, ORIENTATION=FIRST\n.003"), place, "whose axis 3 is not the normal");
  refused(shell_deck("MATERIAL=FULL, ORIENTATION=PROJECTED\n.003"), place, "'FULL', neither isotropic nor a lamina");
  refused(shell_deck("COMPOSITE\n.001,, PLY, ALONG\n.001,, PLY, UP"), place, "'UP' that does not share axis 3");
  refused(shell_deck("COMPOSITE\n.001,, PLY, ALNOG"), place, "'ALNOG'");
  for (const std::string layers : {"COMPOSITE\n.001,, PLY\n.001,, PLY, ACROSS\n.001,, PLY",
                                   "COMPOSITE\n.001,, PLY, ALONG\n.001,, PLY, ACROSS\n.001,, PLY",
                                   "COMPOSITE\n.001,, PLY, ACROSS\n.001,, BLOCK, 0.\n.001,, PLY, ACROSS",
                                   "COMPOSITE, ORIENTATION=ALONG\n.001,, PLY, ACROSS\n.001,, PLY\n.001,, PLY"})
    refused(shell_deck(layers), place, "layers without an ORIENTATION of their own beside layers that have one");
  refused(shell_deck("COMPOSITE\n.001,, FOAMY"), place, "Did you mean 'FOAM'?");
  refused(shell_deck("COMPOSITE\n0.,, FOAM"), "deck.inp:40", "the thickness of the layer");
  refused(shell_deck("COMPOSITE"), place, "has no data line");
  refused(shell_deck("MATERIAL=FOAM, OFFSET=SPOS\n.003"), place, "OFFSET=SPOS");
  const std::string material = "*NODE\n1, 0, 0, 0\n*MATERIAL, NAME=M\n*ELASTIC, TYPE=";
  refused(material + "LAMINA\n1., 4., .6, 1., 1., 1.\n", "deck.inp:5", "√(E1/E2) = 0.5");
  refused(material + "ENGINEERING CONSTANTS\n1., 4., 4., .6, .1, .1, 1., 1.\n1.\n", "deck.inp:5:13", "√(E1/E2) = 0.5");
}

namespace {

/// An arm along x of two beams, n1 along y, as a part; what its instances are stands behind.
std::string arms(const std::string& instances, const std::string& behind = "") {
  return "*PART, NAME=Arm\n*NODE\n1, 0, 0, 0\n2, .5, 0, 0\n3, 1, 0, 0\n*ELEMENT, TYPE=B31, ELSET=Bars\n1, 1, 2\n2, 2, "
         "3\n"
         "*NSET, NSET=Set-1, GENERATE\n1, 3\n*NSET, NSET=Root\n1\n*BEAM SECTION, ELSET=Bars, MATERIAL=M, SECTION=RECT\n"
         ".02, .01\n0, 1, 0\n*END PART\n*ASSEMBLY, NAME=A\n" +
         instances +
         "*NSET, NSET=Set-1, INSTANCE=One\n1\n*ELSET, ELSET=First, INSTANCE=ONE, GENERATE\n1, 1\n*END ASSEMBLY\n"
         "*MATERIAL, NAME=M\n*ELASTIC\n2E11, .3\n*DENSITY\n7800.\n" +
         behind;
}

const std::string one = "*INSTANCE, NAME=One, PART=ARM\n*END INSTANCE\n";

}  // namespace

// A set of the part and one of the assembly may have the same name, as Abaqus/CAE calls them.
TEST_F(Abaqus, NamesOfPartsAndOfTheAssembly) {
  const AbaqusDeck deck = read(arms(one,
                                    "*BOUNDARY\nSet-1, 1, 1\nOne.Root, 2\nOne.3, 3\nFIRST-NONE, 4\n"
                                    "*NSET, NSET=FIRST-NONE, ELSET=First\n"));
  EXPECT_EQ(deck.mesh.point_ids, (std::vector<long>{1, 2, 3}));
  EXPECT_EQ(deck.mesh.point_sets.at("Set-1"), (std::vector{0}));
  EXPECT_EQ(deck.mesh.point_sets.at("One.Set-1"), (std::vector{0, 1, 2}));
  EXPECT_EQ(deck.mesh.cell_sets.at("First"), (std::vector<std::vector<int>>{{0}}));
  std::vector<std::array<int, 2>> held;
  for (const Support& support : deck.model.supports) held.push_back({support.dof.node, support.dof.direction});
  EXPECT_EQ(held, (std::vector<std::array<int, 2>>{{0, 0}, {0, 1}, {2, 2}, {0, 3}, {1, 3}}));
  EXPECT_EQ(
      read(arms(one, "*NSET, NSET=ALL, INSTANCE=One, GENERATE\n2, 9223372036854775807\n")).mesh.point_sets.at("ALL"),
      (std::vector{1, 2}));
  const std::string two = one + "*INSTANCE, NAME=Two, PART=Arm\n*END INSTANCE\n",
                    all = "*NSET, NSET=ALL, INSTANCE=One, GENERATE\n2, ";
  for (const char* last : {"13\n", "100000\n"})
    EXPECT_EQ(read(arms(two, all + last)).mesh.point_sets.at("ALL"), (std::vector{1, 2})) << "none of the other's";
  refused(arms(two, "*NSET, NSET=N, INSTANCE=One\n13\n"), "deck.inp:", "names node 13, which is not defined");
  refused(arms(two, "*BOUNDARY\nOne.13, 1\n"), "deck.inp:", "there is no node set 'One.13'");
  refused(arms(one, "*NODE\n1000000000000, 0, 0, 0\n"), "deck.inp:", "a number below 10^12, in a deck of instances");
  refused(arms(one, "*BOUNDARY\nOne.9223372036854775807, 2\n"), "deck.inp:", "there is no node set");
  refused(arms(one, "*BOUNDARY\nOne.Toor, 2\n"), "deck.inp:", "there is no node set 'One.Toor'");
  refused(arms("*INSTANCE, NAME=Two, PART=Arm\n*END INSTANCE\n"), "deck.inp:", "there is no instance 'One'");
}

// Two instances, the second moved by y and turned by 90° about z through where its root then is.
TEST_F(Abaqus, InstancesAreMovedThenTurned) {
  const AbaqusDeck deck = read(arms(one + "*INSTANCE, NAME=Other, PART=Arm\n0., 2., 0.\n0., 2., 0., 0., 2., 5., 90.\n"
                                          "*NODE\n9, 3., 0., 0.\n*END INSTANCE\n*NODE\n1, 7., 7., 7.\n"
                                          "*RIGID BODY, REF NODE=1, TIE NSET=Other.Root\n"));
  const std::vector<Vec3> expected{{0, 0, 0},   {0.5, 0, 0}, {1, 0, 0}, {0, 2, 0},
                                   {0, 2.5, 0}, {0, 3, 0},   {0, 5, 0}, {7, 7, 7}};
  ASSERT_EQ(deck.mesh.points.size(), expected.size());
  for (std::size_t i = 0; i < expected.size(); ++i) EXPECT_LT((deck.mesh.points[i] - expected[i]).norm(), 1e-15) << i;
  EXPECT_EQ(deck.mesh.point_ids, (std::vector<long>{1, 2, 3, 11, 12, 13, 19, 21}));
  ASSERT_EQ(deck.model.elements.size(), 4U);
  const Beam &first = std::get<Beam>(deck.model.elements[0]), &last = std::get<Beam>(deck.model.elements[3]);
  EXPECT_EQ(first.orientation, Vec3(0, 1, 0));
  EXPECT_LT((last.orientation - Vec3(-1, 0, 0)).norm(), 1e-15);
  EXPECT_EQ(last.id, 12);
  ASSERT_EQ(deck.model.rigid_links.size(), 1U);
  EXPECT_EQ(deck.model.rigid_links[0].independent, 7);
  EXPECT_EQ(deck.model.rigid_links[0].dependents, (std::vector{3}));
}

// Both programs: OP=NEW takes away what stood before its step; what later steps hold is not there yet.
TEST_F(Abaqus, SupportsAreThoseOfTheFirstFrequencyStep) {
  const std::string model = shell_deck("MATERIAL=FOAM\n.003") + "*BOUNDARY\n1, 1, 6\n", step = "*STEP\n*FREQUENCY\n3\n",
                    end = "*END STEP\n";
  const auto held = [&](const std::string& steps) { return read(model + steps).model.supports.size(); };
  EXPECT_EQ(held(step + end), 6U);
  EXPECT_EQ(held(step + "*BOUNDARY\n2, 1, 2\n" + end), 8U);
  EXPECT_EQ(held(step + "*BOUNDARY, OP=NEW\n2, 1, 2\n*BOUNDARY, OP=NEW\n2, 3\n" + end), 3U);
  EXPECT_EQ(held("*STEP\n*STATIC\n*BOUNDARY\n2, 1\n" + end + step + end), 7U);
  EXPECT_EQ(held(step + end + "*STEP\n*STATIC\n*BOUNDARY, OP=NEW\n2, 1\n" + end), 6U);
  EXPECT_EQ(held("*STEP\n*STATIC\n*BOUNDARY\n2, 1\n" + end), 7U) << "no frequency: the last step";
  const std::vector<Loss> losses = read(model + step + end + step + "*BOUNDARY\n2, 1\n" + end).model.losses;
  EXPECT_TRUE(std::ranges::any_of(losses, [](const Loss& l) { return l.name == "*BOUNDARY of later steps"; }));
}

TEST_F(Abaqus, FrequenciesAboutALoadedStateAreRefused) {
  const std::string model = shell_deck("MATERIAL=FOAM\n.003"), statics = "*STATIC\n*END STEP\n",
                    step = "*FREQUENCY\n3\n*END STEP\n", what = "*STATIC before *FREQUENCY";
  refused(model + "*STEP\n" + statics + "*STEP, PERTURBATION\n" + step, "deck.inp:44", what);
  refused(model + "*STEP, NLGEOM=YES\n" + statics + "*STEP\n" + step, "deck.inp:44", what);
  EXPECT_EQ(read(model + "*STEP, NLGEOM=NO\n" + statics + "*STEP\n" + step).model.elements.size(), 1U);
  EXPECT_EQ(read(model + "*STEP, PERTURBATION\n" + step).model.elements.size(), 1U);
}

TEST_F(Abaqus, DirectionsOfBeamsInFewerNumbersOrByDefault) {
  const auto n1 = [&](const std::string& line) {
    return std::get<Beam>(
               read("*NODE\n1, 0, 0, 0\n2, 1, 0, 0\n*ELEMENT, TYPE=B31, ELSET=B\n1, 1, 2\n*MATERIAL, NAME=M\n"
                    "*ELASTIC\n2E11, .3\n*BEAM SECTION, ELSET=B, MATERIAL=M, SECTION=RECT\n.02, .01\n" +
                    line)
                   .model.elements.at(0))
        .orientation;
  };
  EXPECT_EQ(n1("0., 1.\n"), Vec3(0, 1, 0));
  EXPECT_EQ(n1("0, 1, 0\n5, 5\n"), Vec3(0, 1, 0));
  EXPECT_EQ(n1("\n5, 5\n"), Vec3(0, 0, -1)) << "left blank: what follows are points of integration";
  EXPECT_EQ(n1(""), Vec3(0, 0, -1));
}

TEST_F(Abaqus, LoadsOfAFrequencyStepAreRefused) {
  refused(shell_deck("MATERIAL=FOAM\n.003") +
              "*STEP, PERTURBATION\n*FREQUENCY\n3\n*DLOAD\nSKIN, CENTRIF, 100., 0,0,0, 0,0,1\n"
              "*END STEP\n",
          "deck.inp:44", "*DLOAD in a *FREQUENCY step");
}
