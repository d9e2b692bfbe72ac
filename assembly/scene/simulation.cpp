#include "assembly/scene/simulation.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "assembly/integration/method.hpp"
#include "assembly/scene/quantity.hpp"
#include "assembly/scene/read.hpp"
#include "fem/mesh.hpp"

namespace tenon::assembly {
namespace {

constexpr Dimension velocity{1, 0, -1}, rate{0, 0, -1};

[[noreturn]] void unknown(const Place& place, const char* what, const std::string& word,
                          const std::vector<std::string>& names) {
  const std::string near = fem::near_miss(word, names);
  throw InputError(place, fmt::format("there is no {} '{}'", what, word),
                   !near.empty()   ? fmt::format("Did you mean '{}'?", near)
                   : names.empty() ? "The scene has none"
                                   : fmt::format("There are: {}", fmt::join(names, ", ")));
}

Signal read_signal(const Value& value, const Dimension& dimension, const Units& units) {
  Signal signal;
  if (value.kind == Value::Kind::scalar) {
    signal.value = quantity(value, dimension, units);
    return signal;
  }
  const std::string kind = one_of(value, {"constant", "step", "sine", "table"}, "a force");
  if (kind != "step") refuse(value, {"at"}, "this force");
  if (kind != "sine") refuse(value, {"frequency", "phase"}, "this force");
  const Value& size = *value.find(kind);
  if (kind == "table") {
    signal.kind = Signal::Kind::table;
    for (const Value& row : size.items) {
      if (row.items.size() != 2)
        throw InputError(row.place, "a row of a table is no pair", "Write [[0, 0], [1, 2.5]]: times and values");
      signal.times.push_back(quantity(row.items[0], dimension::time, units));
      signal.values.push_back(quantity(row.items[1], dimension, units));
      if (signal.times.size() > 1 && !(signal.times.back() > signal.times[signal.times.size() - 2]))
        throw InputError(row.place, "the times of a table do not rise", "Sort them, each once");
    }
    if (signal.times.empty()) throw InputError(size.place, "the table is empty", "Write [[0, 0], [1, 2.5]]");
    return signal;
  }
  signal.value = quantity(size, dimension, units);
  if (kind == "step") {
    signal.kind = Signal::Kind::step;
    if (const Value* at = value.find("at")) signal.at = quantity(*at, dimension::time, units);
  } else if (kind == "sine") {
    signal.kind = Signal::Kind::sine;
    const Value* cycles = value.find("frequency");
    if (!cycles) throw InputError(value.place, "a sine without a frequency", "Add `frequency: 2 Hz`");
    signal.omega = frequency(*cycles);
    if (const Value* phase = value.find("phase")) signal.phase = angle(*phase);
  }
  return signal;
}

InitialMotion read_initial(const Member& entry, const Scene& scene) {
  InitialMotion initial;
  initial.name = entry.key;
  initial.place = entry.place;
  const Value& map = entry.value;
  std::vector<std::string> names;
  for (const SceneJoint& joint : scene.joints) {
    names.push_back(joint.joint.name);
    if (joint.joint.name != entry.key) continue;
    initial.joint = true;
    if (joint.joint.kind == JointKind::weld)
      throw InputError(entry.place, fmt::format("joint '{}' is a weld and does not move", entry.key), "Leave it out");
  }
  if (initial.joint) {
    refuse(map, {"velocity", "angular_rate"}, "a joint; write `rate`");
    if (const Value* value = map.find("angle")) initial.angle = angle(*value);
    if (const Value* value = map.find("rate")) initial.rate = quantity(*value, rate, scene.units);
    return initial;
  }
  bool known = false;
  for (const SceneBody& body : scene.bodies) {
    names.push_back(body.name);
    known = known || body.name == entry.key;
  }
  if (!known) unknown(entry.place, "joint or body", entry.key, names);
  refuse(map, {"angle", "rate"}, "a body; write `velocity` or `angular_rate`");
  if (const Value* value = map.find("velocity")) initial.velocity = vector(*value, velocity, scene.units);
  if (const Value* value = map.find("angular_rate")) initial.turning = vector(*value, rate, scene.units);
  return initial;
}

/// One word for all bodies, or body -> word.
std::map<std::string, Flexibility> read_deformation(const Value& value, const Scene& scene) {
  const auto word = [](const Value& said) {
    return static_cast<Flexibility>(choice(said, {"full", "dropped", "rigid", "auto"}));
  };
  std::map<std::string, Flexibility> of;
  std::vector<std::string> names;
  for (const SceneBody& body : scene.bodies) names.push_back(body.name);
  if (value.kind == Value::Kind::scalar) {
    for (const std::string& name : names) of[name] = word(value);
    return of;
  }
  for (const Member& entry : value.members) {
    if (std::find(names.begin(), names.end(), entry.key) == names.end()) unknown(entry.place, "body", entry.key, names);
    of[entry.key] = word(entry.value);
  }
  return of;
}

}  // namespace

double value(const Signal& s, double t) {
  switch (s.kind) {
    case Signal::Kind::constant:
      return s.value;
    case Signal::Kind::step:
      return t < s.at ? 0.0 : s.value;
    case Signal::Kind::sine:
      return s.value * std::sin(s.omega * t + s.phase);
    case Signal::Kind::table:
      break;
  }
  const auto after = std::upper_bound(s.times.begin(), s.times.end(), t);
  if (after == s.times.begin()) return s.values.front();
  if (after == s.times.end()) return s.values.back();
  const auto k = static_cast<std::size_t>(after - s.times.begin());
  const double part = (t - s.times[k - 1]) / (s.times[k] - s.times[k - 1]);
  return (1.0 - part) * s.values[k - 1] + part * s.values[k];
}

SceneSimulation read_simulation(const Scene& scene) {
  const Value document = read_document(scene.file);
  SceneSimulation simulation;
  if (const Value* run = document.find("run")) {
    if (const Value* found = run->find("duration")) simulation.time = positive(*found, dimension::time, scene.units);
    if (const Value* found = run->find("gravity"))
      simulation.gravity = vector(*found, dimension::acceleration, scene.units);
  }
  const Value* section = document.find("simulation");
  if (!section) return simulation;
  const auto seconds = [&](const char* key, std::optional<double>& to) {
    if (const Value* found = section->find(key)) to = positive(*found, dimension::time, scene.units);
  };
  seconds("time", simulation.time);
  seconds("step", simulation.step);
  seconds("sample", simulation.sample);
  if (const Value* found = section->find("tolerance")) simulation.tolerance = positive(*found, dimension::none, {});
  const std::vector<std::string> methods(method_names.begin(), method_names.end());
  if (const Value* found = section->find("method"))
    simulation.method = methods[static_cast<std::size_t>(choice(*found, methods))];
  if (const Value* found = section->find("deformation")) simulation.deformation = read_deformation(*found, scene);
  if (const Value* found = section->find("gravity"))
    simulation.gravity = vector(*found, dimension::acceleration, scene.units);
  if (const Value* initial = section->find("initial"))
    for (const Member& entry : initial->members) simulation.initial.push_back(read_initial(entry, scene));
  if (const Value* forces = section->find("forces"))
    for (const Member& entry : forces->members) {
      std::vector<std::string> names;
      const SceneInput* input = nullptr;
      for (const SceneInput& candidate : scene.inputs) {
        names.push_back(candidate.name);
        if (candidate.name == entry.key) input = &candidate;
      }
      if (!input) unknown(entry.place, "input", entry.key, names);
      const bool turns = input->joint || input->direction >= 3;
      simulation.forces.push_back(
          {entry.key, entry.place,
           read_signal(entry.value, turns ? dimension::torque : dimension::force, scene.units)});
    }
  return simulation;
}

}  // namespace tenon::assembly
