#include "assembly/scene/quantity.hpp"

#include <fmt/format.h>

#include <Eigen/Eigenvalues>
#include <charconv>
#include <cmath>
#include <numbers>
#include <optional>

#include "fem/mesh.hpp"

namespace tenon::assembly {
namespace {

std::string shown(const Value& value) {
  switch (value.kind) {
    case Value::Kind::scalar:
      return fmt::format("'{}'", value.text);
    case Value::Kind::list:
      return "a list";
    case Value::Kind::map:
      return "a map";
    case Value::Kind::null:
      break;
  }
  return "nothing";
}

[[noreturn]] void refuse_value(const Value& value, const std::string& expected, const std::string& cure) {
  throw InputError(value.place, fmt::format("found {}, expected {}", shown(value), expected), cure);
}

/// A number with what follows it, e.g. (30, "deg").
std::optional<std::pair<double, std::string>> number_and_rest(const std::string& text) {
  const std::size_t begin = text.find_first_not_of(" \t+");
  if (begin == std::string::npos) return std::nullopt;
  double x = 0.0;
  const auto [end, fault] = std::from_chars(text.data() + begin, text.data() + text.size(), x);
  if (fault != std::errc() || !std::isfinite(x)) return std::nullopt;
  std::string rest(end, text.data() + text.size());
  const std::size_t word = rest.find_first_not_of(" \t");
  return std::pair(x, word == std::string::npos ? std::string() : rest.substr(word));
}

}  // namespace

double number(const Value& value) {
  const auto read = value.kind == Value::Kind::scalar ? number_and_rest(value.text) : std::nullopt;
  if (!read) refuse_value(value, "a number", "Write a finite number such as 0.02 or 70e9");
  if (!read->second.empty())
    refuse_value(value, "a bare number", "Leave the unit out: `units` at the top of the scene states all units once");
  return read->first;
}

int count(const Value& value, int least) {
  const double x = number(value);
  if (x != std::floor(x) || x < least || x > 1e9)
    refuse_value(value, fmt::format("a whole number of at least {}", least), "Write it without a fraction");
  return static_cast<int>(x);
}

double quantity(const Value& value, const Dimension& dimension, const Units& units) {
  return units.to_si(dimension) * number(value);
}

double positive(const Value& value, const Dimension& dimension, const Units& units, bool zero_too) {
  const double x = quantity(value, dimension, units);
  if (x < 0.0 || (x == 0.0 && !zero_too))
    refuse_value(value, zero_too ? "a number of at least 0" : "a number above 0", "Correct the value");
  return x;
}

double angle(const Value& value) {
  const auto read = value.kind == Value::Kind::scalar ? number_and_rest(value.text) : std::nullopt;
  if (read && (read->second.empty() || read->second == "rad")) return read->first;
  if (read && read->second == "deg") return read->first * std::numbers::pi / 180.0;
  refuse_value(value, "an angle", "Write `30 deg`, or a number of radians");
}

double frequency(const Value& value) {
  const auto read = value.kind == Value::Kind::scalar ? number_and_rest(value.text) : std::nullopt;
  const std::string cure = "Write `20 Hz` or `125 rad/s`";
  if (!read) refuse_value(value, "a frequency", cure);
  const auto [x, unit] = *read;
  if (x < 0.0) refuse_value(value, "a frequency of at least 0", cure);
  if (unit == "Hz") return 2.0 * std::numbers::pi * x;
  if (unit == "kHz") return 2e3 * std::numbers::pi * x;
  if (unit == "rad/s" || (unit.empty() && x == 0.0)) return x;
  refuse_value(value, "a frequency with its unit", cure);
}

bool truth(const Value& value) {
  if (value.kind == Value::Kind::scalar && value.text == "true") return true;
  if (value.kind == Value::Kind::scalar && value.text == "false") return false;
  refuse_value(value, "true or false", "Write one of the two");
}

std::vector<double> quantities(const Value& value, std::size_t size, const Dimension& dimension, const Units& units) {
  if (value.kind != Value::Kind::list || value.items.size() != size)
    refuse_value(value, fmt::format("a list of {} numbers", size),
                 value.kind == Value::Kind::list ? fmt::format("It has {}", value.items.size()) : "Write [..., ...]");
  std::vector<double> numbers;
  for (const Value& item : value.items) numbers.push_back(quantity(item, dimension, units));
  return numbers;
}

fem::Vec3 vector(const Value& value, const Dimension& dimension, const Units& units) {
  const std::vector<double> v = quantities(value, 3, dimension, units);
  return {v[0], v[1], v[2]};
}

fem::Vec3 axis(const Value& value) {
  if (value.kind == Value::Kind::scalar) return fem::Vec3::Unit(choice(value, {"x", "y", "z"}));
  const fem::Vec3 v = vector(value, dimension::none, {});
  const double length = v.stableNorm();
  if (!(length > 0.0)) refuse_value(value, "a direction", "Write x, y, z or a vector that is not zero");
  return v / length;
}

fem::Mat3 inertia(const Value& value, const Units& units) {
  fem::Mat3 J = fem::Mat3::Zero();
  const bool matrix =
      value.kind == Value::Kind::list && value.items.size() == 3 && value.items.front().kind == Value::Kind::list;
  if (matrix) {
    for (int i = 0; i < 3; ++i) J.row(i) = vector(value.items[static_cast<std::size_t>(i)], dimension::inertia, units);
  } else {
    J.diagonal() = vector(value, dimension::inertia, units);
  }
  const double scale = J.cwiseAbs().maxCoeff();
  if ((J - J.transpose()).cwiseAbs().maxCoeff() > 1e-12 * scale)
    refuse_value(value, "a symmetric matrix", "Write products of inertia as they stand in the tensor, -∫xy dm");
  const Eigen::SelfAdjointEigenSolver<fem::Mat3> eigen(J, Eigen::EigenvaluesOnly);
  if (eigen.eigenvalues().minCoeff() < -1e-12 * scale)
    refuse_value(value, "a tensor of inertia without a negative principal moment", "Check signs and units");
  return J;
}

std::vector<const Value*> words(const Value& value) {
  std::vector<const Value*> all;
  if (value.kind == Value::Kind::scalar) all.push_back(&value);
  for (const Value& item : value.items) {
    if (item.kind != Value::Kind::scalar) refuse_value(item, "a word", "Write a list of words");
    all.push_back(&item);
  }
  return all;
}

int choice(const Value& value, const std::vector<std::string>& choices) {
  if (value.kind == Value::Kind::scalar)
    for (std::size_t k = 0; k < choices.size(); ++k)
      if (choices[k] == value.text) return static_cast<int>(k);
  const std::string near = fem::near_miss(value.text, choices);
  refuse_value(value, fmt::format("one of {}", fmt::join(choices, ", ")),
               near.empty() ? "Write one of these" : fmt::format("Did you mean '{}'?", near));
}

std::string one_of(const Value& map, const std::vector<std::string>& keys, const std::string& what) {
  std::string found;
  for (const Member& member : map.members) {
    if (std::find(keys.begin(), keys.end(), member.key) == keys.end()) continue;
    if (!found.empty())
      throw InputError(member.place, fmt::format("{} has both '{}' and '{}'", what, found, member.key), "Keep one");
    found = member.key;
  }
  if (found.empty())
    throw InputError(map.place, fmt::format("{} says none of {}", what, fmt::join(keys, ", ")), "Add one of these");
  return found;
}

void refuse(const Value& map, std::initializer_list<const char*> keys, const std::string& because) {
  for (const Member& member : map.members)
    for (const char* key : keys)
      if (member.key == key)
        throw InputError(member.place, fmt::format("'{}' makes no sense with {}", key, because), "Leave it out");
}

}  // namespace tenon::assembly
