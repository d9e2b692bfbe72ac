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

/// Lower-triangular pattern (column starts and sorted row indices) of Σ T_eᵀ A_e T_e over n free dofs.
struct LowerPattern {
  std::vector<int> column_start;
  std::vector<int> row;
};
LowerPattern lower_pattern(const ElementDofs& elements, int n);

/// A square sparse matrix with that pattern and zero values.
SparseMatrix zeros(const LowerPattern& pattern);

}  // namespace tenon::fem
