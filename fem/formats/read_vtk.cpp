#include "fem/formats/read_vtk.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <bit>
#include <charconv>
#include <limits>
#include <utility>

#include "fem/error.hpp"
#include "fem/formats/file_bytes.hpp"
#include "fem/formats/vtk/grid.hpp"

namespace tenon::fem {
namespace {

using vtk::Values;
using Words = std::vector<std::string>;

constexpr const char* write_again = "Write the file again";

bool is_white(char c) { return c == ' ' || c == '\n' || c == '\t' || c == '\r'; }

/// VTK does not tell upper from lower case.
std::string upper(std::string word) {
  std::ranges::transform(word, word.begin(),
                         [](char c) { return c >= 'a' && c <= 'z' ? static_cast<char>(c - 32) : c; });
  return word;
}

struct Type {
  std::string_view legacy, xml;
  std::size_t bytes;
};

/// vtkIdType is written as int, whatever it is in memory.
constexpr std::array<Type, 14> types{{{"UNSIGNED_CHAR", "UInt8", 1},
                                      {"CHAR", "Int8", 1},
                                      {"UNSIGNED_SHORT", "UInt16", 2},
                                      {"SHORT", "Int16", 2},
                                      {"UNSIGNED_INT", "UInt32", 4},
                                      {"INT", "Int32", 4},
                                      {"UNSIGNED_LONG", "UInt64", 8},
                                      {"LONG", "Int64", 8},
                                      {"FLOAT", "Float32", 4},
                                      {"DOUBLE", "Float64", 8},
                                      {"VTKIDTYPE", "Int32", 4},
                                      {"VTKTYPEINT64", "Int64", 8},
                                      {"VTKTYPEUINT64", "UInt64", 8},
                                      {"SIGNED_CHAR", "Int8", 1}}};

/// Names are written with %20 for a blank.
std::string decoded(std::string_view name) {
  std::string out;
  for (std::size_t i = 0; i < name.size(); ++i) {
    unsigned code = 0;
    if (name[i] == '%' && i + 2 < name.size() &&
        std::from_chars(name.data() + i + 1, name.data() + i + 3, code, 16).ptr == name.data() + i + 3) {
      out += static_cast<char>(code);
      i += 2;
    } else {
      out += name[i];
    }
  }
  return out;
}

class VtkReader {
 public:
  VtkReader(std::string_view bytes, const std::string& source) : bytes_(bytes) { mesh_.source = source; }
  Mesh read();

 private:
  [[noreturn]] void fail(const std::string& what, const std::string& cure = write_again) const;
  std::string_view line();
  Words words();
  bool next_section(Words& section);
  std::size_t number(const Words& section, std::size_t i, const char* meaning) const;
  const Type& type(const Words& section, std::size_t i) const;
  Values values(std::size_t n, const Type& type);
  void read_heading();
  void read_section(const Words& section);
  void read_cells(const Words& section);
  void read_array(const std::string& name, const Type& type, std::size_t width);
  void read_scalars(const Words& section);
  void read_fields(const Words& section);
  void add_cells();

  std::string_view bytes_;
  std::size_t at_ = 0;     ///< next byte
  std::size_t start_ = 0;  ///< of the section being read
  std::size_t cells_at_ = 0;
  bool binary_ = false, split_cells_ = false;
  Mesh mesh_;
  vtk::Grid grid_{mesh_};
  Values nodes_, ends_, types_;
  bool has_points_ = false, has_cells_ = false, has_types_ = false, added_ = false;
  int data_ = -1;  ///< 0 of points, 1 of cells
  std::size_t n_data_ = 0;
};

void VtkReader::fail(const std::string& what, const std::string& cure) const {
  const auto before = bytes_.substr(0, start_);
  throw InputError({mesh_.source, 1 + std::ranges::count(before, '\n'),
                    static_cast<long>(before.size() - (before.rfind('\n') + 1)) + 1},
                   what, cure);
}

/// What is left of the line; moves behind its end.
std::string_view VtkReader::line() {
  const std::size_t end = std::min(bytes_.find('\n', at_), bytes_.size());
  std::string_view text = bytes_.substr(at_, end - at_);
  at_ = std::min(end + 1, bytes_.size());
  if (text.ends_with('\r')) text.remove_suffix(1);
  return text;
}

Words VtkReader::words() {
  const std::string_view text = line();
  Words out;
  for (std::size_t i = 0; i < text.size();) {
    const std::size_t begin = text.find_first_not_of(" \t\r", i);
    if (begin == text.npos) break;
    i = std::min(text.find_first_of(" \t\r", begin), text.size());
    out.emplace_back(text.substr(begin, i - begin));
  }
  return out;
}

/// The words of the next line that has any; false at the end of the file.
bool VtkReader::next_section(Words& section) {
  while (at_ < bytes_.size() && is_white(bytes_[at_])) ++at_;
  start_ = at_;
  if (at_ == bytes_.size()) return false;
  section = words();
  return true;
}

std::size_t VtkReader::number(const Words& section, std::size_t i, const char* meaning) const {
  const std::string word = i < section.size() ? section[i] : "";
  std::size_t n = 0;
  const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), n);
  if (word.empty() || error != std::errc() || end != word.data() + word.size())
    fail(fmt::format("found '{}' in '{}', expected {}", word.substr(0, 40), section[0].substr(0, 40), meaning));
  // Text takes two bytes a number, but for the last; bytes take one.
  if (n > bytes_.size())
    fail(fmt::format("'{}' declares {}: more than the {} bytes of the file", section[0], n, bytes_.size()));
  return n;
}

