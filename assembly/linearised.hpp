#pragma once

#include <complex>

#include "assembly/integration/simulation.hpp"
#include "assembly/steady_motion.hpp"
#include "titop/state_space.hpp"

/// A network in small motion about rest, an equilibrium or a constant spin, from its recursive model.
namespace tenon::assembly {

/// M ξ̈ + C ξ̇ + K ξ = B u + Jᵀ λ, J ξ = 0, y = C_p ξ + C_v ξ̇ + C_a ξ̈, over the coordinates of the tree: modes, joint
/// angles, displacements of floating pieces. Ports act and are read along world axes at time 0 that turn with the
/// undisturbed motion of their body.
struct LinearisedNetwork {
  SteadyMotion about;
  std::vector<std::string> coordinates;                    ///< nv names
  Eigen::MatrixXd M, C, K, J;                              ///< C with gyroscopic terms; nv×nv, J m×nv
  Eigen::MatrixXd B;                                       ///< nv×inputs
  Eigen::MatrixXd C_position, C_velocity, C_acceleration;  ///< outputs×nv
  Eigen::MatrixXd T;  ///< nv×n: ξ = T ζ, J T = 0, TᵀMT = 1; at rest without gravity ζ are the modal coordinates
  Eigen::VectorXd omega;  ///< n: of the springs and modes alone [rad/s], the first `rigid` 0, ascending
  int rank = 0;           ///< of J
  int free = 0;           ///< first coordinates ζ: no displacement of theirs makes a force
  titop::StateSpace ss;   ///< states [ζ; ζ̇], named channels
};

/// The bodies of the simulation, its gravity and its initial rates; its forces are left out. Throws what
/// steady_motion() throws, ModelError for a motion whose equations change as it goes on (a rotor on a support that
/// gives way unevenly, a mechanism that runs), naming the input or output that alone does so, and for motions without
/// inertia.
LinearisedNetwork linearised(const Network& network, const Simulation& simulation);

/// Modes, the free ones first (0), then ascending. Undamped frequencies and ratios φᵀCφ / 2ω at rest without gravity,
/// as modes() of the assembled system; |λ| and −Re λ / |λ| of the poles otherwise.
struct LinearisedModes {
  Eigen::VectorXd omega, zeta;              ///< of oscillations
  std::vector<std::complex<double>> poles;  ///< all 2n, by size; conjugates beside each other [rad/s]
  double growth = 0.0;  ///< largest real part beyond round-off [1/s]: above 0 the motion is unstable
};
LinearisedModes modes(const LinearisedNetwork& network);

}  // namespace tenon::assembly
