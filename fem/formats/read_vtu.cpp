#include "fem/formats/read_vtu.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cstdlib>
#include <limits>
#include <pugixml.hpp>
#include <set>

#include "fem/error.hpp"
#include "fem/formats/file_bytes.hpp"
#include "fem/formats/vtk/values.hpp"

namespace tenon::fem {
namespace {

using vtk::Values;

/// A VTK cell as a cell of a Mesh, whose node i is VTK's node order[i]; an empty order is VTK's own.
struct Kind {
  int number = 0;
  CellType type = CellType::vertex;
  std::array<std::uint8_t, 8> order{};
};

/// Source: vtkCellType.h; pixel (8) and voxel (11) count along the axes.
constexpr std::array<Kind, 20> kinds{{{1, CellType::vertex},
                                      {3, CellType::line},
                                      {21, CellType::line3},
                                      {5, CellType::triangle},
                                      {22, CellType::triangle6},
                                      {9, CellType::quad},
                                      {23, CellType::quad8},
                                      {28, CellType::quad9},
                                      {10, CellType::tetra},
                                      {24, CellType::tetra10},
                                      {12, CellType::hexahedron},
                                      {25, CellType::hexahedron20},
                                      {29, CellType::hexahedron27},
                                      {13, CellType::wedge, {0, 2, 1, 3, 5, 4}},
                                      {26, CellType::wedge15},
                                      {32, CellType::wedge18},
                                      {14, CellType::pyramid},
                                      {27, CellType::pyramid13},
                                      {8, CellType::quad, {0, 1, 3, 2}},
                                      {11, CellType::hexahedron, {0, 1, 3, 2, 4, 5, 7, 6}}}};

class Reader {
 public:
  Reader(std::string_view bytes, const std::string& source) : bytes_(bytes) {
    mesh_.source = source;
    encoding_.file_bytes = bytes.size();
    places_.fill(-1);
  }
  Mesh read();

 private:
  [[noreturn]] void fail(std::ptrdiff_t offset, const std::string& what, const std::string& cure) const;
  [[noreturn]] void fail(pugi::xml_node node, const std::string& what,
                         const std::string& cure = "Write it again") const {
    fail(node.offset_debug(), what, cure);
  }
  pugi::xml_node load();
  void read_heading(pugi::xml_node file);
  void read_piece(pugi::xml_node piece);
  void read_cells(pugi::xml_node piece, std::size_t first_point, std::size_t n_points, std::size_t n_cells);
  void read_data(pugi::xml_node group, bool of_cells, std::size_t first, std::size_t n);
  void split_cell_data();
  void make_sets(const std::string& name, const Eigen::MatrixXd& values);
  std::size_t count(pugi::xml_node node, const char* attribute) const;
  Values values(pugi::xml_node array) const;
  pugi::xml_node named(pugi::xml_node cells, const char* name) const;

