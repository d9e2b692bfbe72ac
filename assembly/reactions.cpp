#include "assembly/reactions.hpp"

#include <Eigen/QR>

#include "assembly/disjoint.hpp"

namespace tenon::assembly {

using Eigen::Index;
using Eigen::MatrixXcd;
using Eigen::MatrixXd;
using Eigen::VectorXd;

Reactions reactions(const Network& network, const SecondOrderSystem& system, double omega) {
  const DisjointSystem d = disjoint(network);
  const MatrixXcd q = system.N * motion(system, omega);
  const std::complex<double> j(0.0, omega);
  const MatrixXcd force =
      d.stiffness_root.transpose() * (d.stiffness_root * q) + j * (d.damping_root.transpose() * (d.damping_root * q)) -
      omega * omega * (d.mass_root.transpose() * (d.mass_root * q)) - d.B.cast<std::complex<double>>();

  // in natural sizes of coordinates and rows: A = S Gᵀ W⁻¹, λ = W⁻¹ A⁺ S (...)
  const MatrixXd G = d.G * d.scale.asDiagonal();
  const VectorXd weight = G.rowwise().norm().unaryExpr([](double w) { return w > 0.0 ? 1.0 / w : 1.0; });
  const MatrixXd A = G.transpose() * weight.asDiagonal();
  Eigen::CompleteOrthogonalDecomposition<MatrixXd> decomposition;
  decomposition.setThreshold(1e-10);
  const MatrixXd inverse = decomposition.compute(A).pseudoInverse();
  Reactions result;
  result.names = d.row_names;
  result.units = d.row_units;
  result.value = weight.asDiagonal() * (inverse * (d.scale.asDiagonal() * force));
  const MatrixXd fixed = inverse * A;  // projects onto what equilibrium fixes
  for (Index i = 0; i < G.rows(); ++i) result.determinate.push_back(std::abs(fixed(i, i) - 1.0) < 1e-8);
  return result;
}

}  // namespace tenon::assembly
