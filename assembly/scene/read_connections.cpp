#include <fmt/format.h>

#include <algorithm>

#include "assembly/scene/quantity.hpp"
#include "assembly/scene/read.hpp"

namespace tenon::assembly {
namespace {

const SceneBody* find_body(const Scene& scene, const std::string& name) {
  const auto found =
      std::find_if(scene.bodies.begin(), scene.bodies.end(), [&](const auto& b) { return b.name == name; });
  return found == scene.bodies.end() ? nullptr : &*found;
}

[[noreturn]] void unknown(const Value& value, const std::string& what, const std::string& word,
                          const std::vector<std::string>& names) {
  const std::string near = fem::near_miss(word, names);
  throw InputError(value.place, what,
                   !near.empty()   ? fmt::format("Did you mean '{}'?", near)
                   : names.empty() ? "There are none yet; add it first"
                                   : fmt::format("There are: {}", fmt::join(names, ", ")));
}

/// A port, or a body or a joint alone.
struct AnyTarget {
  SceneTarget at;
  bool joint = false;
};

AnyTarget read_any_target(const Value& value, const Scene& scene) {
  if (value.text.find('.') != std::string::npos) return {read_port_target(value, scene), false};
  std::vector<std::string> names;
  for (const SceneBody& body : scene.bodies) names.push_back(body.name);
  for (const SceneJoint& joint : scene.joints) {
    if (joint.joint.name == value.text) return {{value.text, "", value.place}, true};
    names.push_back(joint.joint.name);
  }
  if (!find_body(scene, value.text))
    unknown(value, fmt::format("there is no body or joint '{}'", value.text), value.text, names);
  return {{value.text, "", value.place}, false};
}

/// "x" or [x, y, z] as directions 0..2; `names` gets a suffix for each when there are several.
std::vector<std::pair<int, std::string>> directions(const Value& value, const std::string& name) {
  std::vector<std::pair<int, std::string>> all;
  const bool several = value.kind == Value::Kind::list;
  for (const Value* word : words(value)) {
    const int k = choice(*word, {"x", "y", "z"});
    all.emplace_back(k, several ? fmt::format("{}.{}", name, "xyz"[k]) : name);
  }
  return all;
}

SceneJoint read_joint(const Member& entry, const Scene& scene) {
  check_name(entry);
  const Value& map = entry.value;
  SceneJoint joint;
  joint.joint.name = entry.key;
  joint.parent = read_port_target(*map.find("parent"), scene);
  joint.child = read_port_target(*map.find("child"), scene);
  joint.place = entry.place;
  const std::string what = fmt::format("joint '{}'", entry.key);
  if (joint.parent.body == joint.child.body)
    throw InputError(map.find("child")->place, fmt::format("{} joins body '{}' to itself", what, joint.child.body),
                     "Name ports of two bodies");
  if (one_of(map, {"weld", "revolute"}, what) == "weld") {
    refuse(map, {"angle", "near", "stiffness", "damping", "inertia"}, "a weld");
    if (!truth(*map.find("weld"))) throw InputError(map.find("weld")->place, "a joint that is no weld", "Write true");
    return joint;
  }
  joint.joint.kind = JointKind::revolute;
  joint.joint.axis = axis(*map.find("revolute"));
  if (const Value* at_rest = map.find("angle")) joint.joint.angle = angle(*at_rest);
  if (const Value* near = map.find("near")) {
    refuse(map, {"angle"}, "a joint whose angle follows from the loops");
    joint.joint.angle = angle(*near);
    joint.joint.follows = true;
  }
  if (const Value* k = map.find("stiffness"))
    joint.joint.stiffness = positive(*k, dimension::torque, scene.units, true);
  if (const Value* c = map.find("damping"))
    joint.joint.damping = positive(*c, dimension::rotary_damping, scene.units, true);
  if (const Value* J = map.find("inertia")) joint.joint.inertia = positive(*J, dimension::inertia, scene.units, true);
  return joint;
}

void read_input(const Member& entry, Scene& scene) {
  const Value& map = entry.value;
  const AnyTarget target = read_any_target(*map.find("at"), scene);
  if (target.joint) {
    refuse(map, {"force", "torque"}, "a joint, whose input is the torque of its drive");
    const auto joint = std::find_if(scene.joints.begin(), scene.joints.end(),
                                    [&](const SceneJoint& j) { return j.joint.name == target.at.body; });
    if (joint->joint.kind == JointKind::weld)
      throw InputError(map.find("at")->place, fmt::format("joint '{}' is a weld and has no drive", target.at.body),
                       "Put the input at a port, or make the joint revolute");
    scene.inputs.push_back({entry.key, target.at, true, 0});
    return;
  }
  const std::string kind = one_of(map, {"force", "torque"}, fmt::format("input '{}'", entry.key));
  for (const auto& [k, name] : directions(*map.find(kind), entry.key))
    scene.inputs.push_back({name, target.at, false, kind == "force" ? k : k + 3});
}

void read_output(const Member& entry, Scene& scene) {
  const Value& map = entry.value;
  const AnyTarget target = read_any_target(*map.find("at"), scene);
  const std::vector<std::string> motions{"displacement", "velocity",     "acceleration",
                                         "rotation",     "angular_rate", "angular_acceleration"};
  if (target.joint) {
    for (const std::string& motion : motions) refuse(map, {motion.c_str()}, "a joint; write `measure: rate`");
    const Value* measure = map.find("measure");
    if (!measure)
      throw InputError(map.place, fmt::format("output '{}' does not say what it measures", entry.key),
                       "Add `measure: angle`, rate or acceleration");
    scene.outputs.push_back(
        {entry.key, target.at, true, static_cast<Quantity>(choice(*measure, {"angle", "rate", "acceleration"})), 0});
    return;
  }
  refuse(map, {"measure"}, "a port, which has directions");
  const std::string kind = one_of(map, motions, fmt::format("output '{}'", entry.key));
  const int which = static_cast<int>(std::find(motions.begin(), motions.end(), kind) - motions.begin());
  for (const auto& [k, name] : directions(*map.find(kind), entry.key))
    scene.outputs.push_back({name, target.at, false, static_cast<Quantity>(which % 3), which < 3 ? k : k + 3});
}

}  // namespace

SceneTarget read_port_target(const Value& value, const Scene& scene) {
  const std::size_t dot = value.text.find('.');
  if (value.kind != Value::Kind::scalar || dot == std::string::npos)
    throw InputError(value.place, fmt::format("found '{}', expected body.port", value.text),
                     "Write the body and its port with a dot, e.g. hub.east");
  SceneTarget target{value.text.substr(0, dot), value.text.substr(dot + 1), value.place};
  const SceneBody* body = find_body(scene, target.body);
  if (!body) {
    std::vector<std::string> names;
    for (const SceneBody& b : scene.bodies) names.push_back(b.name);
    unknown(value, fmt::format("there is no body '{}'", target.body), target.body, names);
  }
  if (std::holds_alternative<ReducedSource>(body->source)) return target;
  std::vector<std::string> ports;
  for (const ScenePort& port : body->ports) ports.push_back(port.name);
  if (std::find(ports.begin(), ports.end(), target.port) == ports.end())
    unknown(value, fmt::format("body '{}' has no port '{}'", target.body, target.port), target.port, ports);
  return target;
}

void read_connections(const Value& document, Scene& scene) {
  if (const Value* joints = document.find("joints"))
    for (const Member& entry : joints->members) {
      if (find_body(scene, entry.key))
        throw InputError(entry.place, fmt::format("'{}' names a body and a joint", entry.key), "Rename one of them");
      scene.joints.push_back(read_joint(entry, scene));
    }
  if (const Value* masses = document.find("masses"))
    for (const Member& entry : masses->members) {
      SceneMass mass{.name = entry.key,
                     .at = read_port_target(*entry.value.find("at"), scene),
                     .mass = positive(*entry.value.find("mass"), dimension::mass, scene.units, true)};
      if (const Value* J = entry.value.find("inertia")) mass.inertia = inertia(*J, scene.units);
      scene.masses.push_back(std::move(mass));
    }
  if (const Value* ground = document.find("ground"))
    for (const Value* port : words(*ground)) scene.ground.push_back(read_port_target(*port, scene));
  if (const Value* inputs = document.find("inputs"))
    for (const Member& entry : inputs->members) read_input(entry, scene);
  if (const Value* outputs = document.find("outputs"))
    for (const Member& entry : outputs->members) read_output(entry, scene);
}

}  // namespace tenon::assembly
