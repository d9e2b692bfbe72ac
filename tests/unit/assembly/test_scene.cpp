#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>
#include <numbers>
#include <regex>

#include "assembly/plan.hpp"
#include "assembly/scene.hpp"
#include "assembly/scene/schema.hpp"
#include "tests/support/temporary_folder.hpp"

namespace tenon::assembly {
namespace {

using testing::HasSubstr;

constexpr double pi = std::numbers::pi;

const std::string spacecraft = R"(units: {length: mm, mass: t, time: s}
materials: {foam: {E: 100, nu: 0.2, rho: 5e-11}}
bodies:
  hub:
    rigid: {mass: 0.9, inertia: [4e5, 3.5e5, 5e5], com: [0, 0, 400]}
    ports: {east: [0, 900, 0], west: {at: [0, -900, 0], rotate: {axis: z, angle: 180 deg}}}
  panel: &panel
    fe: panel.msh
    material: {E: 70e3, nu: 0.33, rho: 2.7e-9}
    sections: {skin: {shell: 20, material: foam}, yoke: {tube: [50, 46]}, rib: {rectangle: [10, 20], orientation: [0, 0, 1]}}
    ports: {root: {set: root, kind: average}, tip: {nearest: [4000, 800, 0]}}
    damping: 0.005
    reduction: {basis: clamped-free, band: 50 Hz}
    fix: {edge: [x, rz], pin: all}
    masses: {lamp: {port: tip, mass: 1e-4, offset: [0, 0, 5]}}
  twin:
    <<: *panel
    reduction: auto
  antenna: {reduced: antenna.body.json}
joints:
  drive: {parent: hub.east, child: panel.root, revolute: y, angle: 30 deg, stiffness: 5e6, damping: 3, inertia: 2e1}
  other: {parent: hub.west, child: twin.root, weld: true}
  tip:   {parent: panel.tip, child: antenna.foot, weld: true}
masses: {ball: {at: hub.east, mass: 0.004}}
inputs:  {torque: {at: drive}, thruster: {at: hub, force: [x, z]}}
outputs: {rate: {at: hub, angular_rate: z}, tip: {at: panel.tip, acceleration: [x, y, z]}, turn: {at: drive, measure: angle}}
requires: {band: [0, 20 Hz], tolerance: 1e-4}
)";

Scene read(const std::string& text, const TemporaryFolder& folder) {
  return read_scene(folder.write("scene.yaml", text));
}

TEST(Scene, ReadsEveryValueIntoSI) {
  const TemporaryFolder folder;
  const Scene scene = read(spacecraft, folder);
  ASSERT_EQ(scene.bodies.size(), 4u);

  const auto& hub = std::get<RigidSource>(scene.bodies[0].source);
  EXPECT_NEAR(hub.mass, 900.0, 1e-12 * 900.0);
  EXPECT_NEAR(hub.inertia(1, 1), 350.0, 1e-12 * 350.0);  // t mm² = 1e3 kg · 1e-6 m²
  EXPECT_NEAR(hub.centre.z(), 0.4, 1e-15);
  EXPECT_NEAR(scene.bodies[0].ports[0].where.point.y(), 0.9, 1e-15);
  EXPECT_NEAR(scene.bodies[0].ports[1].axes(0, 0), -1.0, 1e-15);

  const SceneBody& panel = scene.bodies[1];
  const auto& fe = std::get<FeSource>(panel.source);
  EXPECT_EQ(fe.file, folder.path() / "panel.msh");
  EXPECT_NEAR(fe.sections[0].material.E, 100e6, 1e-4);  // t/(mm s²) = MPa
  EXPECT_NEAR(fe.sections[0].material.rho, 50.0, 1e-12 * 50.0);
  EXPECT_NEAR(std::get<fem::ShellSection>(fe.sections[0].shape).thickness, 0.02, 1e-16);
  EXPECT_NEAR(std::get<fem::BeamSection>(fe.sections[1].shape).A, pi * (0.05 * 0.05 - 0.046 * 0.046), 1e-15);
  EXPECT_NEAR(std::get<fem::BeamSection>(fe.sections[2].shape).Iy, 0.01 * 8e-6 / 12.0, 1e-22);
  EXPECT_TRUE(panel.ports[0].average);
  EXPECT_EQ(panel.parent_port, "root");
  EXPECT_EQ(fe.supports[0].directions, 0b100001);
  EXPECT_EQ(fe.supports[1].directions, fem::all_six);
  EXPECT_NEAR(fe.masses[0].mass, 0.1, 1e-15);
  EXPECT_NEAR(*panel.reduction.band, 100.0 * pi, 1e-12);
  EXPECT_EQ(panel.reduction.basis, reduction::Basis::clamped_free);

  const SceneBody& twin = scene.bodies[2];  // the merge takes what the map does not say itself
  EXPECT_EQ(twin.reduction.kind, SceneReduction::Kind::automatic);
  EXPECT_EQ(twin.reduction.basis, reduction::Basis::craig_bampton_inertia_relief);
  EXPECT_EQ(twin.damping, 0.005);

  const Joint& drive = scene.joints[0].joint;
  EXPECT_NEAR(drive.angle, pi / 6.0, 1e-15);
  EXPECT_NEAR(drive.stiffness, 5e3, 1e-9);  // t mm²/s² = 1e-3 N m
  EXPECT_NEAR(drive.inertia, 0.02, 1e-16);
  EXPECT_EQ(drive.axis, Vec3::UnitY());

  ASSERT_EQ(scene.inputs.size(), 3u);
  EXPECT_TRUE(scene.inputs[0].joint);
  EXPECT_EQ(scene.inputs[2].name, "thruster.z");
  EXPECT_EQ(scene.inputs[2].direction, 2);
  ASSERT_EQ(scene.outputs.size(), 5u);
  EXPECT_EQ(scene.outputs[0].quantity, Quantity::velocity);
  EXPECT_EQ(scene.outputs[0].direction, 5);
  EXPECT_EQ(scene.outputs[4].quantity, Quantity::position);
  EXPECT_NEAR((*scene.requirement.band)[1], 40.0 * pi, 1e-12);
}

TEST(Scene, ReadsJsonAsTheSubsetItIs) {
  const TemporaryFolder folder;
  const Scene scene = read(R"({"units": "SI",
  "bodies": {"a": {"rigid": {"mass": 1, "inertia": [[2, -0.5, 0], [-0.5, 3, 0], [0, 0, 4]]}, "ports": {"p": [1, 0, 0]}}},
  "ground": ["a.p"]})",
                           folder);
  EXPECT_EQ(std::get<RigidSource>(scene.bodies[0].source).inertia(0, 1), -0.5);
  EXPECT_EQ(scene.ground[0].port, "p");
}

