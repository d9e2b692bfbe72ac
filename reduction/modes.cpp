#include "reduction/modes.hpp"

#include <fmt/format.h>

#include <Eigen/QR>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "fem/error.hpp"
#include "fem/rigid_forces.hpp"
#include "reduction/count.hpp"
#include "reduction/dense.hpp"
#include "reduction/dense_modes.hpp"
#include "reduction/eigenpairs.hpp"
#include "reduction/shift.hpp"
#include "reduction/sparse.hpp"

namespace tenon::reduction {

namespace {

constexpr int densest = 8000;       // largest problem whose modes are all found by a dense solve
constexpr double zero_mode = 1e-8;  // of the first flexible λ: below it a mode whose strain energy is rounding is rigid
constexpr int searches = 4;         // runs of the solver before a wrong count is final

double hertz(double lambda) { return std::sqrt(std::max(lambda, 0.0)) / (2.0 * std::numbers::pi); }

// Flexible eigenpairs: those below the cut, and one more when there is one.
struct Flexible {
  Eigen::VectorXd lambda;
  Eigen::MatrixXd X;  // mass-normalised
  Cut cut;
};

// Everything the steps below read.
struct Problem {
  const fem::SparseMatrix& K;
  const fem::SparseMatrix& M;
  const ShiftedFactor& at;
  const Eigen::MatrixXd& rigid;
  const ModesOptions& options;
  Count& count;

  Inertia below(double sigma, bool estimate_nearest = false) const {
    return count.below(K, M, sigma, estimate_nearest);
  }
  // Unit of rounding of K's own numbers: a program's or, in files of fewer digits, what they leave where rigid motions
  // cost no force.
  double unit() const {
    return std::max(std::numeric_limits<double>::epsilon(), fem::rigid_forces(K, rigid).worst().ratio);
  }
  void progress(double fraction, const char* step) const {
    if (options.progress) options.progress(fraction, step);
  }
};

[[noreturn]] void report_mismatch(int found, int counted, double sigma) {
  throw NumericalError(
      fmt::format("{} modes were found below {:.6g} Hz but the inertia of K − σM counts {}: the difference is", found,
                  hertz(sigma), counted),
      counted - found,
      "The list would be incomplete and is withheld: ask for a few more or fewer modes, or a larger block");
}

// σ of a band, moved off an eigenvalue it may lie on
std::pair<double, int> count_of_band(const Problem& p, double band) {
  double sigma = band * band;
  for (int attempt = 0; attempt < 4; ++attempt, sigma *= 1.0 + 1e-7) {
    const Inertia inertia = p.below(sigma, true);
    if (inertia.null_pivots == 0 && inertia.nearest > 1e-9 * sigma) return {sigma, inertia.negative};
  }
  throw NumericalError(fmt::format("the band's upper end {:.6g} Hz lies in a cluster of eigenvalues", hertz(sigma)),
                       sigma, "Move it by a small part of itself");
}

Flexible solve_dense(const Problem& p, int wanted, std::optional<double> sigma, bool all) {
  const Eigen::MatrixXd K = dense_matrix(p.K), M = dense_matrix(p.M);
  const int margin = 10;  // company of the last mode, to see the gap above it
  const DensePairs pairs = dense_modes(K, M, p.at.s, all || sigma ? -1 : wanted + margin, p.rigid, p.options.row_name);
  RitzValues ritz;
  ritz.theta = (pairs.lambda.array() + p.at.s).inverse();
  ritz.residual = Eigen::VectorXd::Zero(ritz.theta.size());
  ritz.exhausted = all || sigma || pairs.lambda.size() < wanted + margin;
  if (ritz.theta.size() == 0) return {{}, Eigen::MatrixXd(p.K.rows(), 0), Cut{0, sigma.value_or(p.at.s), true}};
  // the shift of one solve spans only 1e13: give every finite mode a value above that floor
  const double floor = 2e-13 * ritz.theta[0];
  std::optional<Cut> cut;
  if (ritz.theta.minCoeff() > floor) cut = choose_cut(ritz, wanted, p.at.s, 1.0, sigma);
  if (!cut) {
    if (!all && !sigma) return solve_dense(p, wanted, sigma, true);
    const double last = pairs.lambda[pairs.lambda.size() - 1];
    int modes = static_cast<int>(pairs.lambda.size());
    if (sigma) modes = static_cast<int>((pairs.lambda.array() < *sigma).count());
    cut = Cut{modes, sigma.value_or(1.1 * last), modes == static_cast<int>(pairs.lambda.size())};
  }
  const int kept = std::min<int>(cut->modes + 1, static_cast<int>(pairs.lambda.size()));
  return {pairs.lambda.head(kept), pairs.shapes.leftCols(kept), *cut};
}

// appends pairs and sorts by descending θ
void merge(LanczosResult& run, const LanczosResult& more) {
  const Eigen::Index a = run.vectors.cols(), b = more.vectors.cols();
  Eigen::VectorXd theta(a + b);
  theta << run.ritz.theta.head(a), more.ritz.theta.head(b);
  Eigen::MatrixXd vectors(run.vectors.rows(), a + b);
  vectors << run.vectors, more.vectors;
  std::vector<Eigen::Index> order(static_cast<std::size_t>(a + b));
  for (std::size_t k = 0; k < order.size(); ++k) order[k] = static_cast<Eigen::Index>(k);
  std::stable_sort(order.begin(), order.end(), [&](Eigen::Index i, Eigen::Index j) { return theta[i] > theta[j]; });
  run.ritz.theta = theta(order);
  run.vectors = vectors(Eigen::all, order);
}

// The search for the pairs of a large problem. It keeps what it found, to look again beside it. It limits threads: the
// count beside it does so for the whole process while it lasts, and digits must not depend on when it ends.
class Search {
 public:
  Search(const Problem& p, int wanted, std::optional<double> sigma)
      : p_(p), op_(p.at.factor, p.M), locked_(locked_motions(p.at.factor, p.M, p.rigid)) {
    run_ = look(wanted, block(), 1, sigma, [&](const RitzValues& ritz) {
      if (!p.options.certify || sigma || p.count.foreseen()) return;
      if (const auto expected = foresee_cut(ritz, wanted, p.at.s)) p.count.foresee(p.K, p.M, *expected);
    });
    cut_ = choose_cut(run_.ritz, wanted, p.at.s, 0.05 * p.options.residual_limit, sigma).value();
    const auto expected = p.count.foreseen();
    if (expected && clear_of_modes(run_.ritz, cut_.modes, p.at.s, *expected)) cut_.sigma = *expected;
    cut_.modes = found();
  }

