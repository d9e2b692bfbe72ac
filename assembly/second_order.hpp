#pragma once

#include <Eigen/Core>

#include "assembly/network.hpp"
#include "titop/state_space.hpp"

namespace tenon::assembly {

/// N'MN ξ̈ + N'CN ξ̇ + N'KN ξ = N'B u over q = (x_ref, η) of all bodies (NUMERICS 4a): joint and ground rows G q = 0,
/// N = null(G) by a rank-revealing decomposition.
struct SecondOrderSystem {
  Eigen::MatrixXd M, C, K;  ///< reduced, n×n
  Eigen::MatrixXd B;        ///< n×inputs
  Eigen::MatrixXd N;        ///< q×n null-space basis
  Eigen::MatrixXd G;        ///< rows×q, scaled
  std::vector<int> offset;  ///< first row in q of each body: 6 reference coordinates (world axes), then η
  int rank = 0;             ///< of G
  int redundant = 0;        ///< rows of G that say nothing new
  double rank_gap = 0.0;    ///< ratio of the smallest kept to the largest dropped singular value
  Eigen::MatrixXd Kroot;    ///< a matrix F with FᵀF = K, for rank decisions
  Eigen::MatrixXd C_position, C_velocity, C_acceleration;  ///< outputs×n: y = Cp ξ + Cv ξ̇ + Ca ξ̈
  Placement placement;
};

SecondOrderSystem second_order(const Network& network);

/// Modes of the assembled system: the exact number of rigid ones first (λ = 0), then ascending.
struct SystemModes {
  Eigen::VectorXd omega;   ///< undamped [rad/s]
  Eigen::VectorXd zeta;    ///< modal damping ratio φᵀCφ / 2ω; 0 for rigid modes
  Eigen::MatrixXd shapes;  ///< over ξ, mass-normalised
  int rigid = 0;
};
SystemModes modes(const SecondOrderSystem& system);

/// Response of the outputs to the inputs at ω [rad/s] (outputs×inputs).
Eigen::MatrixXcd response(const SecondOrderSystem& system, double omega);

/// First-order form with named inputs and outputs; states [modal positions; modal velocities], rigid modes as exact
/// double integrators.
titop::StateSpace state_space(const Network& network, const SecondOrderSystem& system);

}  // namespace tenon::assembly
