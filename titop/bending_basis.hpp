#pragma once

#include <Eigen/Core>

namespace tenon::titop {

/// Clamped-free shapes of one bending plane of a uniform beam, in the form of eq (1), with ρA = EI = l = 1. For the
/// motion (v, α) of a plane: frequencies scale by √(EI/(ρA l⁴)), L by √m diag(1, l), Phi by diag(1, 1/l)/√m, m = ρAl.
struct BendingBasis {
  Eigen::VectorXd omega;   ///< n, ascending
  Eigen::MatrixXd L;       ///< n×2 participation ∫φ, ∫ξφ
  Eigen::MatrixXd Phi;     ///< 2×n φ(1), φ′(1); φ(1) > 0
  Eigen::MatrixXd shapes;  ///< 2N×n φ and φ′ at the N abscissas asked for, alternating
};

/// The quintic polynomials of eqs (14)–(17), four modes. Rayleigh-Ritz: frequencies are upper bounds; the first two are
/// good under every end condition (0.85 and 3.8 % at worst), the third is off by up to 85 %.
BendingBasis quintic_basis(const Eigen::VectorXd& xi);

/// The first n exact clamped-free modes, eq (13). Other conditions at the parent end converge as 1/n only.
BendingBasis clamped_free_basis(int n, const Eigen::VectorXd& xi);

}  // namespace tenon::titop
