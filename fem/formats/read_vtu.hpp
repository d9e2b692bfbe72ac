#pragma once

#include <filesystem>
#include <string>
#include <string_view>

#include "fem/mesh.hpp"

namespace tenon::fem {

/// Reads a VTK XML file of an unstructured grid (.vtu): text, base64 and raw or base64 appended data, compressed by
/// zlib or not, either byte order and header type, any number of pieces.
///
/// One block of cells a type, nodes in a Mesh's order. Points and cells are numbered from 0 as ParaView shows them,
/// piece after piece. The points of pieces stay apart: nothing coincident is merged. Whole numbers, one a cell, make
/// the cell sets "array_value" beside the cell data, up to 256 values an array. A value that a piece lacks is NaN.
///
/// Throws InputError with file:line:column of the element at fault; for cells this project has none of, ghost cells
/// (copies, whose stiffness would count twice), other compressors than zlib. Memory is bounded by the file.
/// Source: VTK file formats, "XML file formats"; cell numbers of vtkCellType.h.
Mesh read_vtu(const std::filesystem::path& path);

/// The same from the bytes of a file; `source` names them in messages.
Mesh parse_vtu(std::string_view bytes, const std::string& source);

}  // namespace tenon::fem
