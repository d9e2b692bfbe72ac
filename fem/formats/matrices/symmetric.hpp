#pragma once

#include <Eigen/SparseCore>
#include <string>
#include <variant>
#include <vector>

#include "fem/formats/matrices/matrix_data.hpp"

namespace tenon::fem::matrices {

using Entry = Eigen::Triplet<double>;

/// "node 11 uy", "scalar point 2995001".
std::string to_string(const MatrixRow& row);

/// Which off-diagonal entries a file holds: both triangles, or each once: in one of them, or in either (then both are
/// allowed and agree).
enum class Stored { both, either, one };

/// What keeps entries from being a symmetric matrix: an entry that stands twice, or the worst difference of the
/// triangles.
struct Asymmetry {
  bool twice = false;
  int row = 0, column = 0;  ///< of an entry that stands twice; else in the lower triangle
  double lower = 0.0, upper = 0.0;
};

/// The lower triangle of a symmetric n×n matrix from its entries in any order, the mean of both triangles where both
/// are given: sorted in place, in 12 bytes an entry beside the entries' own 16. n < 2³⁰.
/// @param tolerance  of differences between the triangles, relative to the larger row maximum
std::variant<SparseMatrix, Asymmetry> lower_triangle(Eigen::Index n, std::vector<Entry> entries, Stored stored,
                                                     double tolerance);

/// The same of a file. Throws InputError for an entry that stands twice, and for a difference of the triangles above
/// 1e-6 (single precision): nothing unsymmetric is made symmetric.
/// @param name  of the matrix and  @param file  for messages
SparseMatrix lower_triangle(const std::string& name, const std::string& file, const std::vector<MatrixRow>& rows,
                            std::vector<Entry> entries, Stored stored);

/// R A Rᵀ of a symmetric A given by its lower triangle, again as lower triangle.
SparseMatrix turned(const SparseMatrix& R, const SparseMatrix& lower);

}  // namespace tenon::fem::matrices
