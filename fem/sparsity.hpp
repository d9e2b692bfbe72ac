#pragma once

#include <span>
#include <vector>

#include "fem/structure.hpp"

namespace tenon::fem {

/// Which free dofs each element moves (sorted, one list an element, kept in one array).
struct ElementDofs {
  std::vector<int> start;  ///< size elements + 1
  std::vector<int> dofs;

  std::span<const int> of(std::size_t element) const {
    return {dofs.data() + start[element], static_cast<std::size_t>(start[element + 1] - start[element])};
  }
  std::size_t size() const { return start.size() - 1; }
};

/// A lower triangle while it grows: column starts, sorted rows, values.
struct LowerTriangle {
  std::vector<int> start;
  Eigen::VectorXi row;
  Eigen::VectorXd value;

  /// Index of (i, j), searched from `from` (0: the column's start); −1 where the pattern has no such entry.
  int position(int i, int j, int from = 0) const;
};

/// Columns that one thread fills together: no two threads write near each other.
constexpr int columns_of_strip = 64;

/// What the pattern of a growing matrix has no place for: terms of the lower triangle by strips of columns, those of
/// one entry in the order in which they are added.
using Beside = std::vector<std::vector<Eigen::Triplet<double>>>;

/// Σ T_eᵀ A_e T_e over n free dofs before anything is added: every entry that an element may fill, with value zero.
/// Columns are shared among the threads.
LowerTriangle lower_zeros(const ElementDofs& elements, int n);

/// The entries of A's pattern, with value zero.
LowerTriangle zeros_of_pattern(const SparseMatrix& A);

/// The entries that are not exactly zero, with those beside the pattern; takes A apart piece by piece, so that both
/// hardly ever stand side by side. Columns are shared among the threads.
SparseMatrix without_zeros(LowerTriangle A, Beside beside);

/// The diagonal of a lower triangle with sorted rows.
Eigen::VectorXd diagonal(const SparseMatrix& lower);

}  // namespace tenon::fem
