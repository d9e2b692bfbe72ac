#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <numbers>

#include "assembly/build.hpp"
#include "assembly/same_body.hpp"
#include "fem/structure.hpp"
#include "tests/refusal.hpp"
#include "tests/support/temporary_folder.hpp"

namespace tenon::assembly {
namespace {

using testing::HasSubstr;

/// Two quadrilaterals of a strip along x, a beam from the origin to it, and three points of interest.
///   1 ──yoke── 2 ┬── 3 ┬── 4     y = 0
///                5 ┴── 6 ┴── 7     y = 1 (above in the plane)
const char* const mesh = R"($MeshFormat
2.2 0 8
$EndMeshFormat
$PhysicalNames
5
0 1 "root"
0 2 "tip"
1 3 "yoke"
1 5 "edge"
2 4 "skin"
$EndPhysicalNames
$Nodes
8
1 0 0 0
2 1000 0 0
3 2000 0 0
4 3000 0 0
5 1000 1000 0
6 2000 1000 0
7 3000 1000 0
8 9000 0 0
$EndNodes
$Elements
6
1 15 2 1 1 1
2 15 2 2 2 7
3 1 2 3 1 1 2
4 1 2 5 2 4 7
5 3 2 4 1 2 3 6 5
6 3 2 4 1 3 4 7 6
$EndElements
)";

const std::string scene_text = R"(units: {length: mm, mass: t, time: s}
bodies:
  panel:
    fe: panel.msh
    material: {E: 70e3, nu: 0.33, rho: 2.7e-9}
    sections: {skin: {shell: 20}, yoke: {circle: 50}}
    ports: {root: {set: root}, rim: {set: edge, at: [3000, 500, 0]}, mean: {set: edge, kind: average}, near: {nearest: [2100, 10, 0]}}
    fix: {tip: [x, rz]}
    masses: {lamp: {port: rim, mass: 0.001}, bolt: {node: 3, mass: 0.002}}
)";

class BuildModel : public testing::Test {
 protected:
  BuildModel() { folder_.write("panel.msh", mesh); }

  fem::Model build(const std::string& text) const {
    return build_model(read_scene(folder_.write("scene.yaml", text)).bodies[0]);
  }
  static std::string with(const std::string& from, const std::string& to) {
    std::string text = scene_text;
    const std::size_t at = text.find(from);
    EXPECT_NE(at, std::string::npos) << from;
    return text.replace(at, from.size(), to);
  }
  /// The message when `from` becomes `to`.
  std::string fault(const std::string& from, const std::string& to) const {
    try {
      build(with(from, to));
    } catch (const InputError& error) {
      return error.what();
    }
    return "built without complaint";
  }

  TemporaryFolder folder_;
};

TEST_F(BuildModel, GivesEveryCellItsSectionInSI) {
  const fem::Model model = build(scene_text);
  EXPECT_NEAR(model.nodes[3].x(), 3.0, 1e-15);
  ASSERT_EQ(model.elements.size(), 5u);  // a beam, two shells, two masses
  const auto& beam = std::get<fem::Beam>(model.elements[0]);
  EXPECT_EQ(beam.id, 3);
  EXPECT_NEAR(std::abs(beam.orientation.normalized().x()), 0.0, 1e-15);  // across the beam
  EXPECT_EQ(std::get<fem::Quad4>(model.elements[1]).nodes, (std::array<int, 4>{1, 2, 5, 4}));
  EXPECT_NEAR(model.shell_sections[0].thickness, 0.02, 1e-16);
  EXPECT_NEAR(model.materials[0].E, 70e9, 1.0);
  EXPECT_NEAR(model.beam_sections[0].A, std::numbers::pi * 0.05 * 0.05, 1e-16);
}