const Type& VtkReader::type(const Words& section, std::size_t i) const {
  const std::string word = i < section.size() ? section[i] : "";
  const auto found = std::ranges::find(types, upper(word), &Type::legacy);
  if (found == types.end())
    fail(fmt::format("found type '{}' in '{}', expected char, short, int, long, float, double or vtkIdType",
                     word.substr(0, 40), section[0].substr(0, 40)),
         "Write the array as numbers, or leave it out");
  return *found;
}

Values VtkReader::values(std::size_t n, const Type& type) {
  try {
    if (binary_) {
      if (n > (bytes_.size() - at_) / type.bytes)
        throw vtk::ArrayFault{
            fmt::format("needs {} values of {} bytes, {} bytes are left", n, type.bytes, bytes_.size() - at_),
            write_again};
      const std::size_t begin = at_;
      at_ += n * type.bytes;
      return vtk::raw_values(bytes_.substr(begin, n * type.bytes), type.xml,
                             std::endian::native == std::endian::little);
    }
    const std::size_t begin = at_;
    std::size_t found = 0;
    for (; found < n; ++found) {
      while (at_ < bytes_.size() && is_white(bytes_[at_])) ++at_;
      if (at_ == bytes_.size()) break;
      while (at_ < bytes_.size() && !is_white(bytes_[at_])) ++at_;
    }
    Values out = vtk::text_values(bytes_.substr(begin, at_ - begin), type.xml);
    if (found < n) throw vtk::ArrayFault{fmt::format("holds {} values, expected {}", found, n), write_again};
    return out;
  } catch (const vtk::ArrayFault& fault) {
    const std::size_t end = bytes_.find_first_of(" \t\r\n", start_);
    fail(fmt::format("'{}' {}", bytes_.substr(start_, std::min(end - start_, std::size_t{40})), fault.what),
         fault.cure);
  }
}

void VtkReader::read_heading() {
  constexpr std::string_view heading = "# vtk DataFile Version ";
  const std::string_view first = line();
  int major = 0, minor = 0;
  const char* const end = first.data() + first.size();
  const char* const begin = first.data() + std::min(heading.size(), first.size());
  const auto [dot, error] = std::from_chars(begin, end, major);
  if (!first.starts_with(heading) || error != std::errc() || dot == end || *dot != '.' ||
      std::from_chars(dot + 1, end, minor).ec != std::errc())
    fail("does not begin with '# vtk DataFile Version x.y'", "Give a legacy VTK file");
  if (major < 1 || major > 5)
    fail(fmt::format("found version {}.{}, expected 1.0 to 5.1", major, minor), "Save it as version 5.1 or 4.2");
  split_cells_ = major >= 5;
  line();  // title
  Words section;
  next_section(section);
  const std::string encoding = section.empty() ? "" : upper(section[0]);
  if (encoding != "ASCII" && encoding != "BINARY")
    fail(fmt::format("found '{}', expected ASCII or BINARY", encoding.substr(0, 40)));
  binary_ = encoding == "BINARY";
  mesh_.format = fmt::format("vtk {}.{} {}", major, minor, binary_ ? "binary" : "ascii");
}

