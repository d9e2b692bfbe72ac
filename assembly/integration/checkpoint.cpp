#include "assembly/integration/checkpoint.hpp"

#include <fmt/format.h>

#include <cmath>
#include <cstdlib>
#include <fstream>
#include <nlohmann/json.hpp>

#include "assembly/integration/signature.hpp"
#include "fem/error.hpp"
#include "fem/formats/atomic_file.hpp"

namespace tenon::assembly {

using Eigen::VectorXd;
using Json = nlohmann::ordered_json;

namespace {

constexpr int version = 1;
constexpr const char* kind = "tenon checkpoint";

Json hex(double x) { return fmt::format("{:a}", x); }

Json hex(const VectorXd& x) {
  Json list = Json::array();
  for (const double value : x) list.push_back(hex(value));
  return list;
}

double number(const Json& text) {
  const auto word = text.get<std::string>();
  char* end = nullptr;
  const double value = std::strtod(word.c_str(), &end);
  if (word.empty() || *end != '\0') throw nlohmann::json::other_error::create(501, word, &text);
  return value;
}

VectorXd numbers(const Json& list) {
  VectorXd x(static_cast<Eigen::Index>(list.size()));
  for (std::size_t k = 0; k < list.size(); ++k) x[static_cast<Eigen::Index>(k)] = number(list[k]);
  return x;
}

Json traits(const Signature& signature) {
  Json list = Json::array();
  for (const Trait& t : signature.traits) list.push_back({t.of, t.what, hex(t.sum), hex(t.size)});
  return list;
}

// The system is the one that the file was written of.
void check_system(const Json& file, const Place& place, const Multibody& system) {
  constexpr const char* cure = "Continue the scene it was taken from";
  const Signature now = signature(system);
  if (file.at("system") != Json(now.structure))
    throw InputError(place, "belongs to other bodies, joints or modes", cure);
  const Json& before = file.at("data");
  for (std::size_t k = 0; k < now.traits.size(); ++k) {
    const Json& row = before.at(k);
    const Trait was{row.at(0).get<std::string>(), row.at(1).get<std::string>(), number(row.at(2)), number(row.at(3))};
    if (!same(was, now.traits[k]))
      throw InputError(
          place, fmt::format("{} has another {} than when this was written", now.traits[k].of, now.traits[k].what),
          cure);
  }
}

void check_numbers(const IntegrationState& s, const Place& place, const Multibody& system) {
  Dynamics dynamics = make_dynamics(system);
  const auto demand = [&](bool good, const char* what) {
    if (!good) throw InputError(place, fmt::format("holds {}", what), "Take another checkpoint, or start anew");
  };
  demand(s.at.v_dot.size() == system.nv && s.at.a.size() == system.nv && s.lambda.size() == dynamics.rows.rows(),
         "accelerations or forces of another size");
  demand(s.at.v_dot.allFinite() && s.at.a.allFinite() && s.lambda.allFinite(), "accelerations that are no numbers");
  bool times = s.steps >= 0 && s.samples >= 0 && s.t >= s.begin && s.seen >= s.begin;
  for (const double x : {s.begin, s.t, s.seen}) times = times && std::isfinite(x);
  for (const double x : {s.h, s.step, s.sample, s.error, s.energy}) times = times && std::isfinite(x) && x >= 0.0;
  demand(times, "times, steps or counts that no run has");
  try {
    check_state(dynamics, s.at.motion);
  } catch (const ModelError& fault) {
    throw ModelError(place.file, fault);
  }
}

}  // namespace

void write_checkpoint(const std::filesystem::path& path, const Multibody& system, const Checkpoint& checkpoint) {
  const IntegrationState& s = checkpoint.state;
  const Signature now = signature(system);
  const Json file{{"format", kind},
                  {"version", version},
                  {"method", name(checkpoint.method)},
                  {"tolerance", {hex(checkpoint.tolerance.relative), hex(checkpoint.tolerance.absolute)}},
                  {"system", now.structure},
                  {"data", traits(now)},
                  {"steps", s.steps},
                  {"samples", s.samples},
                  {"begin_s", hex(s.begin)},
                  {"t_s", hex(s.t)},
                  {"seen_s", hex(s.seen)},
                  {"step_s", hex(s.h)},
                  {"step_asked_s", hex(s.step)},
                  {"sample_s", hex(s.sample)},
                  {"error", hex(s.error)},
                  {"energy_j", hex(s.energy)},
                  {"q", hex(s.at.motion.q)},
                  {"v", hex(s.at.motion.v)},
                  {"v_dot", hex(s.at.v_dot)},
                  {"a", hex(s.at.a)},
                  {"lambda", hex(s.lambda)}};
  fem::AtomicFile out(path);
  out.stream() << file.dump(1) << '\n';
  out.commit();
}

Checkpoint read_checkpoint(const std::filesystem::path& path, const Multibody& system) {
  const Place place{path.string()};
  std::ifstream stream(path);
  if (!stream) throw InputError(place, "cannot be read", "Check the name and the rights");
  try {
    const Json file = Json::parse(stream);
    if (file.at("format") != kind) throw InputError(place, "is no checkpoint", "Give a file that a simulation wrote");
    if (file.at("version") != version)
      throw InputError(place, fmt::format("has version {} where {} is read", file.at("version").dump(), version),
                       "Continue with the program that wrote it, or start anew");
    check_system(file, place, system);
    Checkpoint c{method_named(file.at("method").get<std::string>()),
                 {number(file.at("tolerance").at(0)), number(file.at("tolerance").at(1))},
                 {}};
    IntegrationState& s = c.state;
    s.steps = file.at("steps").get<long>();
    s.samples = file.at("samples").get<long>();
    s.begin = number(file.at("begin_s"));
    s.t = number(file.at("t_s"));
    s.seen = number(file.at("seen_s"));
    s.h = number(file.at("step_s"));
    s.step = number(file.at("step_asked_s"));
    s.sample = number(file.at("sample_s"));
    s.error = number(file.at("error"));
    s.energy = number(file.at("energy_j"));
    s.at = {{numbers(file.at("q")), numbers(file.at("v"))}, numbers(file.at("v_dot")), numbers(file.at("a"))};
    s.lambda = numbers(file.at("lambda"));
    check_numbers(s, place, system);
    return c;
  } catch (const nlohmann::json::exception& fault) {
    throw InputError(place, fmt::format("is no checkpoint ({})", fault.what()), "Give a file that a simulation wrote");
  }
}

}  // namespace tenon::assembly
