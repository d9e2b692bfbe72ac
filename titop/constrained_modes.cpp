#include <fmt/format.h>

#include <Eigen/Cholesky>
#include <Eigen/SVD>
#include <cmath>

#include "fem/error.hpp"
#include "reduction/dense.hpp"
#include "titop/constrain.hpp"

namespace tenon::titop {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;
using reduction::ReducedBody;

namespace {

constexpr double hidden = 1e-11;  // of the terms that cancel: below, an inertia has fewer than five digits

// Least eigenvalue of diag(1/s) A diag(1/s).
double least_scaled(const MatrixXd& A, const VectorXd& s) {
  const VectorXd r = s.cwiseInverse();
  return reduction::symmetric_eigen(r.asDiagonal() * A * r.asDiagonal()).values[0];
}

}  // namespace

MatrixXd port_motions(const ReducedBody& body, const MatrixXd& reference, const MatrixXd& eta) {
  MatrixXd motion(6 * static_cast<Index>(body.ports.size()), eta.cols());
  for (int p = 0; p < static_cast<int>(body.ports.size()); ++p)
    motion.middleRows<6>(6 * p) =
        reduction::tau(body, p) * reference + body.ports[static_cast<std::size_t>(p)].Phi * eta;
  return motion;
}

void fix_signs(const ReducedBody& body, MatrixXd& reference, MatrixXd& eta) {
  constexpr double still = 1e-8;  // of the deformation: ports that move less hardly move at all
  MatrixXd motion = port_motions(body, reference, eta);
  const double a = size_of(body), unit = a * std::sqrt(body.D(0, 0));
  for (Index p = 0; p < motion.rows(); p += 6) motion.middleRows<3>(p + 3) *= a;
  for (Index j = 0; j < motion.cols(); ++j) {
    Index row = 0;
    const bool moves =
        motion.rows() > 0 && motion.col(j).cwiseAbs().maxCoeff(&row) * unit > still * a * eta.col(j).norm();
    if (!moves && eta.rows() > 0) eta.col(j).cwiseAbs().maxCoeff(&row);
    if (moves ? motion(row, j) > 0.0 : eta.rows() == 0 || eta(row, j) > 0.0) continue;
    reference.col(j) *= -1.0;
    eta.col(j) *= -1.0;
  }
}

// M = [D Lᵀ; L 1] over (x_ref, η) = (X ξ + R ρ, N ξ) is diag(S, 1), K is diag(NᵀΩ²N, 0):
//   S = 1 + XᵀDX + XᵀLᵀN + NᵀLX = CCᵀ,   Ω N C⁻ᵀ = P ω Wᵀ,   modes (X, N) C⁻ᵀW.
ConstrainedModes constrained_modes(const ReducedBody& body, const Boundary& boundary) {
  const ConstraintBasis basis = constraint_basis(body, boundary);
  const MatrixXd &N = basis.N, &X = basis.X;
  ConstrainedModes modes;
  modes.removed = basis.removed;
  modes.redundant = basis.redundant;
  modes.rigid = basis.R;
  const MatrixXd LtN = body.L.transpose() * N;  // 6×k
  const Index k = N.cols();
  if (k == 0) {
    modes.omega.resize(0);
    modes.eta.resize(body.n(), 0);
    modes.reference.resize(6, 0);
    return modes;
  }

  const MatrixXd DX = body.D * X, cross = X.transpose() * LtN;
  const MatrixXd S = MatrixXd::Identity(k, k) + X.transpose() * DX + cross + cross.transpose();
  VectorXd terms(k);  // size of what cancels in S
  for (Index j = 0; j < k; ++j) terms[j] = 1.0 + std::sqrt(std::max(0.0, X.col(j).dot(DX.col(j))));
  const double least = least_scaled(S, terms);
  if (!(least > hidden))
    throw NumericalError(
        fmt::format("under this boundary the inertia of body '{}' is not resolved in some motion, it is "
                    "round-off of larger terms: scaled eigenvalue",
                    body.name),
        least, "Take fewer modes, or join the load as a body of its own");
  const MatrixXd C = S.llt().matrixL();
  MatrixXd back = N.transpose();  // C⁻¹ Nᵀ, C⁻¹ Xᵀ
  MatrixXd back_X = X.transpose();
  reduction::triangular_solve(C, back, false);
  reduction::triangular_solve(C, back_X, false);
  const Eigen::JacobiSVD<MatrixXd> svd(body.omega.asDiagonal() * back.transpose(), Eigen::ComputeThinV);
  const MatrixXd W = svd.matrixV().rowwise().reverse();
  modes.omega = svd.singularValues().reverse();
  modes.eta = back.transpose() * W;
  modes.reference = back_X.transpose() * W;
  fix_signs(body, modes.reference, modes.eta);
  return modes;
}

}  // namespace tenon::titop