  std::string_view bytes_;
  pugi::xml_document document_;
  vtk::Encoding encoding_;
  Mesh mesh_;
  std::array<int, 19> places_{};                        ///< CellType → block
  std::vector<std::pair<int, int>> cells_;              ///< file's cell → block, cell
  std::map<std::string, std::vector<double>> rows_[2];  ///< point and cell data, row by row
  std::map<std::string, std::size_t> widths_[2];        ///< components
  std::set<std::string> whole_;                         ///< cell data of whole numbers
};

void Reader::fail(std::ptrdiff_t offset, const std::string& what, const std::string& cure) const {
  const auto before = bytes_.substr(0, static_cast<std::size_t>(std::max<std::ptrdiff_t>(offset, 0)));
  const auto line_start = before.rfind('\n');
  throw InputError({mesh_.source, 1 + std::ranges::count(before, '\n'),
                    static_cast<long>(before.size() - (line_start == before.npos ? 0 : line_start + 1)) + 1},
                   what, cure);
}

/// Appended data is no XML: the document ends where it starts.
pugi::xml_node Reader::load() {
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
  return document_.child("VTKFile");
}

void Reader::read_heading(pugi::xml_node file) {
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

std::size_t Reader::count(pugi::xml_node node, const char* attribute) const {
  const std::string text = node.attribute(attribute).value();
  char* end = nullptr;
  const long n = std::strtol(text.c_str(), &end, 10);
  if (text.empty() || *end != '\0' || n < 0 || n > std::numeric_limits<int>::max())
    fail(node, fmt::format("found {}=\"{}\", expected a number of {}", attribute, text, "points, cells or bytes"));
  return static_cast<std::size_t>(n);
}

Values Reader::values(pugi::xml_node array) const {
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

pugi::xml_node Reader::named(pugi::xml_node cells, const char* name) const {
  const pugi::xml_node array = cells.find_child_by_attribute("DataArray", "Name", name);
  if (!array) fail(cells, fmt::format("the cells have no array '{}'", name));
  return array;
}

void Reader::read_cells(pugi::xml_node piece, std::size_t first_point, std::size_t n_points, std::size_t n_cells) {
  const pugi::xml_node cells = piece.child("Cells");
  if (n_cells == 0) return;
  if (!cells) fail(piece, "the piece has no Cells");
  const Values nodes = values(named(cells, "connectivity")), ends = values(named(cells, "offsets")),
               types = values(named(cells, "types"));
  if (nodes.real || ends.real || types.real) fail(cells, "found cells made of reals, expected whole numbers");
  if (ends.size() != n_cells || types.size() != n_cells)
    fail(cells, fmt::format("found {} offsets and {} types for {} cells", ends.size(), types.size(), n_cells));
  std::int64_t start = 0;
  for (std::size_t c = 0; c < n_cells; ++c) {
    const auto kind = std::ranges::find(kinds, types.whole[c], &Kind::number);
    if (kind == kinds.end())
      fail(cells, fmt::format("cell {} has VTK's type {}, which is not read", cells_.size(), types.whole[c]),
           "Convert it to lines, triangles, quadrilaterals or solids of first or second order");
    const int width = node_count(kind->type);
    if (ends.whole[c] < 0 || ends.whole[c] > std::ssize(nodes.whole) || ends.whole[c] - start != width)
      fail(cells, fmt::format("cell {} ends at {} after {}, expected {} nodes of a {}", cells_.size(), ends.whole[c],
                              start, width, name(kind->type)));
    int& place = places_[static_cast<std::size_t>(kind->type)];
    if (place < 0) {
      place = static_cast<int>(mesh_.cells.size());
      mesh_.cells.push_back({kind->type, {}, {}});
    }
    CellBlock& block = mesh_.cells[static_cast<std::size_t>(place)];
    for (int i = 0; i < width; ++i) {
      const int from = kind->order[1] + kind->order[2] == 0 ? i : kind->order[static_cast<std::size_t>(i)];
      const std::int64_t node = nodes.whole[static_cast<std::size_t>(start + from)];
      if (node < 0 || node >= static_cast<std::int64_t>(n_points))
        fail(cells, fmt::format("cell {} names point {} of {}", cells_.size(), node, n_points));
      block.nodes.push_back(static_cast<int>(first_point) + static_cast<int>(node));
    }
    block.ids.push_back(static_cast<long>(cells_.size()));
    cells_.emplace_back(place, block.size() - 1);
    start = ends.whole[c];
  }
}

void Reader::read_data(pugi::xml_node group, bool of_cells, std::size_t first, std::size_t n) {
  for (const pugi::xml_node array : group.children()) {
    const std::string name = array.attribute("Name").value(), type = array.attribute("type").value();
    if (type == "String" || std::string_view(array.name()) != "DataArray") {
      mesh_.losses.push_back({fmt::format("array '{}'", name), 1, "no numbers"});
      continue;
    }
    const Values found = values(array);
    const std::size_t width = n == 0 ? 1 : found.size() / n;
    if (width * n != found.size() || (n > 0 && width == 0))
      fail(array, fmt::format("the array '{}' holds {} values for {} {}", name, found.size(), n,
                              of_cells ? "cells" : "points"));
    if (of_cells && name == "vtkGhostType" && std::ranges::any_of(found.whole, [](auto v) { return v != 0; }))
      fail(array, "some cells are ghosts: copies of cells of another piece, whose stiffness would count twice",
           "Save the pieces without ghost cells");
    if (n == 0) continue;
    const auto [known, fresh] = widths_[of_cells].try_emplace(name, width);
    if (known->second != width)
      fail(array, fmt::format("the array '{}' has {} components, {} in an earlier piece", name, width, known->second));
    auto& rows = rows_[of_cells][name];
    if (rows.size() > first * width) fail(array, fmt::format("found a second array '{}' in this piece", name));
    rows.resize(first * width, std::numeric_limits<double>::quiet_NaN());
    for (std::size_t i = 0; i < found.size(); ++i) rows.push_back(found.at(i));
    if (of_cells && !found.real && width == 1 && fresh) whole_.insert(name);
    if (found.real) whole_.erase(name);
  }
}

void Reader::read_piece(pugi::xml_node piece) {
  const std::size_t n = count(piece, "NumberOfPoints"), n_cells = count(piece, "NumberOfCells");
  const std::size_t first = mesh_.points.size(), first_cell = cells_.size();
  const pugi::xml_node array = piece.child("Points").child("DataArray");
  if (!array && n > 0) fail(piece, "the piece has no Points");
  const Values x = array ? values(array) : Values{};
  if (x.size() != 3 * n) fail(array, fmt::format("found {} coordinates for {} points", x.size(), n));
  if (first + n > static_cast<std::size_t>(std::numeric_limits<int>::max())) fail(piece, "has more than 2^31 points");
  for (std::size_t i = 0; i < n; ++i) {
    mesh_.points.emplace_back(x.at(3 * i), x.at(3 * i + 1), x.at(3 * i + 2));
    mesh_.point_ids.push_back(static_cast<long>(first + i));
    if (!mesh_.points.back().allFinite()) fail(array, fmt::format("point {} is not finite", first + i));
  }
  read_cells(piece, first, n, n_cells);
  read_data(piece.child("PointData"), false, first, n);
  read_data(piece.child("CellData"), true, first_cell, n_cells);
}

void Reader::make_sets(const std::string& name, const Eigen::MatrixXd& values) {
  std::set<std::int64_t> distinct;
  for (const double v : values.reshaped())
    if (v == v && distinct.size() <= 256) distinct.insert(static_cast<std::int64_t>(v));
  if (distinct.size() > 256) {
    mesh_.losses.push_back({fmt::format("sets of '{}'", name), 1, "more than 256 values; it is cell data alone"});
    return;
  }
  for (const std::int64_t v : distinct) mesh_.cell_sets[fmt::format("{}_{}", name, v)].resize(mesh_.cells.size());
  for (std::size_t c = 0; c < cells_.size(); ++c) {
    const double v = values(static_cast<Eigen::Index>(c), 0);
    if (v != v) continue;
    auto& set = mesh_.cell_sets[fmt::format("{}_{}", name, static_cast<std::int64_t>(v))];
    set[static_cast<std::size_t>(cells_[c].first)].push_back(cells_[c].second);
  }
}

void Reader::split_cell_data() {
  using Rows = Eigen::Map<const Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>>;
  for (const bool of_cells : {false, true})
    for (auto& [name, rows] : rows_[of_cells]) {
      const std::size_t width = widths_[of_cells][name], n = of_cells ? cells_.size() : mesh_.points.size();
      rows.resize(n * width, std::numeric_limits<double>::quiet_NaN());
      const Eigen::MatrixXd all = Rows(rows.data(), static_cast<Eigen::Index>(n), static_cast<Eigen::Index>(width));
      if (!of_cells) {
        mesh_.point_data[name] = all;
        continue;
      }
      auto& data = mesh_.cell_data[name];
      for (const CellBlock& block : mesh_.cells) data.emplace_back(block.size(), all.cols());
      for (std::size_t c = 0; c < cells_.size(); ++c)
        data[static_cast<std::size_t>(cells_[c].first)].row(cells_[c].second) = all.row(static_cast<Eigen::Index>(c));
      if (whole_.contains(name)) make_sets(name, all);
    }
}

Mesh Reader::read() {
  const pugi::xml_node file = load();
  read_heading(file);
  const auto pieces = file.child("UnstructuredGrid").children("Piece");
  for (const pugi::xml_node piece : pieces) read_piece(piece);
  if (const auto n = std::distance(pieces.begin(), pieces.end()); n > 1)
    mesh_.losses.push_back({"Piece", n, "points that pieces share stay apart: nothing joins the pieces"});
  if (mesh_.points.empty() || mesh_.cells.empty())
    throw InputError({mesh_.source}, "has no points or no cells", "Save the mesh again");
  split_cell_data();
  return std::move(mesh_);
}

}  // namespace

Mesh parse_vtu(std::string_view bytes, const std::string& source) {
  if (bytes.empty()) throw InputError({source}, "the file is empty", "Save the mesh again");
  return Reader(bytes, source).read();
}

Mesh read_vtu(const std::filesystem::path& path) { return parse_vtu(read_bytes(path), path.string()); }

}  // namespace tenon::fem
