#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <fstream>
#include <iterator>
#include <numbers>

#include "tests/unit/interfaces/program.hpp"

// What the program prints, what it writes, how it ends.
namespace {

using testing::ContainsRegex;
using testing::HasSubstr;

/// Cantilever of FV2's square section (0.125 m, E = 200 GPa, ρ = 8000), L = 10, Euler-Bernoulli, clamped through a
/// port.
const char* const beam_scene = R"(units: SI
bodies:
  beam:
    fe: beam_16.msh
    material: {E: 200e9, nu: 0.3, rho: 8000}
    sections: {beam: {rectangle: [0.125, 0.25], shear: euler-bernoulli, orientation: [0, 1, 0]}}
    ports: {root: {set: left}, tip: {set: right}}
    damping: 0.01
    reduction: {modes: 12}
ground: [beam.root]
inputs: {push: {at: beam.tip, force: z}}
outputs: {tip: {at: beam.tip, displacement: [y, z]}}
requires: {band: [0, 40 Hz], tolerance: 1e-4}
)";

class Cli : public Program {
 protected:
  Cli() {
    fs::copy_file(fs::path(TENON_SOURCE_DIR) / "data/reference/beam_16.msh", folder_.path() / "beam_16.msh");
    scene_ = folder_.write("scene.yaml", beam_scene).string();
  }
  std::string scene_with(const std::string& from, const std::string& to) const {
    std::string changed = beam_scene;
    const std::size_t at = changed.find(from);
    EXPECT_NE(at, std::string::npos) << from;
    return folder_.write("changed.yaml", changed.replace(at, from.size(), to)).string();
  }

  std::string scene_;
};

/// Bending frequencies of the cantilever [Hz]: (βL)² √(EI/ρA) / 2πL², L from the mesh's end points.
double cantilever_hz(double root, double depth, double length) {
  return root * root * std::sqrt(200e9 * depth * depth / 12.0 / 8000.0) / (2.0 * std::numbers::pi * length * length);
}

// A mass m on a spring, .1 m off it with J about itself: held as AUTOSPC does, √(k/m); free to turn, √(k (J + m e²)/m
// J). A mass on a rod that leans: only along the rod there is stiffness, √(EA/Lm).
TEST_F(Cli, DecksHoldWhatHasNoStiffness) {
  const std::string mass = "GRID,1\nCELAS2,1,1000.,1,1\nCONM2,2,1,,2.,0.,.1,0.\n,.01,,.01,,,.01\n",
                    deck = folder_.write("spring.bdf", mass).string(),
                    no = folder_.write("free.bdf", "PARAM,AUTOSPC,NO\n" + mass).string(),
                    rod = folder_
                              .write("rod.bdf",
                                     "GRID,1,,,,,,123456\nGRID,2,,3.,4.,0.\nMAT1,1,2.+11,,.3\nCONROD,1,1,2,1,1.-4\n"
                                     "CONM2,2,2,,8.\n")
                              .string();
  const double turns = 2.0 * std::numbers::pi;
  const json held = object("modes " + deck), free = object("modes " + no), along = object("modes " + rod);
  ASSERT_EQ(held["frequencies_hz"].size(), 1U);
  EXPECT_NEAR(held["frequencies_hz"][0], std::sqrt(1000.0 / 2.0) / turns, 1e-12);
  EXPECT_EQ(held["held_without_stiffness"],
            json::array({"node 1 uy", "node 1 uz", "node 1 rx", "node 1 ry", "node 1 rz"}));
  EXPECT_EQ(free["rigid_modes"], 5);
  EXPECT_NEAR(free["frequencies_hz"][5], std::sqrt(1000.0 * (0.01 + 2.0 * 0.01) / (2.0 * 0.01)) / turns, 1e-11);
  EXPECT_EQ(free["held_without_stiffness"], json::array());
  ASSERT_EQ(free["read_past"].size(), 1U);
  EXPECT_THAT(free["read_past"][0].get<std::string>(), HasSubstr("PARAM AUTOSPC"));
  ASSERT_EQ(along["frequencies_hz"].size(), 1U);
  EXPECT_NEAR(along["frequencies_hz"][0], std::sqrt(2e11 * 1e-4 / 5.0 / 8.0) / turns, 1e-10);
  EXPECT_THAT(tenon("modes " + deck).out, HasSubstr("held, as Nastran's AUTOSPC holds"));
  const auto still = folder_.write("still.bdf", "GRDSET,,,,,,,123456\n" + mass).string();
  const Ended nothing = tenon("modes " + still);
  EXPECT_EQ(nothing.status, 2);
  EXPECT_THAT(nothing.err, HasSubstr("nothing is free to move"));
}

TEST_F(Cli, InfoPrintsWhatTheMeshHolds) {
  const json info = object("info " + (folder_.path() / "beam_16.msh").string());
  EXPECT_EQ(info["points"], 17);
  EXPECT_EQ(info["cells"]["line"], 16);
  EXPECT_EQ(info["cell_sets"]["beam"]["cells"], 16);
  EXPECT_EQ(info["point_sets"]["left"], 1);
  EXPECT_TRUE(info["read_past"].is_array());
}

