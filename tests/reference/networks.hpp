#pragma once

#include "assembly/network.hpp"
#include "tests/reference/beams.hpp"

/// Small networks with closed-form modes.
namespace tenon::reference {

using assembly::Joint;
using assembly::JointKind;
using assembly::Network;
using assembly::PortRef;

inline reduction::BodyPort port(const std::string& name, const fem::Vec3& position = fem::Vec3::Zero()) {
  reduction::BodyPort p;
  p.name = name;
  p.position = position;
  return p;
}

/// Two rigid bodies with inertias J1, J2 about a common z axis, joined there by a revolute joint of stiffness k:
/// ω² = k (1/J1 + 1/J2).
inline Network two_inertias(double J1, double J2, double k) {
  Network net;
  net.bodies = {reduction::rigid_body("one", 1.0, {0, 0, 0}, fem::Vec3(1.0, 1.0, J1).asDiagonal(), {port("hinge")}),
                reduction::rigid_body("two", 1.0, {0, 0, 0}, fem::Vec3(1.0, 1.0, J2).asDiagonal(), {port("hinge")})};
  Joint joint;
  joint.name = "spring";
  joint.parent = {0, 0};
  joint.child = {1, 0};
  joint.kind = JointKind::revolute;
  joint.stiffness = k;
  net.joints = {joint};
  return net;
}

/// A rigid bar of 2 kg and 1 m with its mass in the middle, ports p and q at its ends, turned by `axes`.
inline ReducedBody rigid_bar(const char* name, const fem::Mat3& axes = fem::Mat3::Identity()) {
  return reduction::rigid_body(name, 2.0, axes * fem::Vec3(0.5, 0.0, 0.0), 0.2 * fem::Mat3::Identity(),
                               {{"p", fem::Vec3::Zero(), axes, {}}, {"q", axes * fem::Vec3::UnitX(), axes, {}}});
}

inline Joint weld(const char* name, PortRef parent, PortRef child) {
  Joint joint;
  joint.name = name;
  joint.parent = parent;
  joint.child = child;
  return joint;
}

/// A rigid hub with two uniform clamped-free beams welded on opposite sides, all at one point; hub mass and polar
/// inertia are `ratio` times those of both beams as rigid bodies.
inline Network hub_and_panels(double ratio, int modes) {
  Network net;
  const double mass = 2.0 * ratio, J = 2.0 * ratio / 3.0;
  net.bodies = {reduction::rigid_body("hub", mass, {0, 0, 0}, J * fem::Mat3::Identity(), {port("east"), port("west")}),
                clamped_free_beam("east panel", modes), clamped_free_beam("west panel", modes)};
  for (int side = 0; side < 2; ++side) {
    Joint joint;
    joint.name = side ? "west root" : "east root";
    joint.parent = {0, side};
    joint.child = {1 + side, 0};
    joint.angle = side * std::numbers::pi;
    net.joints.push_back(joint);
  }
  return net;
}

/// Exact flexible frequencies of hub_and_panels: the i-th root above the i-th clamped frequency of
/// h (1 + cos b cosh b) + 2 g(b) = 0, ω = b², with h the hub's mass or inertia and g the beam's driving inertia times
/// (1 + cos b cosh b): (sinh b cos b + cosh b sin b)/b in translation, (cosh b sin b − sinh b cos b)/b³ in rotation.
/// Divided by cosh b.
inline double hub_and_panels_root(double ratio, bool rotation, int i) {
  const double h = 2.0 * ratio * (rotation ? 1.0 / 3.0 : 1.0);
  const auto g = [&](double b) {
    const double c = std::cos(b), s = std::sin(b), th = std::tanh(b);
    return 2.0 * (rotation ? (s - th * c) / (b * b * b) : (th * c + s) / b);
  };
  const auto f = [&](double b) { return h * (1.0 / std::cosh(b) + std::cos(b)) + g(b); };
  double a = clamped_free_root(i), b = clamped_free_root(i + 1);
  const double fa = g(a);  // f at the clamped frequency itself, where the hub's term vanishes
  for (int step = 0; step < 200; ++step) {
    const double m = 0.5 * (a + b);
    if (m <= a || m >= b) break;
    (fa * f(m) <= 0.0 ? b : a) = m;
  }
  return std::pow(0.5 * (a + b), 2);
}

}  // namespace tenon::reference
