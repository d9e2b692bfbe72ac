#pragma once

#include <Eigen/Core>
#include <array>

#include "assembly/network.hpp"
#include "titop/state_space.hpp"

/// What every route of assembly says about a network in the same words: port motions, joint axes, lumped masses and the
/// names of channels.
namespace tenon::assembly {

inline constexpr std::array<const char*, 6> direction_names{"translation x", "translation y", "translation z",
                                                            "rotation x",    "rotation y",    "rotation z"};

/// A length to weigh rotations against translations: the scene's size, 1 m for a scene that is a point.
double natural_length(const Placement& placement);

/// Of each mode the η that moves the most mobile port by about 1 m, rotations times the length. A mode that hardly
/// moves any port counts as one of the body's whole mass, a thousandth of it.
Eigen::VectorXd natural_amplitudes(const ReducedBody& body, double length);

/// Motion of a port in world axes over (x_ref in world axes, η): x_port = [τ  R Phi] (x_ref; η), 6×(6+n), eq (2) of the
/// TITOP paper.
Eigen::MatrixXd port_rows(const ReducedBody& body, int port, const Mat3& R);

/// Axis of a joint in world axes, unit length.
Vec3 joint_axis(const Network& network, const Placement& placement, const Joint& joint);

/// diag(m, m, m, J) of a lumped mass in world axes.
fem::Mat6 lumped_mass(const LumpedMass& lump, const Mat3& R);

/// Name and unit of an input (N or N m) or output (m, rad and their rates).
titop::Channel channel(const Input& input);
titop::Channel channel(const Output& output);

}  // namespace tenon::assembly
