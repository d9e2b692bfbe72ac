#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "assembly/scene/quantity.hpp"
#include "assembly/scene/read.hpp"
#include "assembly/scene/schema.hpp"
#include "assembly/scene/simulation.hpp"

namespace tenon::assembly {
namespace {

// Exact by definition: the international inch, foot and pound, and standard gravity.
constexpr double inch = 0.0254, foot = 0.3048, pound = 0.45359237, gravity = 9.80665, pound_force = pound * gravity;

double unit(const Value& value, const std::vector<std::pair<std::string, double>>& table) {
  std::vector<std::string> names;
  for (const auto& [name, factor] : table) names.push_back(name);
  return table[static_cast<std::size_t>(choice(value, names))].second;
}

/// Complains at the first mesh file that would have to be read without units, else at the top of the scene.
[[noreturn]] void refuse_without_units(const Value& document, const std::filesystem::path& file) {
  Place place{file.string(), 1, 1};
  std::string what = "the scene declares no units";
  if (const Value* bodies = document.find("bodies"))
    for (const Member& body : bodies->members)
      if (const Value* fe = body.value.find("fe")) {
        place = fe->place;
        what = fmt::format("{} carries no units and the scene declares none", fe->text);
        break;
      }
  throw InputError(place, what, "Add `units: SI` or e.g. `units: {length: mm, mass: t, time: s}` at the top");
}

/// The port a body hangs by when the scene does not say: the one by which it is a joint's child, else its first.
void choose_parent_ports(Scene& scene) {
  for (SceneBody& body : scene.bodies) {
    if (!body.parent_port.empty() || body.ports.empty()) continue;
    body.parent_port = body.ports.front().name;
    for (auto joint = scene.joints.rbegin(); joint != scene.joints.rend(); ++joint)
      if (joint->child.body == body.name) body.parent_port = joint->child.port;  // the first joint decides
  }
}

void read_requirement(const Value& map, Requirement& requirement) {
  if (const Value* band = map.find("band")) {
    if (band->items.size() != 2)
      throw InputError(band->place, fmt::format("a band of {} numbers", band->items.size()), "Write [0, 20 Hz]");
    requirement.band = {frequency(band->items[0]), frequency(band->items[1])};
    if (!((*requirement.band)[0] < (*requirement.band)[1]))
      throw InputError(band->place, "the band is empty", "Write the lower frequency first, e.g. [0, 20 Hz]");
  }
  if (const Value* tolerance = map.find("tolerance")) requirement.tolerance = positive(*tolerance, dimension::none, {});
}

/// The linear commands model rest without gravity: they must not drop it quietly.
void check_run(const Value& run, const Units& units) {
  if (const Value* duration = run.find("duration")) positive(*duration, dimension::time, units);
  if (const Value* gravity = run.find("gravity"))
    if (vector(*gravity, dimension::acceleration, units) != Vec3::Zero())
      throw InputError(gravity->place, "gravity changes the state of rest, which linear models take as unloaded",
                       "Leave it out, or write it under `simulation`, which only `tenon simulate` reads");
}

}  // namespace

void check_name(const Member& entry) {
  if (entry.key.empty() || entry.key.find_first_of(". \t/") != std::string::npos)
    throw InputError(entry.place, fmt::format("'{}' is no name", entry.key),
                     "Use one word without dots, slashes or blanks: a dot separates a body from its port");
}

Units read_units(const Value& document, const std::filesystem::path& file) {
  const Value* value = document.find("units");
  if (!value) refuse_without_units(document, file);
  if (value->kind == Value::Kind::scalar) {
    const std::vector<std::string> names{"SI", "mm-t-s", "inch-lbf", "inch-lbf-lbm"};
    switch (choice(*value, names)) {
      case 1:
        return {.length = 1e-3, .mass = 1e3, .name = names[1]};
      case 2:
        return {.length = inch, .mass = pound_force / inch, .name = names[2]};
      case 3:
        return {.length = inch, .mass = pound, .force = pound_force, .name = names[3]};
      default:
        return {};
    }
  }
  Units units;
  units.length =
      unit(*value->find("length"), {{"m", 1.0}, {"mm", 1e-3}, {"cm", 1e-2}, {"km", 1e3}, {"in", inch}, {"ft", foot}});
  units.mass = unit(*value->find("mass"), {{"kg", 1.0},
                                           {"g", 1e-3},
                                           {"t", 1e3},
                                           {"lb", pound},
                                           {"slug", pound_force / foot},
                                           {"slinch", pound_force / inch}});
  units.time = unit(*value->find("time"), {{"s", 1.0}, {"ms", 1e-3}});
  units.name =
      fmt::format("{}, {}, {}", value->find("length")->text, value->find("mass")->text, value->find("time")->text);
  if (const Value* force = value->find("force")) {
    units.force = unit(*force, {{"N", 1.0}, {"kN", 1e3}, {"lbf", pound_force}, {"kgf", gravity}});
    units.name += ", " + force->text;
  }
  return units;
}

namespace {

Scene read(const std::filesystem::path& path, bool moving) {
  const Value document = read_document(path);
  if (document.kind != Value::Kind::map)
    throw InputError(document.place, "this is no scene: it holds no `bodies`",
                     "See docs/scene.md, or let `tenon init MESH` write one");
  validate(document, scene_schema());
  Scene scene;
  scene.file = path;
  scene.units = read_units(document, path);
  const Materials materials(document.find("materials"), scene.units);
  const Value& bodies = *document.find("bodies");
  if (bodies.members.empty()) throw InputError(bodies.place, "the scene has no bodies", "Add one under `bodies`");
  for (const Member& entry : bodies.members)
    scene.bodies.push_back(read_body(entry, path.parent_path(), materials, scene.units));
  read_connections(document, scene);
  choose_parent_ports(scene);
  if (const Value* requirement = document.find("requires")) read_requirement(*requirement, scene.requirement);
  if (const Value* run = document.find("run"); run && !moving) check_run(*run, scene.units);
  return scene;
}

}  // namespace

Scene read_scene(const std::filesystem::path& path) { return read(path, false); }
Scene read_moving_scene(const std::filesystem::path& path) { return read(path, true); }

const SceneBody& body_named(const Scene& scene, const std::string& name) {
  std::vector<std::string> names;
  for (const SceneBody& body : scene.bodies) {
    if (body.name == name) return body;
    names.push_back(body.name);
  }
  const std::string near = fem::near_miss(name, names);
  throw InputError({scene.file.string()}, fmt::format("there is no body '{}'", name),
                   near.empty() ? fmt::format("Its bodies are: {}", fmt::join(names, ", "))
                                : fmt::format("Did you mean '{}'?", near));
}

}  // namespace tenon::assembly