TEST_F(Cli, ExportsMeshesAndTheMeshOfADeck) {
  const std::string folder = folder_.path().string() + "/";
  json info = object("info " + folder + "beam_16.msh");
  for (const std::string options : {"", " --binary"}) {
    EXPECT_EQ(tenon("export " + folder + "beam_16.msh" + options + " -o " + folder + "again.msh").status, 0);
    const json again = object("info " + folder + "again.msh");
    for (const char* what : {"points", "cells", "cell_sets", "bounding_box_file_units"})
      EXPECT_EQ(again[what], info[what]);
    EXPECT_EQ(again["format"], options.empty() ? "gmsh 4.1 ascii" : "gmsh 4.1 binary");
  }
  folder_.write("deck.bdf", "GRID,1\nGRID,2,,1.\nMAT1,1,2.+11,,.3\nPBAR,7,1,1.,1.,1.,1.\nCBAR,5,7,1,2,0.,1.,0.\n");
  EXPECT_EQ(tenon("export " + folder + "deck.bdf -o " + folder + "deck.msh").status, 0);
  EXPECT_EQ(object("info " + folder + "deck.msh")["cell_sets"]["pbar 7"]["cells"], 1);
  EXPECT_EQ(tenon("export " + folder + "beam_16.msh -o " + folder + "again.vtu").status, 0);
  for (const char* what : {"points", "cells", "bounding_box_file_units"})  // with all digits
    EXPECT_EQ(object("info " + folder + "again.vtu")[what], info[what]);
  folder_.write(
      "part.vtk",
      "# vtk DataFile Version 3.0\nt\nASCII\nDATASET UNSTRUCTURED_GRID\nPOINTS 2 double\n0 0 0 0.1234567890123 0 0\n"
      "CELLS 1 3\n2 0 1\nCELL_TYPES 1\n3\nCELL_DATA 1\nSCALARS E double 1\nLOOKUP_TABLE default\n0.12345678901\n");
  EXPECT_THAT(tenon("export " + folder + "part.vtk -o " + folder + "part.vtu").out,
              testing::Not(HasSubstr("cell data")));
  EXPECT_THAT(text(folder_.path() / "part.vtu"),
              testing::AllOf(HasSubstr("0.1234567890123"), HasSubstr("0.12345678901 ")));
  const Ended unknown = tenon("export " + folder + "beam_16.msh -o " + folder + "again.stl");
  EXPECT_EQ(unknown.status, 2);
  EXPECT_THAT(unknown.err, HasSubstr("not as '.stl'"));
}

TEST_F(Cli, InfoNamesEveryKindOfElement) {
  folder_.write("kinds.bdf",
                "GRID,1,,0.,0.,0.\nGRID,2,,1.,0.,0.\nGRID,3,,1.,1.,0.\nGRID,4,,0.,1.,0.\nMAT1,1,7.+10,,.3,2700.\n"
                "PBAR,1,1,1.-4,1.-8,1.-8,2.-8\nCBAR,1,1,1,2,0.,0.,1.\nPROD,2,1,1.-4\nCROD,2,2,2,3\n"
                "PSHELL,3,1,.01,1,,1\nCQUAD4,3,3,1,2,3,4\nCTRIA3,4,3,1,2,3\nCONM2,5,3,,1.5\nCELAS2,6,1.+3,1,1,2,1\n"
                "PBUSH,7,K,1.+3,1.+3,1.+3,1.+3,1.+3,1.+3\nCBUSH,7,7,3,4,,,,0\nENDDATA\n");
  const std::string info = object("info kinds.bdf").dump();
  for (const char* kind :
       {"beams", "rods", "4-node shells", "3-node shells", "lumped masses", "\"springs\"", "springs in six directions"})
    EXPECT_THAT(info, HasSubstr(kind));
}

TEST_F(Cli, ModesAgreeWithTheClosedFormOfTheCantilever) {
  const json info = object("info " + (folder_.path() / "beam_16.msh").string());
  const auto low = info["bounding_box_file_units"]["min"], high = info["bounding_box_file_units"]["max"];
  const double length = high[0].get<double>() - low[0].get<double>();
  const json modes = object("modes " + scene_ + " --full --count 4");
  EXPECT_EQ(modes["rigid_modes"], 0);
  // y along the orientation: b = 0.125 bends in x-y, h = 0.25 in x-z; the third mode is torsion. 16 elements: 1e-5.
  const double expected[] = {cantilever_hz(1.875104068712, 0.125, length), cantilever_hz(1.875104068712, 0.25, length),
                             cantilever_hz(4.694091132974, 0.125, length)};
  const int place[] = {0, 1, 3};
  for (int k = 0; k < 3; ++k) {
    EXPECT_NEAR(modes["full"]["frequencies_hz"][place[k]].get<double>() / expected[k], 1.0, 1e-5);
    if (k == 2) continue;  // far above the scene's band
    EXPECT_NEAR(modes["frequencies_hz"][place[k]].get<double>() / expected[k], 1.0, 1e-4);
  }
  EXPECT_TRUE(modes["full"]["within_tolerance"].get<bool>());
  EXPECT_NEAR(modes["damping_ratios"][0].get<double>(), 0.01, 1e-3);
}

TEST_F(Cli, ACheckThatFailsEndsWithStatusOne) {
  std::string coarse = beam_scene;  // static shapes alone miss the first bending modes, which the band asks for
  coarse.replace(coarse.find("{modes: 12}"), 11, "{basis: craig-bampton, modes: 0}");
  coarse.replace(coarse.find("40 Hz"), 5, "400 Hz");
  coarse = folder_.write("coarse.yaml", coarse).string();
  const json modes = object("modes " + coarse + " --full --count 4", 1);
  EXPECT_FALSE(modes["full"]["within_tolerance"].get<bool>());
}

TEST_F(Cli, StaticResponseIsTheCantileversDeflection) {
  const json info = object("info " + (folder_.path() / "beam_16.msh").string());
  const double length =
      info["bounding_box_file_units"]["max"][0].get<double>() - info["bounding_box_file_units"]["min"][0].get<double>();
  const json frf = object("frf " + scene_ + " --from push --to tip.z --band 1e-4 1e-3 --points 2");
  // F = 1 N at the tip: L³/3EI with EI of bending in x-z; static shapes are exact in Craig-Bampton.
  const double I = 0.125 * 0.25 * 0.25 * 0.25 / 12.0;
  EXPECT_NEAR(frf["responses"][0]["gain"][0].get<double>() * 3.0 * 200e9 * I / std::pow(length, 3), 1.0, 1e-6);
  EXPECT_EQ(frf["responses"][0]["unit"], "(m)/(N)");
  EXPECT_EQ(frf["frequencies_hz"].size(), 2u);
}

TEST_F(Cli, ReduceWritesABodyThatTheSceneCanUse) {
  const std::string body = (folder_.path() / "beam.body.json").string();
  const json reduced = object("reduce " + scene_ + " --body beam -o " + body);
  EXPECT_TRUE(fs::exists(body));
  EXPECT_GE(reduced["certificate"]["modes_counted"].get<int>(), 12);
  const std::string joined = folder_
                                 .write("reduced.yaml", R"(units: SI
bodies: {beam: {reduced: beam.body.json}}
ground: [beam.root]
)")
                                 .string();
  const json from_file = object("modes " + joined), direct = object("modes " + scene_);
  EXPECT_EQ(from_file["frequencies_hz"], direct["frequencies_hz"]);
}

