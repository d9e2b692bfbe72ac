#include "fem/formats/xdmf/hdf5.hpp"

#include <fmt/format.h>
#include <hdf5.h>

#include <utility>

namespace tenon::fem::xdmf {
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

[[noreturn]] void fault(const std::string& what, const char* cure = "Write both files again") {
  throw vtk::ArrayFault{what, cure};
}

/// Each step of the path must be a link within the file: one that names another file would be followed out of the
/// mesh's folder.
void check_links(hid_t file, const std::string& dataset, const std::string& file_name) {
  for (std::size_t end = dataset.find('/', 1);; end = dataset.find('/', end + 1)) {
    const std::string step = dataset.substr(0, end);
    H5L_info_t info{};
    if (step.empty() || H5Lget_info(file, step.c_str(), &info, H5P_DEFAULT) < 0)
      fault(fmt::format("names '{}', which '{}' does not hold", dataset, file_name));
    if (info.type != H5L_TYPE_HARD)
      fault(fmt::format("names '{}', a link to another place", step), "Copy the dataset into the file (h5repack)");
    if (end == dataset.npos) return;
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
      fault(fmt::format("'{}' holds {}, which no signed whole number of 64 bits can be", dataset, raw[i]));
    whole[i] = static_cast<std::int64_t>(raw[i]);
  }
  return status;
}

}  // namespace

vtk::Values hdf5_values(const std::filesystem::path& path, const std::string& dataset, std::uint64_t most) {
  const Quiet quiet;
  const Handle file(H5Fopen(path.c_str(), H5F_ACC_RDONLY, H5P_DEFAULT), H5Fclose);
  if (!file.good()) fault(fmt::format("names '{}', which is no HDF5 file", path.filename().string()));
  check_links(file, dataset, path.filename().string());
  const Handle data(H5Dopen2(file, dataset.c_str(), H5P_DEFAULT), H5Dclose);
  if (!data.good()) fault(fmt::format("names '{}', which '{}' does not hold", dataset, path.filename().string()));
  check_storage(data, dataset);
  const Handle space(H5Dget_space(data), H5Sclose), type(H5Dget_type(data), H5Tclose);
  const hssize_t n = space.good() ? H5Sget_simple_extent_npoints(space) : -1;
  const H5T_class_t kind = type.good() ? H5Tget_class(type) : H5T_NO_CLASS;
  if (n < 0 || (kind != H5T_INTEGER && kind != H5T_FLOAT)) fault(fmt::format("'{}' holds no numbers", dataset));
  const auto count = static_cast<std::size_t>(n);
  if (const hsize_t stored = H5Dget_storage_size(data); count / 1100 > stored)
    fault(fmt::format("'{}' declares {} numbers and stores {} bytes of them", dataset, count, stored));
  if (count > most / sizeof(double))
    fault(
        fmt::format("'{}' declares {} numbers: with all before, more than a hundred times the files", dataset, count));
  vtk::Values values;
  values.real = kind == H5T_FLOAT;
  herr_t status = 0;
  if (values.real) {
    values.reals.resize(count);
    status = H5Dread(data, H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, values.reals.data());
  } else {
    values.whole.resize(count);
    status = H5Tget_sign(type) == H5T_SGN_NONE
                 ? read_unsigned(data, values.whole, dataset)
                 : H5Dread(data, H5T_NATIVE_INT64, H5S_ALL, H5S_ALL, H5P_DEFAULT, values.whole.data());
  }
  if (status < 0) fault(fmt::format("'{}' cannot be read: it is damaged, or packed in a way that HDF5 lacks", dataset));
  return values;
}

}  // namespace tenon::fem::xdmf
