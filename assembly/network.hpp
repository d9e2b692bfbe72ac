#pragma once

#include <optional>
#include <string>
#include <vector>

#include "reduction/reduced_body.hpp"

/// Bodies, joints and what acts on them: the value that every route of assembly reads.
namespace tenon::assembly {

using fem::Mat3;
using fem::Vec3;
using reduction::ReducedBody;

/// A body and the port of it.
struct PortRef {
  int body = 0;
  int port = 0;  ///< index into ReducedBody::ports
};

enum class JointKind { weld, revolute };

/// Joins the child's port to the parent's port. Child port axes = parent port axes · Rot(axis, angle) at rest.
struct Joint {
  std::string name;
  PortRef parent, child;
  JointKind kind = JointKind::weld;
  Vec3 axis = Vec3::UnitZ();  ///< unit vector in the parent port's axes (revolute)
  double angle = 0.0;         ///< [rad]
  bool follows = false;       ///< the loops decide the angle, near the one given: close_angles() finds it
  double stiffness = 0.0;     ///< about the axis [N m/rad]
  double damping = 0.0;       ///< about the axis [N m s/rad]
  double inertia = 0.0;       ///< of the drive, acts on the relative rotation [kg m²]
};

/// A lumped mass at a port, inertia about the port in body axes.
struct LumpedMass {
  std::string name;
  PortRef at;
  double mass = 0.0;
  Mat3 inertia = Mat3::Zero();
};

/// An input: a unit force or torque at a port (world axes), or the torque of a joint's drive (on the child, reaction on
/// the parent).
struct Input {
  std::string name;
  std::optional<PortRef> at;
  int direction = 0;         ///< 0..5 with `at`
  std::optional<int> joint;  ///< index
};

enum class Quantity { position, velocity, acceleration };

/// An output: one component of a port's motion (world axes), or the relative angle of a joint, or its rate or
/// acceleration.
struct Output {
  std::string name;
  Quantity quantity = Quantity::acceleration;
  std::optional<PortRef> at;
  int direction = 0;
  std::optional<int> joint;
};

struct Network {
  std::vector<ReducedBody> bodies;
  std::vector<Joint> joints;
  std::vector<LumpedMass> masses;
  std::vector<PortRef> ground;
  std::vector<Input> inputs;
  std::vector<Output> outputs;
};

/// Where each body lies at rest.
struct Placement {
  std::vector<Mat3> R;              ///< body axes → world axes
  std::vector<Vec3> origin;         ///< world position of each body frame's origin [m]
  std::vector<int> tree_joint;      ///< per body: the joint that placed it, −1 for roots
  std::vector<int> order;           ///< bodies, parents before children
  std::vector<int> closing_joints;  ///< joints that close loops
  double size = 0.0;                ///< diagonal of the box around all ports and references in the world [m]
};

/// Refers only to bodies and ports that exist, numbers are finite and of the right sign, welds carry no stiffness,
/// damping, inertia or drive. Throws ModelError naming the item.
void check(const Network& network);

/// Walks the joints from body 0 (then from any body not yet reached, which starts a tree of its own), the frame of each
/// root being the world frame. Throws ModelError when a loop does not close within 1e-6 of the size or 1e-6 rad (gap
/// and angle stated), or when check() does.
Placement place(const Network& network);
/// The same without a look at the loops: closing joints may gape.
Placement place_open(const Network& network);

const ReducedBody& body_of(const Network& network, const PortRef& ref);
const reduction::BodyPort& port_of(const Network& network, const PortRef& ref);
std::string name(const Network& network, const PortRef& ref);  ///< "panel.root"

}  // namespace tenon::assembly
