#pragma once

#include "assembly/recursion/sweeps.hpp"

namespace tenon::assembly {

/// The lowest natural frequencies of a tree at rest, for systems too large for linearise(): Lanczos on K^-½ 𝓜 K^-½ with
/// products by inverse dynamics, O(N) each. No matrix is formed.
struct LowestModes {
  Eigen::VectorXd omega;   ///< ascending [rad/s]
  Eigen::MatrixXd shapes;  ///< nv×count, mass-normalised
};

/// At most nv − 1 of them, whatever is asked. Throws ModelError naming the body when a hinge has no spring (a rigid
/// motion), when the system has loops, fewer than two coordinates or `count` is below one; NumericalError when the
/// iteration does not converge.
LowestModes lowest_modes(const Multibody& system, int count);

}  // namespace tenon::assembly
