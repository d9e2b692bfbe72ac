#include <hdf5.h>

#include <sstream>

#include "fem/formats/read_med.hpp"
#include "tests/fuzz/one_reader.hpp"

// A case is the list of what an HDF5 file holds: fuzz_hdf5 has the bytes themselves.
//   i PATH n n n   dataset of whole numbers      r PATH x x x   of reals      t PATH word word   of texts of 80 bytes
//   n PATH NAME n  attribute, a whole number     s PATH NAME word             attribute, a text
// Groups on the way are made; what cannot be made is left out.
namespace {

using Close = herr_t (*)(hid_t);

struct Handle {
  Handle(hid_t opened, Close with) : id(opened), close(with) {}
  ~Handle() {
    if (id >= 0) close(id);
  }
  Handle(const Handle&) = delete;
  Handle& operator=(const Handle&) = delete;
  hid_t id;
  Close close;
};

template <class T>
std::vector<T> rest_of(std::istringstream& line) {
  std::vector<T> values;
  for (T value; line >> value;) values.push_back(value);
  return values;
}

void put(hid_t file, const std::string& path, hid_t type, hsize_t n, const void* values) {
  const Handle groups(H5Pcreate(H5P_LINK_CREATE), H5Pclose), space(H5Screate_simple(1, &n, nullptr), H5Sclose);
  H5Pset_create_intermediate_group(groups.id, 1);
  const Handle data(H5Dcreate2(file, path.c_str(), type, space.id, groups.id, H5P_DEFAULT, H5P_DEFAULT), H5Dclose);
  if (data.id >= 0 && n > 0) H5Dwrite(data.id, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, values);
}

void put_attribute(hid_t file, const std::string& path, const std::string& name, hid_t type, const void* value) {
  const Handle groups(H5Pcreate(H5P_LINK_CREATE), H5Pclose), space(H5Screate(H5S_SCALAR), H5Sclose);
  H5Pset_create_intermediate_group(groups.id, 1);
  if (H5Oexists_by_name(file, path.c_str(), H5P_DEFAULT) <= 0)
    Handle(H5Gcreate2(file, path.c_str(), groups.id, H5P_DEFAULT, H5P_DEFAULT), H5Gclose);
  const Handle attribute(
      H5Acreate_by_name(file, path.c_str(), name.c_str(), type, space.id, H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT),
      H5Aclose);
  if (attribute.id >= 0) H5Awrite(attribute.id, type, value);
}

void put_line(hid_t file, const std::string& text) {
  std::istringstream line(text);
  std::string kind, path, name;
  line >> kind >> path;
  if (kind == "i") {
    const auto values = rest_of<std::int64_t>(line);
    put(file, path, H5T_NATIVE_INT64, values.size(), values.data());
  } else if (kind == "r") {
    const auto values = rest_of<double>(line);
    put(file, path, H5T_NATIVE_DOUBLE, values.size(), values.data());
  } else if (kind == "t") {
    const hsize_t width = 80;
    const Handle type(H5Tarray_create2(H5T_NATIVE_SCHAR, 1, &width), H5Tclose);
    const auto words = rest_of<std::string>(line);
    std::string bytes;
    for (std::string word : words) {
      word.resize(width, ' ');
      bytes += word;
    }
    put(file, path, type.id, words.size(), bytes.data());
  } else if (std::int64_t value = 0; kind == "n" && line >> name >> value) {
    put_attribute(file, path, name, H5T_NATIVE_INT64, &value);
  } else if (std::string word; kind == "s" && line >> name >> word) {
    const Handle type(H5Tcopy(H5T_C_S1), H5Tclose);
    H5Tset_size(type.id, word.size());
    put_attribute(file, path, name, type.id, word.data());
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr);
  const auto path = tenon::fuzz::folder() / "case.med";
  {
    const Handle file(H5Fcreate(path.c_str(), H5F_ACC_TRUNC, H5P_DEFAULT, H5P_DEFAULT), H5Fclose);
    std::istringstream lines{std::string(tenon::fuzz::text_of(data, size))};
    for (std::string line; std::getline(lines, line);) put_line(file.id, line);
  }
  return tenon::fuzz::read_or_refuse(std::filesystem::file_size(path), [&] { tenon::fem::read_med(path, true); });
}
