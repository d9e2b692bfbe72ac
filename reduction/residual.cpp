#include "reduction/residual.hpp"

#include <algorithm>
#include <cmath>

#include "reduction/dense.hpp"
#include "reduction/sparse.hpp"

namespace tenon::reduction {

namespace {

constexpr double contained = 1e-14;  // of a response's energy: what is left below it is rounding
constexpr double dependent = 1e-12;  // of a response's energy beside the others'
constexpr double sound = 1e-2;       // least pivot that leaves XᵀKX = 1 to 14 digits without another pass
constexpr int passes = 3;

// the columns `keep` of A
Eigen::MatrixXd columns(const Eigen::MatrixXd& A, const std::vector<Eigen::Index>& keep) { return A(Eigen::all, keep); }

// PᵀGP = LLᵀ with the largest pivot first, as far as pivots exceed `floor`
struct PivotedCholesky {
  std::vector<Eigen::Index> order;  // of the pivots taken
  Eigen::MatrixXd L;
  double least = 1.0;
};

PivotedCholesky pivoted_cholesky(Eigen::MatrixXd G, double floor) {
  const Eigen::Index n = G.rows();
  PivotedCholesky c;
  std::vector<Eigen::VectorXd> factor;
  Eigen::VectorXd left = G.diagonal();
  for (Eigen::Index k = 0; k < n; ++k) {
    Eigen::Index p = 0;
    const double pivot = left.maxCoeff(&p);
    if (!(pivot > floor)) break;
    Eigen::VectorXd l = G.col(p) / std::sqrt(pivot);
    G -= l * l.transpose();
    left -= l.cwiseAbs2();
    left[p] = 0.0;
    c.order.push_back(p);
    c.least = std::min(c.least, pivot);
    factor.push_back(std::move(l));
  }
  const auto rank = static_cast<Eigen::Index>(c.order.size());
  c.L = Eigen::MatrixXd::Zero(rank, rank);
  for (Eigen::Index i = 0; i < rank; ++i)
    for (Eigen::Index j = 0; j <= i; ++j)
      c.L(i, j) = factor[static_cast<std::size_t>(j)][c.order[static_cast<std::size_t>(i)]];
  return c;
}

Eigen::MatrixXd gram(const Eigen::MatrixXd& X, const Eigen::MatrixXd& F) {
  const Eigen::MatrixXd G = transposed_product(X, F);
  return 0.5 * (G + G.transpose());
}

}  // namespace

ResidualShapes residual_shapes(const std::function<Eigen::MatrixXd(const Eigen::MatrixXd&)>& solve,
                               const fem::SparseMatrix& M, const Modes& modes, Loads loads) {
  const Eigen::MatrixXd& Phi = modes.shapes;
  const Eigen::Index flexible = modes.lambda.size() - modes.rigid;
  const Eigen::MatrixXd MPhi = Phi.cols() > 0 ? symmetric_product(M, Phi) : Eigen::MatrixXd(M.rows(), 0);
  const auto take_out_modes = [&](Eigen::MatrixXd& F) {  // F ← (1 − MΦΦᵀ)F, twice against rounding
    for (int pass = 0; pass < 2 && Phi.cols() > 0; ++pass) subtract_product(MPhi, transposed_product(Phi, F), F);
  };

  ResidualShapes shapes;
  Eigen::MatrixXd F = std::move(loads.F);
  std::vector<std::string> names = std::move(loads.names);
  const Eigen::VectorXd size = F.colwise().norm();
  Eigen::VectorXd held = Eigen::VectorXd::Zero(F.cols());  // energy in the kept modes, Σ (φᵀf)²/λ
  if (flexible > 0 && F.cols() > 0)
    held = (modes.lambda.tail(flexible).cwiseSqrt().cwiseInverse().asDiagonal() *
            transposed_product(Phi.rightCols(flexible), F))
               .colwise()
               .squaredNorm();
  take_out_modes(F);
  Eigen::MatrixXd X = solve(F);

  std::vector<Eigen::Index> keep;
  for (Eigen::Index k = 0; k < F.cols(); ++k) {
    const double energy = X.col(k).dot(F.col(k));
    if (energy > contained * held[k] && energy > 0.0) {
      keep.push_back(k);
      F.col(k) /= std::sqrt(energy);
      X.col(k) /= std::sqrt(energy);
    } else if (size[k] > 0.0) {
      shapes.dropped.push_back(names[static_cast<std::size_t>(k)]);
    }
  }
  F = columns(F, keep);
  X = columns(X, keep);
  for (int pass = 0; pass < passes && F.cols() > 0; ++pass) {
    const PivotedCholesky c = pivoted_cholesky(gram(X, F), dependent);
    if (pass == 0)
      for (std::size_t k = 0; k < keep.size(); ++k)
        if (std::find(c.order.begin(), c.order.end(), static_cast<Eigen::Index>(k)) == c.order.end())
          shapes.dropped.push_back(names[static_cast<std::size_t>(keep[k])]);
    const auto combine = [&](const Eigen::MatrixXd& A) -> Eigen::MatrixXd {  // A ← A P L⁻ᵀ
      Eigen::MatrixXd B = columns(A, c.order).transpose();
      triangular_solve(c.L, B, false);
      return B.transpose();
    };
    F = combine(F);
    if (c.least > sound) {
      X = combine(X);
      break;
    }
    take_out_modes(F);  // differences of nearly equal responses: their own loads have the digits
    X = solve(F);
  }
  shapes.K = gram(X, F);
  shapes.X = std::move(X);
  return shapes;
}

}  // namespace tenon::reduction
