#include "fem/formats/read_vtu.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cstdlib>
#include <limits>
#include <pugixml.hpp>

#include "fem/error.hpp"
#include "fem/formats/file_bytes.hpp"
#include "fem/formats/vtk/grid.hpp"

namespace tenon::fem {
namespace {

using vtk::Values;

class VtuReader {
 public:
  VtuReader(std::string_view bytes, const std::string& source) : bytes_(bytes) {
    mesh_.source = source;
    encoding_.file_bytes = bytes.size();
  }
  Mesh read();

 private:
  [[noreturn]] void fail(std::ptrdiff_t offset, const std::string& what, const std::string& cure) const;
  [[noreturn]] void fail(pugi::xml_node node, const std::string& what,
                         const std::string& cure = "Write it again") const {
    fail(node.offset_debug(), what, cure);
  }
  pugi::xml_node load();
  pugi::xml_node only(pugi::xml_node parent, const char* name) const;
  void read_heading(pugi::xml_node file);
  void read_piece(pugi::xml_node piece);
  void read_cells(pugi::xml_node piece, std::size_t n);
  void read_data(pugi::xml_node group, bool of_cells, std::size_t n);
  std::size_t count(pugi::xml_node node, const char* attribute) const;
  Values values(pugi::xml_node array) const;
  pugi::xml_node named(pugi::xml_node cells, const char* name) const;