  // repeated eigenvalues wider than the block, or a start that missed some: look again beside what was found
  void complete(int modes) {
    for (int attempt = 1; attempt < searches && modes > found(); ++attempt) {
      Eigen::MatrixXd all(locked_.rows(), locked_.cols() + run_.vectors.cols());
      all << locked_, run_.vectors;
      std::swap(locked_, all);
      const int missing = modes - found();
      merge(run_, look(missing, block() + missing, static_cast<std::uint64_t>(attempt) + 1, cut_.sigma));
    }
    cut_.modes = found();
  }

  Flexible pairs() const {
    const ThreadLimit limit;
    const Eigen::Index kept = std::min<Eigen::Index>(cut_.modes + 1, run_.vectors.cols());
    const Eigen::VectorXd theta = run_.ritz.theta.head(kept);
    Flexible result{theta.cwiseInverse().array() - p_.at.s, op_.shapes(run_.vectors.leftCols(kept)), cut_};
    result.X *= theta.cwiseSqrt().cwiseInverse().asDiagonal();  // xᵀMx = μ
    return result;
  }

 private:
  int block() const { return p_.options.block > 0 ? p_.options.block : 8; }
  int found() const {
    return static_cast<int>((run_.ritz.theta.head(run_.vectors.cols()).array() > 1.0 / (cut_.sigma + p_.at.s)).count());
  }
  LanczosResult look(int modes, int width, std::uint64_t seed, std::optional<double> up_to,
                     const std::function<void(const RitzValues&)>& watch = {}) const {
    const ThreadLimit limit;
    LanczosResult run = find_pairs(op_, p_.options, locked_, modes, width, seed, p_.at.s, up_to, watch);
    if (!run.converged)
      throw NumericalError(fmt::format("the eigenvalue solver did not converge to {} modes; steps taken", modes),
                           run.steps, "Ask for fewer modes or a lower band");
    return run;
  }

