#include "reduction/dense_modes.hpp"

#include <fmt/format.h>

#include <Eigen/QR>
#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "fem/error.hpp"
#include "reduction/dense.hpp"
#include "reduction/shift.hpp"

extern "C" void dpstrf_(const char* triangle, const int* n, double* a, const int* lda, int* pivots, int* rank,
                        const double* tolerance, double* work, int* info);

namespace tenon::reduction {

namespace {

constexpr double resolved = 1e-13;  // of the largest μ: smaller ones are rounding
constexpr int most_solves = 20;
constexpr double one_solve = 1e7;  // eigenvalues this far above the first wait for a shift of their own

struct Spectrum {
  Eigen::VectorXd mu;  // descending
  Eigen::MatrixXd X;   // columns x with xᵀ(K + sM)x = 1
};

Spectrum spectrum(const Eigen::MatrixXd& K, const Eigen::MatrixXd& M, double s, const Eigen::MatrixXd& rigid,
                  const RowName& row_name) {
  Eigen::MatrixXd L = K + s * M;
  if (const int pivot = cholesky_in_place(L); pivot >= 0)
    throw NumericalError(
        fmt::format("K + sM is not positive definite: the pivot of {} fails at the shift", name_of(row_name, pivot)), s,
        "Something there can move with neither stiffness nor mass, or has a negative one: look for loose parts, nodes "
        "that are linked to too few others, and wrong signs");
  Eigen::MatrixXd C = M;
  triangular_solve(L, C, false);
  C.transposeInPlace();
  triangular_solve(L, C, false);  // L⁻¹ M L⁻ᵀ
  if (rigid.cols() > 0) {  // y = LᵀR are eigenvectors with μ = 1/s: (1 − YYᵀ) C (1 − YYᵀ) takes them to μ = 0
    const Eigen::MatrixXd Y = Eigen::HouseholderQR<Eigen::MatrixXd>(L.transpose() * rigid).householderQ() *
                              Eigen::MatrixXd::Identity(L.rows(), rigid.cols());
    C -= Y * (Y.transpose() * C).eval();
    C -= (C * Y).eval() * Y.transpose();
  }
  SymmetricEigen e = symmetric_eigen(0.5 * (C + C.transpose()));
  Spectrum result{e.values.reverse(), e.vectors.rowwise().reverse()};
  triangular_solve(L, result.X, true);
  return result;
}

}  // namespace

int mass_rank(const Eigen::MatrixXd& M) {
  const int n = static_cast<int>(M.rows());
  if (n == 0) return 0;
  Eigen::VectorXd d = M.diagonal().cwiseMax(0.0).cwiseSqrt();
  for (double& x : d) x = x > 0.0 ? 1.0 / x : 0.0;
  Eigen::MatrixXd A = d.asDiagonal() * M * d.asDiagonal();
  std::vector<int> pivots(static_cast<std::size_t>(n));
  std::vector<double> work(static_cast<std::size_t>(2 * n));
  const double tolerance = 10.0 * n * std::numeric_limits<double>::epsilon();
  int rank = 0, info = 0;
  dpstrf_("L", &n, A.data(), &n, pivots.data(), &rank, &tolerance, work.data(), &info);
  return rank;
}

DensePairs dense_modes(const Eigen::MatrixXd& K, const Eigen::MatrixXd& M, double s, int count,
                       const Eigen::MatrixXd& rigid, const RowName& row_name) {
  const auto finite = static_cast<Eigen::Index>(mass_rank(M)) - rigid.cols();
  const Eigen::Index wanted = count < 0 ? finite : std::min<Eigen::Index>(count, finite);
  DensePairs pairs{Eigen::VectorXd(wanted), Eigen::MatrixXd(K.rows(), wanted)};
  Eigen::Index done = 0;
  for (int pass = 0; done < wanted; ++pass) {
    const Spectrum at = spectrum(K, M, s, rigid, row_name);
    for (; done < wanted && at.mu[done] > at.mu[0] / one_solve; ++done) {
      const double mu = at.mu[done];
      pairs.lambda[done] = 1.0 / mu - s;
      pairs.shapes.col(done) = at.X.col(done) / std::sqrt(mu);
    }
    if (done == wanted) break;
    if (pass == most_solves)
      throw NumericalError("a finite mode cannot be told from the massless directions: 1/(ω² + s) is", at.mu[done],
                           "Ask for fewer modes, or remove the nearly massless dofs");
    // the next mode's own size, as far as this solve has digits for it
    s = 1.0 / std::max(at.mu[done], at.mu[0] * resolved) - s;
  }
  return pairs;
}

}  // namespace tenon::reduction
