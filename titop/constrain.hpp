#pragma once

#include "titop/constraint_basis.hpp"

namespace tenon::titop {

/// Natural modes of a body under a boundary, by Rayleigh-Ritz on the motions that the boundary leaves (no channel is
/// inverted): mass-normalised, undamped.
struct ConstrainedModes {
  Eigen::VectorXd omega;      ///< k flexible frequencies [rad/s], ascending; no rigid mode among them
  Eigen::MatrixXd eta;        ///< n×k modal coordinates of the body
  Eigen::MatrixXd reference;  ///< 6×k motion x_ref (of the parent port, of a cantilever body)
  Eigen::MatrixXd rigid;      ///< 6×rigid motions x_ref of the rigid modes (η = 0), mass-normalised
  int removed = 0;            ///< internal state constraints: deformations that the fixed ports forbid
  int redundant = 0;          ///< fixed directions that say nothing new; their reactions are indeterminate
};

/// ω are singular values of Ω N S^{−1/2}, S the reduced mass, so that ω₁ keeps its digits beside ω_max. Error: that of
/// the basis of the body. Throws NumericalError when S is round-off in some motion (below 1e-11 of the terms that
/// cancel in it): the modes carry all inertia at a released port, or a load 1e7 times the body hides it.
ConstrainedModes constrained_modes(const reduction::ReducedBody& body, const Boundary& boundary);

/// A body under a boundary as a linear system. Inputs: wrenches of the free directions, port by port (applied to the
/// body, at the parent port *by* the body). Outputs: positions of the free directions [m, rad], their accelerations,
/// reactions of the fixed directions (same sign as the inputs).
struct ConstrainedModel {
  StateSpace ss;
  int rigid = 0;           ///< double integrators
  int removed_states = 0;  ///< 2r
  double condition = 1.0;  ///< of the channel inversion, where there was one
};

/// From the modes: states [ζ; ρ; ζ̇; ρ̇], so that flexible poles are exactly ±jω without damping, and rigid modes
/// exact double integrators. Reactions of redundant directions are the ones of least norm.
ConstrainedModel constrain(const reduction::ReducedBody& body, const Boundary& boundary);

/// The same system as the TITOP paper has it: channels of eq (3) inverted by (27)–(28), the states confined to the
/// deformations that the boundary leaves, positions through the augmented model of eq (18). States [ξ; ξ̇; ρ; ρ̇].
/// Throws NumericalError where a channel has no direct transmission to invert (`invert_channels`).
ConstrainedModel constrain_by_inversion(const reduction::ReducedBody& body, const Boundary& boundary,
                                        double limit = 1e14);

/// Motions of all ports in given motions of a body, stacked 6 rows each: τ x_ref + Φ η.
Eigen::MatrixXd port_motions(const reduction::ReducedBody& body, const Eigen::MatrixXd& reference,
                             const Eigen::MatrixXd& eta);

/// Turns each column of a set of motions so that its largest port motion is positive, or where ports hardly move its
/// largest modal coordinate.
void fix_signs(const reduction::ReducedBody& body, Eigen::MatrixXd& reference, Eigen::MatrixXd& eta);

/// Channels of a port's motion: "panel.tip.ux" [m] .. "panel.tip.rz" [rad].
std::vector<Channel> position_channels(const std::string& port);

}  // namespace tenon::titop
