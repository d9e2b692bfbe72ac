#pragma once

#include <filesystem>

#include "fem/mesh.hpp"

namespace tenon::fem {

/// Reads a mesh file, its format chosen by what the file begins with and then by its extension: Gmsh .msh (read_gmsh),
/// Abaqus and CalculiX .inp (read_abaqus), Nastran's grids and elements without properties (read_nastran_mesh), VTK
/// .vtu (read_vtu) and .vtk (read_vtk), XDMF .xdmf and .xmf (read_xdmf), MED .med (read_med). Throws InputError listing
/// the formats when it is none of them, and with near misses when there is no such file.
Mesh read_mesh(const std::filesystem::path& path);

}  // namespace tenon::fem