// A skew patch of a cylinder, R = 1, cells of about .2 × .2: h²/(R t) = 40 for t = .001.
TEST_F(Cli, ReduceCertifiesWhatAMeshDoesNotResolve) {
  std::string points, cells;
  for (int j = 0; j < 5; ++j)
    for (int i = 0; i < 5; ++i)
      points += fmt::format("{} {} {}\n", std::cos(0.2 * i), 0.2 * (j + i), std::sin(0.2 * i));
  for (int j = 0; j < 4; ++j)
    for (int i = 0; i < 4; ++i)
      cells += fmt::format("4 {} {} {} {}\n", 5 * j + i, 5 * j + i + 1, 5 * j + i + 6, 5 * j + i + 5);
  folder_.write("patch.vtk", "# vtk DataFile Version 3.0\nt\nASCII\nDATASET UNSTRUCTURED_GRID\nPOINTS 25 double\n" +
                                 points + "CELLS 16 80\n" + cells + "CELL_TYPES 16\n" +
                                 "9 9 9 9 9 9 9 9 9 9 9 9 9 9 9 9\n");
  for (const auto& [thickness, said] : {std::pair(0.001, true), {0.1, false}}) {
    const auto scene = folder_.write(
        "patch.yaml",
        fmt::format("units: SI\nbodies: {{patch: {{fe: patch.vtk, material: steel, sections: {{everywhere: "
                    "{{shell: {}}}}}, ports: {{root: {{nearest: [1, 0, 0]}}}}, reduction: {{basis: "
                    "craig-bampton, modes: 3}}}}}}\n",
                    thickness));
    const std::string certificate = object("reduce " + scene.string() + " --body patch")["certificate"].dump();
    EXPECT_EQ(certificate.find("bending that the mesh does not resolve: 16 skew shells") != certificate.npos, said);
  }
}

TEST_F(Cli, AssembleWritesNamedChannelsWithUnits) {
  const std::string file = (folder_.path() / "system.json").string();
  const json summary = object("assemble " + scene_ + " -o " + file);
  const json system = json::parse(text(file));
  EXPECT_EQ(system["A"].size(), summary["states"].get<std::size_t>());
  EXPECT_EQ(system["inputs"][0]["name"], "push");
  EXPECT_EQ(system["outputs"][1]["name"], "tip.z");
  EXPECT_EQ(system["outputs"][1]["unit"], "m");
}

TEST_F(Cli, CheckLooksAtMassAndRigidMotions) {
  const json floating = object("check " + scene_with("ground: [beam.root]", "ground: []"));
  EXPECT_EQ(floating["rigid_motions"], 6);
  EXPECT_TRUE(floating["good"].get<bool>());
  EXPECT_EQ(object("check " + scene_)["rigid_motions"], 0);
  EXPECT_THAT(floating["bodies"][0]["plan"]["kept"].get<std::string>(), HasSubstr("lowest 12 fixed-interface modes"));
}

TEST_F(Cli, WritesPicturesAndTables) {
  const std::string svg = (folder_.path() / "frf.svg").string(), csv = (folder_.path() / "frf.csv").string();
  ASSERT_EQ(tenon("frf " + scene_ + " --from push --to tip --svg " + svg + " -o " + csv).status, 0);
  EXPECT_THAT(text(svg),
              testing::AllOf(testing::StartsWith("<svg"), HasSubstr("<polyline"), HasSubstr("frequency [Hz]")));
  EXPECT_THAT(text(csv), testing::StartsWith("frequency_hz,tip.y gain (m)/(N),tip.y phase_deg,tip.z gain"));
  const std::string vtu = (folder_.path() / "modes.vtu").string();
  ASSERT_EQ(tenon("modes " + scene_ + " --count 3 --vtu " + vtu).status, 0);
  EXPECT_THAT(text(vtu),
              testing::AllOf(HasSubstr("NumberOfPoints=\"17\" NumberOfCells=\"16\""), HasSubstr("mode 03, ")));
}

TEST_F(Cli, TablesFitAHundredColumns) {
  for (const char* command : {"check ", "modes ", "reduce --body beam ", "assemble "}) {
    std::istringstream lines(tenon(std::string(command) + "scene.yaml").out);
    for (std::string line; std::getline(lines, line);)
      EXPECT_LE(std::count_if(line.begin(), line.end(), [](char c) { return (c & 0xC0) != 0x80; }), 100) << line;
  }
}

TEST_F(Cli, InitWritesASceneThatOnlyLacksWhatTheUserKnows) {
  const std::string mesh = (folder_.path() / "beam_16.msh").string();
  std::string text = tenon("init " + mesh).out;
  const Ended unfilled = tenon("check " + folder_.write("new.yaml", text).string());
  EXPECT_EQ(unfilled.status, 2);
  EXPECT_THAT(unfilled.err, HasSubstr("found 'UNITS', expected one of SI"));
  for (const auto& [word, value] : {std::pair("UNITS ", "SI "), {"[OUTER, INNER]", "[0.1, 0.09]"}, {"BAND", "20"}}) {
    ASSERT_NE(text.find(word), std::string::npos);
    text.replace(text.find(word), std::string(word).size(), value);
  }
  EXPECT_EQ(tenon("check " + folder_.write("new.yaml", text).string()).status, 0);
}

