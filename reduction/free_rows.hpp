#pragma once

#include "fem/structure.hpp"

namespace tenon::reduction {

/// The rows of free dofs out of fields over all nodes, 6N×columns.
inline Eigen::MatrixXd free_rows(const fem::Structure& structure, const Eigen::MatrixXd& full) {
  Eigen::MatrixXd rows(structure.n(), full.cols());
  for (Eigen::Index row = 0; row < rows.rows(); ++row) {
    const fem::Dof& dof = structure.dofs.free[static_cast<std::size_t>(row)];
    rows.row(row) = full.row(6 * dof.node + dof.direction);
  }
  return rows;
}

}  // namespace tenon::reduction
