#pragma once

#include <Eigen/Core>
#include <concepts>
#include <cstdint>
#include <functional>

namespace tenon::reduction {

/// A symmetric operator that maps blocks of columns; Spectra's operators have the same rows().
template <class Op>
concept BlockOperator = requires(const Op& op, const Eigen::MatrixXd& X, Eigen::MatrixXd& Y) {
  { op.rows() } -> std::convertible_to<Eigen::Index>;
  op.apply(X, Y);
};

/// Ritz values (descending) with their residual norms ‖C y − θ y‖, as they stand after a step.
struct RitzValues {
  Eigen::VectorXd theta;
  Eigen::VectorXd residual;
  bool exhausted = false;  ///< the whole space the operator can reach has been spanned: the values are exact
};

struct LanczosOptions {
  int wanted = 20;         ///< Ritz vectors carried through a restart (with some company)
  int block = 8;           ///< at least the multiplicity to be found in one run
  int max_basis = 0;       ///< columns before a restart; 0: chosen from wanted and block
  int max_steps = 200;     ///< block steps before giving up
  std::uint64_t seed = 1;  ///< of the starting block
};

struct LanczosResult {
  RitzValues ritz;
  Eigen::MatrixXd vectors;  ///< orthonormal Ritz vectors, one a column, of the leading values
  int steps = 0;            ///< block applications of the operator
  bool converged = false;   ///< the caller's test was met
};

/// Block Lanczos on a symmetric positive semi-definite operator C, for its largest eigenvalues:
///   C Q = Q T + F E,  QᵀQ = 1, QᵀF = 0,
/// with full reorthogonalisation (T is QᵀCQ as computed, so nothing rests on a three-term recurrence), thick restart
/// (Q ← Q S, T ← Θ, E ← E S keeps the relation) and replacement of columns of F that vanish by fresh ones. The start is
/// pseudo-random from a fixed seed: the same input gives the same digits. Wu and Simon, SIAM J. Matrix Anal. 22 (2000).
class BlockLanczos {
 public:
  /// `locked`: orthonormal vectors kept out of the space (n×k, may be empty).
  BlockLanczos(Eigen::Index n, const LanczosOptions& options, const Eigen::MatrixXd& locked);

  /// The block F to be mapped next.
  const Eigen::MatrixXd& block() const { return F_; }
  /// Takes C F, extends the basis by F, restarting first where the basis is full; returns the new Ritz values.
  const RitzValues& extend(Eigen::MatrixXd image);
  /// Ritz vectors of the `count` largest values.
  Eigen::MatrixXd vectors(int count) const;
  int steps() const { return steps_; }

 private:
  void orthogonalise(Eigen::MatrixXd& W, Eigen::MatrixXd* H) const;
  void next_block(Eigen::MatrixXd& W);
  void restart();
  Eigen::VectorXd random();

  LanczosOptions options_;
  const Eigen::MatrixXd& locked_;
  Eigen::MatrixXd Q_;  ///< basis, the first m_ columns in use
  Eigen::Index m_ = 0;
  Eigen::Index coupled_ = 0;  ///< C F couples to the basis from this column on, but for rounding
  Eigen::MatrixXd T_, S_, F_, E_;
  RitzValues ritz_;
  double scale_ = 0.0;  ///< largest Ritz value so far: the size of C
  bool fresh_ = false;  ///< F is wholly random: the basis is invariant
  std::uint64_t state_;
  int steps_ = 0;
};

/// Runs until done(ritz values) or the limits; returns the leading `keep(ritz)` vectors.
template <BlockOperator Op>
LanczosResult block_lanczos(const Op& op, const LanczosOptions& options, const Eigen::MatrixXd& locked,
                            const std::function<bool(const RitzValues&)>& done,
                            const std::function<int(const RitzValues&)>& keep) {
  BlockLanczos lanczos(op.rows(), options, locked);
  LanczosResult result;
  while (lanczos.block().cols() > 0 && lanczos.steps() < options.max_steps) {
    Eigen::MatrixXd image(op.rows(), lanczos.block().cols());
    op.apply(lanczos.block(), image);
    result.ritz = lanczos.extend(std::move(image));
    if ((result.converged = done(result.ritz) || result.ritz.exhausted)) break;
  }
  result.steps = lanczos.steps();
  result.vectors = lanczos.vectors(keep(result.ritz));
  return result;
}

}  // namespace tenon::reduction
