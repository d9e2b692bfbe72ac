#include <fmt/format.h>

#include "fem/formats/gmsh/sections.hpp"

namespace tenon::fem::gmsh {
namespace {

std::int64_t line_with_count(TextFields& header, const char* what) {
  header.begin_record(0, 1, what);
  const std::int64_t n = header.count(what);
  header.end_record();
  return n;
}

/// Numbers are 4-byte integers in binary files, whatever the version.
template <class Fields>
void read_values(Fields fields, std::int64_t n, Field& field) {
  const char* const thing = field.on_nodes ? "node value" : "element value";
  for (std::int64_t i = 0; i < n; ++i) {
    fields.begin_record(i, n, thing);
    field.ids.push_back(fields.integer(field.on_nodes ? "the node's number" : "the element's number"));
    for (int c = 0; c < field.components; ++c) field.values.push_back(fields.real("a component"));
    fields.end_record();
  }
}

}  // namespace

void read_field(Cursor& cursor, Content& content, bool on_nodes) {
  Field field;
  field.on_nodes = on_nodes;
  field.offset = cursor.offset();
  TextFields header(cursor);

  const std::int64_t strings = line_with_count(header, "the number of string tags");
  for (std::int64_t i = 0; i < strings; ++i) {
    header.begin_record(i, strings, "string tag");
    std::string_view text = cursor.line();
    if (text.size() >= 2 && text.front() == '"' && text.back() == '"') text = text.substr(1, text.size() - 2);
    if (i == 0) field.name = text;
  }
  const std::int64_t reals = line_with_count(header, "the number of real tags");
  for (std::int64_t i = 0; i < reals; ++i) {
    header.begin_record(i, reals, "real tag");
    header.real("a real tag");
    header.end_record();
  }
  const std::int64_t integers = line_with_count(header, "the number of integer tags");
  if (integers < 3)
    cursor.fail(header.start(),
                fmt::format("found {} integer tags, expected at least 3: step, components, values", integers));
  std::int64_t components = 0, n = 0;
  for (std::int64_t i = 0; i < integers; ++i) {
    header.begin_record(i, integers, "integer tag");
    const std::int64_t tag = header.count("an integer tag");
    if (i == 1 && (tag < 1 || tag > 9))
      cursor.fail(header.start(),
                  fmt::format("found {} components, expected 1 (scalar), 3 (vector) or 9 (tensor)", tag));
    if (i == 1) components = tag;
    if (i == 2) n = tag;
    header.end_record();
  }
  field.components = static_cast<int>(components);
  if (cursor.binary)
    read_values(BinaryFields(cursor), n, field);
  else
    read_values(TextFields(cursor), n, field);
  content.fields.push_back(std::move(field));
}

}  // namespace tenon::fem::gmsh