/// A written scene with its capitals filled in ends `tenon check` with that status.
TEST_F(Cli, InitWritesScenesForEveryFormat) {
  const fs::path folder = folder_.path();
  const auto check = [&](const std::string& file) {
    std::string text = tenon("init " + (folder / file).string()).out;
    for (const auto& [word, value] :
         {std::pair("UNITS ", "SI "), {"[OUTER, INNER]", "[0.1, 0.09]"}, {"THICKNESS", "0.02"}, {"BAND", "20"}})
      for (std::size_t at = text.find(word); at != std::string::npos; at = text.find(word))
        text.replace(at, std::string(word).size(), value);
    const Ended checked = tenon("check " + folder_.write("of_" + file + ".yaml", text).string());
    EXPECT_EQ(checked.status, 0) << file << checked.err << checked.out << text;
    return text;
  };
  const std::string grids = "GRID,1\nGRID,2,,1.\nGRID,3,,1.,1.\nGRID,4,,,1.\n";
  folder_.write("plate.bdf",
                grids + "MAT1,1,2.+11,,.3,7800.\nPSHELL,7,1,.01,1,,1\nCQUAD4,5,7,1,2,3,4\nASET1,123456,1\n");
  folder_.write("deck.inp",
                "*NODE, NSET=NALL\n1, 0, 0, 0\n2, 1, 0, 0\n3, 1, 1, 0\n4, 0, 1, 0\n*NSET, NSET=EDGE\n1, 4\n"
                "*NSET, NSET=CORNER\n1\n*ELEMENT, TYPE=S4, ELSET=SKIN\n1, 1, 2, 3, 4\n*MATERIAL, NAME=M\n*ELASTIC\n"
                "2e11, 0.3\n*DENSITY\n7800\n*SHELL SECTION, ELSET=SKIN, MATERIAL=M\n0.01\n");
  folder_.write("mesh.inp",
                "*NODE\n1, 0, 0, 0\n2, 1, 0, 0\n3, 1, 1, 0\n4, 0, 1, 0\n*ELEMENT, TYPE=S4, ELSET=MY SKIN\n"
                "1, 1, 2, 3, 4\n*NSET, NSET=ROOT\n1, 4\n");
  folder_.write("plain.vtk",
                "# vtk DataFile Version 3.0\nt\nASCII\nDATASET UNSTRUCTURED_GRID\nPOINTS 4 double\n"
                "0 0 0 1 0 0 1 1 0 0 1 0\nCELLS 1 5\n4 0 1 2 3\nCELL_TYPES 1\n9\n");
  EXPECT_EQ(tenon("export " + (folder / "plain.vtk").string() + " -o " + (folder / "plain.vtu").string()).status, 0);
  EXPECT_THAT(check("plate.bdf"), HasSubstr("boundary: {set: boundary}"));
  fs::copy_file(folder / "plate.bdf", folder / "plate.dat");
  EXPECT_THAT(check("plate.dat"), HasSubstr("fe: \"plate.dat\""));
  const std::string deck = check("deck.inp");
  EXPECT_THAT(deck, HasSubstr("      CORNER: {set: CORNER}\n      # EDGE: {set: EDGE}  # shares points"));
  EXPECT_THAT(deck, HasSubstr("# NALL: {set: NALL}  # most of the points"));
  EXPECT_THAT(check("mesh.inp"), HasSubstr("\"MY SKIN\": {shell"));
  EXPECT_THAT(check("plain.vtk"), HasSubstr("everywhere: {shell"));
  check("plain.vtu");
  folder_.write(
      "plain.xdmf",
      "<Xdmf Version=\"3.0\"><Domain><Grid GridType=\"Uniform\">\n<Topology TopologyType=\"Quadrilateral\" "
      "NumberOfElements=\"1\"><DataItem Dimensions=\"1 4\" NumberType=\"Int\" Format=\"XML\">0 1 2 3</DataItem>"
      "</Topology>\n<Geometry GeometryType=\"XYZ\"><DataItem Dimensions=\"4 3\" Format=\"XML\">"
      "0 0 0 1 0 0 1 1 0 0 1 0</DataItem></Geometry>\n</Grid></Domain></Xdmf>\n");
  EXPECT_THAT(check("plain.xdmf"), HasSubstr("everywhere: {shell"));
  folder_.write("rim.msh",
                "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$PhysicalNames\n3\n2 1 \"skin\"\n1 2 \"rim\"\n1 3 \"brace\"\n"
                "$EndPhysicalNames\n$Nodes\n4\n1 0 0 0\n2 1 0 0\n3 1 1 0\n4 0 1 0\n$EndNodes\n$Elements\n3\n"
                "1 3 2 1 1 1 2 3 4\n2 1 2 2 2 4 1\n3 1 2 3 3 1 3\n$EndElements\n");
  EXPECT_THAT(check("rim.msh"), AllOf(HasSubstr("      # rim: {set: rim}  # lines along edges"),
                                      Not(HasSubstr("# brace")), HasSubstr("brace: {tube"), HasSubstr("rim: {tube")));
  // lines that no group names beside surfaces that none names, and a group of a surface and its edges
  folder_.write("bare.msh",
                "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes\n4\n1 0 0 0\n2 1 0 0\n3 1 1 0\n4 0 1 0\n$EndNodes\n"
                "$Elements\n2\n1 3 2 0 1 1 2 3 4\n2 1 2 0 2 4 1\n$EndElements\n");
  EXPECT_THAT(check("bare.msh"), AllOf(HasSubstr("everywhere: {shell"), HasSubstr("    ignore: [everywhere]  ")));
  folder_.write(
      "both.msh",
      "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$PhysicalNames\n2\n2 1 \"skin\"\n1 2 \"skin\"\n$EndPhysicalNames\n"
      "$Nodes\n4\n1 0 0 0\n2 1 0 0\n3 1 1 0\n4 0 1 0\n$EndNodes\n"
      "$Elements\n2\n1 3 2 1 1 1 2 3 4\n2 1 2 2 2 4 1\n$EndElements\n");
  EXPECT_THAT(check("both.msh"), AllOf(HasSubstr("skin: {shell"), HasSubstr("    ignore: [everywhere]  ")));
  folder_.write("twice.vtk",  // sets of each part and of parts together
                "# vtk DataFile Version 3.0\nt\nASCII\nDATASET UNSTRUCTURED_GRID\nPOINTS 6 double\n"
                "0 0 0 1 0 0 1 1 0 0 1 0 2 0 0 2 1 0\nCELLS 2 10\n4 0 1 2 3\n4 1 4 5 2\nCELL_TYPES 2\n9\n9\n"
                "CELL_DATA 2\nSCALARS part int 1\nLOOKUP_TABLE default\n1\n2\nSCALARS skin int 1\n"
                "LOOKUP_TABLE default\n7\n7\n");
  EXPECT_THAT(check("twice.vtk"),
              AllOf(HasSubstr("      skin_7: {shell"), HasSubstr("      # part_1: shares cells with skin_7\n")));
  folder_.write("alike.msh",
                "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$PhysicalNames\n4\n2 1 \"skin\"\n1 2 \"rim a\"\n"
                "1 3 \"rim_a\"\n1 4 \"root\"\n$EndPhysicalNames\n$Nodes\n4\n1 0 0 0\n2 1 0 0\n3 1 1 0\n4 0 1 0\n"
                "$EndNodes\n$Elements\n4\n1 3 2 1 1 1 2 3 4\n2 1 2 2 2 4 1\n3 1 2 3 3 1 2\n4 1 2 4 4 3 4\n"
                "$EndElements\n");
  EXPECT_THAT(check("alike.msh"), AllOf(HasSubstr("      root: {nearest"), HasSubstr("# rim_a: {set: \"rim a\"}"),
                                        HasSubstr("# rim_a_: {set: rim_a}"), HasSubstr("# root_: {set: root}")));
  folder_.write("block.vtk",
                "# vtk DataFile Version 3.0\nt\nASCII\nDATASET UNSTRUCTURED_GRID\nPOINTS 4 double\n"
                "0 0 0 1 0 0 1 1 0 0 1 1\nCELLS 1 5\n4 0 1 2 3\nCELL_TYPES 1\n10\n");
  const Ended none = tenon("init " + folder.string());
  EXPECT_EQ(none.status, 2);
  EXPECT_THAT(none.err, HasSubstr("this is a folder"));
  const Ended solid = tenon("init " + (folder / "block.vtk").string());
  EXPECT_EQ(solid.status, 2);
  EXPECT_THAT(solid.err, HasSubstr("by the K and M of the program that owns it"));
  const json info = json::parse(tenon("info " + (folder / "block.vtk").string() + " --json").out);
  EXPECT_EQ(info["read_past"][0]["name"], "tetra");
  EXPECT_EQ(info["read_past"][0]["changes_physics"], true);
  for (const char* command : {"info ", "check "})
    EXPECT_THAT(tenon(command + (folder / "block.vtk").string()).out, HasSubstr("`matrices:` in a scene"));
  std::ofstream(folder / "block.yaml") << "units: SI\nbodies:\n  b:\n    fe: block.vtk\n    material: steel\n"
                                          "    sections: {everywhere: {shell: 0.1}}\n    ports: {p: {node: 1}}\n";
  EXPECT_THAT(tenon("check " + (folder / "block.yaml").string()).err, HasSubstr("`matrices:` in place of `fe:`"));
}

