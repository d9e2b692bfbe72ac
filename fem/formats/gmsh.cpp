#include "fem/formats/gmsh.hpp"

#include <fmt/format.h>

#include "fem/error.hpp"
#include "fem/formats/file_bytes.hpp"
#include "fem/formats/gmsh/content.hpp"
#include "fem/formats/gmsh/cursor.hpp"
#include "fem/formats/gmsh/sections.hpp"

namespace tenon::fem {
namespace gmsh {

void read_format(Cursor& cursor, Content& content) {
  constexpr const char* save_again = "Save it as version 4.1 (gmsh old.msh -save -format msh41 -o new.msh)";
  TextFields fields(cursor);
  fields.begin_record(0, 1, "the line of version, file type and data size");
  content.version = fields.real("the format's version");
  if (!(content.version >= 2.0 && content.version < 2.25) && content.version != 4.0 && content.version != 4.1)
    cursor.fail(fields.start(), fmt::format("found version {}, expected 2.0 to 2.2, 4.0 or 4.1", content.version),
                save_again);
  const int type = fields.integer("the file type");
  if (type != 0 && type != 1)
    cursor.fail(fields.start(), fmt::format("found file type {}, expected 0 (text) or 1 (binary)", type));
  const int width = fields.integer("the data size");
  if (width != 8 && !(width == 4 && content.version == 4.1))
    cursor.fail(fields.start(), fmt::format("found data size {}, expected 8", width), save_again);
  if (type == 1 && content.version == 4.0)
    cursor.fail(fields.start(), "binary files of version 4.0 are not read", save_again);
  fields.end_record();
  if (type == 0) return;

  cursor.binary = content.binary = true;
  cursor.size_width = content.version < 4.0 ? 4 : width;
  std::int32_t one = 0;
  cursor.raw(&one, sizeof one, "the number 1 in binary, which tells the byte order");
  if (one == 0x01000000) cursor.swapped = true;
  if (one != 1 && !cursor.swapped)
    cursor.fail(cursor.offset() - 4, fmt::format("found {:#010x}, expected the number 1 in either byte order",
                                                 static_cast<std::uint32_t>(one)));
}

namespace {

/// Reads one section's body; false for a section that has no effect here.
bool read_section(const std::string& name, Cursor& cursor, Content& content) {
  if (name == "MeshFormat")
    read_format(cursor, content);
  else if (name == "PhysicalNames")
    read_physical_names(cursor, content);
  else if (name == "Entities" && content.version >= 4.0)
    read_entities(cursor, content);
  else if (name == "PartitionedEntities" && content.version >= 4.0)
    read_partitioned_entities(cursor, content);
  else if (name == "Nodes" || (name == "ParametricNodes" && content.version < 4.0))
    read_nodes(cursor, content, name == "ParametricNodes");
  else if (name == "Elements")
    read_elements(cursor, content);
  else if (name == "NodeData" || name == "ElementData")
    read_field(cursor, content, name == "NodeData");
  else
    return false;
  return true;
}

const char* meaning(const std::string& name) {
  if (name == "Periodic") return "which nodes mirror which; no constraint is made of it";
  if (name == "ElementNodeData") return "values at the nodes of elements";
  if (name == "GhostElements") return "copies of cells for other partitions";
  return "an unknown section";
}

void skip_section(const std::string& name, std::size_t start, Cursor& cursor, Content& content) {
  if (!cursor.skip_past_line("$End" + name))
    cursor.fail(start, fmt::format("the section ${} has no $End{}", name, name));
  if (name != "Comments") content.lose("$" + name, 1, meaning(name));
}

void read_sections(Cursor& cursor, Content& content) {
  for (cursor.skip_white(); cursor.remaining() > 0; cursor.skip_white()) {
    const std::size_t start = cursor.offset();
    const bool has_format = content.version > 0.0;
    const std::string_view heading = cursor.word();
    if (heading.size() < 2 || heading[0] != '$' || heading.starts_with("$End") ||
        (!has_format && heading != "$MeshFormat" && heading != "$Comments")) {
      const char* const cure = has_format ? "" : "Give a Gmsh .msh file of version 2.2 or 4.1";
      cursor.fail(start,
                  fmt::format("found {}, expected {}", quoted(heading),
                              has_format ? "a section such as $Nodes" : "$MeshFormat"),
                  cure);
    }
    const std::string name(heading.substr(1));
    if (has_format && name == "MeshFormat")
      cursor.fail(start, "found a second $MeshFormat, expected one mesh in a file",
                  "Keep each mesh in a file of its own");
    cursor.end_line();
    cursor.section = heading.substr(1);
    if (read_section(name, cursor, content)) {
      cursor.skip_white();
      if (Cursor ahead = cursor; ahead.word() != "$End" + name) cursor.fail_expected("$End" + name);
      cursor.word();
      cursor.end_line();
    } else {
      skip_section(name, start, cursor, content);
    }
    cursor.section = {};
  }
}

}  // namespace
}  // namespace gmsh

namespace {

Mesh parse(gmsh::Cursor cursor) {
  if (cursor.size() == 0) throw InputError({cursor.file()}, "the file is empty", "Save the mesh again");
  gmsh::Content content(cursor.size());
  gmsh::read_sections(cursor, content);
  if (content.points.empty()) cursor.fail(cursor.size(), "the file ends without any node, expected $Nodes");
  if (content.cells.empty()) cursor.fail(cursor.size(), "the file ends without any element, expected $Elements");
  return gmsh::make_mesh(std::move(content), cursor.file());
}

}  // namespace

Mesh parse_gmsh(std::string_view bytes, const std::string& source) { return parse({source, bytes}); }

Mesh read_gmsh(const std::filesystem::path& path) {
  const MappedFile file(path);
  return parse({path.string(), file.bytes(), &file});
}

}  // namespace tenon::fem