TEST_F(BuildModel, PutsPortsWhereTheSceneSays) {
  const fem::Model model = build(scene_text);
  ASSERT_EQ(model.ports.size(), 4u);
  EXPECT_EQ(model.ports[0].node, 0);  // a set of one node is that node
  const auto& rim = model.rigid_links.at(0);
  EXPECT_EQ(rim.independent, model.ports[1].node);
  EXPECT_EQ(rim.dependents, (std::vector<int>{3, 6}));
  EXPECT_NEAR((model.nodes[static_cast<std::size_t>(rim.independent)] - Vec3(3.0, 0.5, 0.0)).norm(), 0.0, 1e-15);
  EXPECT_LT(model.node_ids[static_cast<std::size_t>(rim.independent)], 0);
  const auto& mean = model.average_links.at(0);
  EXPECT_EQ(mean.reference, model.ports[2].node);
  EXPECT_EQ(mean.nodes.size(), 2u);
  EXPECT_EQ(model.ports[3].node, 2);
}

TEST_F(BuildModel, AddsSupportsAndMasses) {
  const fem::Model model = build(scene_text);
  ASSERT_EQ(model.supports.size(), 2u);
  EXPECT_EQ(model.supports[0].dof.node, 6);
  EXPECT_EQ(model.supports[1].dof.direction, 5);
  const auto& lamp = std::get<fem::PointMass>(model.elements[3]);
  EXPECT_EQ(lamp.node, model.ports[1].node);
  EXPECT_NEAR(lamp.mass, 1.0, 1e-15);
  EXPECT_EQ(std::get<fem::PointMass>(model.elements[4]).node, 2);
}

TEST_F(BuildModel, TakesEverywhereForWhatNoOtherSectionNames) {
  const fem::Model model = build(with("skin: {shell: 20}", "everywhere: {shell: 20}"));
  EXPECT_EQ(model.elements.size(), 5u);
}

TEST_F(BuildModel, ReadsLaminatesAndOffsetsOfShells) {
  const std::string skin = "skin: {shell: 20}";
  const std::string carbon = "ply: {E1: 135e3, E2: 10e3, nu12: 0.3, G12: 5e3, G23: 3.5e3, rho: 1.6e-9}";
  const fem::Model model =
      build(with(skin, "skin: {laminate: {plies: [[0.25, 45 deg], [0.5, 0], [4, 0, steel]], " + carbon +
                           ", symmetric: true}, orientation: [0, 2, 0], offset: 5, nsm: 1e-9}"));
  const fem::ShellSection& s = model.shell_sections.at(0);
  ASSERT_EQ(s.plies.size(), 6u);
  EXPECT_NEAR(s.thickness, 9.5e-3, 1e-16);
  EXPECT_NEAR(s.nsm, 1.0, 1e-12);
  EXPECT_NEAR(s.plies[0].angle, std::numbers::pi / 4, 1e-15);
  EXPECT_NEAR(s.plies[5].angle, std::numbers::pi / 4, 1e-15);
  EXPECT_NEAR(s.plies[1].E1, 135e9, 1.0);
  EXPECT_NEAR(s.plies[1].G13, 5e9, 1.0);  // G12 when absent
  EXPECT_NEAR(s.plies[1].rho, 1600.0, 1e-9);
  EXPECT_NEAR(s.plies[2].E2, 200e9, 1.0);
  const auto& quad = std::get<fem::Quad4>(model.elements[1]);
  EXPECT_NEAR(quad.offset, 5e-3, 1e-17);
  EXPECT_EQ(quad.material_axis, Vec3::UnitY());

  const auto laminate = [&](const std::string& text) { return fault(skin, "skin: {laminate: {" + text + "}}"); };
  EXPECT_THAT(laminate("plies: [[1, 0]]"), HasSubstr("the ply has no material"));
  EXPECT_THAT(laminate("plies: [1, 0], " + carbon), HasSubstr("expected [thickness, angle]"));
  EXPECT_THAT(laminate("plies: [], " + carbon), HasSubstr("no plies"));
  EXPECT_THAT(laminate("plies: [[1, 0, stel]]"), HasSubstr("'steel'?"));
  EXPECT_THAT(laminate("plies: [[1, 0]], ply: {E1: 1, E2: 100, nu12: 0.3, G12: 1, rho: 1}"), HasSubstr("nu21"));
  EXPECT_THAT(fault(skin, "skin: {shell: 20, orientation: [1, 0, 0]}"), HasSubstr("orientation"));
}

