#include "reduction/eigenpairs.hpp"

#include <Spectra/SymEigsSolver.h>

#include <algorithm>
#include <cmath>

#include "fem/error.hpp"
#include "reduction/dense.hpp"

namespace tenon::reduction {

namespace {

constexpr double cluster = 1e-4;    // relative distance below which two eigenvalues are not separated by a cut
constexpr double near_cut = 0.01;   // σ lies at most this far, relatively, above the last mode
constexpr double infinite = 1e-13;  // of the largest μ: what is below belongs to massless directions

// (1 − QQᵀ) C (1 − QQᵀ) for Spectra
class Deflated {
 public:
  using Scalar = double;
  Deflated(const ShiftInvert& op, const Eigen::MatrixXd& locked) : op_(op), locked_(locked) {}
  Eigen::Index rows() const { return op_.rows(); }
  Eigen::Index cols() const { return op_.cols(); }
  void perform_op(const double* x, double* y) const {
    Eigen::VectorXd v = Eigen::Map<const Eigen::VectorXd>(x, rows());
    v -= locked_ * (locked_.transpose() * v);
    Eigen::Map<Eigen::VectorXd> w(y, rows());
    op_.perform_op(v.data(), y);
    w -= locked_ * (locked_.transpose() * w);
  }

 private:
  const ShiftInvert& op_;
  const Eigen::MatrixXd& locked_;
};

LanczosResult by_spectra(const ShiftInvert& op, const Eigen::MatrixXd& locked, int wanted, double tolerance) {
  const int n = static_cast<int>(op.rows());
  Deflated deflated(op, locked);
  const int count = std::min(wanted + 4, n - 1);
  Spectra::SymEigsSolver<Deflated> solver(deflated, count, std::min(n, 2 * count + 20));
  solver.init();
  solver.compute(Spectra::SortRule::LargestAlge, 1000, tolerance);
  if (solver.info() != Spectra::CompInfo::Successful)
    throw NumericalError("Spectra's eigenvalue solver did not converge; pairs it found",
                         static_cast<double>(solver.eigenvalues().size()), "Use the project's own block Lanczos");
  LanczosResult result;
  result.ritz.theta = solver.eigenvalues();
  result.vectors = solver.eigenvectors();
  Eigen::MatrixXd image(op.rows(), result.vectors.cols());
  op.apply(result.vectors, image);
  result.ritz.residual = (image - result.vectors * result.ritz.theta.asDiagonal()).colwise().norm();
  result.converged = true;
  result.steps = static_cast<int>(solver.num_operations());
  return result;
}

}  // namespace

std::optional<Cut> choose_cut(const RitzValues& ritz, int wanted, double s, double tolerance,
                              std::optional<double> sigma) {
  const auto count = static_cast<int>(ritz.theta.size());
  const double floor = infinite * std::max(ritz.theta[0], 0.0);
  int finite = 0;
  while (finite < count && ritz.theta[finite] > floor) ++finite;
  const auto met = [&](int modes) {
    for (int k = 0; k < modes; ++k)
      if (!(ritz.residual[k] <= tolerance * ritz.theta[k])) return false;
    return true;
  };
  if (sigma) {
    int modes = 0;
    while (modes < finite && ritz.theta[modes] > 1.0 / (*sigma + s)) ++modes;
    const bool next_known = modes < finite && ritz.residual[modes] <= 0.1 * ritz.theta[modes];
    if ((!next_known && !ritz.exhausted) || modes < wanted || !met(modes)) return std::nullopt;
    return Cut{modes, *sigma, modes == finite};
  }
  for (int modes = std::max(wanted, 1); modes < finite; ++modes) {
    const double above = ritz.theta[modes - 1], below = ritz.theta[modes] + ritz.residual[modes];
    if (above - below < cluster * above) continue;
    if (ritz.residual[modes] > 0.05 * ritz.theta[modes] || !met(modes)) return std::nullopt;
    const double mu = above - std::min(0.5 * (above - below), near_cut * above);
    return Cut{modes, 1.0 / mu - s, false};
  }
  if (!ritz.exhausted) return std::nullopt;
  const double last = finite == 0 ? 0.0 : 1.0 / ritz.theta[finite - 1] - s;  // no gap before the end: all of them
  return Cut{finite, last + 0.1 * (std::abs(last) + s), true};
}

std::optional<double> foresee_cut(const RitzValues& ritz, int wanted, double s) {
  const Eigen::Index count = ritz.theta.size();
  for (Eigen::Index modes = std::max(wanted, 1); modes < count; ++modes) {
    const double above = ritz.theta[modes - 1], gap = above - ritz.theta[modes];
    if (gap < cluster * above) continue;
    const double floor = infinite * std::max(ritz.theta[0], 0.0);
    for (Eigen::Index k = 0; k <= modes; ++k)
      if (ritz.theta[k] <= floor || !(ritz.residual[k] * ritz.residual[k] < 0.1 * gap * ritz.theta[k]))
        return std::nullopt;
    return 1.0 / (above - std::min(0.25 * gap, near_cut * above)) - s;
  }
  return std::nullopt;
}

bool clear_of_modes(const RitzValues& ritz, int modes, double s, double sigma) {
  if (modes < 1 || modes >= ritz.theta.size()) return false;
  const double mu = 1.0 / (sigma + s), above = ritz.theta[modes - 1], below = ritz.theta[modes] + ritz.residual[modes];
  const double clear = 0.5 * cluster * above;
  return above - mu >= clear && mu - below >= clear;
}

LanczosResult find_pairs(const ShiftInvert& op, const ModesOptions& options, const Eigen::MatrixXd& locked, int wanted,
                         int block, std::uint64_t seed, double s, std::optional<double> sigma,
                         const std::function<void(const RitzValues&)>& watch) {
  const double tolerance = 0.05 * options.residual_limit;
  if (options.solver == EigenSolver::spectra) return by_spectra(op, locked, wanted, tolerance);
  std::optional<Cut> cut;
  const auto done = [&](const RitzValues& ritz) {
    cut = choose_cut(ritz, wanted, s, tolerance, sigma);
    if (!cut && watch) watch(ritz);
    return cut.has_value();
  };
  const auto keep = [&](const RitzValues& ritz) {
    if (!cut) cut = choose_cut(ritz, wanted, s, tolerance, sigma);
    return cut ? cut->modes + (cut->last ? 0 : 1) : static_cast<int>(ritz.theta.size());
  };
  const LanczosOptions lanczos{.wanted = wanted, .block = block, .max_steps = 60 + 4 * wanted / block, .seed = seed};
  LanczosResult result = block_lanczos(op, lanczos, locked, done, keep);
  result.converged = cut.has_value();
  return result;
}

}  // namespace tenon::reduction
