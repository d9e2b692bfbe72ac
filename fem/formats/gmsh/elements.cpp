#include <fmt/format.h>

#include "fem/formats/gmsh/sections.hpp"

namespace tenon::fem::gmsh {
namespace {

const ElementType& known_type(int number, std::size_t offset, const Cursor& cursor) {
  const ElementType* const type = element_type(number);
  if (!type)
    cursor.fail(offset,
                fmt::format("found element type {}, expected one of 1 to 19 (points to solids of order two)", number),
                "Mesh with order 1 or 2 (in Gmsh: Mesh.ElementOrder)");
  return *type;
}

/// Reads the node numbers of one element and appends the cell.
template <class Fields>
void add_cell(Fields& fields, const ElementType& type, int nodes, std::int64_t number, int group, Cells& cells,
              const Cursor& cursor, const Content& content) {
  const std::size_t first = cells.nodes.size();
  cells.nodes.resize(first + static_cast<std::size_t>(nodes));
  std::array<int, 27> read{};
  for (int i = 0; i < nodes; ++i) {
    const std::int64_t node = fields.count("a node of the element");
    const int index = content.numbers.find(node);
    if (index < 0)
      cursor.fail(fields.start(), fmt::format("element {} names node {}, which $Nodes does not define", number, node));
    read[static_cast<std::size_t>(i)] = index;
  }
  for (std::size_t i = 0; i < static_cast<std::size_t>(nodes); ++i) cells.nodes[first + i] = read[type.vtk_order[i]];
  cells.ids.push_back(static_cast<long>(number));
  cells.groups.push_back(group);
}

/// Room for `declared` cells of a type, as far as the rest of the file can hold them: a number and a node take two
/// bytes at least as text, four as raw bytes.
void reserve(Cells& cells, std::int64_t declared, const Cursor& cursor) {
  const auto nodes = static_cast<std::size_t>(node_count(cells.type));
  const std::size_t possible = cursor.remaining() / ((nodes + 1) * (cursor.binary ? 4 : 2));
  const std::size_t wanted = cells.ids.size() + std::min(static_cast<std::size_t>(declared), possible);
  if (wanted < 2 * cells.ids.capacity()) return;  // blocks come one by one: grow by doubling at least
  cells.nodes.reserve(nodes * wanted);
  cells.ids.reserve(wanted);
  cells.groups.reserve(wanted);
}

/// The group list of an element of a 2.x file: its first tag is the physical one (0: none), the second the entity's;
/// partitions follow.
class Tags {
 public:
  template <class Fields>
  int read(Fields& fields, int n, CellType type, Content& content) {
    int physical = 0;
    for (int i = 0; i < n; ++i) {
      const int tag = fields.integer("a tag of the element");
      if (i == 0) physical = std::abs(tag);
    }
    if (n > 2) content.lose("partition tags", 1, "the partition a cell belongs to is not kept");
    if (physical == 0) return 0;
    if (physical != last_physical_ || dimension(type) != last_dimension_) {
      last_list_ = content.group_list({physical});
      last_physical_ = physical;
      last_dimension_ = dimension(type);
    }
    return last_list_;
  }

