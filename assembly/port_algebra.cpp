#include "assembly/port_algebra.hpp"

#include <fmt/format.h>

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

#include "assembly/loop_closure.hpp"
#include "assembly/port_tree.hpp"
#include "fem/error.hpp"

namespace tenon::assembly {

using Eigen::Index;
using Eigen::MatrixXd;

namespace {

// Diagonal scaling by powers of two that brings rows and columns to like size (Parlett and Reinsch 1969); similar to A.
MatrixXd balanced(MatrixXd A) {
  for (bool changed = true; changed;) {
    changed = false;
    for (Index i = 0; i < A.rows(); ++i) {
      const double r = A.row(i).cwiseAbs().sum() - std::abs(A(i, i)), c = A.col(i).cwiseAbs().sum() - std::abs(A(i, i));
      if (r == 0.0 || c == 0.0) continue;
      const double f = std::exp2(std::round(0.5 * std::log2(r / c)));
      if (c * f + r / f >= 0.95 * (c + r)) continue;
      A.col(i) *= f;
      A.row(i) /= f;
      changed = true;
    }
  }
  return A;
}

}  // namespace

PortAlgebra port_algebra(const Network& network) {
  for (const Output& output : network.outputs)
    if (output.quantity != Quantity::acceleration)
      throw ModelError(
          fmt::format("output '{}' is a position or velocity, port algebra gives accelerations", output.name),
          "Use the second-order route, or ask for the acceleration");
  const OpenLoops open = open_loops(network);
  PortTree tree = port_tree(open.network);
  if (open.closures.empty()) return {std::move(tree.ss), tree.worst_condition};
  return close_loops(network, open, tree);
}

Eigen::VectorXcd poles(const PortAlgebra& system) {
  if (system.ss.order() == 0) return {};
  const Eigen::EigenSolver<MatrixXd> eigen(balanced(system.ss.A), false);
  if (eigen.info() != Eigen::Success)
    throw NumericalError("the poles of the system did not converge after sweeps", 30.0 * system.ss.order(),
                         "Use the second-order route");
  return eigen.eigenvalues();
}

Eigen::VectorXd frequencies(const PortAlgebra& system) {
  std::vector<double> omega;
  for (const std::complex<double>& pole : poles(system))
    if (pole.imag() > 0.0) omega.push_back(std::abs(pole));
  std::sort(omega.begin(), omega.end());
  return Eigen::Map<Eigen::VectorXd>(omega.data(), static_cast<Index>(omega.size()));
}

}  // namespace tenon::assembly
