#include "assembly/close_angles.hpp"

#include <fmt/format.h>

#include <Eigen/QR>
#include <algorithm>
#include <cmath>

#include "assembly/kinematics.hpp"
#include "fem/error.hpp"

namespace tenon::assembly {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

namespace {

struct PortFrame {
  Mat3 R;
  Vec3 p;
};

PortFrame closure_frame(const Network& network, const Placement& at, const PortRef& ref) {
  const reduction::BodyPort& port = port_of(network, ref);
  const Mat3& R = at.R[static_cast<std::size_t>(ref.body)];
  return {R * port.axes, at.origin[static_cast<std::size_t>(ref.body)] + R * port.position};
}

// Rotation of a closing joint's child side against where its parent side and angle want it [rad], world axes. When the
// angle follows, what lies about the axis is free: the gap is the angle between the axes as the two sides see them.
Vec3 misalignment(const Joint& joint, const PortFrame& parent, const PortFrame& child) {
  if (joint.follows) return (parent.R * joint.axis).cross(child.R * joint.axis);
  const Mat3 wanted = parent.R * Eigen::AngleAxisd(joint.angle, joint.axis).toRotationMatrix();
  const Eigen::AngleAxisd turn(Mat3(child.R * wanted.transpose()));
  return turn.angle() * turn.axis();
}

// r: gap over size and misalignment of every closing joint; J: its derivative by the angles of the tree joints that
// follow. A joint turns all that hangs beyond it: δp = δθ axis × (p − p_joint), δR = δθ axis~ R.
struct Gaps {
  VectorXd r;
  MatrixXd J;
};

// The body is joined to the root through the joint.
bool hangs_beyond(const Network& network, const Placement& at, int body, int joint) {
  for (int j = at.tree_joint[static_cast<std::size_t>(body)]; j >= 0;
       j = at.tree_joint[static_cast<std::size_t>(body)]) {
    if (j == joint) return true;
    const Joint& inner = network.joints[static_cast<std::size_t>(j)];
    body = inner.child.body == body ? inner.parent.body : inner.child.body;
  }
  return false;
}

// +1 when a tree joint turns the child side of a closing joint against its parent side, −1 the other way, 0 both or
// none.
double turns(const Network& network, const Placement& at, const Joint& closing, int joint) {
  return (hangs_beyond(network, at, closing.child.body, joint) ? 1.0 : 0.0) -
         (hangs_beyond(network, at, closing.parent.body, joint) ? 1.0 : 0.0);
}

Gaps gaps(const Network& network, const Placement& at, const std::vector<int>& unknown) {
  const auto rows = 6 * static_cast<Index>(at.closing_joints.size());
  Gaps g{VectorXd::Zero(rows), MatrixXd::Zero(rows, static_cast<Index>(unknown.size()))};
  for (std::size_t c = 0; c < at.closing_joints.size(); ++c) {
    const Joint& closing = network.joints[static_cast<std::size_t>(at.closing_joints[c])];
    const PortFrame parent = closure_frame(network, at, closing.parent),
                    child = closure_frame(network, at, closing.child);
    const Index row = 6 * static_cast<Index>(c);
    g.r.segment<3>(row) = (child.p - parent.p) / at.size;
    g.r.segment<3>(row + 3) = misalignment(closing, parent, child);
    for (std::size_t k = 0; k < unknown.size(); ++k) {
      const Joint& joint = network.joints[static_cast<std::size_t>(unknown[k])];
      const bool outward = at.tree_joint[static_cast<std::size_t>(joint.child.body)] == unknown[k];
      const double side = turns(network, at, closing, unknown[k]);
      if (side == 0.0) continue;
      const Vec3 axis = (outward ? side : -side) * joint_axis(network, at, joint);
      const PortFrame hinge = closure_frame(network, at, joint.parent);
      const auto column = static_cast<Index>(k);
      g.J.col(column).segment<3>(row) = axis.cross((side > 0.0 ? child.p : parent.p) - hinge.p) / at.size;
      const Vec3 a = parent.R * closing.axis, b = child.R * closing.axis;
      g.J.col(column).segment<3>(row + 3) = !closing.follows ? axis
                                            : side > 0.0     ? a.cross(axis.cross(b))
                                                             : -axis.cross(a).cross(b);
    }
  }
  return g;
}

}  // namespace

Network close_angles(Network network) {
  if (std::none_of(network.joints.begin(), network.joints.end(), [](const Joint& j) { return j.follows; }))
    return network;
  constexpr int most_steps = 60;
  constexpr double largest_step = 0.5, closed = 1e-14;  // [rad]; of the size
  std::vector<int> unknown;
  Placement at = place_open(network);
  for (std::size_t j = 0; j < network.joints.size(); ++j)
    if (network.joints[j].follows &&
        std::find(at.closing_joints.begin(), at.closing_joints.end(), static_cast<int>(j)) == at.closing_joints.end())
      unknown.push_back(static_cast<int>(j));
  for (const int j : unknown)
    if (std::none_of(at.closing_joints.begin(), at.closing_joints.end(),
                     [&](int c) { return turns(network, at, network.joints[static_cast<std::size_t>(c)], j) != 0.0; }))
      throw ModelError(fmt::format("joint '{}' is in no loop that could decide its angle",
                                   network.joints[static_cast<std::size_t>(j)].name),
                       "Write `angle` in place of `near`");
  double last = INFINITY;
  for (int step = 0; step < most_steps; ++step) {
    const Gaps g = gaps(network, at, unknown);
    const double size = g.r.size() > 0 ? g.r.cwiseAbs().maxCoeff() : 0.0;
    if (size <= closed || (size < 1e-10 && size >= 0.5 * last)) break;  // as near as rounding lets it
    last = size;
    Eigen::CompleteOrthogonalDecomposition<MatrixXd> inverse;
    inverse.setThreshold(1e-9);
    VectorXd turn = inverse.compute(g.J).solve(-g.r);
    const double most = turn.size() > 0 ? turn.cwiseAbs().maxCoeff() : 0.0;
    if (most > largest_step) turn *= largest_step / most;
    for (std::size_t k = 0; k < unknown.size(); ++k)
      network.joints[static_cast<std::size_t>(unknown[k])].angle += turn[static_cast<Index>(k)];
    at = place_open(network);
  }
  for (const int j : at.closing_joints) {
    Joint& joint = network.joints[static_cast<std::size_t>(j)];
    const PortFrame parent = closure_frame(network, at, joint.parent), child = closure_frame(network, at, joint.child);
    const double gap = (child.p - parent.p).norm(), angle = misalignment(joint, parent, child).norm();
    if (gap > 1e-10 * at.size || angle > 1e-10)
      throw ModelError(
          fmt::format("the loop through joint '{}' ({} to {}) finds no configuration that closes it near the "
                      "given angles: gap {:.3g} m in a scene of {:.3g} m, angle {:.3g} rad",
                      joint.name, name(network, joint.parent), name(network, joint.child), gap, at.size, angle),
          "Give `near` angles closer to the wanted configuration, or check the lengths");
    if (!joint.follows) continue;  // its angle: what turns the parent side into the child side about the axis
    const Vec3 e = joint.axis.normalized().unitOrthogonal(), across = joint.axis.normalized().cross(e);
    const Vec3 seen = parent.R.transpose() * child.R * e;
    joint.angle = std::atan2(seen.dot(across), seen.dot(e));
  }
  return network;
}

}  // namespace tenon::assembly