// Gmsh types 8 line3, 9 triangle6, 10 quad9, 16 quad8: areas 4, 4 and 2, pieces with the sense of
// their cells; the node in the middle of the quad8 is made.
TEST_F(BuildModel, SplitsSecondOrderCellsAndSaysSo) {
  folder_.write("panel.msh", R"($MeshFormat
2.2 0 8
$EndMeshFormat
$PhysicalNames
2
1 1 "rim"
2 2 "skin"
$EndPhysicalNames
$Nodes
17
1 0 0 0
2 2 0 0
3 2 2 0
4 0 2 0
5 1 0 0
6 2 1 0
7 1 2 0
8 0 1 0
9 1 1 0
10 4 0 0
11 4 2 0
12 3 0 0
13 4 1 0
14 3 2 0
15 6 0 0
16 5 0 0
17 5 1 0
$EndNodes
$Elements
4
1 8 2 1 1 1 2 5
2 10 2 2 1 1 2 3 4 5 6 7 8 9
3 16 2 2 1 2 10 11 3 12 13 14 6
4 9 2 2 1 10 15 11 16 17 13
$EndElements
)");
  const fem::Model model = build(R"(units: SI
bodies:
  panel:
    fe: panel.msh
    material: {E: 1, nu: 0.3, rho: 8}
    sections: {skin: {shell: 0.5}, rim: {circle: 0.1}}
    ports: {corner: {at: [0, 0, 0]}}
)");
  std::vector<std::string> losses;
  for (const fem::Loss& loss : model.losses)
    losses.push_back(std::to_string(loss.count) + " " + loss.name + ": " + loss.note);
  EXPECT_THAT(losses, testing::IsSupersetOf(
                          {HasSubstr("1 line3 cells: each is split into 2"),
                           HasSubstr("1 triangle6 cells: each is split into 4 first-order triangle"),
                           HasSubstr("1 quad9 cells: each is split into 4"),
                           HasSubstr("1 quad8 cells: each is split into 4 first-order quads, with a node made")}));
  ASSERT_EQ(model.elements.size(), 14u);
  EXPECT_EQ(model.nodes.size(), 18u);
  EXPECT_EQ(model.node_ids.back(), -1);
  EXPECT_NEAR((model.nodes.back() - Vec3(3.0, 1.0, 0.0)).norm(), 0.0, 1e-15);
  double area = 0.0, length = 0.0;
  const auto at = [&](int node) -> const Vec3& { return model.nodes[static_cast<std::size_t>(node)]; };
  for (const fem::Element& element : model.elements) {
    if (const auto* q = std::get_if<fem::Quad4>(&element)) {
      const double piece = 0.5 * (at(q->nodes[2]) - at(q->nodes[0])).cross(at(q->nodes[3]) - at(q->nodes[1])).z();
      EXPECT_NEAR(piece, 1.0, 1e-14);
      area += piece;
    } else if (const auto* t = std::get_if<fem::Tria3>(&element)) {
      const double piece = 0.5 * (at(t->nodes[1]) - at(t->nodes[0])).cross(at(t->nodes[2]) - at(t->nodes[0])).z();
      EXPECT_NEAR(piece, 0.5, 1e-14);
      area += piece;
    } else if (const auto* b = std::get_if<fem::Beam>(&element)) {
      length += (at(b->nodes[1]) - at(b->nodes[0])).norm();
    }
  }
  EXPECT_NEAR(area, 10.0, 1e-13);
  EXPECT_NEAR(length, 2.0, 1e-14);
}

