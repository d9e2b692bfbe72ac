#pragma once

#include "titop/constrain.hpp"

namespace tenon::titop {

/// Modes of a port model with inverted channels, read off its state matrices.
struct InvertedModes {
  Eigen::VectorXd omega;      ///< |λ| [rad/s], ascending; rigid modes are not in the model
  Eigen::MatrixXd eta;        ///< n×k, real part with the phase of the largest component taken out
  Eigen::MatrixXd reference;  ///< 6×k motion of the parent port
  double largest_real = 0.0;  ///< largest |Re λ| [rad/s]: round-off for an undamped body
};

/// Eq (22) of the TITOP paper for any set I of inverted channels: eigenvectors v of A, confined to the deformations
/// that the boundary of I leaves; x_P = C_P v / λ² in the free directions of the parent port, η the upper half of v.
/// Mass-normalised and signed as `constrained_modes`. An overdamped pair is not a mode and is left out.
InvertedModes inverted_modes(const reduction::ReducedBody& body, const std::vector<int>& I);

/// Motions [u; θ] at body.node_positions, 6N×k: (τ(x), φ(x)) of eq (20) applied to motions of the parent port and modal
/// coordinates. Throws ModelError when the body keeps no shapes.
Eigen::MatrixXd node_motions(const reduction::ReducedBody& body, const Eigen::MatrixXd& reference,
                             const Eigen::MatrixXd& eta);

}  // namespace tenon::titop