struct Fault {
  const char* name;
  const char* from;       ///< text of the good scene
  const char* to;         ///< what the fault makes of it
  const char* points_at;  ///< text of the faulty scene at whose start the message must point
  const char* what;
  const char* cure;
};

/// "line:column" of the text's first occurrence, counted from 1.
std::string place_of(const std::string& text, const std::string& word) {
  const std::size_t at = text.find(word);
  const auto line = std::count(text.begin(), text.begin() + static_cast<std::ptrdiff_t>(at), '\n') + 1;
  return std::to_string(line) + ":" + std::to_string(at - (at == 0 ? 0 : text.rfind('\n', at - 1) + 1) + 1);
}

class SceneFaults : public testing::TestWithParam<Fault> {};

TEST_P(SceneFaults, AreRefusedWithPlaceAndCure) {
  const TemporaryFolder folder;
  const Fault& fault = GetParam();
  std::string text = spacecraft;
  const std::size_t at = text.find(fault.from);
  ASSERT_NE(at, std::string::npos);
  text.replace(at, std::string(fault.from).size(), fault.to);
  ASSERT_NE(text.find(fault.points_at), std::string::npos);
  try {
    read(text, folder);
    FAIL() << "read without complaint";
  } catch (const InputError& error) {
    EXPECT_THAT(error.what(), HasSubstr("scene.yaml:" + place_of(text, fault.points_at) + ": "));
    EXPECT_THAT(error.what(), HasSubstr(fault.what));
    EXPECT_THAT(error.what(), HasSubstr(fault.cure));
  }
}

