#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "fem/mesh.hpp"

namespace tenon::cli {

/// The highest dimension of a set's cells, 0 for points alone.
int dimension_of(const fem::Mesh& mesh, const std::vector<std::vector<int>>& blocks);

/// A name of the file as a value or key of the scene. Throws InputError for one that is no UTF-8, as scenes are.
std::string quoted(const std::string& name, const std::filesystem::path& file);

/// Lines of `sections` and `ignore` that give each cell of the mesh one section: sets that share cells with those
/// before them are left as comments, large sets and names of their own before `Line7` and its like. Throws InputError
/// for a mesh without lines and surfaces.
std::string section_lines(const fem::Mesh& mesh, const std::filesystem::path& file);

}  // namespace tenon::cli
