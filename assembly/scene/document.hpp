#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "fem/error.hpp"

namespace tenon::assembly {

struct Member;

/// A node of a YAML or JSON document that knows where it stands. Scalars keep their text: what it means is the reader's
/// business.
struct Value {
  enum class Kind { null, scalar, list, map };

  Kind kind = Kind::null;
  Place place;
  std::string text;             ///< of a scalar
  std::vector<Value> items;     ///< of a list
  std::vector<Member> members;  ///< of a map, in the order of the file

  /// The value of a key, or nullptr.
  const Value* find(std::string_view key) const;
  std::vector<std::string> keys() const;
};

struct Member {
  std::string key;
  Place place;  ///< of the key
  Value value;
};

/// Reads a document. JSON is read as the subset of YAML that it is; anchors, aliases and the merge key `<<` work.
/// Throws InputError with line and column for a missing or empty file, for what is not YAML, for a key that stands
/// twice in a map and for nesting deeper than 64.
Value read_document(const std::filesystem::path& path);

}  // namespace tenon::assembly
