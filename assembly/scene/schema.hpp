#pragma once

#include <string_view>
#include <vector>

#include "assembly/scene/document.hpp"

/// The grammar of a scene as data: which keys a map may hold, and what each may look like. Values are the readers'
/// business; structure is checked here, once.
namespace tenon::assembly {

/// What a value may look like, as bits.
enum Form : unsigned { scalar = 1, list = 2, map = 4 };

struct Schema;

struct Key {
  std::string_view name;
  unsigned forms = scalar;
  std::string_view meaning;  ///< one line, for messages and the guide
  bool required = false;
  const Schema* inside = nullptr;  ///< of the value when it is a map
};

/// A map with known keys, or (when `each` is given) a map from free names to maps of one kind.
struct Schema {
  std::string_view what;  ///< "a joint"
  std::vector<Key> keys;
  const Key* each = nullptr;
};

/// Grammar of the scene file.
const Schema& scene_schema();

/// Throws InputError at the place of the first fault: an unknown key (with a near miss), a missing key, a value of
/// another form.
void validate(const Value& value, const Schema& schema);

}  // namespace tenon::assembly
