#pragma once

#include <filesystem>
#include <string>
#include <string_view>

#include "fem/mesh.hpp"

namespace tenon::fem {

/// Reads a Gmsh .msh file: 2.x and 4.1 as text or binary (either byte order), 4.0 as text.
///
/// One block of cells a type, nodes in VTK's order (linear wedges as Gmsh and meshio have them: first triangle's normal
/// inward). Every physical group becomes a cell set of its name, or of "curve_7" when tag 7 of dimension 1 has no name;
/// groups that share a name share the set. Physical points are point sets too. A cell in several groups is one cell:
/// the copies that 2.x files hold are merged. $NodeData and $ElementData become point_data and cell_data, NaN where
/// there is no value. Everything else read past is in Mesh::losses.
///
/// Throws InputError with file:line:column (the byte offset in binary files) for whatever the file does not say as the
/// format demands; memory is bounded by the file's size, never by a number in it.
/// Source: Gmsh reference manual, "MSH file format" and "Node ordering".
Mesh read_gmsh(const std::filesystem::path& path);

/// The same from the bytes of a file; `source` names them in messages.
Mesh parse_gmsh(std::string_view bytes, const std::string& source);

}  // namespace tenon::fem
