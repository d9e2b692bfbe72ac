#pragma once

#include <filesystem>

#include "fem/mesh.hpp"

namespace tenon::fem {

/// Reads a MED file of Salome or Code_Aster (.med, .mmed, .rmed), version 3 or 4, that holds one unstructured mesh: one
/// block of cells a type, nodes in a Mesh's order, points and cells with the file's numbers where it gives them, else
/// counted from 1. Groups of nodes and of cells become sets, fields at nodes and at cells data, of their first time.
/// Fields on parts of a mesh, at points within cells or of later times are in Mesh::losses, and so are names, joints,
/// equivalences, and the unit of the coordinates, which a scene states.
/// Throws InputError, which names the group or dataset at fault; for cells this project has none of, curvilinear
/// coordinates, several meshes. What is kept takes at most a hundred times the size of the file. Damaged files on which
/// HDF5 itself fails are refused too (rehearse).
/// Source: MED-fichier 4, model and its HDF5 representation (salome-platform.org).
/// @param sound  the file's bytes are known to be good HDF5: without rehearsal
Mesh read_med(const std::filesystem::path& path, bool sound = false);

}  // namespace tenon::fem
