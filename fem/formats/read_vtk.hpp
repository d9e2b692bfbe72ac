#pragma once

#include <filesystem>
#include <string>
#include <string_view>

#include "fem/mesh.hpp"

namespace tenon::fem {

/// Reads a legacy VTK file (.vtk) of an unstructured grid, versions 1.0 to 5.1, ASCII or BINARY (big-endian): points,
/// cells, point and cell data. Numbers, nodes and sets as those of read_vtu. Text arrays, lookup tables and fields
/// outside the points and cells are losses.
///
/// Throws InputError with file:line:column of the section at fault; for other datasets by name, for packed bits and
/// binary text. Memory is bounded by the file.
/// Source: VTK file formats, "Simple legacy formats"; vtkDataWriter.cxx (types, sections OFFSETS and CONNECTIVITY).
Mesh read_vtk(const std::filesystem::path& path);

/// The same from the bytes of a file; `source` names them in messages.
Mesh parse_vtk(std::string_view bytes, const std::string& source);

}  // namespace tenon::fem
