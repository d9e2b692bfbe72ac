#pragma once

#include <initializer_list>
#include <string>
#include <utility>
#include <vector>

#include "assembly/scene/document.hpp"
#include "assembly/scene/units.hpp"
#include "fem/spatial.hpp"

/// Readers of single values. Each throws InputError at the value's place saying what was found and what was expected.
namespace tenon::assembly {

/// A finite number without a dimension.
double number(const Value& value);
/// A whole number of at least `least`.
int count(const Value& value, int least = 0);
/// A number in the scene's units, in SI.
double quantity(const Value& value, const Dimension& dimension, const Units& units);
/// The same, refused when not above zero (`zero_too`: when below).
double positive(const Value& value, const Dimension& dimension, const Units& units, bool zero_too = false);
/// "30 deg", "0.5 rad", or a bare number of radians [rad].
double angle(const Value& value);
/// "20 Hz", "1 kHz", "125 rad/s"; a bare number other than 0 is refused, since it could be either [rad/s].
double frequency(const Value& value);
/// "true" or "false".
bool truth(const Value& value);
/// A list of exactly `size` numbers in the scene's units, in SI.
std::vector<double> quantities(const Value& value, std::size_t size, const Dimension& dimension, const Units& units);
fem::Vec3 vector(const Value& value, const Dimension& dimension, const Units& units);
/// x, y, z or a vector; normalised.
fem::Vec3 axis(const Value& value);
/// Three moments or a symmetric 3×3 matrix, positive semi-definite, in SI.
fem::Mat3 inertia(const Value& value, const Units& units);
/// Words of a list; a single word is a list of one.
std::vector<const Value*> words(const Value& value);
/// The index of the word among `choices`; near misses are named.
int choice(const Value& value, const std::vector<std::string>& choices);
/// The one key among `keys` that the map holds; throws when it holds none or two. `what`: "body 'hub'".
std::string one_of(const Value& map, const std::vector<std::string>& keys, const std::string& what);
/// Throws when the map holds any of `keys`: they make no sense with `because`.
void refuse(const Value& map, std::initializer_list<const char*> keys, const std::string& because);

}  // namespace tenon::assembly
