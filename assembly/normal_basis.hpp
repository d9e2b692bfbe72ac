#pragma once

#include <Eigen/Core>
#include <functional>
#include <string>
#include <vector>

namespace tenon::assembly {

/// Coordinates ξ of what rows G q = 0 leave free, q = N ξ, normalised so that extreme ratios of mass and stiffness
/// never meet in one sum. With M = WᵀW and K = FᵀF:
///   the first `rigid` coordinates span null(K) and have unit mass:                        K = 0, M = 1;
///   the others are M-orthogonal to them, have unit stiffness, stiffest last:    K = 1, M = diag(σ²), σ = 1/ω,
/// where σ = 0 for directions without mass.
struct NormalBasis {
  Eigen::MatrixXd N;           ///< q×n
  Eigen::VectorXd sigma;       ///< n − rigid, descending
  Eigen::MatrixXd G;           ///< the rows, of unit length in natural sizes
  int rigid = 0;               ///< motions without stiffness
  int massless = 0;            ///< elastic motions without mass
  int rank = 0;                ///< of G
  double rank_gap = 0.0;       ///< ratio of the smallest kept to the largest dropped pivot of G
  std::vector<int> redundant;  ///< rows of G that say nothing new
};

/// What is normalised: rows, and the roots of stiffness and mass, all over q.
struct Roots {
  const Eigen::MatrixXd &G, &F, &W;
  const Eigen::VectorXd& scale;  ///< natural size of each coordinate
};

/// The number of rigid motions is the rank of F over null(G), never a count of small eigenvalues. `moving` names what
/// moves in a motion over q; throws ModelError with it for a motion with neither mass nor stiffness, NumericalError
/// when a rank cannot be decided.
NormalBasis normal_basis(const Roots& roots, const std::function<std::string(const Eigen::VectorXd&)>& moving);

}  // namespace tenon::assembly
