#pragma once

#include <filesystem>
#include <vector>

#include "assembly/scene.hpp"
#include "fem/formats/matrices/make_model.hpp"

namespace tenon::assembly {

/// K and M of the files that a scene names under `matrices`, as a model in SI. A scalar dof counts as a length.
/// Throws InputError for what the files say wrongly, ModelError for matrices that no body has.
fem::MatrixModel read_matrix_body(const MatrixFiles& files, const Units& units);

/// Every file that they are read from, for provenance.
std::vector<std::filesystem::path> files_read(const MatrixFiles& files);

}  // namespace tenon::assembly
