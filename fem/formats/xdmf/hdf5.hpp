#pragma once

#include <filesystem>
#include <string>

#include "fem/formats/vtk/values.hpp"

namespace tenon::fem::xdmf {

/// All numbers of a dataset of an HDF5 file, row by row: whole or real as it stores them. Throws vtk::ArrayFault for
/// files and datasets that cannot be read, for other contents, and for datasets that would take more than 1100 times
/// what is stored of them (no compression gains more).
vtk::Values hdf5_values(const std::filesystem::path& file, const std::string& dataset);

}  // namespace tenon::fem::xdmf
