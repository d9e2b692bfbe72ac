#pragma once

#include <string>

#include "fem/spatial.hpp"

/// Hinges of 0 to 6 degrees of freedom and their maps H*, eq (8) of the spatial-operator paper.
namespace tenon::assembly {

/// All in the hinge frame of the inboard side, whose z axis is the axis of the hinge:
/// revolute: turn about z; prismatic: slide along z; cylindrical: slide along z, turn about z; universal: turn about x,
/// then about the y carried along; spherical; planar: slide along x and y, turn about z; free: x, y, z and attitude.
enum class HingeKind { weld, revolute, prismatic, cylindrical, universal, spherical, planar, free };

std::string name(HingeKind kind);
/// Degrees of freedom n_r: the size of β.
int hinge_dofs(HingeKind kind);
/// Numbers that say where it stands: n_r, but a quaternion (x, y, z, w) takes four for the three of an attitude.
int hinge_coordinates(HingeKind kind);

/// Where an attitude begins, both among the coordinates (its quaternion) and among the speeds: 0 or 3; −1 without one.
int attitude(HingeKind kind);

/// n_r numbers, inline storage.
using HingeVector = Eigen::Matrix<double, Eigen::Dynamic, 1, 0, 6, 1>;

/// 6×n_r, inline storage.
using HingeMap = Eigen::Matrix<double, 6, Eigen::Dynamic, 0, 6, 6>;

/// The outboard hinge frame O seen from the inboard one O⁺: attitude, place, Δ_V = H* β at O in the axes of O⁺, and
/// what is left of its rate in O⁺ when β̇ = 0. The β of an attitude are angular velocities in the outboard axes.
struct HingeMotion {
  fem::Mat3 R = fem::Mat3::Identity();
  fem::Vec3 d = fem::Vec3::Zero();
  HingeMap H_star{6, 0};
  fem::Vec6 bias = fem::Vec6::Zero();
};

/// θ: hinge_coordinates(kind) numbers, β: hinge_dofs(kind).
void hinge_motion(HingeKind kind, const double* theta, const double* beta, HingeMotion& motion);

/// The same hinge seen from its other side: O⁺ from O, still over the same θ and β.
void reverse(const double* beta, HingeMotion& motion);

/// The coordinates of the hinge at rest, where R = 1 and d = 0.
void rest(HingeKind kind, double* theta);

/// θ ← θ moved by the displacement δ, a velocity β held over a time (δ = β t): quaternions by the exponential.
void move(HingeKind kind, const double* delta, double* theta);

/// θ as displacements from rest over which springs act, n_r numbers: the rotation vector for an attitude.
void displacements(HingeKind kind, const double* theta, double* delta);

}  // namespace tenon::assembly
