#pragma once

#include <Eigen/Eigenvalues>
#include <map>
#include <tuple>
#include <vector>

#include "fem/formats/matrices/matrix_data.hpp"

namespace tenon::tests {

inline Eigen::MatrixXd whole(const fem::SparseMatrix& lower) {
  return Eigen::MatrixXd(Eigen::MatrixXd(lower).selfadjointView<Eigen::Lower>());
}

/// K and M of parts that share the dofs of nodes with the same number: sums over equal labels.
struct Joined {
  Eigen::MatrixXd K, M;
};

inline Joined join(const std::vector<fem::MatrixData>& parts) {
  std::map<std::tuple<bool, long, int>, Eigen::Index> index;
  for (const fem::MatrixData& part : parts)
    for (const fem::MatrixRow& row : part.rows)
      index.try_emplace({row.scalar, row.node, row.direction}, static_cast<Eigen::Index>(index.size()));
  const auto n = static_cast<Eigen::Index>(index.size());
  Joined sum{Eigen::MatrixXd::Zero(n, n), Eigen::MatrixXd::Zero(n, n)};
  for (const fem::MatrixData& part : parts) {
    std::vector<Eigen::Index> at;
    for (const fem::MatrixRow& row : part.rows) at.push_back(index.at({row.scalar, row.node, row.direction}));
    sum.K(at, at) += whole(part.K);
    sum.M(at, at) += whole(part.M);
  }
  return sum;
}

}  // namespace tenon::tests
