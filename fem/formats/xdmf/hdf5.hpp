#pragma once

#include <cstdint>
#include <filesystem>
#include <string>

#include "fem/formats/vtk/values.hpp"

namespace tenon::fem::xdmf {

/// All numbers of a dataset of an HDF5 file, row by row: whole or real as it stores them. Throws vtk::ArrayFault for
/// files and datasets that cannot be read, for other contents, for datasets that would take more than 1100 times what
/// is stored of them (no compression gains more) or more than `most` bytes, and for those that lie in another file:
/// behind links, in external storage or in virtual datasets.
vtk::Values hdf5_values(const std::filesystem::path& file, const std::string& dataset, std::uint64_t most);

}  // namespace tenon::fem::xdmf
