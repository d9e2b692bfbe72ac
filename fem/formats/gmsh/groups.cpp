#include <fmt/format.h>

#include "fem/formats/gmsh/sections.hpp"

namespace tenon::fem::gmsh {
namespace {

/// A name in quotes; what stands between them is taken as it is.
std::string quoted_name(Cursor& cursor) {
  cursor.skip_blanks();
  const std::size_t start = cursor.offset();
  std::string_view rest = cursor.line();
  if (rest.size() < 3 || rest.front() != '"' || rest.back() != '"')
    cursor.fail(start, fmt::format("found {}, expected a name in double quotes", quoted(rest)));
  rest = rest.substr(1, rest.size() - 2);
  return std::string(rest);
}

/// Physical tags of one entity; a negative tag only says that the orientation is reversed.
template <class Fields>
std::vector<int> physical_tags(Fields& fields, std::vector<int>& tags) {
  tags.clear();
  const std::int64_t n = fields.count("the number of physical tags");
  for (std::int64_t i = 0; i < n; ++i) tags.push_back(std::abs(fields.integer("a physical tag")));
  return tags;
}

template <class Fields>
void skip_reals(Fields& fields, int n, const char* what) {
  for (int i = 0; i < n; ++i) fields.real(what);
}

template <class Fields>
void skip_integers(Fields& fields, std::int64_t n, const char* what) {
  for (std::int64_t i = 0; i < n; ++i) fields.integer(what);
}

/// Both sections list points, curves, surfaces and volumes; a partitioned entity also names its parent and partitions.
template <class Fields>
void read_entity_lists(Fields fields, Cursor& cursor, Content& content, bool partitioned) {
  if (!content.entities) content.entities.emplace();
  if (partitioned) {
    fields.begin_record(0, 1, "the number of partitions");
    fields.count("the number of partitions");
    if (!cursor.binary) fields.end_record(), fields.begin_record(0, 1, "the number of ghost entities");
    const std::int64_t ghosts = fields.count("the number of ghost entities");
    fields.end_record();
    for (std::int64_t i = 0; i < ghosts; ++i) {
      fields.begin_record(i, ghosts, "ghost entity");
      skip_integers(fields, 2, "a ghost entity's tag and partition");
      fields.end_record();
    }
  }
  fields.begin_record(0, 1, "line of counts");
  std::array<std::int64_t, 4> counts{};
  for (std::int64_t& count : counts) count = fields.count("the number of points, curves, surfaces or volumes");
  fields.end_record();

  constexpr std::array<const char*, 4> things{"point", "curve", "surface", "volume"};
  std::vector<int> tags;
  for (int dimension = 0; dimension < 4; ++dimension) {
    const std::int64_t n = counts[static_cast<std::size_t>(dimension)];
    for (std::int64_t i = 0; i < n; ++i) {
      fields.begin_record(i, n, things[static_cast<std::size_t>(dimension)]);
      const int tag = fields.integer("the entity's tag");
      bool between_partitions = false;  // a cut through its parent, made when the mesh was divided
      if (partitioned) {
        between_partitions = fields.integer("the parent's dimension") > dimension;
        fields.integer("the parent's tag");
        skip_integers(fields, fields.count("the number of partitions"), "a partition");
      }
      const bool is_position = dimension == 0 && content.version > 4.05;  // 4.0 gives points a box too
      skip_reals(fields, is_position ? 3 : 6, "a coordinate of the entity's box");
      physical_tags(fields, tags);
      (*content.entities)[{dimension, tag}] = between_partitions ? no_body : content.group_list(tags);
      if (dimension > 0) skip_integers(fields, fields.count("the number of bounding entities"), "a bounding entity");
      fields.end_record();
    }
  }
}

}  // namespace

void read_physical_names(Cursor& cursor, Content& content) {
  TextFields fields(cursor);
  fields.begin_record(0, 1, "the number of physical names");
  const std::int64_t n = fields.count("the number of physical names");
  fields.end_record();
  for (std::int64_t i = 0; i < n; ++i) {
    fields.begin_record(i, n, "physical name");
    const int dimension = fields.integer("the group's dimension");
    if (dimension < 0 || dimension > 3)
      cursor.fail(fields.start(), fmt::format("found the dimension {}, expected 0 to 3", dimension));
    const int tag = fields.integer("the group's tag");
    content.physical_names[{dimension, tag}] = quoted_name(cursor);
  }
}

void read_entities(Cursor& cursor, Content& content) {
  if (cursor.binary)
    read_entity_lists(BinaryFields(cursor), cursor, content, false);
  else
    read_entity_lists(TextFields(cursor), cursor, content, false);
}

void read_partitioned_entities(Cursor& cursor, Content& content) {
  if (cursor.binary)
    read_entity_lists(BinaryFields(cursor), cursor, content, true);
  else
    read_entity_lists(TextFields(cursor), cursor, content, true);
  content.lose("$PartitionedEntities", 1, "the partition a cell belongs to is not kept");
}

}  // namespace tenon::fem::gmsh
