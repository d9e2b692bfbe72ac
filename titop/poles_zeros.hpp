#pragma once

#include <Eigen/Core>

#include "titop/state_space.hpp"

namespace tenon::titop {

/// Eigenvalues of A [rad/s], by |s|, conjugates side by side. Each strongly connected block of A is
/// solved by itself, balanced: the poles of a modal system come out of its 2×2 blocks, and rigid motions (chains of
/// integrators) give exact zeros. Throws NumericalError when the QR iteration does not converge.
Eigen::VectorXcd poles(const StateSpace& ss);

/// Invariant zeros: the finite s at which [A − s, B; C, D] has less than its normal rank; any number of inputs and
/// outputs, any D. Uncontrollable and unobservable poles are among them (input and output decoupling zeros).
/// The pencil is freed of its infinite zeros and of its dependent channels by orthogonal compressions of D and C, first
/// of the system, then of its dual (Emami-Naeini and Van Dooren, Automatica 18 (1982) 415–430); what is left has an
/// invertible D and finite zeros only. Ranks are decided at `tolerance` of the normalised system. A zero of
/// multiplicity k is known to the k-th root of the rounding unit only.
Eigen::VectorXcd zeros(const StateSpace& ss, double tolerance = 1e-12);

}  // namespace tenon::titop