 private:
  int last_physical_ = 0, last_dimension_ = -1, last_list_ = 0;
};

int tag_count(int n, std::size_t offset, const Cursor& cursor) {
  if (n < 0) cursor.fail(offset, fmt::format("found {} as the number of tags, expected 0 or more", n));
  return n;
}

/// 2.x text: number type tags... nodes...
void read_lines(std::int64_t n, Cursor& cursor, Content& content) {
  TextFields fields(cursor);
  Tags tags;
  for (std::int64_t i = 0; i < n; ++i) {
    fields.begin_record(i, n, "element");
    const std::int64_t number = fields.count("the element's number");
    const int type_number = fields.integer("the element's type");
    const ElementType& type = known_type(type_number, fields.start(), cursor);
    const int n_tags = fields.integer("the number of tags");
    const int group = tags.read(fields, tag_count(n_tags, fields.start(), cursor), type.type, content);
    add_cell(fields, type, node_count(type.type), number, group, content.cells_of(type.type), cursor, content);
    fields.end_record();
  }
}

/// 2.x binary: runs of elements of one type and number of tags.
void read_runs(std::int64_t n, Cursor& cursor, Content& content) {
  BinaryFields fields(cursor);
  Tags tags;
  for (std::int64_t i = 0; i < n;) {
    fields.begin_record(i, n, "element");
    const int type_number = fields.integer("the elements' type");
    const ElementType& type = known_type(type_number, fields.start(), cursor);
    const int run = fields.integer("the number of elements that follow");
    if (run < 1 || run > n - i)
      cursor.fail(fields.start(), fmt::format("found a run of {} elements, expected 1 to {}", run, n - i));
    const int n_tags = fields.integer("the number of tags");
    tag_count(n_tags, fields.start(), cursor);
    Cells& cells = content.cells_of(type.type);
    reserve(cells, run, cursor);
    for (int k = 0; k < run; ++k) {
      const std::int64_t number = fields.integer("the element's number");
      const int group = tags.read(fields, n_tags, type.type, content);
      add_cell(fields, type, node_count(type.type), number, group, cells, cursor, content);
    }
    i += run;
  }
}

/// 4.x: blocks by entity, whose physical groups $Entities lists.
template <class Fields>
void read_blocks(Fields fields, Cursor& cursor, Content& content) {
  const bool v41 = content.version > 4.05;
  fields.begin_record(0, 1, "line of counts");
  const std::int64_t blocks = fields.count("the number of entity blocks");
  const std::int64_t declared = fields.count("the number of elements");
  if (v41) fields.count("the smallest element number"), fields.count("the largest element number");
  fields.end_record();

  std::int64_t found = 0;
  for (std::int64_t b = 0; b < blocks; ++b) {
    fields.begin_record(b, blocks, "element block");
    DimTag entity;
    (v41 ? entity.first : entity.second) = fields.integer("the entity's dimension (its tag in 4.0)");
    (v41 ? entity.second : entity.first) = fields.integer("the entity's tag (its dimension in 4.0)");
    const std::size_t entity_place = fields.start();
    const int type_number = fields.integer("the elements' type");
    const ElementType& type = known_type(type_number, fields.start(), cursor);
    const std::int64_t n = fields.count("the number of elements in the block");
    fields.end_record();
    if (entity.first != dimension(type.type))
      cursor.fail(entity_place,
                  fmt::format("found cells of type {} on an entity of dimension {}, expected dimension {}",
                              name(type.type), entity.first, dimension(type.type)));
    int group = 0;
    if (content.entities) {
      const auto listed = content.entities->find(entity);
      if (listed == content.entities->end())
        cursor.fail(entity_place,
                    fmt::format("the block is on entity {} of dimension {}, which $Entities does not list",
                                entity.second, entity.first));
      group = listed->second;
    }
    Cells dropped;
    Cells& cells = group == no_body ? dropped : content.cells_of(type.type);
    reserve(cells, n, cursor);
    for (std::int64_t i = 0; i < n; ++i) {
      fields.begin_record(i, n, "element");
      const std::int64_t number = fields.count("the element's number");
      add_cell(fields, type, node_count(type.type), number, group, cells, cursor, content);
      fields.end_record();
    }
    if (group == no_body)
      content.lose("cells between partitions", static_cast<long>(n),
                   "made when the mesh was divided; no part of the body");
    found += n;
  }
  if (found != declared)
    cursor.fail(cursor.offset(), fmt::format("the blocks hold {} elements, expected the {} declared", found, declared));
}

}  // namespace

void read_elements(Cursor& cursor, Content& content) {
  if (content.points.empty())
    cursor.fail(cursor.offset(), "elements come before any node, expected $Nodes first",
                "Write $Nodes before $Elements, as Gmsh does");
  if (content.version >= 4.0) {
    if (cursor.binary)
      read_blocks(BinaryFields(cursor), cursor, content);
    else
      read_blocks(TextFields(cursor), cursor, content);
    return;
  }
  TextFields header(cursor);
  header.begin_record(0, 1, "the number of elements");
  const std::int64_t n = header.count("the number of elements");
  header.end_record();
  if (cursor.binary)
    read_runs(n, cursor, content);
  else
    read_lines(n, cursor, content);
}

}  // namespace tenon::fem::gmsh