/// What a deck holds takes no joint: sets of held nodes stay comments, and the port falls to a free node of the deck.
TEST_F(Cli, InitLeavesHeldNodesToTheDeck) {
  const std::string plate =
      "*NODE\n1, 0, 0, 0\n2, 1, 0, 0\n3, 1, 1, 0\n4, 0, 1, 0\n5, 2, 0, 0\n6, 2, 1, 0\n*ELEMENT, TYPE=S4, ELSET=SKIN\n"
      "1, 1, 2, 3, 4\n2, 2, 5, 6, 3\n*NSET, NSET=ROOT\n1, 4\n*MATERIAL, NAME=M\n*ELASTIC\n2e11, 0.3\n*DENSITY\n7800\n"
      "*SHELL SECTION, ELSET=SKIN, MATERIAL=M\n0.01\n*BOUNDARY\nROOT, 1, 6\n";
  const auto scene = [&](const std::string& name, const std::string& deck) {
    std::string text = tenon("init " + folder_.write(name, deck).string()).out;
    for (const auto& [word, value] : {std::pair("UNITS ", "SI "), {"BAND", "20"}})
      for (std::size_t at = text.find(word); at != std::string::npos; at = text.find(word))
        text.replace(at, std::string(word).size(), value);
    const Ended checked = tenon("check " + folder_.write(name + ".yaml", text).string());
    EXPECT_EQ(checked.status, 0) << checked.err << checked.out << text;
    return text;
  };
  const std::string held = scene("held.inp", plate);
  EXPECT_THAT(held, HasSubstr("      # ROOT: {set: ROOT}  # held by the deck"));
  EXPECT_THAT(held, HasSubstr("      root: {node: 2}\n"));  // 1 m from the origin; 1 and 4 are held
  const std::string named =
      scene("named.inp", plate + "*NSET, NSET=\"no. 1\"\n2\n*NSET, NSET=no..1\n3\n*NSET, NSET=NULL\n5\n");
  EXPECT_THAT(named, HasSubstr("      no__1: {set: \"no. 1\"}\n"));
  EXPECT_THAT(named, HasSubstr("      no__1_: {set: \"no..1\"}\n"));
  EXPECT_THAT(named, HasSubstr("      \"NULL\": {set: \"NULL\"}\n"));
  EXPECT_THAT(named, testing::Not(HasSubstr("node:")));
  folder_.write("accents.inp", plate + "*NSET, NSET=Fl\xFCgel\n2\n");
  const Ended accents = tenon("init " + (folder_.path() / "accents.inp").string());
  EXPECT_EQ(accents.status, 2);
  EXPECT_THAT(accents.err, HasSubstr("is no UTF-8 text"));
}

/// A scene beside the mesh's folder names the mesh from where it stands.
TEST_F(Cli, InitNamesTheMeshFromTheScenesFolder) {
  fs::create_directories(folder_.path() / "meshes");
  fs::create_directories(folder_.path() / "scenes");
  folder_.write("meshes/one.bdf",
                "GRID,1\nGRID,2,,1.\nGRID,3,,1.,1.\nMAT1,1,2.+11,,.3,7800.\nPSHELL,7,1,.01,1,,1\n"
                "CTRIA3,5,7,1,2,3\n");
  const fs::path scene = folder_.path() / "scenes" / "one.yaml";
  ASSERT_EQ(tenon("init " + (folder_.path() / "meshes" / "one.bdf").string() + " -o " + scene.string()).status, 0);
  std::ifstream stream(scene);
  std::string text(std::istreambuf_iterator<char>(stream), {});
  EXPECT_THAT(text, HasSubstr("fe: \"../meshes/one.bdf\"\n"));
  text.replace(text.find("UNITS "), 6, "SI    ").replace(text.find("BAND"), 4, "20  ");
  const Ended checked = tenon("check " + folder_.write("scenes/filled.yaml", text).string());
  EXPECT_EQ(checked.status, 0) << checked.err << checked.out << text;
}

