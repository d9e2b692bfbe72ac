#pragma once

#include <Eigen/Core>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "fem/structure.hpp"

namespace tenon::reduction {

/// Called with a fraction 0..1 and the name of the step; may be empty.
using Progress = std::function<void(double, const char*)>;

/// The name of a row of K for messages, "node 45 rz"; may be empty: then its number serves.
using RowName = std::function<std::string(int)>;

/// Who finds the eigenpairs of the shift-invert operator; everything else (shift, checks, count) is the same.
enum class EigenSolver {
  block_lanczos,  ///< our own: finds repeated eigenvalues, solves in blocks
  spectra         ///< Spectra's SymEigsSolver, one vector at a time: a second opinion
};

/// What to look for: the `count` lowest modes, or every mode below `band` [rad/s] (then `count` is ignored).
struct ModesOptions {
  int count = 20;
  std::optional<double> band = std::nullopt;  ///< [rad/s]
  bool certify = true;                        ///< inertia count at the upper end
  /// ‖Kφ − λMφ‖ in the norm of A⁻¹, A = K + sM, relative to ‖φ‖_A: bounds |λ − λ_exact| / (λ + s). (The Euclidean norm
  /// would weigh the rounding of K φ on a fine mesh, λ_max / λ times the rounding unit, above everything else.)
  double residual_limit = 1e-6;
  int block = 0;  ///< Lanczos block size; 0: chosen
  EigenSolver solver = EigenSolver::block_lanczos;
  int dense_below = 600;   ///< problems of at most this size are solved dense
  double rounding = 1e-9;  ///< of K r for rigid r, row by row (Structure::rounding, which a Structure brings along)
  RowName row_name = {};
  Progress progress = {};
};

/// Eigenpairs of K φ = ω² M φ, mass-normalised, ascending, sign: largest component positive.
struct Modes {
  Eigen::VectorXd lambda;  ///< ω² [rad²/s²]; exactly zero for the rigid modes found in null(K)
  Eigen::MatrixXd shapes;  ///< n×modes
  int rigid = 0;           ///< leading modes with λ = 0: given motions in null(K), mechanisms, loose parts
  int found = 0;     ///< eigenpairs computed below `count_shift`; more than returned when the last has near company
  int counted = -1;  ///< eigenvalues below `count_shift` by Sylvester's inertia; −1 when not certified
  double count_shift = 0.0;  ///< σ of the count [rad²/s²]
  double next_lambda =
      0.0;  ///< estimate of the first eigenvalue not returned (0: there is none, all finite ones are here)
  /// What K leaves of forces on the rigid motions, of what cancels in a row, and the row: above 1e-12 its numbers have
  /// few digits, or something ties the body softly to the ground.
  double rigid_force = 0.0;
  int rigid_force_row = -1;
  double max_residual = 0.0;       ///< as in ModesOptions::residual_limit
  double max_orthogonality = 0.0;  ///< largest entry of |ΦᵀMΦ − 1|
};

/// Lowest modes of a structure, K and M lower triangles, positive semi-definite, M may be singular, K may have rigid
/// motions. `rigid`: n×r basis of expected rigid-body motions (may be empty, may contain columns outside null(K), which
/// are dropped). Works on M x = μ (K + |s|M) x, so it never factors an indefinite or singular matrix; each solve is
/// checked and the number of modes below the upper end is counted by inertia (NUMERICS 4d). Throws NumericalError
/// naming both counts when they disagree, and naming a row when K or M is not positive semi-definite.
Modes solve_modes(const fem::SparseMatrix& K, const fem::SparseMatrix& M, const Eigen::MatrixXd& rigid,
                  const ModesOptions& options = {});

/// Names of a structure's rows; refers to it.
RowName row_name(const fem::Structure& structure);

/// The same for a Structure, rigid motions taken about its nodes' centroid.
Modes solve_modes(const fem::Structure& structure, const ModesOptions& options = {});

/// The same with K + sM already factored (reduction/shift.hpp), so that one factor serves static solves and modes.
/// `rigid`: M-orthonormal basis of null(K), kept exactly. `prepared`: a count begun beside the factorisation of K, M
/// (reduction/count.hpp), or null.
struct ShiftedFactor;
class Count;
Modes solve_modes(const fem::SparseMatrix& K, const fem::SparseMatrix& M, const ShiftedFactor& factored,
                  const Eigen::MatrixXd& rigid, const ModesOptions& options, Count* prepared = nullptr);

/// Number of eigenvalues of (K, M) below σ: negative pivots of an LDLᵀ with pivoting of K − σM.
/// Throws NumericalError when σ is so near an eigenvalue that the count is not reliable.
int count_below(const fem::SparseMatrix& K, const fem::SparseMatrix& M, double sigma);

}  // namespace tenon::reduction
