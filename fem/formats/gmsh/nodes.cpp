#include <fmt/format.h>

#include <limits>

#include "fem/formats/gmsh/sections.hpp"

namespace tenon::fem::gmsh {
namespace {

/// Room for `declared` things of at least `bytes` each, as far as the file can hold them.
template <class T>
void reserve(std::vector<T>& values, std::int64_t declared, const Cursor& cursor, std::size_t bytes) {
  const std::size_t possible = cursor.remaining() / bytes;
  const std::size_t wanted = std::min(static_cast<std::size_t>(declared), possible);
  if (values.empty()) values.reserve(wanted);
}

template <class Fields>
void add_number(Fields& fields, Cursor& cursor, Content& content) {
  const std::int64_t number = fields.count("the node's number");
  if (number == 0) cursor.fail(fields.start(), "found node number 0, expected numbers from 1");
  if (content.point_ids.size() >= static_cast<std::size_t>(std::numeric_limits<int>::max()))
    cursor.fail(fields.start(), "there are more nodes than a mesh may have (2³¹ − 1)", "Split the mesh into bodies");
  if (!content.numbers.insert(number, static_cast<int>(content.point_ids.size())))
    cursor.fail(fields.start(), fmt::format("node {} is defined a second time", number),
                "Give every node its own number (in Gmsh: Mesh > Renumber)");
  content.point_ids.push_back(static_cast<long>(number));
}

template <class Fields>
void add_position(Fields& fields, Content& content) {
  const double x = fields.real("the x coordinate");
  const double y = fields.real("the y coordinate");
  const double z = fields.real("the z coordinate");
  content.points.emplace_back(x, y, z);
}

/// Reads past the place of a node on the geometry: u on a curve, u and v on a surface.
template <class Fields>
void skip_parameters(Fields& fields, int n, Content& content) {
  for (int k = 0; k < n; ++k) fields.real("a parametric coordinate");
  if (n > 0) content.lose("parametric coordinates", 1, "positions on the geometry's curves and surfaces");
}

/// 2.x: number x y z; in $ParametricNodes then also dimension and tag of the entity and u, v on it.
template <class Fields>
void read_list(Fields fields, std::int64_t n, bool parametric, Cursor& cursor, Content& content) {
  for (std::int64_t i = 0; i < n; ++i) {
    fields.begin_record(i, n, "node");
    add_number(fields, cursor, content);
    add_position(fields, content);
    if (parametric) {
      const int dimension = fields.integer("the entity's dimension");
      fields.integer("the entity's tag");
      skip_parameters(fields, dimension == 1 || dimension == 2 ? dimension : 0, content);
    }
    fields.end_record();
  }
}

/// 4.x: blocks by entity. 4.1 gives all numbers of a block, then all positions; 4.0 each node's together.
template <class Fields>
void read_node_blocks(Fields fields, Cursor& cursor, Content& content) {
  const bool v41 = content.version > 4.05;
  fields.begin_record(0, 1, "line of counts");
  const std::int64_t blocks = fields.count("the number of entity blocks");
  const std::int64_t declared = fields.count("the number of nodes");
  if (v41) fields.count("the smallest node number"), fields.count("the largest node number");
  fields.end_record();
  reserve(content.points, declared, cursor, 24);
  reserve(content.point_ids, declared, cursor, 24);

  const std::size_t before = content.points.size();
  for (std::int64_t b = 0; b < blocks; ++b) {
    fields.begin_record(b, blocks, "node block");
    int dimension = fields.integer(v41 ? "the entity's dimension" : "the entity's tag");
    if (v41) fields.integer("the entity's tag");
    if (!v41) dimension = fields.integer("the entity's dimension");
    if (dimension < 0 || dimension > 3)
      cursor.fail(fields.start(), fmt::format("found the dimension {}, expected 0 to 3", dimension));
    const int parameters = fields.integer("the flag 'parametric'") != 0 ? dimension : 0;
    const std::int64_t n = fields.count("the number of nodes in the block");
    fields.end_record();
    if (v41)
      for (std::int64_t i = 0; i < n; ++i) {
        fields.begin_record(i, n, "node number");
        add_number(fields, cursor, content);
        fields.end_record();
      }
    for (std::int64_t i = 0; i < n; ++i) {
      fields.begin_record(i, n, "node");
      if (!v41) add_number(fields, cursor, content);
      add_position(fields, content);
      skip_parameters(fields, parameters, content);
      fields.end_record();
    }
  }
  const std::size_t found = content.points.size() - before;
  if (found != static_cast<std::size_t>(declared))
    cursor.fail(cursor.offset(), fmt::format("the blocks hold {} nodes, expected the {} declared", found, declared));
}

}  // namespace

void read_nodes(Cursor& cursor, Content& content, bool parametric) {
  if (content.version >= 4.0) {
    if (cursor.binary)
      read_node_blocks(BinaryFields(cursor), cursor, content);
    else
      read_node_blocks(TextFields(cursor), cursor, content);
    return;
  }
  TextFields header(cursor);
  header.begin_record(0, 1, "the number of nodes");
  const std::int64_t n = header.count("the number of nodes");
  header.end_record();
  reserve(content.points, n, cursor, 8);
  reserve(content.point_ids, n, cursor, 8);
  if (cursor.binary)
    read_list(BinaryFields(cursor), n, parametric, cursor, content);
  else
    read_list(TextFields(cursor), n, parametric, cursor, content);
}

}  // namespace tenon::fem::gmsh
