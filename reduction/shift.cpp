#include "reduction/shift.hpp"

#include <fmt/format.h>

#include <Eigen/Eigenvalues>
#include <Eigen/QR>
#include <Eigen/SVD>
#include <algorithm>
#include <cmath>
#include <limits>

#include "fem/error.hpp"
#include "fem/rigid_forces.hpp"
#include "reduction/block_lanczos.hpp"
#include "reduction/shift_invert.hpp"
#include "reduction/sparse.hpp"

namespace tenon::reduction {

namespace {

constexpr double epsilon = std::numeric_limits<double>::epsilon();
constexpr double near_enough = 30.0;  // s may exceed the first flexible eigenvalue by this

// least K_ii / M_ii > 0: a Rayleigh quotient, so never below the lowest eigenvalue
double least_diagonal_ratio(const fem::SparseMatrix& K, const fem::SparseMatrix& M) {
  const Eigen::VectorXd k = K.diagonal(), m = M.diagonal();
  double least = std::numeric_limits<double>::infinity();
  for (Eigen::Index i = 0; i < k.size(); ++i)
    if (k[i] > 0.0 && m[i] > 0.0) least = std::min(least, k[i] / m[i]);
  return least;
}

}  // namespace

std::string name_of(const RowName& row_name, int row) { return row_name ? row_name(row) : fmt::format("row {}", row); }

Eigen::MatrixXd null_motions(const fem::SparseMatrix& K, const fem::SparseMatrix& M, const Eigen::MatrixXd& candidates,
                             double rounding, const RowName& row_name) {
  const Eigen::Index n = K.rows();
  if (candidates.cols() == 0 || n == 0) return Eigen::MatrixXd(n, 0);
  // candidates in the norm of diag(K): singular vectors of D^{-1/2} K R, smallest values first, are tested one by one
  Eigen::VectorXd d = K.diagonal().cwiseMax(0.0);
  const double fill = d.maxCoeff() > 0.0 ? d.maxCoeff() : 1.0;
  for (double& x : d) x = std::sqrt(x > 0.0 ? x : fill);
  Eigen::ColPivHouseholderQR<Eigen::MatrixXd> qr(d.asDiagonal() * candidates);
  qr.setThreshold(1e-12);
  const Eigen::Index r = qr.rank();
  if (r == 0) return Eigen::MatrixXd(n, 0);
  const Eigen::MatrixXd basis = d.cwiseInverse().asDiagonal() * (qr.householderQ() * Eigen::MatrixXd::Identity(n, r));
  const Eigen::MatrixXd KR = d.cwiseInverse().asDiagonal() * symmetric_product(K, basis);
  const Eigen::MatrixXd small =
      Eigen::HouseholderQR<Eigen::MatrixXd>(KR).matrixQR().topRows(r).triangularView<Eigen::Upper>();
  const Eigen::JacobiSVD<Eigen::MatrixXd> svd(small, Eigen::ComputeFullV);
  Eigen::MatrixXd found(n, 0);
  const Eigen::MatrixXd X = basis * svd.matrixV();
  const fem::RigidForces forces = fem::rigid_forces(K, X);
  for (Eigen::Index k = r - 1; k >= 0; --k) {
    bool resisted = false;
    for (Eigen::Index i = 0; i < n && !resisted; ++i) resisted = !(forces.ratio(i, k) <= rounding);
    if (resisted) continue;
    found.conservativeResize(Eigen::NoChange, found.cols() + 1);
    found.rightCols(1) = X.col(k);
  }
  for (int pass = 0; pass < 2 && found.cols() > 0; ++pass) {  // M-orthonormal: R ← R (RᵀMR)^{-1/2}
    const Eigen::VectorXd scale = found.colwise().norm().cwiseInverse();
    if (pass == 0) found = (found * scale.asDiagonal()).eval();
    const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> gram(found.transpose() * symmetric_product(M, found));
    const double least = gram.eigenvalues()[0], most = gram.eigenvalues()[found.cols() - 1];
    if (!(least > 1e-14 * most)) {
      Eigen::Index row = 0;
      (found * gram.eigenvectors().col(0)).cwiseAbs().maxCoeff(&row);
      throw ModelError(
          fmt::format("a rigid motion of the structure, of {} most, carries no mass",
                      name_of(row_name, static_cast<int>(row))),
          "Give it mass (density, point masses, inertia of a straight bar about itself) or supports: it has "
          "no frequency");
    }
    found = (found * gram.eigenvectors() * gram.eigenvalues().cwiseSqrt().cwiseInverse().asDiagonal()).eval();
  }
  return found;
}

double lambda_noise(const fem::SparseMatrix& K, const Eigen::VectorXd& x, double modal_mass) {
  const double terms = x.cwiseAbs().dot(absolute_product(K, x));
  // where x should lie in empty rows of K, what of it rounding has put into the others is all that terms has
  const double strays = epsilon * x.cwiseAbs2().maxCoeff() * K.diagonal().cwiseAbs().maxCoeff();
  return epsilon * std::max(terms, strays) / modal_mass;
}

void refuse_negative(const RowName& row_name, const Eigen::VectorXd& x, double lambda) {
  Eigen::Index row = 0;
  x.cwiseAbs().maxCoeff(&row);
  throw NumericalError(
      fmt::format("K is not positive semi-definite: for a motion x, of {} most, xᵀKx / xᵀMx [rad²/s²] is negative",
                  name_of(row_name, static_cast<int>(row))),
      lambda,
      "Look for negative springs and wrong signs, a K that is not the stiffness, a preload beyond buckling, or parts "
      "so "
      "stiff that the rest is lost in their rounding");
}

int free_row(const fem::SparseMatrix& K, const Factor& factor) {
  if (factor.report().lost_digits < 10.0) return -1;  // no pivot came near cancellation
  Eigen::MatrixXd x(K.rows(), 1);
  for (Eigen::Index k = 0; k < x.rows(); ++k) x(k, 0) = std::sin(1.0 + 1.7 * static_cast<double>(k));
  for (int pass = 0; pass < 2; ++pass) {
    x = factor.solve(x);
    x /= x.norm();
  }
  const double energy = x.col(0).dot(symmetric_product(K, x).col(0));
  if (energy > 100.0 * epsilon * x.col(0).cwiseAbs().dot(absolute_product(K, x.col(0)))) return -1;
  Eigen::Index row = 0;
  x.col(0).cwiseAbs().maxCoeff(&row);
  return static_cast<int>(row);
}

Eigen::MatrixXd locked_motions(const Factor& factor, const fem::SparseMatrix& M, const Eigen::MatrixXd& rigid) {
  if (rigid.cols() == 0) return Eigen::MatrixXd(factor.n(), 0);
  const Eigen::MatrixXd Y = factor.half_solve(symmetric_product(M, rigid));
  Eigen::HouseholderQR<Eigen::MatrixXd> qr(Y);
  return qr.householderQ() * Eigen::MatrixXd::Identity(Y.rows(), Y.cols());
}

namespace {

// first eigenvalue that is not zero, from above, by four block steps at the shift at hand
double first_flexible(const fem::SparseMatrix& K, const fem::SparseMatrix& M, const Eigen::MatrixXd& rigid,
                      const RowName& row_name, const ShiftedFactor& at) {
  const ShiftInvert op(at.factor, M);
  const Eigen::MatrixXd locked = locked_motions(at.factor, M, rigid);
  const LanczosOptions options{.wanted = 8, .block = 8, .max_steps = 4};
  const LanczosResult run = block_lanczos(
      op, options, locked, [](const RitzValues&) { return false; }, [](const RitzValues&) { return 16; });
  const Eigen::MatrixXd X = op.shapes(run.vectors);
  double least = std::numeric_limits<double>::infinity();
  for (Eigen::Index j = 0; j < X.cols(); ++j) {
    const Eigen::VectorXd x = X.col(j), Kx = symmetric_product(K, x), Mx = symmetric_product(M, x);
    const double mass = x.dot(Mx);
    if (!(run.ritz.theta[j] > 1e-12 * run.ritz.theta[0])) continue;  // infinite modes
    const double lambda = x.dot(Kx) / mass;
    if (lambda < -zero_noise * lambda_noise(K, x, mass)) refuse_negative(row_name, x, lambda);
    // A motion without stiffness shows what has not left it yet, λ = Σ c² λ_k. Its residual, squared, in the norm of
    // A⁻¹ and over |x|²_A, says the same: s Σ c² λ_k² / (λ_k + s) / s.
    const double left = at.factor.half_solve(Kx - lambda * Mx).squaredNorm() / (mass * (lambda + at.s)) * at.s;
    if (lambda > 1e4 * lambda_noise(K, x, mass) && lambda > 2.0 * left) least = std::min(least, lambda);
  }
  return least;
}

}  // namespace

ShiftedFactor choose_shift(const fem::SparseMatrix& K, const fem::SparseMatrix& M, const Eigen::MatrixXd& rigid,
                           const RowName& row_name, const std::function<void(const Factor&)>& ordered) {
  fem::SparseMatrix A = shifted(K, M, 0.0);
  ShiftedFactor at{0.0, A, Factor(A)};
  if (ordered) ordered(at.factor);
  if (rigid.cols() == 0 && at.factor.try_factorize(at.A) < 0 && free_row(K, at.factor) < 0) return at;

  const double ratio = least_diagonal_ratio(K, M);
  const double start = std::isfinite(ratio) ? 1e-3 * ratio : 1.0;
  at.s = start;
  double too_small = 0.0;  // the largest shift s that failed: K or its rounding has λ < −s
  int row = -1;
  for (int attempt = 0; attempt < 8; ++attempt) {
    at.A = shifted(K, M, at.s);
    row = at.factor.try_factorize(at.A);
    if (row >= 0) {
      too_small = std::max(too_small, at.s);
      at.s *= 100.0;
      continue;
    }
    const double flexible = first_flexible(K, M, rigid, row_name, at);
    if (!std::isfinite(flexible) || at.s <= near_enough * flexible || flexible <= too_small) return at;
    at.s = flexible;
  }
  if (row < 0) return at;
  throw NumericalError(
      fmt::format("K + sM is not positive definite for any shift s tried: the pivot of {} fails, the last shift is",
                  name_of(row_name, row)),
      at.s, "Something there has neither stiffness nor mass, or a negative one: look for loose parts and wrong signs");
}

}  // namespace tenon::reduction
