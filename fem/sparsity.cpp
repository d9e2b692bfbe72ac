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

SparseMatrix lower_zeros(const ElementDofs& elements, int n) {
  const ElementDofs of_dof = elements_of_dofs(elements, n);
  SparseMatrix A(n, n);
  std::vector<int> marked(static_cast<std::size_t>(n), -1);
  std::vector<int> neighbours;
  std::size_t entries = 0;
  for (int pass = 0; pass < 2; ++pass) {  // first count, then fill: the arrays are allocated once, at their size
    if (pass == 1) {
      A.resizeNonZeros(static_cast<Eigen::Index>(entries));
      std::fill(marked.begin(), marked.end(), -1);
    }
    int* row = A.innerIndexPtr();
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
        row = std::copy(lower, neighbours.end(), row);
        A.outerIndexPtr()[j + 1] = static_cast<int>(row - A.innerIndexPtr());
      }
    }
    if (entries > static_cast<std::size_t>(std::numeric_limits<int>::max()))
      throw NumericalError("the stiffness matrix has more entries than 32-bit indices can number",
                           static_cast<double>(entries),
                           "Use a coarser mesh, or cut the body in two and join the parts by ports");
  }
  std::fill(A.valuePtr(), A.valuePtr() + entries, 0.0);
  return A;
}

void drop_zeros(SparseMatrix& A, SparseMatrix& B) {
  int to_A = 0, to_B = 0, at = 0;
  for (int j = 0; j < A.outerSize(); ++j) {
    const int end = A.outerIndexPtr()[j + 1];
    for (; at < end; ++at) {  // what is written lies at or before what is read
      const int row = A.innerIndexPtr()[at];
      if (const double value = A.valuePtr()[at]; value != 0.0) {
        A.innerIndexPtr()[to_A] = row;
        A.valuePtr()[to_A++] = value;
      }
      if (const double value = B.valuePtr()[at]; value != 0.0) {
        B.innerIndexPtr()[to_B] = row;
        B.valuePtr()[to_B++] = value;
      }
    }
    A.outerIndexPtr()[j + 1] = to_A;
    B.outerIndexPtr()[j + 1] = to_B;
  }
  for (auto [matrix, kept] : {std::pair{&B, to_B}, std::pair{&A, to_A}}) {
    const bool roomy = 10 * static_cast<long>(kept) < 9 * static_cast<long>(at);
    matrix->data().resize(kept);
    if (roomy) matrix->data().squeeze();
  }
}

}  // namespace tenon::fem
