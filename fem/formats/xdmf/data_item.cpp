#include "fem/formats/xdmf/data_item.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <charconv>

#include "fem/error.hpp"
#include "fem/formats/file_bytes.hpp"
#include "fem/formats/hdf5.hpp"
#include "fem/formats/rehearsal.hpp"

namespace tenon::fem::xdmf {
namespace {

namespace fs = std::filesystem;

[[noreturn]] void item_fault(const std::string& what, const std::string& cure = "Write it again") {
  throw vtk::ArrayFault{what, cure};
}

std::string_view trimmed(std::string_view text) {
  constexpr const char* blanks = " \t\r\n";
  const auto first = text.find_first_not_of(blanks);
  return first == text.npos ? std::string_view() : text.substr(first, text.find_last_not_of(blanks) - first + 1);
}

/// Product of the Dimensions.
std::size_t declared(pugi::xml_node item) {
  std::string_view text = trimmed(item.attribute("Dimensions").value());
  if (text.empty()) item_fault("has no Dimensions");
  constexpr std::uint64_t most = std::uint64_t{1} << 60;  // 8 bytes each can still be counted
  std::uint64_t n = 1;
  while (!text.empty()) {
    std::uint64_t factor = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), factor);
    if (error != std::errc() || (factor > 0 && n > most / factor))
      item_fault(fmt::format("has Dimensions=\"{}\", expected whole numbers", item.attribute("Dimensions").value()));
    n *= factor;
    text = trimmed(text.substr(static_cast<std::size_t>(end - text.data())));
  }
  return n;
}

/// VTK's name of the type, e.g. Float64; `usual` where the item names none.
std::string type_of(pugi::xml_node item, const char* usual) {
  const std::string type = item.attribute(item.attribute("NumberType") ? "NumberType" : "DataType").as_string(usual);
  const std::string precision = item.attribute("Precision").as_string(type == "Char" || type == "UChar" ? "1" : "4");
  const bool good = precision == "1" || precision == "2" || precision == "4" || precision == "8";
  if (type == "Float" && (precision == "4" || precision == "8"))
    return "Float" + std::to_string(precision == "8" ? 64 : 32);
  if (good && (type == "Int" || type == "Char")) return fmt::format("Int{}", 8 * std::stoi(precision));
  if (good && (type == "UInt" || type == "UChar")) return fmt::format("UInt{}", 8 * std::stoi(precision));
  item_fault(fmt::format("has numbers of type {} with Precision {}", type, precision),
             "Write Float (4, 8), Int, UInt, Char or UChar (1, 2, 4, 8)");
}

/// A file of the mesh's folder or below; no name and no link leads out of it.
fs::path beside(std::string_view name, const fs::path& folder) {
  std::error_code fault;
  const fs::path base = fs::weakly_canonical(folder.empty() ? fs::path(".") : folder, fault);
  const fs::path path = fs::weakly_canonical(base / fs::path(name), fault);
  if (name.empty() || std::ranges::mismatch(base, path).in1 != base.end())
    item_fault(fmt::format("names the file '{}', which does not lie in the folder of the mesh", name),
               "Move it there, and name it without a folder");
  if (!fs::is_regular_file(path, fault))
    item_fault(fmt::format("names the file '{}', which is not there", name), "Copy it beside the mesh");
  return path;
}

/// The DataItem at a path "/Xdmf/Domain/Grid[@Name="a"]/Geometry/DataItem[2]"; no other XPath is followed.
pugi::xml_node referred(pugi::xml_node item) {
  const std::string_view said = item.attribute("Reference").value();
  const std::string path(trimmed(said == "XML" ? std::string_view(item.text().get()) : said));
  pugi::xml_node at = path.starts_with('/') ? item.root() : pugi::xml_node();
  for (std::size_t start = 1; at && start <= path.size();) {
    const std::size_t end = std::min(path.find('/', start), path.size());
    const std::string step = path.substr(start, end - start);
    start = end + 1;
    const auto bracket = std::min(step.find('['), step.size());
    const std::string tag = step.substr(0, bracket), which = step.substr(bracket);
    constexpr std::string_view named = "[@Name=";
    if (which.starts_with(named) && which.size() > named.size() + 2 && which.ends_with(']')) {
      at = at.find_child_by_attribute(tag.c_str(), "Name",
                                      which.substr(named.size() + 1, which.size() - named.size() - 3).c_str());
      continue;
    }
    int n = 1;
    if (!which.empty() && std::from_chars(which.data() + 1, which.data() + which.size(), n).ec != std::errc()) n = 0;
    at = n > 0 ? at.child(tag.c_str()) : pugi::xml_node();
    while (at && --n > 0) at = at.next_sibling(tag.c_str());
  }
  if (std::string_view(at.name()) != "DataItem")
    item_fault(fmt::format("refers to '{}', which is no path to a DataItem of the file", path.substr(0, 80)),
               "Write its numbers in place");
  return at;
}