TEST_F(Cli, BeamPrintsThePapersTablesAndOnesOwnBeam) {
  EXPECT_THAT(tenon("beam").out, HasSubstr("4.38953"));  // the corrected inverse of G_f,4
  // steel, 2 m, solid circle of 10 mm radius: (βl)² √(E r²/4ρ) / l² / 2π
  const json own = object("beam --length 2 --section circle:0.01 --material steel --bc clamped-free --svg b.svg");
  const double exact =
      3.516015268741421 * std::sqrt(200e9 * 0.01 * 0.01 / 4.0 / 7850.0) / 4.0 / (2.0 * std::numbers::pi);
  EXPECT_NEAR(own["cases"][0]["reference_hz"].get<double>(), exact, 1e-9 * exact);
  for (const auto& value : own["cases"][0]["frequencies_hz"]) EXPECT_NEAR(value.get<double>(), exact, 1e-4 * exact);
  ASSERT_EQ(own["convergence"].size(), 2u);
  EXPECT_THAT(text(folder_.path() / "b.svg"), HasSubstr("mode 1, elements"));
}

TEST_F(Cli, SweepTurnsAJointAndItsLoop) {
  const std::string scene = (fs::path(TENON_SOURCE_DIR) / "data/fourbar/scene.yaml").string();
  const json swept =
      object("sweep " + scene +
             " --joint drive --hold --to 90 --steps 4 -o table.csv --svg plot.svg --shapes shapes.svg --at 0 90");
  ASSERT_EQ(swept["points"].size(), 4u);
  EXPECT_EQ(swept["points"][3]["angle_deg"], 90.0);
  EXPECT_EQ(swept["points"][0]["rigid_modes"], 0);
  // exact dynamic stiffness at 0 degrees; quintic beams are 1e-4 above it
  EXPECT_NEAR(2.0 * std::numbers::pi * swept["points"][0]["frequencies_hz"][0].get<double>(), 269.61825725, 0.03);
  // links of 108, 279.4 and 270.5 mm close on a ground link of 254 mm
  const double a = std::numbers::pi / 2,
               b = a + swept["points"][3]["joint_angles_deg"]["a"].get<double>() / 57.29577951308232,
               c = b + swept["points"][3]["joint_angles_deg"]["b"].get<double>() / 57.29577951308232;
  EXPECT_NEAR(0.108 * std::cos(a) + 0.2794 * std::cos(b) + 0.2705 * std::cos(c), 0.254, 1e-12);
  EXPECT_NEAR(0.108 * std::sin(a) + 0.2794 * std::sin(b) + 0.2705 * std::sin(c), 0.0, 1e-12);
  EXPECT_THAT(text(folder_.path() / "table.csv"), HasSubstr("drive_deg,rigid_modes,f1_hz"));
  for (const char* picture : {"plot.svg", "shapes_0.svg", "shapes_90.svg"})
    EXPECT_THAT(text(folder_.path() / picture), HasSubstr("</svg>"));
}

// The cantilever of the scene, pushed at its tip along z at rest: −1 N and L m·N about y at the ground. Held at both
// ends through a weld given twice, every reaction is marked.
TEST_F(Cli, AssemblePrintsReactions) {
  const json rest = object("assemble " + scene_ + " --reactions 0")["reactions"];
  ASSERT_EQ(rest["rows"].size(), 6u);
  EXPECT_EQ(rest["rows"][2]["name"], "ground of beam.root, translation z");
  EXPECT_EQ(rest["rows"][4]["unit"], "N m");
  EXPECT_NEAR(rest["rows"][2]["per_unit_input"]["push"][0].get<double>(), -1.0, 1e-9);
  const json info = object("info " + (folder_.path() / "beam_16.msh").string())["bounding_box_file_units"];
  const double length = info["max"][0].get<double>() - info["min"][0].get<double>();
  EXPECT_NEAR(rest["rows"][4]["per_unit_input"]["push"][0].get<double>(), length, 1e-9 * length);
  EXPECT_TRUE(rest["rows"][0]["determinate"].get<bool>());

  folder_.write("loop.yaml",
                "units: SI\nbodies:\n  a: &bar {rigid: {mass: 2, inertia: [1, 1, 1]}, ports: {p: [0, 0, 0], q: [1, 0, "
                "0]}}\n  b: *bar\njoints:\n  one: {parent: a.p, child: b.p, weld: true}\n  two: {parent: a.q, child: "
                "b.q, weld: true}\ninputs: {push: {at: a.p, force: x}}\noutputs: {x: {at: a.p, acceleration: x}}\n");
  EXPECT_THAT(tenon("assemble loop.yaml --reactions 1").out,
              testing::AllOf(HasSubstr("* joint 'one', translation x"), HasSubstr("* indeterminate")));
  EXPECT_FALSE(object("assemble loop.yaml --reactions 1")["reactions"]["rows"][0]["determinate"].get<bool>());
  EXPECT_THAT(tenon("assemble loop.yaml --reactions 0").err, HasSubstr("has no static response"));
}

// The shipped four-bar against finite elements held to their plane: exact dynamic stiffness, crank free at 0 degrees.
TEST_F(Cli, ModesOfAPlanarMechanismBesideTheFullModel) {
  const std::string scene = (fs::path(TENON_SOURCE_DIR) / "data/fourbar/scene.yaml").string();
  const json modes = object("modes " + scene + " --full --count 5", 1);  // the quintic's fourth mode is 0.5 % high
  EXPECT_EQ(modes["rigid_modes"], 1);
  EXPECT_EQ(modes["full"]["rigid_modes"], 1);
  const double exact[] = {302.05666443, 334.10422238, 1206.7995677, 1290.9783227};
  for (std::size_t k = 0; k < 4; ++k)
    EXPECT_NEAR(2.0 * std::numbers::pi * modes["full"]["frequencies_hz"][k + 1].get<double>() / exact[k], 1.0, 1e-6);
}