  std::string_view bytes_;
  pugi::xml_document document_;
  vtk::Encoding encoding_;
  Mesh mesh_;
  vtk::Grid grid_{mesh_};
};

void VtuReader::fail(std::ptrdiff_t offset, const std::string& what, const std::string& cure) const {
  const auto before = bytes_.substr(0, static_cast<std::size_t>(std::max<std::ptrdiff_t>(offset, 0)));
  const auto line_start = before.rfind('\n');
  throw InputError({mesh_.source, 1 + std::ranges::count(before, '\n'),
                    static_cast<long>(before.size() - (line_start == before.npos ? 0 : line_start + 1)) + 1},
                   what, cure);
}

/// Appended data is no XML: the document ends where it starts.
pugi::xml_node VtuReader::load() {
  std::string text;
  const auto heading = bytes_.find("<AppendedData");
  const auto heading_end = bytes_.find('>', heading == bytes_.npos ? bytes_.size() : heading);
  if (heading_end != bytes_.npos) {
    const auto start = bytes_.find('_', heading_end), end = bytes_.rfind("</AppendedData");
    if (start == bytes_.npos || end == bytes_.npos || end < start)
      fail(static_cast<std::ptrdiff_t>(heading), "AppendedData has no '_' before its data, or no end",
           "Write it again");
    encoding_.appended = bytes_.substr(start + 1, end - start - 1);
    text = bytes_.substr(0, heading_end + 1);
    text += "</AppendedData></VTKFile>";
  }
  const std::string_view xml = text.empty() ? bytes_ : std::string_view(text);
  const auto result = document_.load_buffer(xml.data(), xml.size(), pugi::parse_default, pugi::encoding_utf8);
  if (!result) fail(result.offset, fmt::format("no well-formed XML: {}", result.description()), "Write it again");
  return only(document_, "VTKFile");
}

/// The child of that name, an empty one when there is none: of two, one would be read past.
pugi::xml_node VtuReader::only(pugi::xml_node parent, const char* name) const {
  const pugi::xml_node first = parent.child(name), second = first.next_sibling(name);
  if (second) fail(second, fmt::format("found a second {} where one was expected", name));
  return first;
}

void VtuReader::read_heading(pugi::xml_node file) {
  const std::string type = file.attribute("type").value(),
                    order = file.attribute("byte_order").as_string("LittleEndian"),
                    word = file.attribute("header_type").as_string("UInt32"),
                    compressor = file.attribute("compressor").value();
  if (!file) throw InputError({mesh_.source}, "has no element VTKFile", "Give a .vtu file");
  if (type != "UnstructuredGrid")
    fail(file, fmt::format("found a file of type '{}', expected UnstructuredGrid", type),
         "Save it as an unstructured grid (.vtu); of a parallel file (.pvtu) name the pieces");
  if (order != "LittleEndian" && order != "BigEndian")
    fail(file, fmt::format("found byte_order '{}', expected LittleEndian or BigEndian", order));
  if (word != "UInt32" && word != "UInt64")
    fail(file, fmt::format("found header_type '{}', expected UInt32 or UInt64", word));
  if (!compressor.empty() && compressor != "vtkZLibDataCompressor")
    fail(file, fmt::format("found the compressor '{}', expected vtkZLibDataCompressor or none", compressor),
         "Save it compressed by zlib, or not compressed");
  encoding_.swapped = (order == "BigEndian") != (std::endian::native == std::endian::big);
  encoding_.word = word == "UInt64" ? 8 : 4;
  encoding_.zlib = !compressor.empty();
  if (const pugi::xml_node appended = file.child("AppendedData")) {
    const std::string encoding = appended.attribute("encoding").value();
    if (encoding != "raw" && encoding != "base64")
      fail(appended, fmt::format("found encoding '{}', expected raw or base64", encoding));
    encoding_.appended_raw = encoding == "raw";
  }
  mesh_.format = fmt::format("vtu {}", file.attribute("version").as_string("0.1"));
}

std::size_t VtuReader::count(pugi::xml_node node, const char* attribute) const {
  const std::string text = node.attribute(attribute).value();
  char* end = nullptr;
  const long n = std::strtol(text.c_str(), &end, 10);
  if (text.empty() || *end != '\0' || n < 0 || n > std::numeric_limits<int>::max())
    fail(node, fmt::format("found {}=\"{}\", expected a number of {}", attribute, text, "points, cells or bytes"));
  return static_cast<std::size_t>(n);
}

Values VtuReader::values(pugi::xml_node array) const {
  const std::string format = array.attribute("format").as_string("ascii"), type = array.attribute("type").value();
  try {
    if (format == "ascii") return vtk::text_values(array.text().get(), type);
    if (format == "binary") return vtk::encoded_values(array.text().get(), true, type, encoding_);
    if (format != "appended") fail(array, fmt::format("found format '{}', expected ascii, binary or appended", format));
    const std::string text = array.attribute("offset").value();
    char* end = nullptr;
    const unsigned long offset = std::strtoul(text.c_str(), &end, 10);
    if (text.empty() || *end != '\0' || offset > encoding_.appended.size())
      fail(array, fmt::format("found offset=\"{}\", expected a place in the {} bytes of AppendedData", text,
                              encoding_.appended.size()));
    return vtk::encoded_values(encoding_.appended.substr(offset), !encoding_.appended_raw, type, encoding_);
  } catch (const vtk::ArrayFault& fault) {
    fail(array, fmt::format("the array '{}' {}", array.attribute("Name").value(), fault.what), fault.cure);
  }
}

pugi::xml_node VtuReader::named(pugi::xml_node cells, const char* name) const {
  pugi::xml_node found;
  for (const pugi::xml_node array : cells.children("DataArray")) {
    if (array.attribute("Name").value() != std::string_view(name)) continue;
    if (found) fail(cells, fmt::format("the cells have a second array '{}'", name));
    found = array;
  }
  if (!found) fail(cells, fmt::format("the cells have no array '{}'", name));
  return found;
}

void VtuReader::read_cells(pugi::xml_node piece, std::size_t n) {
  const pugi::xml_node cells = only(piece, "Cells");
  if (n == 0 && !cells.child("DataArray")) return;
  if (!cells) fail(piece, "the piece has no Cells");
  const Values nodes = values(named(cells, "connectivity")), ends = values(named(cells, "offsets")),
               types = values(named(cells, "types"));
  try {
    grid_.add_cells(nodes, ends, types, n);
  } catch (const vtk::ArrayFault& fault) {
    fail(cells, fault.what, fault.cure);
  }
}

void VtuReader::read_data(pugi::xml_node group, bool of_cells, std::size_t n) {
  for (const pugi::xml_node array : group.children()) {
    const std::string name = array.attribute("Name").value(), type = array.attribute("type").value();
    if (type == "String" || std::string_view(array.name()) != "DataArray") {
      mesh_.losses.push_back({fmt::format("array '{}'", name), 1, "no numbers"});
      continue;
    }
    const Values found = values(array);
    try {
      grid_.add_data(of_cells, name, found, n);
    } catch (const vtk::ArrayFault& fault) {
      fail(array, fault.what, fault.cure);
    }
  }
}

void VtuReader::read_piece(pugi::xml_node piece) {
  const std::size_t n = count(piece, "NumberOfPoints"), n_cells = count(piece, "NumberOfCells");
  const pugi::xml_node points = only(piece, "Points"), array = points.child("DataArray");
  if (!array && n > 0) fail(piece, "the piece has no Points");
  if (array.next_sibling("DataArray")) fail(points, "Points has more than one DataArray");
  const Values x = array ? values(array) : Values{};
  try {
    grid_.add_points(x, n);
  } catch (const vtk::ArrayFault& fault) {
    fail(array ? array : piece, fault.what, fault.cure);
  }
  read_cells(piece, n_cells);
  read_data(only(piece, "PointData"), false, n);
  read_data(only(piece, "CellData"), true, n_cells);
}

Mesh VtuReader::read() {
  const pugi::xml_node file = load();
  read_heading(file);
  const auto pieces = only(file, "UnstructuredGrid").children("Piece");
  for (const pugi::xml_node piece : pieces) read_piece(piece);
  if (const auto n = std::distance(pieces.begin(), pieces.end()); n > 1)
    mesh_.losses.push_back({"Piece", n, "points that pieces share stay apart: nothing joins the pieces"});
  grid_.finish();
  return std::move(mesh_);
}

}  // namespace

Mesh parse_vtu(std::string_view bytes, const std::string& source) {
  if (bytes.empty()) throw InputError({source}, "the file is empty", "Save the mesh again");
  return VtuReader(bytes, source).read();
}

Mesh read_vtu(const std::filesystem::path& path) { return parse_vtu(read_bytes(path), path.string()); }

}  // namespace tenon::fem
