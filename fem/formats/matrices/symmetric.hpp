#pragma once

#include <Eigen/SparseCore>
#include <string>
#include <vector>

#include "fem/formats/matrices/matrix_data.hpp"

namespace tenon::fem::matrices {

using Entry = Eigen::Triplet<double>;

/// "node 11 uy", "scalar point 2995001".
std::string to_string(const MatrixRow& row);

/// Which off-diagonal entries a file holds: both triangles, or each once in either (then both are allowed and agree).
enum class Stored { both, either };

/// The lower triangle of a symmetric n×n matrix from its entries, n = rows.size(); the mean of both triangles where
/// both are given. Throws InputError for an entry that stands twice, and for a difference of the triangles above
/// 1e-6 of the larger row maximum (single precision): nothing unsymmetric is made symmetric.
/// @param name  of the matrix and  @param file  for messages
SparseMatrix lower_triangle(const std::string& name, const std::string& file, const std::vector<MatrixRow>& rows,
                            std::vector<Entry> entries, Stored stored);

/// R A Rᵀ of a symmetric A given by its lower triangle, again as lower triangle.
SparseMatrix turned(const SparseMatrix& R, const SparseMatrix& lower);

}  // namespace tenon::fem::matrices
