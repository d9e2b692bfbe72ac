#pragma once

#include <filesystem>

#include "fem/formats/matrices/matrix_data.hpp"

namespace tenon::fem {

/// The label file beside matrices that carry no names: rows, positions and sets of the result, K and M left empty.
/// Text, `#` begins a comment; one line a row of the matrices, in their order, and lines that name sets of nodes:
///
///     NODE DIRECTION [X Y Z]      a dof: a number ≥ 1, one of ux uy uz rx ry rz or 1..6, the node's place (once a
///     node) scalar [NUMBER]             a scalar (modal) dof; without a number: above all nodes set NAME NODE NODE ...
///     repeated lines add to the set
///
/// Throws InputError for anything else, for dofs that stand twice, places that differ and sets of unknown nodes.
MatrixData read_matrix_labels(const std::filesystem::path& path);

}  // namespace tenon::fem
