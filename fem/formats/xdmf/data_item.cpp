#include "fem/formats/xdmf/data_item.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <charconv>

#include "fem/error.hpp"
#include "fem/formats/file_bytes.hpp"
#include "fem/formats/xdmf/hdf5.hpp"

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
  std::uint64_t n = 1;
  while (!text.empty()) {
    std::uint64_t factor = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), factor);
    if (error != std::errc() || (factor > 0 && n > std::uint64_t{1} << 48) || factor > std::uint64_t{1} << 40)
      item_fault(fmt::format("has Dimensions=\"{}\", expected whole numbers", item.attribute("Dimensions").value()));
    n *= factor;
    text = trimmed(text.substr(static_cast<std::size_t>(end - text.data())));
  }
  return n;
}

/// VTK's name of the type, e.g. Float64.
std::string type_of(pugi::xml_node item) {
  const std::string type = item.attribute(item.attribute("NumberType") ? "NumberType" : "DataType").as_string("Float");
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

vtk::Values binary_values(pugi::xml_node item, std::size_t n, const std::string& type, const fs::path& folder) {
  const std::string endian = item.attribute("Endian").as_string("Native");
  if (const std::string packed = item.attribute("Compression").as_string("Raw"); packed != "Raw")
    item_fault(fmt::format("has Compression=\"{}\"", packed), "Write it without compression, or as HDF5");
  if (endian != "Native" && endian != "Little" && endian != "Big")
    item_fault(fmt::format("has Endian=\"{}\", expected Native, Little or Big", endian));
  const fs::path path = beside(trimmed(item.text().get()), folder);
  const MappedFile file(path);
  const std::uint64_t seek = item.attribute("Seek").as_ullong(0);
  const std::size_t width = std::stoul(type.substr(type.find_first_of("1368"))) / 8;
  if (seek > file.bytes().size() || (file.bytes().size() - seek) / width < n)
    item_fault(fmt::format("needs {} bytes from {} on, '{}' has {}", n * width, seek, path.filename().string(),
                           file.bytes().size()));
  const bool big = std::endian::native == std::endian::big;
  return vtk::raw_values(file.bytes().substr(seek, n * width), type, endian == (big ? "Little" : "Big"));
}

}  // namespace

vtk::Values values_of(pugi::xml_node item, const fs::path& folder) {
  if (const std::string kind = item.attribute("ItemType").as_string("Uniform"); kind != "Uniform")
    item_fault(fmt::format("is of ItemType {}, which is not read", kind), "Write plain numbers");
  if (item.attribute("Reference")) item_fault("refers to another DataItem", "Write its numbers in place");
  const std::size_t n = declared(item);
  const std::string type = type_of(item), format = item.attribute("Format").as_string("XML");
  vtk::Values values;
  if (format == "XML") {
    values = vtk::text_values(item.text().get(), type);
  } else if (format == "HDF") {
    const std::string_view text = trimmed(item.text().get());
    const auto colon = text.find(':');
    if (colon == text.npos || colon + 1 == text.size())
      item_fault(fmt::format("holds '{}', expected FILE.h5:/DATASET", text.substr(0, 80)));
    values = hdf5_values(beside(text.substr(0, colon), folder), std::string(text.substr(colon + 1)));
  } else if (format == "Binary") {
    values = binary_values(item, n, type, folder);
  } else {
    item_fault(fmt::format("has Format=\"{}\", expected XML, HDF or Binary", format));
  }
  if (values.size() != n) item_fault(fmt::format("holds {} numbers, its Dimensions say {}", values.size(), n));
  return values;
}

}  // namespace tenon::fem::xdmf
