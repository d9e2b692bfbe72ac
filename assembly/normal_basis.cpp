#include "assembly/normal_basis.hpp"

#include <fmt/format.h>

#include "assembly/rank.hpp"
#include "fem/error.hpp"
#include "reduction/roots.hpp"

namespace tenon::assembly {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

namespace {

VectorXd row_lengths(const MatrixXd& rows) { return rows.rowwise().norm(); }

}  // namespace

// 1. null(G) in scaled coordinates q̂ (q = S q̂):                        q̂ = N0 x
// 2. null(F N0) by the rows' directions alone: rigid motions X, rest Y:   q̂ = X a + Y y
// 3. F Y P = Q R, y = P R⁻¹ z gives unit stiffness:                       K = zᵀz
// 4. W X = Q_x R_x, a = R_x⁻¹ α − (W X)⁺ W Y y: unit rigid mass, M-orthogonal
// 5. SVD of what remains of W: (1 − Q_x Q_xᵀ) W Y P R⁻¹ = U Σ Vᵀ, z = V ζ:  M = Σ², so ω = 1/σ
NormalBasis normal_basis(const Roots& roots, const std::function<std::string(const VectorXd&)>& moving) {
  NormalBasis s;
  const auto S = roots.scale.asDiagonal();
  const MatrixXd G = roots.G * S, F = roots.F * S, W = roots.W * S;
  const RowSpace held = row_space(G, row_lengths(G), "the joint rows");
  s.rank = held.rank;
  s.redundant = held.redundant;
  s.rank_gap = held.gap;
  s.G = row_lengths(G).cwiseInverse().asDiagonal() * roots.G;

  const RowSpace stiff = row_space(F * held.null, row_lengths(F), "the stiffness");
  const MatrixXd X = held.null * stiff.null, Y = held.null * stiff.range;
  const Index r = X.cols(), f = Y.cols(), n = r + f;
  const VectorXd mass_lengths = row_lengths(W);
  if (row_rank(W * X, mass_lengths, "the mass of the rigid motions") < r)
    throw ModelError(
        fmt::format("the network can move with neither mass nor stiffness; moving: {}",
                    moving(X * row_space(W * X, mass_lengths, "the mass of the rigid motions").null.col(0))),
        "Give that motion an inertia, a spring or a joint that holds it");
  s.rigid = static_cast<int>(r);
  s.massless = static_cast<int>(n) - row_rank(W * held.null, mass_lengths, "the mass");

  const MatrixXd Z = graded_qr(F * Y).times_inverse(Y);
  const GradedQR rigid = graded_qr(W * X, W * Z);
  const MatrixXd X_unit = rigid.times_inverse(X);
  const MatrixXd Z_free = Z - X_unit * rigid.Qt_apply.topRows(r);
  MatrixXd N(roots.scale.size(), n);
  s.sigma = VectorXd::Zero(f);
  N.leftCols(r) = X_unit;
  if (f > 0) {
    const MatrixXd rest = rigid.Qt_apply.bottomRows(W.rows() - r);
    const reduction::ThinSvd svd = reduction::thin_svd(rest);
    s.sigma.head(svd.sigma.size()) = svd.sigma;
    s.sigma.tail(s.massless).setZero();
    N.rightCols(f) = Z_free * svd.V;
  }
  s.N = S * N;
  return s;
}

}  // namespace tenon::assembly
