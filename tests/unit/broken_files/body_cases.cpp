#include <unistd.h>

#include <fstream>
#include <nlohmann/json.hpp>

#include "reduction/body_file.hpp"
#include "tests/unit/broken_files/broken.hpp"

namespace tenon::broken {
namespace {

using nlohmann::json;

json sound() {
  reduction::ReducedBody body =
      reduction::rigid_body("boom", 3.0, fem::Vec3(0.1, 0.0, 0.0), 0.3 * fem::Mat3::Identity(),
                            {{"root", fem::Vec3::Zero()}, {"tip", fem::Vec3::UnitX()}});
  body.omega = Eigen::Vector2d(1.0, 2.0);
  body.zeta = Eigen::Vector2d(0.01, 0.02);
  body.L = Eigen::MatrixXd::Constant(2, 6, 0.1);
  for (auto& port : body.ports) port.Phi = fem::Mat6X::Constant(6, 2, 0.5);
  const auto file = std::filesystem::temp_directory_path() / ("tenon-sound-" + std::to_string(::getpid()) + ".json");
  reduction::write_body(file, body);
  const json object = json::parse(std::ifstream(file));
  std::filesystem::remove(file);
  return object;
}

/// "/ports/1/Phi" as the reader writes it: ports[1].Phi.
std::string spoken(const json::json_pointer& pointer) {
  std::string text;
  std::string word;
  for (const char c : pointer.to_string() + "/") {
    if (c != '/') {
      word += c;
      continue;
    }
    if (!word.empty())
      text += word.find_first_not_of("0123456789") == std::string::npos ? "[" + word + "]"
                                                                        : (text.empty() ? "" : ".") + word;
    word.clear();
  }
  return text;
}

/// Every member of every object, and the first of every list.
void walk(const json& value, const json::json_pointer& at, std::vector<json::json_pointer>& all) {
  if (value.is_object())
    for (const auto& [key, inside] : value.items()) {
      all.push_back(at / key);
      walk(inside, at / key, all);
    }
  if (value.is_array() && !value.empty()) {
    all.push_back(at / std::size_t{0});
    walk(value[0], at / std::size_t{0}, all);
  }
}

}  // namespace

Family body_cases() {
  Family family{"bad.body.json", [](const std::filesystem::path& file) { reduction::read_body(file); }, {}};
  std::vector<Case>& cases = family.cases;
  const json body = sound();
  cases.push_back({.name = "sound", .bytes = body.dump(), .reads = true});
  std::vector<json::json_pointer> all;
  walk(body, json::json_pointer(), all);
  for (const json::json_pointer& at : all) {
    const json& value = body[at];
    json other = body;
    other[at] = value.is_string() ? json(7) : json({{"a", "wrong kind"}});
    cases.push_back({"wrong kind at " + at.to_string(), other.dump(), {spoken(at)}});
    if (!value.is_number()) continue;
    other[at] = nullptr;  // what NaN and infinity become
    cases.push_back({"no number at " + at.to_string(), other.dump(), {spoken(at)}});
  }
  for (const auto& [key, value] : body.items()) {
    json other = body;
    other.erase(key);
    cases.push_back({"without " + key, other.dump(), {"'" + key + "'"}});
  }
  const std::string text = body.dump(1);
  for (std::size_t k = 1; k <= 20; ++k)
    cases.push_back({"cut at " + std::to_string(k) + "/21", text.substr(0, k * text.size() / 21), {"bad.body.json:"}});
  cases.push_back({.name = "Windows line ends", .bytes = with_windows_ends(text), .reads = true});
  cases.push_back({"empty", "", {"empty"}});
  cases.push_back({"a list", "[]", {"bad.body.json"}});
  cases.push_back({"nested too deep", std::string(100000, '['), {"bad.body.json"}});
  cases.push_back({"number too large", replaced(text, "3.0", "1e999"), {"bad.body.json"}});
  cases.push_back({"UTF-16", std::string("\xFF\xFE{\0", 4), {"bad.body.json"}});
  return family;
}

}  // namespace tenon::broken
