#pragma once

#include <Eigen/Core>
#include <functional>
#include <string>
#include <vector>

#include "fem/structure.hpp"
#include "reduction/modes.hpp"

namespace tenon::reduction {

/// Loads on a structure and what each is called, one a column.
struct Loads {
  Eigen::MatrixXd F;  ///< n×k
  std::vector<std::string> names;
};

/// Static responses to what the kept modes leave of some loads.
struct ResidualShapes {
  Eigen::MatrixXd X;                 ///< n×r, r ≤ k
  Eigen::MatrixXd K;                 ///< r×r, XᵀKX: 1 but for rounding
  std::vector<std::string> dropped;  ///< names of the loads whose response the modes and the other loads contain
};

/// Residual attachment modes X = K⁻¹F̄, F̄ = (1 − MΦΦᵀ)F, of a supported K or of a free one whose rigid motions are among
/// Φ. ΦᵀF̄ = 0 makes ΦᵀKX = 0: no coupling of stiffness with the modes kept. XᵀKX = XᵀF̄ is formed without K, so no
/// digit goes into the differences of a fine mesh; X is scaled and combined by a Cholesky factorisation with pivoting
/// to XᵀKX = 1. A response is dropped when the modes hold all of its energy, or the other responses do, but for
/// rounding. `solve` maps loads to the responses of the supported structure; K, M and Φ are of the same rows. Craig and
/// Chang, AIAA J. 15 (1977) 1618–1625; Rubin, AIAA J. 13 (1975) 995–1006.
ResidualShapes residual_shapes(const std::function<Eigen::MatrixXd(const Eigen::MatrixXd&)>& solve,
                               const fem::SparseMatrix& M, const Modes& modes, Loads loads);

}  // namespace tenon::reduction
