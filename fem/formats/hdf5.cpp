#include "fem/formats/hdf5.hpp"

#include <fmt/format.h>
#include <hdf5.h>

#include <algorithm>
#include <utility>

namespace tenon::fem::hdf5 {
namespace {

/// An identifier of the library, closed at the end.
class Handle {
 public:
  Handle(hid_t id, herr_t (*close)(hid_t)) : id_(id), close_(close) {}
  ~Handle() {
    if (id_ >= 0) close_(id_);
  }
  Handle(const Handle&) = delete;
  Handle& operator=(const Handle&) = delete;
  operator hid_t() const { return id_; }
  bool good() const { return id_ >= 0; }

 private:
  hid_t id_;
  herr_t (*close_)(hid_t);
};

/// The library prints every failure to standard error unless told not to.
class Quiet {
 public:
  Quiet() {
    H5Eget_auto2(H5E_DEFAULT, &print_, &data_);
    H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr);
  }
  ~Quiet() { H5Eset_auto2(H5E_DEFAULT, print_, data_); }
  Quiet(const Quiet&) = delete;
  Quiet& operator=(const Quiet&) = delete;

 private:
  H5E_auto2_t print_ = nullptr;
  void* data_ = nullptr;
};

[[noreturn]] void fault(const std::string& what, const char* cure = "Write it again") {
  throw vtk::ArrayFault{what, cure};
}

/// Whether each step of the path is there; each must be a link within the file: one that names another file would be
/// followed out of the mesh's folder.
bool has_links(hid_t file, const std::string& object) {
  for (std::size_t end = object.find('/', 1);; end = object.find('/', end + 1)) {
    const std::string step = object.substr(0, end);
    H5L_info_t info{};
    if (step.empty() || H5Lget_info(file, step.c_str(), &info, H5P_DEFAULT) < 0) return false;
    if (info.type != H5L_TYPE_HARD)
      fault(fmt::format("'{}' is a link to another place", step), "Copy the dataset into the file (h5repack)");
    if (end == object.npos) return true;
  }
}

void check_storage(hid_t data, const std::string& dataset) {
  const Handle how(H5Dget_create_plist(data), H5Pclose);
  if (!how.good() || H5Pget_layout(how) == H5D_VIRTUAL || H5Pget_external_count(how) != 0)
    fault(fmt::format("'{}' keeps its numbers in another file", dataset), "Copy them into the file (h5repack)");
}

/// The library clips what does not fit: numbers without sign are read as such, so that none changes in silence.
herr_t read_unsigned(hid_t data, std::vector<std::int64_t>& whole, const std::string& dataset) {
  std::vector<std::uint64_t> raw(whole.size());
  const herr_t status = H5Dread(data, H5T_NATIVE_UINT64, H5S_ALL, H5S_ALL, H5P_DEFAULT, raw.data());
  for (std::size_t i = 0; i < raw.size() && status >= 0; ++i) {
    if (!std::in_range<std::int64_t>(raw[i]))
      fault(fmt::format("'{}' holds {}, more than a signed whole number of 64 bits can be", dataset, raw[i]));
    whole[i] = static_cast<std::int64_t>(raw[i]);
  }
  return status;
}

/// A dataset of the file, its type and how many values it declares.
struct Dataset {
  Dataset(hid_t file, const std::string& name, const std::string& file_name)
      : data(has_links(file, name) ? H5Dopen2(file, name.c_str(), H5P_DEFAULT) : -1, H5Dclose),
        type(data.good() ? H5Dget_type(data) : -1, H5Tclose) {
    if (!data.good()) fault(fmt::format("'{}' is not in '{}'", name, file_name));
    check_storage(data, name);
    const Handle space(H5Dget_space(data), H5Sclose);
    const hssize_t n = space.good() ? H5Sget_simple_extent_npoints(space) : -1;
    if (n < 0 || !type.good()) fault(fmt::format("'{}' is damaged", name));
    count = static_cast<std::size_t>(n);
  }

  /// Each value takes `width` bytes, and `stored_width` in the file.
  void check_size(const std::string& name, std::uint64_t width, std::uint64_t stored_width, std::uint64_t most) const {
    if (const hsize_t stored = H5Dget_storage_size(data); count / 1100 * stored_width > stored)
      fault(fmt::format("'{}' declares {} values and stores {} bytes of them", name, count, stored));
    if (count > most / width)
      fault(fmt::format("'{}' declares {} values: with all before, more than a hundred times the files", name, count));
  }

  Handle data, type;
  std::size_t count = 0;
};

[[noreturn]] void damaged(const std::string& dataset) {
  fault(fmt::format("'{}' cannot be read: it is damaged, or packed in a way that HDF5 lacks", dataset));
}

/// Without blanks and zeros at the end.
std::string trimmed_end(std::string text) {
  text.resize(std::min(text.find('\0'), text.size()));
  text.erase(text.find_last_not_of(' ') + 1);
  return text;
}

Handle open_attribute(hid_t file, const std::string& object, const std::string& attribute) {
  return {
      has_links(file, object) ? H5Aopen_by_name(file, object.c_str(), attribute.c_str(), H5P_DEFAULT, H5P_DEFAULT) : -1,
      H5Aclose};
}

}  // namespace

