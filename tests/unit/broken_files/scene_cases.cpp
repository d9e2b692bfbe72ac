#include <fmt/format.h>
#include "assembly/scene.hpp"

#include "tests/unit/broken_files/broken.hpp"

namespace tenon::broken {
namespace {

const std::string scene = R"(units: SI
materials: {foam: {E: 1e8, nu: 0.2, rho: 50}}
bodies:
  hub:
    rigid: {mass: 900, inertia: [400, 350, 500], com: [0, 0, 0.4]}
    ports: {east: [0, 0.9, 0]}
  panel:
    fe: panel.msh
    material: {E: 70e9, nu: 0.33, rho: 2700}
    sections: {skin: {shell: 0.02}, yoke: {tube: [0.05, 0.046]}}
    ports: {root: {set: root}, tip: {nearest: [4.0, 0.8, 0]}}
    damping: 0.005
  boom: {beam: {from: [0, 0, 0], to: [2, 0, 0], section: {circle: 0.03}, material: foam, elements: 8}}
joints:
  drive: {parent: hub.east, child: panel.root, revolute: y, angle: 30 deg, stiffness: 5, damping: 3, inertia: 0.02}
  tip: {parent: panel.tip, child: boom.P, weld: true}
masses: {ball: {at: hub.east, mass: 4}}
inputs: {torque: {at: drive}, push: {at: hub, force: x}}
outputs: {rate: {at: hub, angular_rate: z}}
requires: {band: [0, 20 Hz], tolerance: 1e-4}
)";

Case changed(const std::string& from, const std::string& to, std::vector<std::string> says) {
  return {from + " -> " + to, replaced(scene, from, to), std::move(says)};
}

}  // namespace

