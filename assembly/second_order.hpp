#pragma once

#include <Eigen/Core>

#include "assembly/network.hpp"
#include "titop/state_space.hpp"

namespace tenon::assembly {

/// M ξ̈ + C ξ̇ + K ξ = B u over q = (x_ref, η) of all bodies (NUMERICS 4a): joint and ground rows G q = 0, q = N ξ with
/// N a basis of null(G). The basis is normalised so that extreme ratios of mass and stiffness never meet in one sum:
///   the first `rigid` coordinates span null(K) and have unit mass:       K = 0, M = 1;
///   the others are M-orthogonal to them, have unit stiffness, stiffest last: K = 1, M = diag(1/ω²),
/// where M = 0 for directions without mass. M and K are these diagonals exactly; C is full.
struct SecondOrderSystem {
  Eigen::MatrixXd M, C, K;  ///< reduced, n×n
  Eigen::MatrixXd B;        ///< n×inputs
  Eigen::MatrixXd N;        ///< q×n null-space basis
  Eigen::MatrixXd G;        ///< rows×q, rows normalised with rotations scaled by the scene's size
  std::vector<int> offset;  ///< first row in q of each body: 6 reference coordinates (world axes), then η
  int rank = 0;             ///< of G
  int redundant = 0;        ///< rows of G that say nothing new
  std::vector<std::string> redundant_rows;  ///< which: "joint 'crank', translation z"
  double rank_gap = 0.0;                    ///< ratio of the smallest kept to the largest dropped pivot of G
  int rigid = 0;                            ///< motions without stiffness
  int massless = 0;                         ///< elastic motions without mass
  Eigen::MatrixXd C_position, C_velocity, C_acceleration;  ///< outputs×n: y = Cp ξ + Cv ξ̇ + Ca ξ̈
  Placement placement;
};

/// Assembles, holds the rows by a rank-revealing decomposition and normalises. The number of rigid motions is the rank
/// of the stiffness's root over null(G), never a count of small eigenvalues. Throws ModelError for a motion with
/// neither mass nor stiffness (bodies named), NumericalError when a rank cannot be decided, and what place() throws.
SecondOrderSystem second_order(const Network& network);

/// Modes of the assembled system: the exact number of rigid ones first (λ = 0), then ascending. Directions without mass
/// have no mode.
struct SystemModes {
  Eigen::VectorXd omega;   ///< undamped [rad/s]
  Eigen::VectorXd zeta;    ///< modal damping ratio φᵀCφ / 2ω; 0 for rigid modes
  Eigen::MatrixXd shapes;  ///< over ξ, mass-normalised: q = N shapes
  int rigid = 0;
};
SystemModes modes(const SecondOrderSystem& system);

/// Response of the outputs to the inputs at ω [rad/s] (outputs×inputs): a direct solve with K + jωC − ω²M. Throws
/// ModelError at ω = 0 when there are rigid motions, NumericalError at an undamped resonance.
Eigen::MatrixXcd response(const SecondOrderSystem& system, double omega);

/// Motion ξ of the same, a column for each unit input.
Eigen::MatrixXcd motion(const SecondOrderSystem& system, double omega);

/// First-order form with named inputs and outputs; states [modal positions; modal velocities] (mass-normalised), rigid
/// modes as exact double integrators. Motions without mass follow the inputs statically; throws ModelError, naming the
/// output, where that makes a velocity or an acceleration improper, and when they are damped.
titop::StateSpace state_space(const Network& network, const SecondOrderSystem& system);

}  // namespace tenon::assembly
