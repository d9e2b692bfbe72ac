#pragma once

#include <functional>

#include "tests/analytic/assembly/tops.hpp"
#include "tests/reference/slider_crank.hpp"

/// Planar mechanisms of rigid bars in the x-y plane, hinges along z, and references that know nothing of trees.
namespace tenon::assembly::testing {

/// A uniform rod from its port 0 at the origin to its port 1 at (length, 0, 0), with a moment of inertia of its own.
inline HingedBody rod(const std::string& name, double mass, double length, double inertia) {
  HingedBody b;
  b.name = name;
  b.body = std::make_shared<const ReducedBody>(reduction::rigid_body(
      name, mass, {0.5 * length, 0.0, 0.0}, Vec3(1e-3 * inertia, inertia, inertia).asDiagonal().toDenseMatrix(),
      {{"root", Vec3::Zero(), Mat3::Identity(), {}}, {"end", {length, 0.0, 0.0}, Mat3::Identity(), {}}}));
  b.kind = HingeKind::revolute;
  b.outer_port = 0;
  return b;
}

/// Two rods on one another under gravity along −y; angles from x, the second relative to the first.
struct DoublePendulum {
  double m1 = 1.3, m2 = 0.7, l1 = 1.0, l2 = 0.8, J1 = 0.11, J2 = 0.04, g = 9.81;

  Multibody system() const {
    Multibody mb;
    mb.gravity = {0.0, -g, 0.0};
    mb.bodies = {rod("upper", m1, l1, J1), rod("lower", m2, l2, J2)};
    mb.bodies[1].parent = 0;
    mb.bodies[1].inner_port = 1;
    index(mb);
    return mb;
  }
  /// Lagrange's equations in absolute angles a, b: rates of (a, b, ȧ, ḃ).
  Eigen::Vector4d rates(const Eigen::Vector4d& y) const {
    const double c = std::cos(y[0] - y[1]), s = std::sin(y[0] - y[1]), k = 0.5 * m2 * l1 * l2;
    Eigen::Matrix2d M;
    M << J1 + 0.25 * m1 * l1 * l1 + m2 * l1 * l1, k * c, k * c, J2 + 0.25 * m2 * l2 * l2;
    const Eigen::Vector2d f(-k * s * y[3] * y[3] - (0.5 * m1 + m2) * g * l1 * std::cos(y[0]),
                            k * s * y[2] * y[2] - 0.5 * m2 * g * l2 * std::cos(y[1]));
    const Eigen::Vector2d a = M.inverse() * f;
    return {y[2], y[3], a[0], a[1]};
  }
};

/// Gragg's midpoint rule extrapolated to order 16 (Hairer, Nørsett, Wanner, II.9): a reference of round-off accuracy.
inline Eigen::Vector4d extrapolate(const std::function<Eigen::Vector4d(const Eigen::Vector4d&)>& f, Eigen::Vector4d y,
                                   double time, int steps) {
  constexpr int columns = 8;
  const double h = time / steps;
  for (int step = 0; step < steps; ++step) {
    std::array<Eigen::Vector4d, columns> row, above;  // of the tableau
    for (std::size_t j = 0; j < columns; ++j) {
      const auto n = static_cast<int>(2 * (j + 1));
      const double d = h / n;
      Eigen::Vector4d before = y, now = y + d * f(y);
      for (int i = 1; i < n; ++i) {
        const Eigen::Vector4d next = before + 2.0 * d * f(now);
        before = now;
        now = next;
      }
      row[0] = 0.5 * (now + before + d * f(now));
      for (std::size_t k = 1; k <= j; ++k) {  // Aitken-Neville in d²
        const double ratio = static_cast<double>(j + 1) / static_cast<double>(j + 1 - k);
        row[k] = row[k - 1] + (row[k - 1] - above[k - 1]) / (ratio * ratio - 1.0);
      }
      above = row;
    }
    y = row[columns - 1];
  }
  return y;
}

/// Crank, rod, rigid here, and a slider along x: the loop closes by a revolute hinge. One degree of freedom:
/// ½ I(φ) φ̇² is constant without forces.
struct SliderCrank : reference::SliderCrank {
  Multibody system() const {
    Multibody mb;  // J1 about the pivot, J2 about the pin
    mb.bodies = {rod("crank", M1, L1, J1 - 0.25 * M1 * L1 * L1), rod("rod", M2, L2, J2 - 0.25 * M2 * L2 * L2),
                 rigid_on(HingeKind::prismatic, "slider", M3, Vec3::Zero(), 1e-3 * M3 * Mat3::Identity())};
    mb.bodies[1].parent = 0;
    mb.bodies[1].inner_port = 1;
    Mat3 along_x;
    along_x << 0, 0, 1, 1, 0, 0, 0, 1, 0;  // z of the hinge along x
    mb.bodies[2].inner_axes = mb.bodies[2].outer_axes = along_x;
    Closure pin;
    pin.name = "pin";
    pin.inner = {1, 1};
    pin.outer = {2, 0};
    pin.kind = HingeKind::revolute;
    mb.closures.push_back(pin);
    index(mb);
    return mb;
  }
  /// The angle of the rod from x, and its rate by that of the crank.
  double rod_angle(double phi) const { return std::asin(-L1 / L2 * std::sin(phi)); }
  double rod_rate(double phi) const { return -L1 * std::cos(phi) / (L2 * std::cos(rod_angle(phi))); }
  double slider(double phi) const { return L1 * std::cos(phi) + L2 * std::cos(rod_angle(phi)); }
  double inertia(double phi) const {  // T = ½ I φ̇²
    const double b = rod_angle(phi), r = rod_rate(phi);
    const double x = -L1 * std::sin(phi) - 0.5 * L2 * std::sin(b) * r,
                 y = L1 * std::cos(phi) + 0.5 * L2 * std::cos(b) * r;
    const double slide = -L1 * std::sin(phi) - L2 * std::sin(b) * r;
    return J1 + M2 * (x * x + y * y) + (J2 - 0.25 * M2 * L2 * L2) * r * r + M3 * slide * slide;
  }
  MotionState start(const Multibody& mb, double phi, double rate) const {
    MotionState s = rest_state(mb);
    const double b = rod_angle(phi), r = rod_rate(phi);
    s.q << phi, b - phi, slider(phi);
    s.v << rate, (r - 1.0) * rate, -(L1 * std::sin(phi) + L2 * std::sin(b) * r) * rate;
    return s;
  }
};

}  // namespace tenon::assembly::testing