INSTANTIATE_TEST_SUITE_P(
    , SceneFaults,
    testing::Values(
        Fault{"unknown_key", "damping: 0.005", "dampng: 0.005", "dampng", "a body has no key 'dampng'",
              "Did you mean 'damping'?"},
        Fault{"unknown_key_on_top", "joints:", "joins:", "joins", "a scene has no key 'joins'",
              "Did you mean 'joints'?"},
        Fault{"key_twice", "damping: 0.005", "damping: 0.006\n    damping: 0.005", "damping: 0.005", "stands twice",
              "Keep one"},
        Fault{"wrong_form", "{tube: [50, 46]}", "{tube: 51}", "51}", "'tube' is a value, expected a list",
              "[outer, inner] radii"},
        Fault{"wrong_type", "damping: 0.005", "damping: little", "little", "found 'little', expected a number",
              "finite number"},
        Fault{"unit_in_place", "stiffness: 5e6", "stiffness: 5e6 N", "5e6 N", "expected a bare number",
              "states all units once"},
        Fault{"not_finite", "damping: 0.005", "damping: nan", "nan", "expected a number", "finite number"},
        Fault{"missing_key", "{mass: 0.9, inertia: [4e5, 3.5e5, 5e5], com: [0, 0, 400]}", "{mass: 0.9}", "{mass: 0.9}",
              "a rigid body without 'inertia'", "about the centre of mass"},
        Fault{"bare_frequency", "[0, 20 Hz]", "[0, 21]", "21]", "a frequency with its unit", "Write `20 Hz`"},
        Fault{"empty_band", "[0, 20 Hz]", "[9 Hz, 2 Hz]", "[9 Hz", "the band is empty", "lower frequency first"},
        Fault{"no_units", "units: {length: mm, mass: t, time: s}", "", "panel.msh", "panel.msh carries no units",
              "Add `units: SI`"},
        Fault{"unknown_unit", "length: mm", "length: mmm", "mmm", "found 'mmm'", "Did you mean 'mm'?"},
        Fault{"unknown_basis", "basis: clamped-free", "basis: clamped-fre", "clamped-fre", "found 'clamped-fre'",
              "Did you mean 'clamped-free'?"},
        Fault{"unknown_body", "parent: hub.east", "parent: hob.east", "hob", "there is no body 'hob'",
              "Did you mean 'hub'?"},
        Fault{"unknown_port", "parent: hub.east", "parent: hub.eest", "hub.eest", "body 'hub' has no port 'eest'",
              "Did you mean 'east'?"},
        Fault{"no_port", "parent: hub.east,", "parent: hub,", "hub, child", "expected body.port", "with a dot"},
        Fault{"no_material", "    material: {E: 70e3, nu: 0.33, rho: 2.7e-9}\n", "",
              "yoke: ", "section 'yoke' has no material", "Add `material: {E, nu, rho}`"},
        Fault{"unknown_material", "material: foam", "material: fom", "fom}", "found 'fom'", "Did you mean 'foam'?"},
        Fault{"no_sections",
              "    sections: {skin: {shell: 20, material: foam}, yoke: {tube: [50, 46]}, rib: {rectangle: [10, 20], "
              "orientation: [0, 0, 1]}}\n",
              "", "panel: &", "body 'panel' has no sections", "one for each set of cells"},
        Fault{"no_orientation", ", orientation: [0, 0, 1]", "", "rib: ", "is not round and has no orientation",
              "Add `orientation: [x, y, z]`"},
        Fault{"two_kinds", "weld: true}\n  tip", "weld: true, revolute: x}\n  tip", "revolute: x",
              "joint 'other' has both 'weld' and 'revolute'", "Keep one"},
        Fault{"tip_without_way", "{tube: [50, 46]}", "{tube: [50, 46], along: [[0, 0, 0], [9, 0, 0]]}", "along",
              "a section without `tip`", "Leave it out"},
        Fault{"tip_of_other_kind", "{tube: [50, 46]}", "{tube: [50, 46], tip: 3}", "3}", "expected a list of 2 numbers",
              "Write [..., ...]"},
        Fault{"tip_that_is_no_general_section", "{tube: [50, 46]}",
              "{general: {A: 9, Iy: 9, Iz: 9, J: 9}, tip: [1, 2], orientation: [0, 0, 1]}", "[1, 2]",
              "found no constants of a section", "Write {A: "},
        Fault{"tip_of_no_section", "{tube: [50, 46]}", "{tube: [50, 46], tip: [3, 4]}", "[3, 4]", "outer radius",
              "[outer, inner] radii"},
        Fault{"tip_with_fewer_sizes", "{tube: [50, 46]}", "{i: [9, 9, 1, 1, 8, 2], tip: [9, 9, 1, 1]}", "[9, 9, 1, 1]}",
              "found 4 sizes, expected 6", "the same sizes at both ends"},
        Fault{"way_without_length", "{tube: [50, 46]}", "{tube: [50, 46], tip: [5, 4], along: [[1, 0, 0], [1, 0, 0]]}",
              "[[1, 0, 0]", "the way has no length", "Move one"},
        Fault{"way_of_one_point", "{tube: [50, 46]}", "{tube: [50, 46], tip: [5, 4], along: [[1, 0, 0]]}",
              "[[1, 0, 0]]", "found no two points", "along: "},
        Fault{"rod_that_tapers", "{tube: [50, 46]}", "{rod: 3, tip: 2}", "tip", "a rod", "Leave it out"},
        Fault{"inside_out_tube", "[50, 46]", "[46, 50]", "[46, 50]", "outer radius", "[outer, inner] radii"},
        Fault{"self_joint", "child: panel.root", "child: hub.west", "hub.west, revolute", "joins body 'hub' to itself",
              "two bodies"},
        Fault{"unknown_target", "{at: drive}", "{at: drve}", "drve", "there is no body or joint 'drve'",
              "Did you mean 'drive'?"},
        Fault{"damping_of_one", "damping: 0.005", "damping: 5", "5\n    reduction", "is not below 1",
              "fraction of critical"},
        Fault{"gravity", "requires:", "run: {gravity: [0, 0, -9810]}\nrequires:", "[0, 0, -9810]", "gravity",
              "Leave it out"},
        Fault{"indefinite_inertia", "[4e5, 3.5e5, 5e5]", "[4e5, -1, 5e5]", "[4e5, -1, 5e5]",
              "negative principal moment", "Check signs"},
        Fault{"impossible_inertia", "[4e5, 3.5e5, 5e5]", "[4e5, 3.5e5, 9e5]", "[4e5, 3.5e5, 9e5]",
              "no body has the principal moments 350, 400, 900", "Check units"},
        Fault{"poisson", "nu: 0.2", "nu: 0.7", "0.7", "-1 < nu < 0.5", "Correct it"},
        Fault{"same_name", "  drive:", "  hub:", "hub: {parent", "names a body and a joint", "Rename"},
        Fault{"dotted_name", "  antenna:", "  anten.na:", "anten.na", "is no name", "without dots"}),
    [](const auto& info) { return std::string(info.param.name); });

