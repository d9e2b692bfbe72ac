#include "fem/rotation.hpp"

#include <cmath>

namespace tenon::fem {

namespace {

// sin t/t, (1 − cos t)/t², (t − sin t)/t³ and the derivatives of the last two by t, divided by t
struct Coefficients {
  double sinc, a, b, a_rate, b_rate;
};

// Below t = 0.1 by series, where the closed forms cancel; the first term left out is below 1e-17.
Coefficients coefficients(double t2) {
  if (t2 < 1e-2)
    return {1.0 - t2 / 6.0 * (1.0 - t2 / 20.0 * (1.0 - t2 / 42.0 * (1.0 - t2 / 72.0))),
            0.5 - t2 / 24.0 * (1.0 - t2 / 30.0 * (1.0 - t2 / 56.0 * (1.0 - t2 / 90.0))),
            1.0 / 6.0 - t2 / 120.0 * (1.0 - t2 / 42.0 * (1.0 - t2 / 72.0 * (1.0 - t2 / 110.0))),
            -1.0 / 12.0 + t2 / 180.0 * (1.0 - t2 * 3.0 / 112.0 * (1.0 - t2 * 2.0 / 135.0 * (1.0 - t2 / 105.6))),
            -1.0 / 60.0 + t2 / 1260.0 * (1.0 - t2 / 48.0 * (1.0 - t2 * 2.0 / 165.0 * (1.0 - t2 / 124.8)))};
  const double t = std::sqrt(t2), s = std::sin(t), c = std::cos(t);
  const double a = (1.0 - c) / t2, b = (t - s) / (t2 * t);
  return {s / t, a, b, (s / t - 2.0 * a) / t2, ((1.0 - c) / t2 - 3.0 * b) / t2};
}

}  // namespace

Mat3 rotation_matrix(const Vec3& phi) {
  const Coefficients k = coefficients(phi.squaredNorm());
  const Mat3 s = skew(phi);
  return Mat3::Identity() + k.sinc * s + k.a * s * s;
}

Vec3 rotation_vector(const Mat3& R) {
  const Eigen::Quaterniond q(R);
  const double s = q.vec().norm();
  if (s == 0.0) return Vec3::Zero();
  return 2.0 * std::atan2(s, std::abs(q.w())) / s * (q.w() < 0.0 ? -1.0 : 1.0) * q.vec();
}

Mat3 rotation_tangent(const Vec3& phi) {
  const Coefficients k = coefficients(phi.squaredNorm());
  const Mat3 s = skew(phi);
  return Mat3::Identity() + k.a * s + k.b * s * s;
}

// Ṫφ̇ with (d/dt)|φ|² = 2 φ·φ̇; φ̇ × φ̇ = 0
Vec3 rotation_tangent_rate(const Vec3& phi, const Vec3& phi_dot) {
  const Coefficients k = coefficients(phi.squaredNorm());
  const double rate = phi.dot(phi_dot);
  const Vec3 turn = phi.cross(phi_dot);
  return k.a_rate * rate * turn + k.b_rate * rate * phi.cross(turn) + k.b * phi_dot.cross(turn);
}

}  // namespace tenon::fem
