#include "reduction/inertia.hpp"

#include <dmumps_c.h>
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <mutex>
#include <numbers>

#include "fem/error.hpp"
#include "reduction/dense.hpp"
#include "reduction/modes.hpp"
#include "reduction/sparse.hpp"

namespace tenon::reduction {

namespace {

std::mutex& mumps_lock() {
  static std::mutex lock;
  return lock;
}

constexpr int use_world = -987654;  // MUMPS's number for "the communicator of the sequential library"

// a fixed vector without structure, so that the check solve meets every mode
Eigen::VectorXd scattered(Eigen::Index n) {
  Eigen::VectorXd v(n);
  for (Eigen::Index k = 0; k < n; ++k) v[k] = std::cos(1.0 + 2.399963229728653 * static_cast<double>(k));
  return v;
}

}  // namespace

struct InertiaCounter::Implementation {
  fem::SparseMatrix A;
  std::vector<int> rows, columns, places;
  DMUMPS_STRUC_C mumps{};

  int& control(int k) { return mumps.icntl[k - 1]; }  // numbered as in MUMPS's manual
  int outcome(int k) const { return mumps.infog[k - 1]; }

  void run(int job, const char* step) {
    mumps.job = job;
    dmumps_c(&mumps);
    if (outcome(1) < 0)
      throw NumericalError(
          fmt::format("the count of eigenvalues failed in MUMPS's {} (its error code is the figure)", step), outcome(1),
          outcome(1) == -13 ? "Memory ran out: use a machine with more memory or a coarser mesh"
                            : "Ask for the modes without certificate, or move the band's upper end");
  }

  Eigen::VectorXd solve(Eigen::VectorXd b) {
    mumps.rhs = b.data();
    run(3, "solve");
    return b;
  }
};

InertiaCounter::InertiaCounter(const fem::SparseMatrix& K, const fem::SparseMatrix& M,
                               const std::vector<int>& permutation)
    : implementation_(std::make_unique<Implementation>()) {
  Implementation& c = *implementation_;
  c.A = shifted(K, M, 0.0);
  const auto n = static_cast<int>(c.A.rows());
  for (int j = 0; j < n; ++j)
    for (fem::SparseMatrix::InnerIterator it(c.A, j); it; ++it) {
      c.rows.push_back(static_cast<int>(it.row()) + 1);
      c.columns.push_back(j + 1);
    }
  const std::lock_guard lock(mumps_lock());
  c.mumps.sym = 2;  // symmetric, indefinite
  c.mumps.par = 1;
  c.mumps.comm_fortran = use_world;
  c.run(-1, "start");
  for (int k = 1; k <= 4; ++k) c.control(k) = k == 4 ? 0 : -1;  // silent
  c.control(6) = 0;                                             // no column permutation
  c.control(12) = 1;                                            // no 2×2 preselection: the ordering given stands
  c.control(13) = 1;                                            // the root front is counted like every other
  c.control(14) = 50;                                           // % of room for delayed pivots
  c.control(24) = 1;                                            // null pivots are counted, not divided by
  if (!permutation.empty()) {
    c.places.resize(permutation.size());
    for (std::size_t k = 0; k < permutation.size(); ++k)
      c.places[static_cast<std::size_t>(permutation[k])] = static_cast<int>(k) + 1;
    c.control(7) = 1;
    c.mumps.perm_in = c.places.data();
  }
  c.mumps.n = n;
  c.mumps.nnz = static_cast<MUMPS_INT8>(c.rows.size());
  c.mumps.irn = c.rows.data();
  c.mumps.jcn = c.columns.data();
  c.run(1, "analysis");
}

InertiaCounter::~InertiaCounter() {
  const std::lock_guard lock(mumps_lock());
  implementation_->mumps.job = -2;
  dmumps_c(&implementation_->mumps);
}

Inertia InertiaCounter::count(const fem::SparseMatrix& K, const fem::SparseMatrix& M, double sigma,
                              bool estimate_nearest) {
  const std::lock_guard lock(mumps_lock());
  Implementation& c = *implementation_;
  c.A = shifted(K, M, -sigma);
  c.mumps.a = c.A.valuePtr();
  c.run(2, "factorisation");
  Inertia result;
  result.negative = c.outcome(12);
  result.null_pivots = c.outcome(28);

  const Eigen::VectorXd ones = Eigen::VectorXd::Ones(c.A.rows());
  const Eigen::VectorXd b = scattered(c.A.rows());
  Eigen::VectorXd x = c.solve(b);
  const double norm = absolute_product(c.A, ones).lpNorm<Eigen::Infinity>();
  result.backward_error = (symmetric_product(c.A, x) - b).lpNorm<Eigen::Infinity>() /
                          (norm * x.lpNorm<Eigen::Infinity>() + b.lpNorm<Eigen::Infinity>());
  if (!(result.backward_error < 1e-10))
    throw NumericalError(
        fmt::format("the factorisation that counts eigenvalues below {:.6g} Hz lost its accuracy; backward error",
                    std::sqrt(std::max(sigma, 0.0)) / (2.0 * std::numbers::pi)),
        result.backward_error, "Move the upper end of the band away from an eigenvalue");
  if (estimate_nearest) {  // inverse iteration: ‖v‖_M / ‖(K − σM)⁻¹Mv‖_M → |λ − σ| of the nearest λ, from above
    const auto m_norm = [&M](const Eigen::VectorXd& v) {
      return std::sqrt(std::max(0.0, v.dot(symmetric_product(M, v).col(0))));
    };
    x /= std::max(m_norm(x), 1e-300);
    x = c.solve(symmetric_product(M, x));
    result.nearest = 1.0 / std::max(m_norm(x), 1e-300);
  }
  return result;
}

int count_below(const fem::SparseMatrix& K, const fem::SparseMatrix& M, double sigma) {
  if (K.rows() == 0) return 0;
  InertiaCounter counter(K, M);
  const Inertia inertia = counter.count(K, M, sigma, true);
  // the pivots are those of a matrix within rounding of K − σM: their signs hold if no eigenvalue is that near
  if (inertia.null_pivots > 0 || inertia.nearest <= 1e-10 * std::abs(sigma))
    throw NumericalError(fmt::format("the shift {:.9g} rad²/s² lies on an eigenvalue: relative distance", sigma),
                         inertia.nearest / std::max(std::abs(sigma), 1e-300),
                         "The count is not reliable there: move the shift by a small part of itself");
  return inertia.negative;
}

}  // namespace tenon::reduction
