#pragma once

#include <Eigen/Core>

#include "reduction/modes.hpp"

namespace tenon::reduction {

/// Finite eigenpairs of K φ = λ M φ, mass-normalised, ascending.
struct DensePairs {
  Eigen::VectorXd lambda;
  Eigen::MatrixXd shapes;
};

/// Rank of a symmetric positive semi-definite matrix scaled to a unit diagonal: the number of finite eigenvalues when
/// M is the mass matrix.
int mass_rank(const Eigen::MatrixXd& M);

/// The lowest `count` finite modes (all when count < 0) of dense symmetric K, M ⪰ 0 with K + sM > 0, by the eigenvalues
/// of L⁻¹ M L⁻ᵀ, K + sM = LLᵀ. Modes more than 1e7 above the first are taken from a second solve at their own shift,
/// for one solve has only 16 digits for all of them. `rigid` (M-orthonormal, K R = 0) is kept out. Throws
/// NumericalError naming a row when K + sM is not positive definite.
DensePairs dense_modes(const Eigen::MatrixXd& K, const Eigen::MatrixXd& M, double s, int count,
                       const Eigen::MatrixXd& rigid, const RowName& row_name = {});

}  // namespace tenon::reduction
