#pragma once

#include <filesystem>

#include "fem/mesh.hpp"

namespace tenon::fem {

struct GmshOptions {
  bool binary = false;  ///< of this machine's byte order; text has the shortest digits that give the same numbers
};

/// Writes a mesh as Gmsh's .msh 4.1: points, cells of every type, sets as physical groups of their names (a set with
/// cells of two dimensions as one in each), point and cell data as $NodeData and $ElementData, without the rows that
/// are NaN. Numbers are the mesh's own where they are positive, below 2³¹ and each stands once, else 1, 2, ... in
/// order. A point set that no vertex cells of its name stand for gets such cells, which is how Gmsh has sets of points.
/// Fields have 1, 3 or 9 components: others are filled up with zeros, those of more than 9 are split. The file appears
/// whole or not at all. Throws ModelError for cells, sets and data that do not fit the mesh, hold infinity or have no
/// name that can be written, InputError when the file cannot be written. Source: Gmsh reference manual, "MSH file
/// format".
void write_gmsh(const std::filesystem::path& path, const Mesh& mesh, const GmshOptions& options = {});

}  // namespace tenon::fem
