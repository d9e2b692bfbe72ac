#include "tests/reference/networks.hpp"

#include <cmath>
#include <numbers>

namespace tenon::reference {

reduction::BodyPort port(const std::string& name, const fem::Vec3& position) {
  reduction::BodyPort p;
  p.name = name;
  p.position = position;
  return p;
}

Network two_inertias(double J1, double J2, double k) {
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

ReducedBody rigid_bar(const char* name, const fem::Mat3& axes) {
  return reduction::rigid_body(name, 2.0, axes * fem::Vec3(0.5, 0.0, 0.0), 0.2 * fem::Mat3::Identity(),
                               {{"p", fem::Vec3::Zero(), axes, {}}, {"q", axes * fem::Vec3::UnitX(), axes, {}}});
}

Joint weld(const char* name, PortRef parent, PortRef child) {
  Joint joint;
  joint.name = name;
  joint.parent = parent;
  joint.child = child;
  return joint;
}

Network hub_and_panels(double ratio, int modes) {
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

double hub_and_panels_root(double ratio, bool rotation, int i) {
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
