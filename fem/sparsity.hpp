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

/// The lower triangle of Σ T_eᵀ A_e T_e over n free dofs, every entry that an element may fill present with value zero.
SparseMatrix lower_zeros(const ElementDofs& elements, int n);

/// Takes the entries that are exactly zero out of A and B, in place. B comes with the values of A's pattern alone (as
/// many non-zeros as A, indices not yet written) and leaves with a pattern of its own.
void drop_zeros(SparseMatrix& A, SparseMatrix& B);

}  // namespace tenon::fem