  const Problem& p_;
  ShiftInvert op_;
  Eigen::MatrixXd locked_;
  LanczosResult run_;
  Cut cut_;
};

// λ far below the shift has lost digits in 1/μ − s: the Rayleigh quotient has them. Zero modes get λ = 0.
int settle_low_modes(const Problem& p, Flexible& f) {
  int zero = 0;
  if (p.at.s == 0.0) return zero;
  for (Eigen::Index k = 0; k < f.lambda.size() && f.lambda[k] < 1e-4 * p.at.s; ++k) {
    const Eigen::VectorXd x = f.X.col(k);
    f.lambda[k] = x.dot(symmetric_product(p.K, x).col(0));
  }
  double first = p.at.s;
  for (Eigen::Index k = f.lambda.size() - 1; k >= 0; --k) {
    if (std::abs(f.lambda[k]) > zero_mode * first) {
      first = std::min(first, f.lambda[k]);
      continue;
    }
    if (std::abs(f.lambda[k]) > zero_noise * lambda_noise(p.K, f.X.col(k), 1.0)) continue;  // soft, yet resolved by K
    f.lambda[k] = 0.0;
    ++zero;
  }
  return zero;
}

void require_no_negative(const Problem& p, const Flexible& f) {
  Eigen::Index least = 0;
  if (f.lambda.size() > 0 && f.lambda.minCoeff(&least) < 0.0)
    refuse_negative(p.options.row_name, f.X.col(least), f.lambda[least]);
}

double residual(const Problem& p, const Eigen::MatrixXd& X, const Eigen::MatrixXd& MX, const Eigen::VectorXd& lambda) {
  if (X.cols() == 0) return 0.0;
  const Eigen::MatrixXd R = symmetric_product(p.K, X) - MX * lambda.asDiagonal();
  const Eigen::VectorXd scale = (lambda.array() + p.at.s).sqrt();
  const Eigen::MatrixXd E = p.at.factor.half_solve(R);  // ‖L⁻¹P r‖ = ‖r‖ in the norm of A⁻¹
  const Eigen::VectorXd each = E.colwise().norm().transpose().cwiseQuotient(scale);
  Eigen::Index worst = 0;
  // rigid motions stand in null(K) as far as its numbers tell (null_motions); what they leave is reported, and no
  // reason to fail
  const Eigen::Index rigid = std::min(p.rigid.cols(), X.cols());
  const double all = each.maxCoeff();
  if (rigid == X.cols()) return all;
  const double most = each.tail(X.cols() - rigid).maxCoeff(&worst);
  worst += rigid;
  if (most <= p.options.residual_limit) return all;
  // what the rounding of K x and of K itself leaves: its size with the signs of a fixed sequence
  Eigen::MatrixXd noise = p.unit() * absolute_product(p.K, X.col(worst));
  for (Eigen::Index i = 0; i < noise.rows(); ++i)
    if (std::sin(2.399963229728653 * static_cast<double>(i * i % 1000003)) < 0.0) noise(i, 0) = -noise(i, 0);
  if (most <= 10.0 * p.at.factor.half_solve(noise).norm() / scale[worst]) return all;
  throw NumericalError(fmt::format("the mode at {:.6g} Hz leaves a residual above the limit", hertz(lambda[worst])),
                       most, "Raise the residual limit only if this accuracy is enough, or ask for fewer modes");
}

void fix_signs(Eigen::MatrixXd& X) {
  for (Eigen::Index j = 0; j < X.cols(); ++j) {
    const double largest = X.col(j).cwiseAbs().maxCoeff();
    for (Eigen::Index i = 0; i < X.rows(); ++i) {  // the first of the largest: symmetric shapes have several
      if (std::abs(X(i, j)) < (1.0 - 1e-6) * largest) continue;
      if (X(i, j) < 0.0) X.col(j) *= -1.0;
      break;
    }
  }
}

void require_sizes(const fem::SparseMatrix& K, const fem::SparseMatrix& M, const Eigen::MatrixXd& rigid) {
  if (K.rows() != K.cols() || M.rows() != K.rows() || M.cols() != K.cols() ||
      (rigid.cols() > 0 && rigid.rows() != K.rows()))
    throw ModelError(fmt::format("K is {}×{}, M {}×{}, the rigid motions {}×{}: they do not belong together", K.rows(),
                                 K.cols(), M.rows(), M.cols(), rigid.rows(), rigid.cols()),
                     "Pass square matrices of one size");
  if (!K.isCompressed() || !M.isCompressed())
    throw ModelError("K or M still has room between its columns", "Call makeCompressed() on both");
}

// The pairs as modes, `returned` of them with the rigid ones, orthonormality and residuals checked.
Modes checked_modes(const Problem& p, Flexible& f, int returned) {
  const ThreadLimit limit;  // as the search
  const auto r = static_cast<int>(p.rigid.cols());
  // L⁻¹ magnifies rounding along the softest motions: take what is left of the rigid ones out, X ← (1 − RRᵀM) X
  if (r > 0) f.X -= p.rigid * transposed_product(p.rigid, symmetric_product(p.M, f.X));
  const int zero = settle_low_modes(p, f);
  require_no_negative(p, f);
  const auto flexible = static_cast<int>(f.lambda.size());
  const int kept_rigid = std::min(r, returned);
  const int kept = std::clamp(returned - r, 0, f.cut.modes);
  Modes modes;
  modes.lambda = Eigen::VectorXd::Zero(kept_rigid + kept);
  modes.lambda.tail(kept) = f.lambda.head(kept);
  modes.shapes.resize(p.K.rows(), kept_rigid + kept);
  modes.shapes << p.rigid.leftCols(kept_rigid), f.X.leftCols(kept);
  modes.rigid = kept_rigid + std::min(zero, kept);
  modes.found = r + f.cut.modes;
  modes.count_shift = f.cut.sigma;
  modes.next_lambda = kept < flexible ? f.lambda[kept] : 0.0;
  if (kept_rigid < r) modes.next_lambda = 0.0;
  const Eigen::MatrixXd MX = symmetric_product(p.M, modes.shapes);
  modes.max_residual = residual(p, modes.shapes, MX, modes.lambda);
  if (modes.lambda.size() > 0)
    modes.max_orthogonality =
        (transposed_product(modes.shapes, MX) - Eigen::MatrixXd::Identity(modes.lambda.size(), modes.lambda.size()))
            .cwiseAbs()
            .maxCoeff();
  if (modes.max_orthogonality > 1e-6)
    throw NumericalError("the modes are not orthonormal with respect to the mass matrix", modes.max_orthogonality,
                         "Raise the count so that the last mode is not cut out of a cluster");
  const fem::RigidForces::Worst rigid = fem::rigid_forces(p.K, p.rigid).worst();
  modes.rigid_force = rigid.ratio;
  modes.rigid_force_row = static_cast<int>(rigid.row);
  fix_signs(modes.shapes);
  return modes;
}

}  // namespace

Modes solve_modes(const fem::SparseMatrix& K, const fem::SparseMatrix& M, const ShiftedFactor& factored,
                  const Eigen::MatrixXd& rigid, const ModesOptions& options, Count* prepared) {
  Count own;
  const Problem p{K, M, factored, rigid, options, prepared != nullptr ? *prepared : own};
  const auto r = static_cast<int>(rigid.cols());
  const auto n = static_cast<int>(K.rows());
  if (options.certify || options.band) p.count.prepare(K, M, factored.factor);
  std::optional<double> sigma;
  int returned = options.count;  // rigid ones included
  if (options.band) {
    p.progress(0.2, "counting the band");
    std::tie(sigma, returned) = count_of_band(p, *options.band);
  }
  const int wanted = std::max(returned - r, 1);
  p.progress(0.3, "eigenvalues");
  const bool dense = n <= options.dense_below || (3 * static_cast<long>(wanted) >= n && n <= densest);
  if (3 * static_cast<long>(wanted) >= n && !dense)
    throw ModelError(fmt::format("{} modes of {} unknowns were asked for, too many for one body", wanted, n),
                     "Ask for fewer modes, give a band, or split the body");
  const std::optional<double> cut_at = wanted == returned - r ? sigma : std::nullopt;
  std::optional<Search> search;
  if (!dense) search.emplace(p, wanted, cut_at);
  Flexible f = dense ? solve_dense(p, std::min(wanted, n), cut_at, 3 * wanted >= n) : search->pairs();

  p.progress(0.7, "checks");  // the count goes on beside them
  Modes modes = checked_modes(p, f, returned);
  if (options.certify && (!dense || f.cut.modes > 0)) {
    p.progress(0.9, "counting");
    const int counted = p.below(f.cut.sigma).negative;
    if (!dense && counted > modes.found) {
      search->complete(counted - r);
      f = search->pairs();
      modes = checked_modes(p, f, returned);
    }
    if (counted != modes.found) report_mismatch(modes.found, counted, f.cut.sigma);
    modes.counted = counted;
  }
  if (sigma && r + static_cast<int>((f.lambda.array() < *sigma).count()) != returned)
    report_mismatch(r + static_cast<int>((f.lambda.array() < *sigma).count()), returned, *sigma);
  p.progress(1.0, "modes");
  return modes;
}

Modes solve_modes(const fem::SparseMatrix& K, const fem::SparseMatrix& M, const Eigen::MatrixXd& rigid,
                  const ModesOptions& options) {
  require_sizes(K, M, rigid);
  if (options.progress) options.progress(0.0, "factorisation");
  const Eigen::MatrixXd moving = null_motions(K, M, rigid, options.rounding, options.row_name);
  Count count;
  const ShiftedFactor at = choose_shift(K, M, moving, options.row_name, [&](const Factor& ordered) {
    if (options.certify || options.band) count.prepare(K, M, ordered);
  });
  return solve_modes(K, M, at, moving, options, &count);
}

}  // namespace tenon::reduction
