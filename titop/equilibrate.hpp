#pragma once

#include <Eigen/Core>

namespace tenon::titop {

/// diag(rows) A diag(cols) with every non-zero row and column of largest entry near one. Takes the units out of a
/// condition number.
struct Equilibrated {
  Eigen::MatrixXd A;
  Eigen::VectorXd rows, cols;
};

/// Ruiz's simultaneous scaling by square roots of the row and column maxima (RAL-TR-2001-034); zero rows and columns
/// keep the scale one.
Equilibrated equilibrate(const Eigen::MatrixXd& A);

}  // namespace tenon::titop
