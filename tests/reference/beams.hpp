#pragma once

#include <Eigen/Core>
#include <string>

#include "reduction/reduced_body.hpp"

/// Closed-form bodies: uniform Euler-Bernoulli beams in the plane (P, x, y) with ρS = EI = l = 1.
namespace tenon::reference {

using reduction::ReducedBody;

/// The body of given 2×2 mass and participation over (v_P, α_P) = (uy, rz), and shapes over (v_C, α_C) at x = 1.
/// Axial motion, the other bending plane and torsion are rigid: a slender rod along x.
ReducedBody planar_beam(const std::string& name, const Eigen::VectorXd& omega, const Eigen::MatrixXd& L,
                        const Eigen::MatrixXd& Phi_C);

/// Root i = 1, 2, ... of 1 + cos β cosh β = 0, as cos β + 1/cosh β = 0 so that nothing overflows.
double clamped_free_root(int i);

/// Clamped-free modes, eq (13) of the TITOP paper normalised to ∫φ² = 1, by their integrals: ∫φ = 2σ/β, ∫xφ = 2/β²,
/// φ(1) = 2(−1)^{i+1}, φ′(1) = 2βσ(−1)^{i+1}, σ = (sinh β − sin β)/(cosh β + cos β) with e^β divided out.
ReducedBody clamped_free_beam(const std::string& name, int modes);

/// The quintic model G_f,pol, eqs (16) and (17), brought to the form of eq (1) by K v = ω² M_ff v.
ReducedBody polynomial_beam(const std::string& name);

}  // namespace tenon::reference