/// Up to 4.2 the list [k, node 1, ..., node k] a cell; from 5.1 on ends (one more than cells, 0 first) and nodes.
void VtkReader::read_cells(const Words& section) {
  if (has_cells_) fail("found a second section CELLS");
  has_cells_ = true;
  cells_at_ = start_;
  const std::size_t n = number(section, 1, "a number of cells"), size = number(section, 2, "a number of values");
  if (!split_cells_) {
    const Values all = values(size, types[5]);
    std::size_t i = 0;
    for (std::size_t c = 0; c < n; ++c) {
      const std::int64_t width = i < size ? all.whole[i] : -1;
      if (width < 0 || width >= std::ssize(all.whole) - static_cast<std::ptrdiff_t>(i))
        fail(fmt::format("cell {} of {} does not fit into the {} values of CELLS", c, n, size));
      const auto from = all.whole.begin() + static_cast<std::ptrdiff_t>(i) + 1;
      nodes_.whole.insert(nodes_.whole.end(), from, from + width);
      ends_.whole.push_back(std::ssize(nodes_.whole));
      i += static_cast<std::size_t>(width) + 1;
    }
    if (i != size) fail(fmt::format("the {} cells take {} values, CELLS declares {}", n, i, size));
    return;
  }
  for (const bool is_nodes : {false, true}) {
    Words part;
    if (!next_section(part) || upper(part[0]) != (is_nodes ? "CONNECTIVITY" : "OFFSETS"))
      fail(fmt::format("CELLS has no {}", is_nodes ? "CONNECTIVITY" : "OFFSETS"));
    (is_nodes ? nodes_ : ends_) = values(is_nodes ? size : n, type(part, 1));
  }
  if (!ends_.real && !ends_.whole.empty()) {
    if (ends_.whole[0] != 0) fail(fmt::format("OFFSETS begin with {}, expected 0", ends_.whole[0]));
    ends_.whole.erase(ends_.whole.begin());
  }
}

/// Types may come before or after the cells.
void VtkReader::add_cells() {
  if (added_) return;
  if (!has_points_ || !has_cells_ || !has_types_)
    fail(fmt::format("the dataset has no {}", !has_points_ ? "POINTS" : !has_cells_ ? "CELLS" : "CELL_TYPES"));
  added_ = true;
  const std::size_t start = std::exchange(start_, cells_at_);
  try {
    grid_.add_cells(nodes_, ends_, types_, types_.size());
  } catch (const vtk::ArrayFault& fault) {
    fail(fault.what, fault.cure);
  }
  start_ = start;
}

void VtkReader::read_array(const std::string& name, const Type& type, std::size_t width) {
  if (data_ < 0) fail(fmt::format("the array '{}' stands before POINT_DATA or CELL_DATA", name));
  if (width == 0 || (n_data_ > 0 && width > bytes_.size() / n_data_))
    fail(fmt::format("the array '{}' declares {} components for {} {}", name, width, n_data_,
                     data_ ? "cells" : "points"));
  const Values found = values(n_data_ * width, type);
  try {
    grid_.add_data(data_ == 1, name, found, n_data_);
  } catch (const vtk::ArrayFault& fault) {
    fail(fault.what, fault.cure);
  }
}

/// SCALARS name type [components], then LOOKUP_TABLE name.
void VtkReader::read_scalars(const Words& section) {
  const std::size_t width = section.size() > 3 ? number(section, 3, "a number of components") : 1;
  const std::size_t start = start_;
  Words table;
  if (!next_section(table) || upper(table[0]) != "LOOKUP_TABLE") fail("SCALARS has no line LOOKUP_TABLE");
  start_ = start;
  read_array(decoded(section[1]), type(section, 2), width);
}

/// FIELD name arrays, each: name components tuples type.
void VtkReader::read_fields(const Words& section) {
  const std::size_t n = number(section, 2, "a number of arrays");
  for (std::size_t k = 0; k < n; ++k) {
    Words array;
    bool found = next_section(array);
    while (found && upper(array[0]) == "METADATA") {
      while (!words().empty()) continue;
      found = next_section(array);
    }
    if (!found) fail(fmt::format("FIELD declares {} arrays, found {}", n, k));
    const std::size_t width = number(array, 1, "a number of components"), rows = number(array, 2, "a number of tuples");
    if (rows > 0 && width > bytes_.size() / rows)
      fail(fmt::format("'{}' declares {} times {} values: more than the file holds", array[0], width, rows));
    const std::string name = decoded(array[0]);
    if (const std::string kind = upper(array.size() > 3 ? array[3] : ""); kind == "STRING" || kind == "UTF8_STRING") {
      if (binary_) fail(fmt::format("the array '{}' is binary text, which is not read", name), "Leave the array out");
      for (std::size_t i = 0; i < width * rows; ++i) {
        if (at_ == bytes_.size())
          fail(fmt::format("the array '{}' holds {} texts, expected {}", name, i, width * rows));
        line();
      }
      mesh_.losses.push_back({fmt::format("array '{}'", name), 1, "no numbers"});
    } else if (data_ < 0) {
      values(width * rows, type(array, 3));
      mesh_.losses.push_back({fmt::format("field '{}'", name), 1, "belongs to no points or cells"});
    } else {
      if (rows != n_data_)
        fail(fmt::format("the array '{}' has {} rows for {} {}", name, rows, n_data_, data_ ? "cells" : "points"));
      read_array(name, type(array, 3), width);
    }
  }
}