void collect_keys(const Schema& schema, std::vector<std::string>& names) {
  for (const Key& key : schema.keys) {
    names.emplace_back(key.name);
    if (key.inside) collect_keys(*key.inside, names);
  }
  if (schema.each && schema.each->inside) collect_keys(*schema.each->inside, names);
}

TEST(Scene, TheGuideNamesEveryKeyOfTheGrammar) {
  std::ifstream stream(std::string(TENON_SOURCE_DIR) + "/docs/scene.md");
  const std::string guide{std::istreambuf_iterator<char>(stream), {}};
  std::vector<std::string> names;
  collect_keys(scene_schema(), names);
  ASSERT_GT(names.size(), 50u);
  for (const std::string& name : names)
    EXPECT_TRUE(std::regex_search(guide, std::regex("\\b" + name + "\\b"))) << "docs/scene.md does not name " << name;
}

TEST(Scene, SaysWhereTheYamlBreaks) {
  const TemporaryFolder folder;
  try {
    read("units: SI\nbodies: {a: {rigid: [1, 2}}\n", folder);
    FAIL() << "read without complaint";
  } catch (const InputError& error) {
    EXPECT_THAT(error.what(), HasSubstr("scene.yaml:2:"));
    EXPECT_THAT(error.what(), HasSubstr("this is not YAML"));
  }
}

TEST(Scene, RefusesWhatIsNoDocument) {
  const TemporaryFolder folder;
  EXPECT_THROW(read_scene(folder.path() / "absent.yaml"), InputError);
  EXPECT_THROW(read("", folder), InputError);
  EXPECT_THROW(read("[1, 2]", folder), InputError);
  EXPECT_THROW(read(std::string("\x00\xff\xfe\x01garbage", 11), folder), InputError);
  EXPECT_THROW(read("a: &a [*a]", folder), InputError);
}

TEST(Plan, KnowsEveryBasis) {
  using enum reduction::Basis;
  const TemporaryFolder folder;
  for (const auto& [word, basis, kept] :
       {std::tuple{"craig-bampton", craig_bampton, "static shapes of all ports, fixed-interface modes"},
        std::tuple{"craig-bampton-inertia-relief", craig_bampton_inertia_relief,
                   "rigid inertia, fixed-interface modes"},
        std::tuple{"clamped-free", clamped_free, "modes clamped at the parent port"},
        std::tuple{"clamped-free-static", clamped_free_static, "static shapes of the child ports, modes clamped"},
        std::tuple{"rubin", rubin, "static shapes of all ports, free-free modes"}}) {
    std::string text = spacecraft;
    const std::string chosen = "basis: clamped-free";
    text.replace(text.find(chosen), chosen.size(), std::string("basis: ") + word);
    const BodyPlan body = plan(read(text, folder)).bodies[1];
    EXPECT_EQ(body.options.basis, basis);
    EXPECT_THAT(body.kept, HasSubstr(kept));
  }
}

TEST(Plan, KeepsTwiceTheRequiredBandAndSaysWhy) {
  const TemporaryFolder folder;
  const Plan made = plan(read(spacecraft, folder));
  EXPECT_TRUE(made.bodies[0].rigid);
  EXPECT_NEAR(*made.bodies[1].options.band, 100.0 * pi, 1e-12);  // as the scene chose
  EXPECT_NEAR(*made.bodies[2].options.band, 80.0 * pi, 1e-12);   // auto: twice 20 Hz
  EXPECT_THAT(made.bodies[2].kept, HasSubstr("below 40 Hz"));
  EXPECT_EQ(made.bodies[2].options.zeta, 0.005);
}

}  // namespace
}  // namespace tenon::assembly
