#include "titop/constraint_basis.hpp"

#include <fmt/format.h>

#include <Eigen/Cholesky>
#include <Eigen/SVD>
#include <cmath>

#include "fem/error.hpp"
#include "reduction/dense.hpp"

namespace tenon::titop {

using Eigen::Index;
using Eigen::MatrixXd;
using fem::Mat6X;
using fem::Vec6;
using reduction::ReducedBody;

namespace {

constexpr double dependent = 1e-12, independent = 1e-8;  // singular values of unit rows: below, above
constexpr double massless = 1e-12;                       // of the unit diagonal: a rigid inertia lost in rounding

// A = U s Wᵀ of rank r with a gap in s; rows of A are of unit size or zero.
struct Ranked {
  Eigen::JacobiSVD<MatrixXd> svd;
  Index rank = 0;
};

Ranked ranked(const ReducedBody& body, const MatrixXd& A) {
  Ranked result;
  if (A.rows() == 0 || A.cols() == 0) return result;
  result.svd.compute(A, Eigen::ComputeFullU | Eigen::ComputeFullV);
  for (const double s : result.svd.singularValues()) {
    if (s > dependent && s < independent)
      throw NumericalError(
          fmt::format(
              "body '{}': its modes do not say whether a fixed direction is independent of the others, singular "
              "value",
              body.name),
          s, "Keep more modes, or free the direction that the body hardly moves in");
    if (s >= independent) ++result.rank;
  }
  return result;
}

MatrixXd null_space(const Ranked& A, Index columns) {
  if (A.rank == 0) return MatrixXd::Identity(columns, columns);
  return A.svd.matrixV().rightCols(columns - A.rank);
}

MatrixXd left_null_space(const Ranked& A, Index rows) {
  if (A.rank == 0) return MatrixXd::Identity(rows, rows);
  return A.svd.matrixU().rightCols(rows - A.rank);
}

// rows of unit norm; what is round-off beside the largest row of the shapes is zero
MatrixXd unit_rows(MatrixXd A, double largest) {
  for (Index i = 0; i < A.rows(); ++i) {
    const double norm = A.row(i).norm();
    if (norm > 1e-13 * largest)
      A.row(i) /= norm;
    else
      A.row(i).setZero();
  }
  return A;
}

// R C⁻ᵀ, RᵀDR = CCᵀ
MatrixXd mass_normalised(const ReducedBody& body, const MatrixXd& R) {
  if (R.cols() == 0) return R;
  const MatrixXd M = R.transpose() * body.D * R;
  const Eigen::VectorXd size = M.diagonal().cwiseMax(0.0).cwiseSqrt();
  double least = 0.0;
  if (size.minCoeff() > 0.0) {
    const Eigen::VectorXd s = size.cwiseInverse();
    least = reduction::symmetric_eigen(s.asDiagonal() * M * s.asDiagonal()).values[0];
  }
  if (!(least > massless))
    throw NumericalError(
        fmt::format("body '{}' is free to move in a direction without inertia, scaled eigenvalue", body.name), least,
        "Fix that direction or give the body inertia there");
  return M.llt().matrixL().solve(R.transpose()).transpose();
}

}  // namespace

double size_of(const ReducedBody& body) {
  double a = 0.0;
  for (const reduction::BodyPort& port : body.ports) a = std::max(a, (port.position - body.reference).norm());
  if (!(a > 0.0) && body.D(0, 0) > 0.0) a = std::sqrt(body.D.diagonal().tail<3>().maxCoeff() / body.D(0, 0));
  return a > 0.0 ? a : 1.0;
}

// Scaled: displacements by a, η by a√m, so that τ and Φ are numbers of order one.
ConstraintBasis constraint_basis(const ReducedBody& body, const Boundary& boundary) {
  if (boundary.ports.size() != body.ports.size())
    throw ModelError(
        fmt::format("a boundary of {} ports for body '{}' of {}", boundary.ports.size(), body.name, body.ports.size()),
        "Give one condition per port");
  const double a = size_of(body), m = body.D(0, 0) > 0.0 ? body.D(0, 0) : 1.0;
  Vec6 unit;  // x = diag(unit) x̂
  unit << a, a, a, 1.0, 1.0, 1.0;
  const double unit_eta = std::sqrt(m) * a;

  std::vector<int> E;  // free directions of x_ref
  std::vector<std::pair<int, int>> F;
  for (int p = 0; p < static_cast<int>(body.ports.size()); ++p)
    for (int i = 0; i < 6; ++i) {
      const bool fixed = boundary.ports[static_cast<std::size_t>(p)].fixed[static_cast<std::size_t>(i)];
      if (p == body.parent && !fixed) E.push_back(i);
      if (p != body.parent && fixed) F.emplace_back(p, i);
    }
  if (body.parent < 0) E = {0, 1, 2, 3, 4, 5};

  const Index n = body.n(), e = static_cast<Index>(E.size()), f = static_cast<Index>(F.size());
  MatrixXd tau_E(f, e), Phi_F(f, n);
  for (Index k = 0; k < f; ++k) {
    const auto [p, i] = F[static_cast<std::size_t>(k)];
    const fem::Mat6 tau = unit.cwiseInverse().asDiagonal() * reduction::tau(body, p) * unit.asDiagonal();
    tau_E.row(k) = tau(i, E);
    Phi_F.row(k) = body.ports[static_cast<std::size_t>(p)].Phi.row(i) * (unit_eta / unit[i]);
  }

  const Ranked rigid = ranked(body, tau_E);
  const double largest = f > 0 && n > 0 ? Phi_F.rowwise().norm().maxCoeff() : 0.0;
  const MatrixXd Z = left_null_space(rigid, f);
  const Ranked deformed = ranked(body, unit_rows(Z.transpose() * Phi_F, largest));  // Zᵀ Φ_F

  ConstraintBasis basis;
  basis.N = null_space(deformed, n);
  basis.removed = static_cast<int>(deformed.rank);
  basis.redundant = static_cast<int>(f - rigid.rank - deformed.rank);
  MatrixXd R = MatrixXd::Zero(6, e - rigid.rank), X = MatrixXd::Zero(6, basis.N.cols());
  R(E, Eigen::all) = null_space(rigid, e);
  if (rigid.rank > 0) {  // X = −(τ_F E)⁺ Φ_F N
    const auto& svd = rigid.svd;
    const MatrixXd right = svd.matrixU().leftCols(rigid.rank).transpose() * (Phi_F * basis.N);
    X(E, Eigen::all) =
        -svd.matrixV().leftCols(rigid.rank) * svd.singularValues().head(rigid.rank).cwiseInverse().asDiagonal() * right;
  }
  basis.R = mass_normalised(body, unit.asDiagonal() * R);
  basis.X = unit.asDiagonal() * X / unit_eta;
  basis.X -= basis.R * (basis.R.transpose() * (body.D * basis.X + body.L.transpose() * basis.N));
  return basis;
}

}  // namespace tenon::titop
