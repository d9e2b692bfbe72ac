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

}  // namespace

vtk::Values hdf5_values(const std::filesystem::path& path, const std::string& dataset) {
  const Quiet quiet;
  const auto fail = [&](const std::string& what, const char* cure = "Write both files again") {
    throw vtk::ArrayFault{what, cure};
  };
  const Handle file(H5Fopen(path.c_str(), H5F_ACC_RDONLY, H5P_DEFAULT), H5Fclose);
  if (!file.good()) fail(fmt::format("names '{}', which is no HDF5 file", path.filename().string()));
  const Handle data(H5Dopen2(file, dataset.c_str(), H5P_DEFAULT), H5Dclose);
  if (!data.good()) fail(fmt::format("names '{}', which '{}' does not hold", dataset, path.filename().string()));
  const Handle space(H5Dget_space(data), H5Sclose), type(H5Dget_type(data), H5Tclose);
  const hssize_t n = space.good() ? H5Sget_simple_extent_npoints(space) : -1;
  const H5T_class_t kind = type.good() ? H5Tget_class(type) : H5T_NO_CLASS;
  if (n < 0 || (kind != H5T_INTEGER && kind != H5T_FLOAT)) fail(fmt::format("'{}' holds no numbers", dataset));
  const auto count = static_cast<std::size_t>(n);
  if (const hsize_t stored = H5Dget_storage_size(data); count / 1100 > stored)
    fail(fmt::format("'{}' declares {} numbers and stores {} bytes of them", dataset, count, stored));
  vtk::Values values;
  values.real = kind == H5T_FLOAT;
  herr_t status = 0;
  if (values.real) {
    values.reals.resize(count);
    status = H5Dread(data, H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, values.reals.data());
  } else {
    values.whole.resize(count);
    status = H5Dread(data, H5T_NATIVE_INT64, H5S_ALL, H5S_ALL, H5P_DEFAULT, values.whole.data());
  }
  if (status < 0) fail(fmt::format("'{}' cannot be read: it is damaged, or packed in a way that HDF5 lacks", dataset));
  return values;
}

}  // namespace tenon::fem::xdmf