// Names of a scene may hold what SVG keeps for itself.
TEST_F(Cli, PicturesEscapeNames) {
  std::string scene = text(fs::path(TENON_SOURCE_DIR) / "data/fourbar/scene.yaml");
  for (std::size_t at = 0; (at = scene.find("drive", at)) != std::string::npos; at += 4) scene.replace(at, 5, "d<&>");
  folder_.write("odd.yaml", scene);
  ASSERT_EQ(tenon("sweep odd.yaml --joint 'd<&>' --to 10 --steps 2 --svg plot.svg --shapes s.svg --at 0").status, 0);
  for (const char* picture : {"plot.svg", "s.svg"}) {
    EXPECT_THAT(text(folder_.path() / picture), HasSubstr("'d&lt;&amp;&gt;'"));
    EXPECT_THAT(text(folder_.path() / picture), testing::Not(HasSubstr("d<")));
  }
}

TEST_F(Cli, DoctorSaysWhatIsLinkedAndUnderWhichTerms) {
  const json doctor = object("doctor");
  for (const char* library : {"CHOLMOD", "SUNDIALS", "libzip"}) EXPECT_TRUE(doctor["libraries"].contains(library));
  EXPECT_GE(doctor["threads"].get<int>(), 1);
  EXPECT_THAT(doctor["licence"]["binary"].get<std::string>(), HasSubstr("GPL"));
}

TEST_F(Cli, DoctorCountsAndMeasuresForwardDynamics) {
  const json cost = object("doctor --cost --bodies 2 --svg cost.svg");
  ASSERT_EQ(cost["chains"].size(), 16u);  // 0 to 15 modes
  const json& chain = cost["chains"][10];
  EXPECT_NEAR(chain["counted_ratio"].get<double>(), 1.07, 5e-3);  // 19,579 / 18,280 by the polynomials of section 8
  EXPECT_GT(chain["articulated_s"].get<double>(), 0.0);
  EXPECT_THAT(text(folder_.path() / "cost.svg"), HasSubstr("2 bodies, measured"));
  // four bars, one of them the frame, and two lumped masses; 5 modes in the plane for each beam
  const json scene = object("doctor --cost " + (fs::path(TENON_SOURCE_DIR) / "data/fourbar/scene.yaml").string());
  EXPECT_EQ(scene["bodies"], 6);
  EXPECT_EQ(scene["modes"], 15);
  EXPECT_EQ(scene["closures"], 1);
  EXPECT_GT(scene["composite_s"].get<double>(), 0.0);
  EXPECT_GT(scene["articulated_s"].get<double>(), 0.0);
  EXPECT_EQ(scene["cheaper"] == "articulated", scene["articulated_s"] <= scene["composite_s"]);
}

TEST_F(Cli, HelpEndsWithStatusZeroAndAnExample) {
  EXPECT_EQ(tenon("--help").status, 0);
  for (const char* command : {"info", "export", "init", "check", "modes", "reduce", "assemble", "frf", "sweep",
                              "simulate", "beam", "doctor"}) {
    const Ended help = tenon(std::string(command) + " --help");
    EXPECT_EQ(help.status, 0);
    EXPECT_THAT(help.out, HasSubstr("Example"));
  }
}

/// Bad input: status 2, one sentence on standard error with place and cure, no file written, nothing on standard
/// output.
struct BadInput {
  const char* name;
  std::string arguments;  ///< SCENE, FOLDER are replaced
  const char* from;       ///< edit of the scene, "" for none
  const char* to;
  const char* message;  ///< regular expression
};

/// Gmsh 2.2: sets root (a point) and part; `cells` are lines "id type 2 2 1 nodes..." of the set part.
std::string small_mesh(int cell_dimension, const std::vector<std::string>& cells) {
  std::string mesh =
      "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$PhysicalNames\n2\n0 1 \"root\"\n" + std::to_string(cell_dimension) +
      " 2 \"part\"\n$EndPhysicalNames\n$Nodes\n5\n1 0 0 0\n2 1 0 0\n3 1 0 0\n4 2 0 0\n5 3 0 0\n$EndNodes\n"
      "$Elements\n" +
      std::to_string(cells.size() + 1) + "\n1 15 2 1 1 1\n";
  for (const std::string& cell : cells) mesh += cell + "\n";
  return mesh + "$EndElements\n";
}

std::string small_scene(const std::string& mesh, const std::string& section) {
  return "units: SI\nbodies:\n  b:\n    fe: " + mesh +
         "\n    material: {E: 70e9, nu: 0.3, rho: 2700}\n    sections: {part: " + section +
         "}\n    ports: {root: {set: root}}\n    parent_port: root\n";
}

class CliBadInput : public Cli, public testing::WithParamInterface<BadInput> {};

TEST_P(CliBadInput, EndsWithStatusTwoAndWritesNothing) {
  const BadInput& bad = GetParam();
  const std::string scene = *bad.from ? scene_with(bad.from, bad.to) : scene_;
  folder_.write("empty.msh", "");
  folder_.write("garbage.msh", std::string("\x7f\x01\x00\xff\x80garbage\x00\x00", 14));
  const std::string good = text(folder_.path() / "beam_16.msh");
  folder_.write("truncated.msh", good.substr(0, good.size() / 2));
  folder_.write("no_length.msh", small_mesh(1, {"2 1 2 2 1 1 2", "7 1 2 2 1 2 3", "4 1 2 2 1 3 4"}));
  folder_.write("no_length.yaml", small_scene("no_length.msh", "{circle: 0.01}"));
  folder_.write("apart.msh", small_mesh(1, {"2 1 2 2 1 1 2", "4 1 2 2 1 4 5"}));
  folder_.write("apart.yaml", small_scene("apart.msh", "{circle: 0.01}"));
  folder_.write("no_area.msh", small_mesh(2, {"8 2 2 2 1 1 2 4"}));
  folder_.write("no_area.yaml", small_scene("no_area.msh", "{shell: 0.01}"));
  folder_.write("loop.yaml",
                "units: SI\nbodies:\n  a: &bar {rigid: {mass: 1, inertia: [1, 1, 1]}, "
                "ports: {p: [0, 0, 0], q: [1, 0, 0]}}\n  b: *bar\njoints:\n"
                "  one: {parent: a.q, child: b.p, weld: true}\n"
                "  two: {parent: b.q, child: a.p, weld: true}\n");
  std::string running = text(fs::path(TENON_SOURCE_DIR) / "data/fourbar/scene.yaml");
  running += "simulation: {initial: {drive: {rate: 5}}}\n";
  std::string arguments = bad.arguments;
  for (const auto& [word, value] : {std::pair(std::string("SCENE"), scene),
                                    {"FOLDER", folder_.path().string()},
                                    {"RUNNING", folder_.write("running.yaml", running).string()},
                                    {"FOURBAR", (fs::path(TENON_SOURCE_DIR) / "data/fourbar/scene.yaml").string()}})
    for (std::size_t at = arguments.find(word); at != std::string::npos; at = arguments.find(word))
      arguments.replace(at, word.size(), value);
  const std::vector<std::string> before = files();
  const Ended run = tenon(arguments);
  EXPECT_EQ(run.status, 2) << run.out << run.err;
  EXPECT_THAT(run.err, ContainsRegex(bad.message));
  EXPECT_EQ(run.out, "");
  EXPECT_EQ(files(), before);
}

