#pragma once

#include "assembly/scene.hpp"
#include "fem/formats/matrices/make_model.hpp"

namespace tenon::assembly {

/// K and M of the files that a scene names under `matrices`, as a model in SI. A scalar dof counts as a length.
/// Throws InputError for what the files say wrongly, ModelError for matrices that no body has.
fem::MatrixModel read_matrix_body(const MatrixFiles& files, const Units& units);

}  // namespace tenon::assembly