File::File(const std::filesystem::path& path) : name_(path.filename().string()) {
  [[maybe_unused]] static const herr_t no_farewell =
      H5dont_atexit();  // which complains of what damaged files left open
  const Quiet quiet;
  id_ = H5Fopen(path.c_str(), H5F_ACC_RDONLY, H5P_DEFAULT);
  if (id_ < 0) fault(fmt::format("'{}' is no HDF5 file", name_));
}

File::~File() { H5Fclose(id_); }

bool File::has(const std::string& object) const {
  const Quiet quiet;
  return has_links(id_, object);
}

std::vector<std::string> File::members(const std::string& group) const {
  const Quiet quiet;
  std::vector<std::string> names;
  const Handle open(has_links(id_, group) ? H5Gopen2(id_, group.c_str(), H5P_DEFAULT) : -1, H5Gclose);
  if (!open.good()) return names;
  const auto add = [](hid_t, const char* name, const H5L_info_t*, void* list) {
    static_cast<std::vector<std::string>*>(list)->emplace_back(name);
    return herr_t{0};
  };
  // not in the alphabet's order: HDF5 1.10 then makes a table of the links, and frees what it never took in damaged
  // ones
  if (H5Literate(open, H5_INDEX_NAME, H5_ITER_NATIVE, nullptr, add, &names) < 0) damaged(group);
  std::ranges::sort(names);
  return names;
}

vtk::Values File::values(const std::string& dataset, std::uint64_t most) const {
  const Quiet quiet;
  const Dataset d(id_, dataset, name_);
  const H5T_class_t kind = H5Tget_class(d.type);
  if (kind != H5T_INTEGER && kind != H5T_FLOAT) fault(fmt::format("'{}' holds no numbers", dataset));
  d.check_size(dataset, sizeof(double), 1, most);
  vtk::Values values;
  values.real = kind == H5T_FLOAT;
  herr_t status = 0;
  if (values.real) {
    values.reals.resize(d.count);
    status = H5Dread(d.data, H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, values.reals.data());
  } else {
    values.whole.resize(d.count);
    status = H5Tget_sign(d.type) == H5T_SGN_NONE
                 ? read_unsigned(d.data, values.whole, dataset)
                 : H5Dread(d.data, H5T_NATIVE_INT64, H5S_ALL, H5S_ALL, H5P_DEFAULT, values.whole.data());
  }
  if (status < 0) damaged(dataset);
  return values;
}

std::vector<std::string> File::texts(const std::string& dataset, std::uint64_t most) const {
  const Quiet quiet;
  const Dataset d(id_, dataset, name_);
  const bool array = H5Tget_class(d.type) == H5T_ARRAY, string = H5Tget_class(d.type) == H5T_STRING;
  const std::size_t width = H5Tget_size(d.type);
  if (width == 0 || !(array || string) || (string && H5Tis_variable_str(d.type) != 0))
    fault(fmt::format("'{}' holds no texts of one length", dataset));
  if (array) {
    const Handle base(H5Tget_super(d.type), H5Tclose);
    if (!base.good() || H5Tget_class(base) != H5T_INTEGER || H5Tget_size(base) != 1)
      fault(fmt::format("'{}' holds no texts", dataset));
  }
  d.check_size(dataset, 2 * width + sizeof(std::string), width, most);
  std::string bytes(d.count * width, '\0');
  if (d.count > 0 && H5Dread(d.data, d.type, H5S_ALL, H5S_ALL, H5P_DEFAULT, bytes.data()) < 0) damaged(dataset);
  std::vector<std::string> all;
  for (std::size_t i = 0; i < d.count; ++i) all.push_back(trimmed_end(bytes.substr(i * width, width)));
  return all;
}

std::optional<std::int64_t> File::number(const std::string& object, const std::string& attribute) const {
  const Quiet quiet;
  const Handle open = open_attribute(id_, object, attribute);
  if (!open.good()) return {};
  const Handle type(H5Aget_type(open), H5Tclose), space(H5Aget_space(open), H5Sclose);
  std::int64_t value = 0;
  if (!type.good() || H5Tget_class(type) != H5T_INTEGER || H5Sget_simple_extent_npoints(space) != 1 ||
      H5Aread(open, H5T_NATIVE_INT64, &value) < 0)
    return {};
  return value;
}

std::optional<std::string> File::text(const std::string& object, const std::string& attribute) const {
  constexpr std::size_t longest = 4096;
  const Quiet quiet;
  const Handle open = open_attribute(id_, object, attribute);
  if (!open.good()) return {};
  const Handle type(H5Aget_type(open), H5Tclose), space(H5Aget_space(open), H5Sclose);
  if (!type.good() || H5Tget_class(type) != H5T_STRING || H5Tis_variable_str(type) != 0 ||
      H5Sget_simple_extent_npoints(space) != 1 || H5Tget_size(type) > longest)
    return {};
  std::string value(H5Tget_size(type), '\0');
  if (H5Aread(open, type, value.data()) < 0) return {};
  return trimmed_end(value);
}

}  // namespace tenon::fem::hdf5
