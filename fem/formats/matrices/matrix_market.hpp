#pragma once

#include <filesystem>

#include "fem/formats/matrices/matrix_data.hpp"

namespace tenon::fem {

/// A symmetric matrix in Matrix Market's coordinate format, lower triangle: real or integer, `symmetric` (each pair of
/// entries once, in either triangle) or `general` (both, equal to 1e-12 of the largest entry of their rows). Throws
/// InputError, with line and column, for other kinds (array, pattern, complex, skew-symmetric, hermitian), for entries
/// out of range or given twice, for counts that the file does not hold, and for a general matrix that is not symmetric,
/// which names the worst entry. Memory follows what the file holds, not what it declares.
/// @param rows  the labels of its rows  Source: Boisvert, Pozo, Remington, NISTIR 5935.
SparseMatrix read_matrix_market(const std::filesystem::path& path, const std::vector<MatrixRow>& rows);

/// K, M and the label file of their rows (labels.hpp). `stiffness` names the result.
MatrixData read_market_matrices(const std::filesystem::path& stiffness, const std::filesystem::path& mass,
                                const std::filesystem::path& labels);

}  // namespace tenon::fem
