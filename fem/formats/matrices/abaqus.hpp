#pragma once

#include <filesystem>
#include <string>

#include "fem/formats/matrices/matrix_data.hpp"

namespace tenon::fem {

/// K and M of Abaqus's *MATRIX GENERATE with FORMAT=MATRIX INPUT, one .mtx file each: lines "row node, dof, column
/// node, dof, value", one triangle or both. Rows come in the order of node and direction; a dof that only one file
/// names is null in the other. Dofs that Abaqus marks as held by 1e36 on the diagonal are left out, and stand in the
/// losses. A file cut off between two lines cannot be told from a shorter one. Throws InputError for lines of another
/// form, internal nodes (negative numbers: connectors, hybrid elements) and dofs that are no displacement or rotation
/// (7 warping, 8 pressure, 11 temperature). Source: *MATRIX INPUT, *MATRIX OUTPUT and "Generating matrices" of the
/// Abaqus manuals.
MatrixData read_abaqus_matrices(const std::filesystem::path& stiffness, const std::filesystem::path& mass);

/// The same from the names that Abaqus gives: job_STIFn.mtx and job_MASSn.mtx of the one step n that has both.
/// Throws InputError when there is none, or more than one.
MatrixData read_abaqus_matrices(const std::string& job);

}  // namespace tenon::fem
