#pragma once

#include <Eigen/Core>

#include "titop/state_space.hpp"

namespace tenon::titop {

/// The same system in scaled states x = diag(scale) x̂; inputs, outputs and the response stay as they are.
struct Balanced {
  StateSpace ss;
  Eigen::VectorXd scale;  ///< powers of two: nothing is rounded
};

/// Scales the states until, of each, the row of [A B] and the column of [A; C] without the diagonal have like 1-norms.
/// Parlett and Reinsch, Numer. Math. 13 (1969) 293–304, on the system instead of A alone.
Balanced balance(const StateSpace& ss);

/// A system for decisions on rank: balanced, its time in units of 1/rate, columns of [B; D] and rows of [C D] about
/// of norm one. Poles and zeros are `rate` times those of the system normalised.
struct Normalised {
  Eigen::MatrixXd A, B, C, D;
  double rate = 1.0;      ///< [rad/s]
  Eigen::VectorXd scale;  ///< of the states, as in Balanced
  double size = 1.0;      ///< Frobenius norm of [A B; C D]
};
Normalised normalise(const StateSpace& ss);

}  // namespace tenon::titop
