#pragma once

#include "fem/matrix_part.hpp"

namespace tenon::fem {

/// MatrixPart::rounding of matrices that a file gave: `rigid_limit::of_elements` where rigid motions cost no more than
/// that, `of_matrices` else; more where K was written with few digits (single precision, nine decimals) and the forces
/// on rigid motions look like it: in a quarter of the rows at least, none far above the others.
double rounding_of(const Model& model, const MatrixPart& part);

/// Half a unit of the last digit that the entries of K have, over the entry: of doubles 1.1e-16, of floats 6e-8, of
/// nine decimals 5e-9.
double unit_of_digits(const SparseMatrix& K);

}  // namespace tenon::fem