TEST_F(BuildModel, RefusesWhatDoesNotFitTheMesh) {
  EXPECT_THAT(fault("yoke: {circle: 50}", "yok: {circle: 50}"),
              testing::AllOf(HasSubstr("scene.yaml:6:"), HasSubstr("no set of cells 'yok'"), HasSubstr("'yoke'?")));
  EXPECT_THAT(fault(", yoke: {circle: 50}", ""),
              testing::AllOf(HasSubstr("scene.yaml:3:3"), HasSubstr("1 line cells of"), HasSubstr("set 'yoke'"),
                             HasSubstr("under `ignore`")));
  EXPECT_THAT(fault("yoke: {circle: 50}", "yoke: {shell: 5}"), HasSubstr("'yoke' holds no triangles"));
  EXPECT_THAT(fault("yoke: {circle: 50}", "yoke: {circle: 50}, root: {circle: 5}"), HasSubstr("'root' holds no lines"));
  EXPECT_THAT(fault("{set: root}", "{set: rot}"),
              testing::AllOf(HasSubstr("scene.yaml:7:"), HasSubstr("no set 'rot'"), HasSubstr("Did you mean 'root'?")));
  EXPECT_THAT(
      fault("{nearest: [2100, 10, 0]}", "{at: [2100, 10, 0]}"),
      testing::AllOf(HasSubstr("no node at (2.1, 0.01, 0) m"), HasSubstr("node 3 is nearest"), HasSubstr("`nearest`")));
  EXPECT_THAT(fault("{nearest: [2100, 10, 0]}", "{node: 99}"), HasSubstr("there is no node 99"));
  EXPECT_THAT(fault("{nearest: [2100, 10, 0]}", "{node: 8}"), HasSubstr("no element uses node 8"));
  EXPECT_THAT(fault("{port: rim,", "{port: rum,"), HasSubstr("Did you mean 'rim'?"));
  EXPECT_THAT(fault("fe: panel.msh", "fe: absent.msh"), HasSubstr("absent.msh"));
}

// "edge" holds a line that two ports name: whether a section of lines everywhere means it too is the user's to say.
TEST_F(BuildModel, EverywhereTakesNoCellsOfPorts) {
  const std::string yoke = "yoke: {circle: 50}", fix = "    fix:";
  EXPECT_THAT(fault(yoke, "everywhere: {circle: 50}"),
              testing::AllOf(HasSubstr("scene.yaml:3:3"), HasSubstr("1 line cells of"), HasSubstr("is 4 of set 'edge'"),
                             HasSubstr("whether `everywhere` means them")));
  const auto beams = [](const fem::Model& model) {
    return std::ranges::count_if(model.elements, [](const auto& e) { return std::holds_alternative<fem::Beam>(e); });
  };
  EXPECT_EQ(beams(build(with(yoke, "everywhere: {circle: 50}, edge: {circle: 50}"))), 2);
  std::string ignored = with(yoke, "everywhere: {circle: 50}");
  EXPECT_EQ(beams(build(ignored.insert(ignored.find(fix), "    ignore: [edge]\n"))), 1);
}

TEST_F(BuildModel, IgnoresWhatIsNamedAndNothingElse) {
  const auto ignoring = [&](const std::string& sets) { return "    ignore: [" + sets + "]\n    fix:"; };
  EXPECT_THAT(fault("    fix:", ignoring("edg")),
              testing::AllOf(HasSubstr("scene.yaml:8:14"), HasSubstr("no set of cells 'edg'"), HasSubstr("'edge'?")));
  EXPECT_THAT(fault("    fix:", ignoring("edge, skin")),
              testing::AllOf(HasSubstr("scene.yaml:8:20"), HasSubstr("all cells of the set 'skin' have a section")));
  std::string text = with("    fix:", ignoring("everywhere"));
  const std::string yoke = ", yoke: {circle: 50}";
  text.erase(text.find(yoke), yoke.size());
  const std::string root = "{set: root}";  // at the yoke's end
  text.replace(text.find(root), root.size(), "{node: 2}");
  EXPECT_EQ(build(text).elements.size(), 4u);  // two shells, two masses
}

TEST_F(BuildModel, NamesLinksByTheirPorts) {
  std::string text = with("{set: edge, kind: average}", "{set: edge, kind: average, at: [3000, 0, 0]}");
  fem::Model model = build(text);
  model.average_links.at(0).nodes.resize(1);
  for (auto& group : model.average_links.at(0).nodes) group.directions = 0b000111;
  EXPECT_THAT(tests::refusal([&] { fem::assemble(model); }),
              HasSubstr("the averaging link of port mean has nodes that do not"));
}

TEST_F(BuildModel, RefusesCellsWithTwoSections) {
  std::string text = mesh;
  text.replace(text.find("5 3 2 4 1 2 3 6 5"), 17, "5 3 2 4 1 2 3 6 5\n7 3 2 6 1 2 3 6 5");
  text.replace(text.find("6\n1 15"), 1, "7");
  text.replace(text.find("5\n0 1"), 1, "6");
  text.replace(text.find("2 4 \"skin\""), 10, "2 4 \"skin\"\n2 6 \"patch\"");
  folder_.write("panel.msh", text);
  EXPECT_THAT(fault("yoke: {circle: 50}", "yoke: {circle: 50}, patch: {shell: 1}"),
              HasSubstr("sections 'skin' and 'patch' both name cell"));
}

