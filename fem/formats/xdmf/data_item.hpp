#pragma once

#include <cstdint>
#include <filesystem>
#include <pugixml.hpp>

#include "fem/formats/vtk/values.hpp"

namespace tenon::fem::xdmf {

/// What has been read of a mesh's files: all numbers together may take a hundred times the files' size, however often a
/// file names the same of them.
struct Reading {
  std::filesystem::path folder;  ///< where files that the mesh names must lie
  std::uint64_t file_bytes = 0;  ///< of the mesh and of every file it named
  std::uint64_t taken = 0;       ///< bytes of the numbers

  std::uint64_t most() const { return 100 * file_bytes > taken ? 100 * file_bytes - taken : 0; }
};

/// The numbers of a DataItem, or of the one it refers to, as many as its Dimensions say. `whole`: they are whole
/// numbers where the item names no type (else reals, XDMF's default). Throws vtk::ArrayFault.
vtk::Values values_of(pugi::xml_node item, Reading& reading, bool whole);

}  // namespace tenon::fem::xdmf
