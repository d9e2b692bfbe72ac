#include "assembly/sweep.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <numbers>

#include "assembly/close_angles.hpp"
#include "fem/error.hpp"

namespace tenon::assembly {

namespace {

SweepPoint at_angle(const Network& network, int joint, const SweepOptions& options) {
  SweepPoint point{
      .angle = network.joints[static_cast<std::size_t>(joint)].angle, .angles = {}, .omega = {}, .shapes = {}};
  for (const Joint& j : network.joints) point.angles.push_back(j.angle);
  const SecondOrderSystem system = second_order(network);
  const SystemModes found = modes(system);
  const Eigen::Index kept = std::min<Eigen::Index>(found.rigid + options.modes, found.omega.size());
  point.rigid = found.rigid;
  point.omega = found.omega.head(kept);
  if (options.shapes) point.shapes = node_motions(network, system, found.shapes.leftCols(kept));
  return point;
}

}  // namespace

std::vector<SweepPoint> sweep(const Network& network, int joint, const SweepOptions& options,
                              const reduction::Progress& progress) {
  const auto swept = static_cast<std::size_t>(joint);
  if (network.joints[swept].kind != JointKind::revolute)
    throw ModelError(fmt::format("joint '{}' does not turn", network.joints[swept].name), "Name a revolute joint");
  if (options.steps < 1) throw ModelError("a sweep has no points", "Ask for at least one step");
  Network moving = network;
  moving.joints[swept].follows = false;
  if (options.hold) {  // what is between the sides of a clamped joint has no motion to act on
    Joint& held = moving.joints[swept];
    held.stiffness = held.damping = held.inertia = 0.0;
    std::erase_if(moving.inputs, [&](const Input& input) { return input.joint == joint; });
    std::erase_if(moving.outputs, [&](const Output& output) { return output.joint == joint; });
  }
  std::vector<SweepPoint> points;
  for (int k = 0; k < options.steps; ++k) {
    const double t = options.steps > 1 ? static_cast<double>(k) / (options.steps - 1) : 0.0;
    const double angle = (1.0 - t) * options.from + t * options.to;
    moving.joints[swept].angle = angle;
    try {
      moving = close_angles(moving);
    } catch (const ModelError& fault) {
      throw ModelError(
          fmt::format("at {:.6g} deg of joint '{}'", angle * 180.0 / std::numbers::pi, network.joints[swept].name),
          fault);
    }
    Network still = moving;
    if (options.hold) {
      Joint& held = still.joints[swept];
      const Mat3 turn = Eigen::AngleAxisd(held.angle, held.axis.normalized()).toRotationMatrix();
      reduction::BodyPort& side =
          still.bodies[static_cast<std::size_t>(held.child.body)].ports[static_cast<std::size_t>(held.child.port)];
      side.axes = side.axes * turn.transpose();  // a weld has no angle: the child's port takes it
      held.kind = JointKind::weld;
      held.angle = 0.0;
    }
    points.push_back(at_angle(still, joint, options));
    points.back().angle = angle;
    if (progress) progress(static_cast<double>(k + 1) / options.steps, "sweep");
  }
  return points;
}

}  // namespace tenon::assembly
