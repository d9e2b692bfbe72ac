#include "assembly/network.hpp"

#include <fmt/format.h>

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <deque>

#include "fem/error.hpp"

namespace tenon::assembly {

namespace {

constexpr double closing_tolerance = 1e-6;  // of the scene's size, and [rad]
constexpr double coinciding = 1e-12;        // of a point's distance from the origin: what rounding leaves between two

template <typename T>
const T& at(const std::vector<T>& items, int k) {
  return items[static_cast<std::size_t>(k)];
}

void check_port(const Network& network, const PortRef& ref, const std::string& user) {
  if (ref.body < 0 || ref.body >= static_cast<int>(network.bodies.size()))
    throw ModelError(fmt::format("{} refers to body number {} of {}", user, ref.body, network.bodies.size()),
                     "Name a body of the network");
  const ReducedBody& body = body_of(network, ref);
  if (ref.port < 0 || ref.port >= static_cast<int>(body.ports.size()))
    throw ModelError(fmt::format("{} refers to port number {} of body '{}', which has {}", user, ref.port, body.name,
                                 body.ports.size()),
                     "Name a port of the body");
}

void check_joint(const Network& network, const Joint& joint) {
  const std::string who = fmt::format("joint '{}'", joint.name);
  check_port(network, joint.parent, who);
  check_port(network, joint.child, who);
  if (joint.parent.body == joint.child.body)
    throw ModelError(fmt::format("{} joins body '{}' to itself", who, body_of(network, joint.parent).name),
                     "Join ports of two bodies");
  const double numbers[] = {joint.stiffness, joint.damping, joint.inertia};
  for (const double x : numbers)
    if (!(x >= 0.0) || !std::isfinite(x))
      throw ModelError(fmt::format("{} has a stiffness, damping or inertia of {}", who, x),
                       "Give finite numbers that are not negative");
  if (joint.kind == JointKind::weld && (joint.stiffness > 0.0 || joint.damping > 0.0 || joint.inertia > 0.0))
    throw ModelError(fmt::format("{} is a weld, which has no free direction for a stiffness, damping or inertia", who),
                     "Make it a revolute joint, or leave them out");
  if (!std::isfinite(joint.angle) || !joint.axis.allFinite() || std::abs(joint.axis.norm() - 1.0) > 1e-9)
    throw ModelError(fmt::format("{} needs a finite angle and an axis of length one", who), "Normalise the axis");
}

template <typename Item>
void check_channel(const Network& network, const Item& item, const char* kind) {
  const std::string who = fmt::format("{} '{}'", kind, item.name);
  if (item.at.has_value() == item.joint.has_value())
    throw ModelError(fmt::format("{} must be at a port or at a joint, one of them", who), "Give one place");
  if (item.at) {
    check_port(network, *item.at, who);
    if (item.direction < 0 || item.direction > 5)
      throw ModelError(fmt::format("{} has direction {}", who, item.direction), "Directions are 0 to 5");
  } else if (*item.joint < 0 || *item.joint >= static_cast<int>(network.joints.size()) ||
             at(network.joints, *item.joint).kind != JointKind::revolute) {
    throw ModelError(fmt::format("{} is at a joint that does not turn", who), "Name a revolute joint");
  }
}

Mat3 rotation(const Joint& joint) { return Eigen::AngleAxisd(joint.angle, joint.axis.normalized()).toRotationMatrix(); }

// world axes and position of a port
struct Frame {
  Mat3 R;
  Vec3 p;
};

Frame frame(const Network& network, const Placement& placement, const PortRef& ref) {
  const reduction::BodyPort& port = port_of(network, ref);
  const Mat3& R = at(placement.R, ref.body);
  return {R * port.axes, at(placement.origin, ref.body) + R * port.position};
}

// R_child port = R_parent port · Rot(axis, angle), read outward or inward
void place_across(const Network& network, const Joint& joint, bool outward, Placement& placement) {
  const PortRef& from = outward ? joint.parent : joint.child;
  const PortRef& to = outward ? joint.child : joint.parent;
  const Frame f = frame(network, placement, from);
  const Mat3 turn = outward ? rotation(joint) : Mat3(rotation(joint).transpose());
  const auto k = static_cast<std::size_t>(to.body);
  placement.R[k] = f.R * turn * port_of(network, to).axes.transpose();
  placement.origin[k] = f.p - placement.R[k] * port_of(network, to).position;
}

// root of the mean square distance of the mass from the reference
double radius_of_gyration(const ReducedBody& body) {
  const double mass = body.D(0, 0);
  return mass > 0.0 ? std::sqrt(std::max(body.D.bottomRightCorner<3, 3>().trace(), 0.0) / (2.0 * mass)) : 0.0;
}

// The box of references and ports, or a body's radius of gyration where that is larger: ports may all coincide, and
// their box is then what rounding leaves.
double scene_size(const Network& network, const Placement& placement) {
  Eigen::AlignedBox3d box;
  double gyration = 0.0;
  for (std::size_t k = 0; k < network.bodies.size(); ++k) {
    const auto add = [&](const Vec3& r) { box.extend(placement.origin[k] + placement.R[k] * r); };
    add(network.bodies[k].reference);
    for (const reduction::BodyPort& port : network.bodies[k].ports) add(port.position);
    gyration = std::max(gyration, radius_of_gyration(network.bodies[k]));
  }
  if (box.isEmpty()) return gyration;
  const double far = std::max(box.min().norm(), box.max().norm()), diagonal = box.diagonal().norm();
  return std::max(diagonal > coinciding * far ? diagonal : 0.0, gyration);
}

void check_closure(const Network& network, const Placement& placement, const Joint& joint) {
  const Frame parent = frame(network, placement, joint.parent), child = frame(network, placement, joint.child);
  const double gap = (child.p - parent.p).norm();
  const Eigen::AngleAxisd turn(Mat3((parent.R * rotation(joint)).transpose() * child.R));
  if (gap > closing_tolerance * placement.size || turn.angle() > closing_tolerance)
    throw ModelError(
        fmt::format("the loop through joint '{}' ({} to {}) does not close: gap {:.3g} m in a scene of {:.3g} m, "
                    "angle {:.3g} rad",
                    joint.name, name(network, joint.parent), name(network, joint.child), gap, placement.size,
                    turn.angle()),
        "Correct the angles of the joints of the loop");
}

}  // namespace

const ReducedBody& body_of(const Network& network, const PortRef& ref) { return at(network.bodies, ref.body); }

const reduction::BodyPort& port_of(const Network& network, const PortRef& ref) {
  return at(body_of(network, ref).ports, ref.port);
}

std::string name(const Network& network, const PortRef& ref) {
  return body_of(network, ref).name + "." + port_of(network, ref).name;
}

void check(const Network& network) {
  if (network.bodies.empty()) throw ModelError("the network has no body", "Give at least one");
  for (const Joint& joint : network.joints) check_joint(network, joint);
  for (const LumpedMass& lump : network.masses) {
    const std::string who = fmt::format("mass '{}'", lump.name);
    check_port(network, lump.at, who);
    const double scale = lump.inertia.cwiseAbs().maxCoeff();
    const Eigen::SelfAdjointEigenSolver<Mat3> eigen(lump.inertia, Eigen::EigenvaluesOnly);
    if (!std::isfinite(lump.mass) || !lump.inertia.allFinite() || lump.mass < 0.0 ||
        (lump.inertia - lump.inertia.transpose()).cwiseAbs().maxCoeff() > 1e-12 * scale ||
        eigen.eigenvalues()[0] < -1e-12 * scale)
      throw ModelError(fmt::format("{} needs a mass that is not negative and a symmetric inertia without negative "
                                   "principal values",
                                   who),
                       "Correct the mass or the inertia");
  }
  for (const PortRef& port : network.ground) check_port(network, port, "the ground");
  for (const Input& input : network.inputs) check_channel(network, input, "input");
  for (const Output& output : network.outputs) check_channel(network, output, "output");
}

Placement place(const Network& network) {
  Placement placement = place_open(network);
  for (const int j : placement.closing_joints) check_closure(network, placement, at(network.joints, j));
  return placement;
}

Placement place_open(const Network& network) {
  check(network);
  const std::size_t n = network.bodies.size();
  std::vector<std::vector<int>> joints_of(n);
  for (std::size_t j = 0; j < network.joints.size(); ++j) {
    joints_of[static_cast<std::size_t>(network.joints[j].parent.body)].push_back(static_cast<int>(j));
    joints_of[static_cast<std::size_t>(network.joints[j].child.body)].push_back(static_cast<int>(j));
  }

  Placement placement;
  placement.R.assign(n, Mat3::Identity());
  placement.origin.assign(n, Vec3::Zero());
  placement.tree_joint.assign(n, -1);
  std::vector<bool> placed(n, false), used(network.joints.size(), false);
  for (std::size_t root = 0; root < n; ++root) {
    if (placed[root]) continue;
    placed[root] = true;
    for (std::deque<int> queue{static_cast<int>(root)}; !queue.empty(); queue.pop_front()) {
      const int k = queue.front();
      placement.order.push_back(k);
      for (const int j : at(joints_of, k)) {
        if (used[static_cast<std::size_t>(j)]) continue;
        used[static_cast<std::size_t>(j)] = true;
        const Joint& joint = at(network.joints, j);
        const bool outward = joint.parent.body == k;
        const int next = outward ? joint.child.body : joint.parent.body;
        if (placed[static_cast<std::size_t>(next)]) {
          placement.closing_joints.push_back(j);
          continue;
        }
        place_across(network, joint, outward, placement);
        placed[static_cast<std::size_t>(next)] = true;
        placement.tree_joint[static_cast<std::size_t>(next)] = j;
        queue.push_back(next);
      }
    }
  }
  placement.size = scene_size(network, placement);
  return placement;
}

}  // namespace tenon::assembly