// Bodies that differ in nothing but the name are reduced once, and are the same numbers.
TEST_F(BuildModel, ReducesEqualBodiesOnce) {
  const auto build_scene = [&](const std::string& third) {
    const Scene scene = read_scene(folder_.write(
        "twins.yaml",
        "units: SI\nbodies:\n"
        "  east: {beam: &b {from: [0, 0, 0], to: [1, 0, 0], section: {circle: 0.01}, material: steel, elements: 8}}\n"
        "  west: {beam: *b}\n  other: {beam: {<<: *b, " +
            third + "}}\njoints:\n  j: {parent: east.C, child: west.P, weld: true}\n" +
            "  k: {parent: west.C, child: other.P, weld: true}\n"));
    int reductions = 0;
    const Network network = build_network(
        scene, plan(scene), [&](double, const char* step) { reductions += std::string(step) == "component modes"; });
    return std::pair(network, reductions);
  };
  const auto [same, once] = build_scene("elements: 8");
  EXPECT_EQ(build_scene("elements: 9").second, 2 * once);
  ASSERT_GT(once, 0);
  EXPECT_EQ(same.bodies[1].name, "west");
  EXPECT_EQ(same.bodies[1].omega, same.bodies[0].omega);
  EXPECT_EQ(same.bodies[1].L, same.bodies[0].L);
  EXPECT_EQ(same.bodies[2].certificate.basis, same.bodies[0].certificate.basis);
}

// ... and everything that decides a body tells them apart.
TEST_F(BuildModel, FingerprintsDifferWhereBodiesDo) {
  const auto print_of = [&](const std::string& text) {
    const Scene scene = read_scene(folder_.write("scene.yaml", text));
    return fingerprint(scene.bodies[0], plan(scene).bodies[0]);
  };
  const std::string own = print_of(scene_text);
  EXPECT_EQ(print_of(with("  panel:", "  other:")), own);
  for (const auto& [from, to] : {std::pair("E: 70e3", "E: 71e3"),
                                 {"rho: 2.7e-9", "rho: 2.8e-9"},
                                 {"{shell: 20}", "{shell: 21}"},
                                 {"{circle: 50}", "{circle: 51}"},
                                 {"root: {set: root}", "foot: {set: root}"},
                                 {"[3000, 500, 0]", "[3000, 501, 0]"},
                                 {"kind: average", "kind: rigid"},
                                 {"[x, rz]", "[x, ry]"},
                                 {"mass: 0.001", "mass: 0.0011"},
                                 {"node: 3", "node: 4"},
                                 {"length: mm", "length: m"},
                                 {"{circle: 50}", "{circle: 50, tip: 40, along: [[0, 0, 0], [1, 0, 0]]}"},
                                 {"    fix:", "    damping: 0.01\n    fix:"},
                                 {"    fix:", "    reduction: {modes: 7}\n    fix:"},
                                 {"    fix:", "    reduction: rigid\n    fix:"}})
    EXPECT_NE(print_of(with(from, to)), own) << to;
  const auto tapered = [&](const char* way) { return print_of(with("{circle: 50}", way)); };
  EXPECT_NE(tapered("{circle: 50, tip: 40, along: [[0, 0, 0], [1, 0, 0]]}"),
            tapered("{circle: 50, tip: 30, along: [[0, 0, 0], [1, 0, 0]]}"));
  EXPECT_NE(tapered("{circle: 50, tip: 40, along: [[0, 0, 0], [1, 0, 0]]}"),
            tapered("{circle: 50, tip: 40, along: [[0, 0, 0], [2, 0, 0]]}"));
  const Scene scene = read_scene(folder_.write("scene.yaml", scene_text));
  BodyPlan moving = plan(scene).bodies[0];
  moving.options.nonlinear = true;  // shape integrals
  EXPECT_NE(fingerprint(scene.bodies[0], moving), own);
}

}  // namespace
}  // namespace tenon::assembly
