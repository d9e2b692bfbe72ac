#include "fem/sparsity.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <limits>

#include "fem/error.hpp"

namespace tenon::fem {
namespace {

/// Transpose of element → dofs: the elements that move each dof.
ElementDofs elements_of_dofs(const ElementDofs& elements, int n) {
  ElementDofs of_dof;
  of_dof.start.assign(static_cast<std::size_t>(n) + 1, 0);
  for (const int dof : elements.dofs) ++of_dof.start[static_cast<std::size_t>(dof) + 1];
  for (std::size_t i = 1; i < of_dof.start.size(); ++i) of_dof.start[i] += of_dof.start[i - 1];
  of_dof.dofs.resize(elements.dofs.size());
  std::vector<int> next(of_dof.start.begin(), of_dof.start.end() - 1);
  for (std::size_t e = 0; e < elements.size(); ++e)
    for (const int dof : elements.of(e))
      of_dof.dofs[static_cast<std::size_t>(next[static_cast<std::size_t>(dof)]++)] = static_cast<int>(e);
  return of_dof;
}

}  // namespace

int LowerTriangle::position(int i, int j, int from) const {
  const auto column = static_cast<std::size_t>(j);
  const auto begin = row.begin() + std::max(from, start[column]), end = row.begin() + start[column + 1];
  const auto at = std::lower_bound(begin, end, i);
  return at != end && *at == i ? static_cast<int>(at - row.begin()) : -1;
}

LowerTriangle lower_zeros(const ElementDofs& elements, int n) {
  const ElementDofs of_dof = elements_of_dofs(elements, n);
  LowerTriangle A;
  A.start.assign(1, 0);
  A.start.reserve(static_cast<std::size_t>(n) + 1);
  std::vector<int> marked(static_cast<std::size_t>(n), -1);
  std::vector<int> neighbours;
  std::size_t entries = 0;
  for (int pass = 0; pass < 2; ++pass) {  // first count, then fill: the arrays are allocated once, at their size
    if (pass == 1) {
      A.row.reserve(entries);
      std::fill(marked.begin(), marked.end(), -1);
    }
    for (int j = 0; j < n; ++j) {
      const auto column = static_cast<std::size_t>(j);
      const bool same_elements = j > 0 && std::ranges::equal(of_dof.of(column), of_dof.of(column - 1));
      if (!same_elements) {  // dofs of one node share their neighbours
        neighbours.clear();
        for (const int e : of_dof.of(column))
          for (const int i : elements.of(static_cast<std::size_t>(e)))
            if (marked[static_cast<std::size_t>(i)] != j) {
              marked[static_cast<std::size_t>(i)] = j;
              neighbours.push_back(i);
            }
        if (std::find(neighbours.begin(), neighbours.end(), j) == neighbours.end()) neighbours.push_back(j);
        std::sort(neighbours.begin(), neighbours.end());
      }
      auto lower = std::lower_bound(neighbours.begin(), neighbours.end(), j);
      if (lower == neighbours.end() || *lower != j) lower = neighbours.insert(lower, j);
      if (pass == 0) {
        entries += static_cast<std::size_t>(neighbours.end() - lower);
      } else {
        A.row.insert(A.row.end(), lower, neighbours.end());
        A.start.push_back(static_cast<int>(A.row.size()));
      }
    }
    if (entries > static_cast<std::size_t>(std::numeric_limits<int>::max()))
      throw NumericalError("the stiffness matrix has more entries than 32-bit indices can number",
                           static_cast<double>(entries),
                           "Use a coarser mesh, or cut the body in two and join the parts by ports");
  }
  A.value.assign(entries, 0.0);
  return A;
}

SparseMatrix without_zeros(LowerTriangle A) {
  const auto n = static_cast<Eigen::Index>(A.start.size()) - 1;
  SparseMatrix result(n, n);
  result.resizeNonZeros(static_cast<Eigen::Index>(std::ranges::count_if(A.value, [](double v) { return v != 0.0; })));
  int at = 0;
  for (Eigen::Index j = 0; j < n; ++j) {
    const auto column = static_cast<std::size_t>(j);
    for (auto t = static_cast<std::size_t>(A.start[column]); t < static_cast<std::size_t>(A.start[column + 1]); ++t)
      if (A.value[t] != 0.0) result.innerIndexPtr()[at++] = A.row[t];
    result.outerIndexPtr()[j + 1] = at;
  }
  A.row = {};
  std::ranges::copy_if(A.value, result.valuePtr(), [](double v) { return v != 0.0; });
  return result;
}

}  // namespace tenon::fem