INSTANTIATE_TEST_SUITE_P(
    , CliBadInput,
    testing::Values(
        BadInput{"unknown_command", "mods SCENE", "", "", "no command 'mods'. Did you mean 'modes'"},
        BadInput{"missing_mesh", "info FOLDER/beam_17.msh", "", "", "beam_17.msh: .*Did you mean 'beam_16.msh'"},
        BadInput{"empty_mesh", "info FOLDER/empty.msh", "", "", "empty.msh"},
        BadInput{"garbage_mesh", "info FOLDER/garbage.msh", "", "", "garbage.msh"},
        BadInput{"truncated_mesh", "info FOLDER/truncated.msh", "", "", "truncated.msh:[0-9]+"},
        BadInput{"bare_mesh", "modes FOLDER/beam_16.msh", "", "",
                 "neither units nor materials nor sections.*tenon init"},
        BadInput{"missing_scene", "modes FOLDER/absent.yaml", "", "", "absent.yaml: there is no such file"},
        BadInput{"missing_set", "modes SCENE", "{set: left}", "{set: lefd}", "changed.yaml:7:.*no set 'lefd'"},
        BadInput{"missing_port", "assemble SCENE -o FOLDER/x.json", "beam.tip, force", "beam.top, force",
                 "changed.yaml:11:.*has no port 'top'. Did you mean 'tip'"},
        BadInput{"no_material", "reduce SCENE --body beam -o FOLDER/x.body.json",
                 "    material: {E: 200e9, nu: 0.3, rho: 8000}\n", "", "section 'beam' has no material. Add"},
        BadInput{"unknown_body", "reduce SCENE --body bean -o FOLDER/x.body.json", "", "", "Did you mean 'beam'"},
        BadInput{"unknown_output", "frf SCENE --from push --to top -o FOLDER/x.csv", "", "", "no output 'top'"},
        BadInput{"unknown_ending", "frf SCENE --from push --to tip -o FOLDER/x.xls", "", "",
                 "written as .csv or .json"},
        BadInput{"missing_folder", "assemble SCENE -o FOLDER/absent/x.json", "", "", "cannot be written"},
        BadInput{"zero_length", "reduce FOLDER/no_length.yaml --body b -o FOLDER/x.body.json", "", "",
                 "no_length.msh: beam element 7: its length is zero.*Delete it"},
        BadInput{"zero_area", "reduce FOLDER/no_area.yaml --body b -o FOLDER/x.body.json", "", "",
                 "no_area.msh: triangle element 8: its area is zero.*Delete it"},
        BadInput{"no_stiffness_path", "reduce FOLDER/apart.yaml --body b -o FOLDER/x.body.json", "", "",
                 "no stiffness path to parent port 'root': node 4 ux.*Join this part"},
        BadInput{"open_loop", "assemble FOLDER/loop.yaml -o FOLDER/x.json", "", "",
                 "joint 'two' \\(b.q to a.p\\) does not close: gap 2 m.*Correct"},
        BadInput{"unknown_port_of_a_joint", "assemble SCENE -o FOLDER/x.json", "ground: [beam.root]",
                 "joints: {j: {parent: beam.tip, child: beam.rot, weld: true}}", "changed.yaml:10:.*no port 'rot'"},
        BadInput{"held_and_reduced", "assemble SCENE -o FOLDER/x.json", "    damping: 0.01\n", "    fix: {left: all}\n",
                 "changed.yaml:3:.*held to the inertial frame.*cannot be reduced.*ground"},
        BadInput{"no_such_end", "beam --bc clamped-fre", "", "", "'fre' is no end of a beam. Did you mean 'free'"},
        BadInput{"half_a_beam", "beam --length 2", "", "", "needs all three"},
        BadInput{"no_such_shape", "beam --length 2 --section tub:1,2 --material steel", "", "", "Did you mean 'tube'"},
        BadInput{"no_such_joint", "sweep FOURBAR --joint driv", "", "", "no joint 'driv'. Did you mean 'drive'"},
        BadInput{"no_angle", "sweep FOURBAR --joint drive --to ninety", "", "", "'ninety' is no angle"},
        BadInput{"not_steady", "assemble RUNNING --linearise -o FOLDER/x.json", "", "",
                 "the initial motion is not steady.*tenon simulate"},
        BadInput{"linearised_reactions", "assemble SCENE --linearise --reactions 0", "", "", "--reactions"},
        BadInput{"no_units", "check SCENE", "units: SI\n", "", "beam_16.msh carries no units"},
        BadInput{"empty_band", "modes SCENE --band 5 5", "", "", "the band is empty"},
        BadInput{"bad_option", "modes SCENE --cuont 3", "", "", "cuont"}),
    [](const auto& info) { return std::string(info.param.name); });

TEST_F(Cli, AGoodFileSurvivesAFailedRun) {
  const std::string file = folder_.write("system.json", "good").string();
  EXPECT_EQ(tenon("assemble " + scene_with("{set: left}", "{set: lefd}") + " -o " + file).status, 2);
  EXPECT_EQ(text(file), "good");
}

}  // namespace
