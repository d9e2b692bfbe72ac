#include "assembly/integration/checkpoint.hpp"

#include <fmt/format.h>

#include <cstdlib>
#include <fstream>
#include <nlohmann/json.hpp>

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

// What a state belongs to: "name hinge modes" of each body.
Json signature(const Multibody& system) {
  Json list = Json::array();
  for (const HingedBody& b : system.bodies) list.push_back(fmt::format("{} {} {}", b.name, name(b.kind), b.modes()));
  for (const Closure& c : system.closures) list.push_back(fmt::format("{} closure {}", c.name, name(c.kind)));
  return list;
}

}  // namespace

void write_checkpoint(const std::filesystem::path& path, const Multibody& system, const Checkpoint& checkpoint) {
  const IntegrationState& s = checkpoint.state;
  const Json file{{"format", kind},
                  {"version", version},
                  {"method", name(checkpoint.method)},
                  {"system", signature(system)},
                  {"steps", s.steps},
                  {"samples", s.samples},
                  {"begin_s", hex(s.begin)},
                  {"t_s", hex(s.t)},
                  {"step_s", hex(s.h)},
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
    if (file.at("system") != signature(system))
      throw InputError(place, "belongs to other bodies, hinges or modes", "Continue the scene it was taken from");
    Checkpoint c{method_named(file.at("method").get<std::string>()), {}};
    IntegrationState& s = c.state;
    s.steps = file.at("steps").get<long>();
    s.samples = file.at("samples").get<long>();
    s.begin = number(file.at("begin_s"));
    s.t = number(file.at("t_s"));
    s.h = number(file.at("step_s"));
    s.error = number(file.at("error"));
    s.energy = number(file.at("energy_j"));
    s.at = {{numbers(file.at("q")), numbers(file.at("v"))}, numbers(file.at("v_dot")), numbers(file.at("a"))};
    s.lambda = numbers(file.at("lambda"));
    if (s.at.motion.q.size() != system.nq || s.at.motion.v.size() != system.nv)
      throw InputError(place, "holds a state of another size", "Continue the scene it was taken from");
    return c;
  } catch (const nlohmann::json::exception& fault) {
    throw InputError(place, fmt::format("is no checkpoint ({})", fault.what()), "Give a file that a simulation wrote");
  }
}

}  // namespace tenon::assembly
