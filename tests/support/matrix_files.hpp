#pragma once

#include <fmt/format.h>

#include <map>
#include <string>
#include <vector>

#include "fem/structure.hpp"

/// Matrices as the text of files, to all digits.
namespace tenon::tests {

/// Matrix Market, symmetric, of a lower triangle.
inline std::string market_text(const fem::SparseMatrix& A) {
  std::string text =
      fmt::format("%%MatrixMarket matrix coordinate real symmetric\n{} {} {}\n", A.rows(), A.cols(), A.nonZeros());
  for (int j = 0; j < A.outerSize(); ++j)
    for (fem::SparseMatrix::InnerIterator it(A, j); it; ++it)
      text += fmt::format("{} {} {:.17g}\n", it.row() + 1, j + 1, it.value());
  return text;
}

/// Labels of the rows of a structure whose dofs are all free, with places, and sets of its node numbers.
inline std::string label_text(const fem::Structure& s, const std::map<std::string, std::vector<long>>& sets) {
  std::string text;
  for (const fem::Dof& dof : s.dofs.free) {
    const auto node = static_cast<std::size_t>(dof.node);
    const fem::Vec3& x = s.nodes[node];
    text += fmt::format("{} {} {:.17g} {:.17g} {:.17g}\n", s.node_ids[node], dof.direction + 1, x.x(), x.y(), x.z());
  }
  for (const auto& [name, nodes] : sets) text += fmt::format("set {} {}\n", name, fmt::join(nodes, " "));
  return text;
}

}  // namespace tenon::tests
