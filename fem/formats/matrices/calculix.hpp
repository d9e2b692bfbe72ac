#pragma once

#include <map>
#include <string>

#include "fem/formats/matrices/matrix_data.hpp"

namespace tenon::fem {

/// What CalculiX writes for *FREQUENCY, SOLVER=MATRIXSTORAGE: job.sti and job.mas ("row column value", upper triangle),
/// job.dof ("node.direction" of every row). Dofs that are held or that an equation governs are already eliminated.
/// @param job        the files' common name, with or without one of their endings
/// @param positions  of nodes, as the job's deck has them; those of nodes without rows are left out
/// Throws InputError when a file is missing, cut off or damaged, and for repeated labels: CalculiX expands beams and
/// shells to solids and labels several rows alike, so these rows cannot be told apart.
/// Source: matrixstorage.c of CalculiX 2.20, and its manual on *FREQUENCY.
MatrixData read_calculix_matrices(const std::string& job, const std::map<long, Vec3>& positions = {});

}  // namespace tenon::fem