vtk::Values binary_values(pugi::xml_node item, std::size_t n, const std::string& type, Reading& reading) {
  const std::string endian = item.attribute("Endian").as_string("Native");
  if (const std::string packed = item.attribute("Compression").as_string("Raw"); packed != "Raw")
    item_fault(fmt::format("has Compression=\"{}\"", packed), "Write it without compression, or as HDF5");
  if (endian != "Native" && endian != "Little" && endian != "Big")
    item_fault(fmt::format("has Endian=\"{}\", expected Native, Little or Big", endian));
  const fs::path path = beside(trimmed(item.text().get()), reading.folder);
  const MappedFile file(path);
  reading.file_bytes += file.bytes().size();
  const std::string seek_text = item.attribute("Seek").as_string("0");
  std::uint64_t seek = 0;
  const auto [end, error] = std::from_chars(seek_text.data(), seek_text.data() + seek_text.size(), seek);
  if (error != std::errc() || *end != '\0')
    item_fault(fmt::format("has Seek=\"{}\", expected a number of bytes", seek_text));
  const std::size_t width = std::stoul(type.substr(type.find_first_of("1368"))) / 8;
  if (seek > file.bytes().size() || (file.bytes().size() - seek) / width < n)
    item_fault(fmt::format("needs {} bytes from {} on, '{}' has {}", n * width, seek, path.filename().string(),
                           file.bytes().size()));
  if (n > reading.most() / sizeof(double)) item_fault("makes, with all before, more than a hundred times the files");
  const bool big = std::endian::native == std::endian::big;
  return vtk::raw_values(file.bytes().substr(seek, n * width), type, endian == (big ? "Little" : "Big"));
}

vtk::Values hdf5_values(const fs::path& file, const std::string& dataset, std::uint64_t most) {
  try {
    const auto read = [&] { return hdf5::File(file).values(dataset, most); };
    rehearse(file, read);
    return read();
  } catch (const vtk::ArrayFault& fault) {
    item_fault(fmt::format("names '{}' of '{}': {}", dataset, file.filename().string(), fault.what), fault.cure);
  }
}

}  // namespace

vtk::Values values_of(pugi::xml_node item, Reading& reading, bool whole) {
  for (int step = 0; item.attribute("Reference"); ++step) {
    if (step == 8) item_fault("refers to an item that refers on and on", "Write its numbers in place");
    item = referred(item);
  }
  if (const std::string kind = item.attribute("ItemType").as_string("Uniform"); kind != "Uniform")
    item_fault(fmt::format("is of ItemType {}, which is not read", kind), "Write plain numbers");
  const std::size_t n = declared(item);
  const std::string type = type_of(item, whole ? "Int" : "Float"), format = item.attribute("Format").as_string("XML");
  vtk::Values values;
  if (format == "XML") {
    values = vtk::text_values(item.text().get(), type);
  } else if (format == "HDF") {
    const std::string_view text = trimmed(item.text().get());
    const auto colon = text.find(':');
    if (colon == text.npos || colon + 1 == text.size())
      item_fault(fmt::format("holds '{}', expected FILE.h5:/DATASET", text.substr(0, 80)));
    const fs::path file = beside(text.substr(0, colon), reading.folder);
    std::error_code fault;
    if (const auto size = fs::file_size(file, fault); !fault) reading.file_bytes += size;
    values = hdf5_values(file, std::string(text.substr(colon + 1)), reading.most());
  } else if (format == "Binary") {
    values = binary_values(item, n, type, reading);
  } else {
    item_fault(fmt::format("has Format=\"{}\", expected XML, HDF or Binary", format));
  }
  if (sizeof(double) * values.size() > reading.most())
    item_fault("makes, with all before, more than a hundred times the files");
  reading.taken += sizeof(double) * values.size();
  if (values.size() != n) item_fault(fmt::format("holds {} numbers, its Dimensions say {}", values.size(), n));
  return values;
}

}  // namespace tenon::fem::xdmf