Family scene_cases() {
  Family family{"bad.yaml", [](const std::filesystem::path& file) { assembly::read_scene(file); }, {}};
  std::vector<Case>& cases = family.cases;
  cases.push_back({.name = "sound", .bytes = scene, .reads = true});
  std::vector<Word> numbers;
  for (const Word& word : numbers_of(scene, ",:[]{}"))
    if (word.text != "30" && word.text != "20") numbers.push_back(word);  // angles and frequencies: below
  add_words_for_numbers(cases, "scene", scene, numbers);
  for (const Word& word : numbers) {
    if (word.line < 5) continue;
    std::string nan = scene;
    nan.replace(word.offset, word.text.size(), ".nan");
    cases.push_back({.name = "nan at " + std::to_string(word.line) + ":" + std::to_string(word.column),
                     .bytes = nan,
                     .place = std::pair{word.line, word.column}});
  }
  for (Case& c : std::vector<Case>{
           changed("30 deg", "30 grad", {"bad.yaml:15:", "30 grad"}),
           changed("20 Hz", "20 hertz", {"bad.yaml:20:", "20 hertz"}),
           changed("20 Hz", "20", {"Hz"}),
           changed("units: SI", "units: si", {"bad.yaml:1:8", "SI"}),
           changed("units: SI", "units: {length: mm, mass: t}", {"bad.yaml:1:8", "time"}),
           changed("units: SI", "units: {length: mm, mass: t, time: s, force: pond}", {"bad.yaml:1:", "pond"}),
           changed("units: SI", "units: inch-lbm", {"bad.yaml:1:8", "Did you mean 'inch-lbf'"}),
           changed("units: SI", "units: [SI]", {"bad.yaml:1:8"}),
           changed("units: SI\n", "", {"panel.msh carries no units"}),
           changed("units: SI", "units: SI\nunits: SI", {"bad.yaml:2:1", "twice"}),
           changed("mass: 900", "mass: -900", {"bad.yaml:5:"}),
           changed("mass: 900", "mass: 1e999", {"bad.yaml:5:"}),
           changed("mass: 900", "mass: {kg: 900}", {"bad.yaml:5:"}),
           changed("mass: 900", "mass:", {"bad.yaml:5:"}),
           changed("[400, 350, 500]", "[400, 350]", {"bad.yaml:5:"}),
           changed("[400, 350, 500]", "[]", {"bad.yaml:5:"}),
           changed("com: [0, 0, 0.4]", "com: [0, 0, 0.4, 1]", {"bad.yaml:5:"}),
           changed("nu: 0.33", "nu: 0.5", {"bad.yaml:9:"}),
           changed("nu: 0.33", "nu: -1", {"bad.yaml:9:"}),
           changed("E: 70e9", "E: 0", {"bad.yaml:9:"}),
           changed("shell: 0.02", "shell: 0", {"bad.yaml:10:"}),
           changed("shell: 0.02", "shell: [0.02, 0.03]", {"bad.yaml:10:"}),
           changed("[0.05, 0.046]", "[0.046, 0.05]", {"bad.yaml:10:", "outer"}),
           changed("{set: root}", "{set: root, nearest: [0, 0, 0]}", {"bad.yaml:11:"}),
           changed("{set: root}", "{}", {"bad.yaml:11:"}),
           changed("fe: panel.msh", "fe: [panel.msh]", {"bad.yaml:8:"}),
           changed("fe: panel.msh\n", "fe: panel.msh\n    reduced: a.body.json\n", {"bad.yaml:"}),
           changed("elements: 8", "elements: 0", {"bad.yaml:13:"}),
           changed("elements: 8", "elements: 99999999999", {"bad.yaml:13:"}),
           changed("elements: 8", "elements: 8.5", {"bad.yaml:13:"}),
           changed("to: [2, 0, 0]", "to: [0, 0, 0]", {"bad.yaml:13:"}),
           changed("parent: hub.east", "parent: hub.west", {"bad.yaml:15:", "west"}),
           changed("parent: hub.east", "parent: [hub.east]", {"bad.yaml:15:"}),
           changed("revolute: y", "revolute: w", {"bad.yaml:15:"}),
           changed("revolute: y", "revolute: [0, 0, 0]", {"bad.yaml:15:"}),
           changed("weld: true", "weld: maybe", {"bad.yaml:16:"}),
           changed("stiffness: 5", "stiffness: -5", {"bad.yaml:15:"}),
           changed("  tip: {", "  drive: {", {"bad.yaml:16:", "twice"}),
           changed("at: hub.east, mass", "at: hob.east, mass", {"bad.yaml:17:", "Did you mean 'hub'"}),
           changed("force: x", "force: xx", {"bad.yaml:18:"}),
           changed("force: x", "farce: x", {"Did you mean 'force'"}),
           changed("angular_rate: z", "angular_rate: 3", {"bad.yaml:19:"}),
           changed("tolerance: 1e-4", "tolerance: 0", {"bad.yaml:20:"}),
           changed("[0, 20 Hz]", "[20 Hz, 0]", {"bad.yaml:20:", "empty"}),
           changed("bodies:\n", "bodies: {}\nbodys:\n", {"bad.yaml:4:1", "bodies"}),
           changed("joints:", "\tjoints:", {"bad.yaml:14:"}),
           changed("joints:", "joints: [", {"bad.yaml:"}),
           changed("  hub:", "  &a hub: *a\n  hub2:", {"bad.yaml:"}),
           changed("  hub:", "  ? [1, 2]\n  : 3\n  hub:", {"bad.yaml:4:"})})
    cases.push_back(std::move(c));
  std::string wide, deep = "units: SI\nbodies: ";
  for (const char c : scene) wide += {c, '\0'};
  for (int k = 0; k < 500; ++k) deep += '[';
  std::string laughs = "a0: &a0 [x, x, x, x, x, x, x, x, x, x]\n";
  for (int k = 1; k < 10; ++k) {
    laughs += "a" + std::to_string(k) + ": &a" + std::to_string(k) + " [";
    for (int i = 0; i < 10; ++i) laughs += (i > 0 ? ", *a" : "*a") + std::to_string(k - 1);
    laughs += "]\n";
  }
  std::string nested = "a0: &a0 x\n";  // each in a list of two levels about the one before
  for (int k = 1; k < 40; ++k) nested += fmt::format("a{}: &a{} [[*a{}]]\n", k, k, k - 1);
  cases.push_back({.name = "Windows line ends", .bytes = with_windows_ends(scene), .reads = true});
  cases.push_back({.name = "byte order mark", .bytes = "\xEF\xBB\xBF" + scene, .reads = true});
  cases.push_back({"tabs before keys", replaced(scene, "  hub:", "\thub:"), {"bad.yaml:4:"}});
  cases.push_back({"nested too deep", deep, {"bad.yaml:"}});
  cases.push_back({"aliases that multiply", laughs, {"too large"}});
  cases.push_back({"an alias inside what it names", "units: &u [SI, *u]\n", {"bad.yaml:1:16", "inside what it names"}});
  cases.push_back({"aliases that nest", nested, {"too deep"}});
  cases.push_back({"zero bytes", std::string(40, '\0'), {"bad.yaml"}});
  cases.push_back({"empty", "", {"bad.yaml"}});
  cases.push_back({"comments alone", "# nothing\n", {"bad.yaml"}});
  cases.push_back({"two documents", scene + "---\n" + scene, {"bad.yaml"}});
  cases.push_back({"a comma first", ",1.\n" + scene, {"bad.yaml:1:1", "belongs to nothing"}});  // once read on for ever
  cases.push_back({"a word", "scene", {"bad.yaml"}});
  for (const std::size_t n : {3U, 12U, 40U, 90U, 130U, 222U, 333U})
    cases.push_back({"cut after " + std::to_string(n), scene.substr(0, n), {"bad.yaml"}});
  return family;
}

}  // namespace tenon::broken
