#pragma once

#include "fem/spatial.hpp"

/// Finite rotations. A rotation vector φ stands for the turn by |φ| [rad] about φ/|φ|.
namespace tenon::fem {

/// Exp(φ), the direction cosine matrix (Rodrigues).
Mat3 rotation_matrix(const Vec3& phi);

/// The rotation vector of R, 0 ≤ |φ| ≤ π.
Vec3 rotation_vector(const Mat3& R);

/// T(φ) of the left side: ω = T φ̇ is the angular velocity of Exp(φ) in the axes it turns from,
/// T = 1 + a φ̃ + b φ̃², a = (1 − cos|φ|)/|φ|², b = (|φ| − sin|φ|)/|φ|³.
Mat3 rotation_tangent(const Vec3& phi);

/// Ṫ φ̇: the part of ω̇ that is left when φ̈ = 0.
Vec3 rotation_tangent_rate(const Vec3& phi, const Vec3& phi_dot);

}  // namespace tenon::fem