void VtkReader::read_section(const Words& section) {
  constexpr std::size_t any = std::numeric_limits<std::size_t>::max();
  struct Attribute {
    std::string_view name;
    std::size_t components;
  };
  constexpr std::array<Attribute, 8> attributes{{{"VECTORS", 3},
                                                 {"NORMALS", 3},
                                                 {"TENSORS", 9},
                                                 {"TENSORS6", 6},
                                                 {"GLOBAL_IDS", 1},
                                                 {"PEDIGREE_IDS", 1},
                                                 {"EDGE_FLAGS", 1},
                                                 {"TEXTURE_COORDINATES", any}}};
  const std::string word = upper(section[0]);
  const auto attribute = std::ranges::find(attributes, word, &Attribute::name);
  if ((attribute != attributes.end() || word == "SCALARS") && section.size() < 3)
    fail(fmt::format("'{}' has no name and type", word));
  if (word == "POINTS") {
    if (has_points_) fail("found a second section POINTS");
    has_points_ = true;
    const std::size_t n = number(section, 1, "a number of points");
    const Values x = values(3 * n, type(section, 2));
    try {
      grid_.add_points(x, n);
    } catch (const vtk::ArrayFault& fault) {
      fail(fault.what, fault.cure);
    }
  } else if (word == "CELLS") {
    read_cells(section);
  } else if (word == "CELL_TYPES") {
    if (has_types_) fail("found a second section CELL_TYPES");
    has_types_ = true;
    types_ = values(number(section, 1, "a number of cells"), types[5]);
  } else if (word == "POINT_DATA" || word == "CELL_DATA") {
    add_cells();
    data_ = word == "CELL_DATA" ? 1 : 0;
    n_data_ = number(section, 1, "a number of points or cells");
    if (const std::size_t n = data_ ? types_.size() : mesh_.points.size(); n_data_ != n)
      fail(fmt::format("{} declares {} rows, the dataset has {} {}", word, n_data_, n, data_ ? "cells" : "points"));
  } else if (word == "SCALARS") {
    read_scalars(section);
  } else if (attribute != attributes.end()) {
    const bool texture = attribute->components == any;
    read_array(decoded(section[1]), type(section, texture ? 3 : 2),
               texture ? number(section, 2, "a number of components") : attribute->components);
  } else if (word == "COLOR_SCALARS" || word == "LOOKUP_TABLE") {
    const bool colours = word == "COLOR_SCALARS";
    const std::size_t n = number(section, 2, "a number of values");
    if (colours && n_data_ > 0 && n > bytes_.size() / n_data_) fail("COLOR_SCALARS declares more than the file holds");
    values(colours ? n * n_data_ : 4 * n, types[binary_ ? 0 : 8]);  // bytes, or reals of 0 to 1
    mesh_.losses.push_back({word, 1, "colours"});
  } else if (word == "FIELD") {
    read_fields(section);
  } else if (word == "METADATA") {
    while (!words().empty()) continue;
  } else {
    fail(fmt::format("found '{}', expected a section of an unstructured grid", section[0].substr(0, 40)));
  }
}

Mesh VtkReader::read() {
  read_heading();
  Words section;
  bool dataset = false;
  while (next_section(section)) {
    if (upper(section[0]) == "DATASET") {
      const std::string kind = section.size() > 1 ? upper(section[1]) : "";
      if (kind != "UNSTRUCTURED_GRID")
        fail(fmt::format("found the dataset {}, expected UNSTRUCTURED_GRID", kind.substr(0, 40)),
             "Turn it into an unstructured grid (in ParaView: Append Datasets) and save that");
      if (dataset) fail("found a second DATASET");
      dataset = true;
    } else if (!dataset && upper(section[0]) != "FIELD") {
      fail(fmt::format("found '{}', expected DATASET", section[0].substr(0, 40)));
    } else {
      read_section(section);
    }
  }
  add_cells();
  grid_.finish();
  return std::move(mesh_);
}

}  // namespace

Mesh parse_vtk(std::string_view bytes, const std::string& source) {
  if (bytes.empty()) throw InputError({source}, "the file is empty", "Save the mesh again");
  return VtkReader(bytes, source).read();
}

Mesh read_vtk(const std::filesystem::path& path) { return parse_vtk(read_bytes(path), path.string()); }

}  // namespace tenon::fem
