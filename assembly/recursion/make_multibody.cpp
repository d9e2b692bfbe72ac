#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <numeric>

#include "assembly/recursion/multibody.hpp"
#include "fem/error.hpp"

namespace tenon::assembly {

namespace {

// Axes whose z is the joint's axis a, in the parent port's axes: the least turn that takes z there,
// R = 1 + ṽ + ṽ²/(1 + c), v = z × a, c = z · a; half a turn about x where a = −z.
Mat3 axis_frame(const Joint& joint) {
  const Vec3 a = joint.axis.normalized();
  const double c = a.z();
  if (c < -1.0 + 1e-12) return Vec3(1.0, -1.0, -1.0).asDiagonal();
  const Mat3 v = fem::skew(Vec3::UnitZ().cross(a));
  return Mat3::Identity() + v + v * v / (1.0 + c);
}

struct HingeFrames {
  Mat3 parent, child;  // in the axes of the joint's two bodies
};

// Child port axes = parent port axes · Rot(axis, angle): both hinge frames coincide in the placed position.
HingeFrames hinge_frames(const Network& network, const Joint& joint) {
  const Mat3 Z = axis_frame(joint);
  const Mat3 turn = Eigen::AngleAxisd(joint.angle, joint.axis).toRotationMatrix();
  return {port_of(network, joint.parent).axes * Z, port_of(network, joint.child).axes * turn.transpose() * Z};
}

HingeKind kind_of(const Joint& joint) {
  return joint.kind == JointKind::revolute ? HingeKind::revolute : HingeKind::weld;
}

bool carries_drive(const Joint& joint) {
  return joint.stiffness != 0.0 || joint.damping != 0.0 || joint.inertia != 0.0;
}

// Which joints belong to the tree (Kruskal): those that carry a drive first, then those that an input drives, then
// those by which the network is placed, so that a joint of none of these closes the loop where there is one.
std::vector<bool> tree_joints(const Network& network, const Placement& placement) {
  const std::size_t count = network.joints.size();
  std::vector<int> rank(count, 3);
  for (const int j : placement.tree_joint)
    if (j >= 0) rank[static_cast<std::size_t>(j)] = 2;
  for (const Input& input : network.inputs)
    if (input.joint) rank[static_cast<std::size_t>(*input.joint)] = 1;
  for (std::size_t j = 0; j < count; ++j)
    if (carries_drive(network.joints[j])) rank[j] = 0;
  std::vector<std::size_t> order(count);
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return rank[a] < rank[b]; });

  std::vector<int> piece(network.bodies.size());  // bodies that are joined so far have the same
  std::iota(piece.begin(), piece.end(), 0);
  std::vector<bool> in_tree(count, false);
  for (const std::size_t j : order) {
    const int a = piece[static_cast<std::size_t>(network.joints[j].parent.body)],
              b = piece[static_cast<std::size_t>(network.joints[j].child.body)];
    if (a == b) continue;
    in_tree[j] = true;
    std::replace(piece.begin(), piece.end(), b, a);
  }
  return in_tree;
}

struct MultibodyBuilder {
  const Network& network;
  Placement placement;
  NetworkMultibody result;
  std::vector<bool> in_tree, used_ground;

  explicit MultibodyBuilder(const Network& net)
      : network(net), placement(place(net)), in_tree(tree_joints(net, placement)), used_ground(net.ground.size()) {
    result.body.assign(net.bodies.size(), -1);
    result.hinge.assign(net.joints.size(), -1);
    result.closure.assign(net.joints.size(), -1);
  }

  const Mat3& R(int body) const { return placement.R[static_cast<std::size_t>(body)]; }
  Vec3 place_of(int body, const Vec3& position) const {
    return placement.origin[static_cast<std::size_t>(body)] + R(body) * position;
  }

  HingedBody& add(int body) {
    HingedBody b;
    b.body = std::make_shared<const ReducedBody>(network.bodies[static_cast<std::size_t>(body)]);
    b.name = b.body->name;
    result.body[static_cast<std::size_t>(body)] = static_cast<int>(result.system.bodies.size());
    return result.system.bodies.emplace_back(std::move(b));
  }

  // A piece hangs by its first grounded port, or floats by the body that placement starts from.
  void add_root(int body, int port) {
    HingedBody& b = add(body);
    b.kind = port >= 0 ? HingeKind::weld : HingeKind::free;
    b.outer_port = port;
    b.inner_position = place_of(
        body, port >= 0 ? network.bodies[static_cast<std::size_t>(body)].ports[static_cast<std::size_t>(port)].position
                        : network.bodies[static_cast<std::size_t>(body)].reference);
    b.outer_axes = R(body).transpose();
  }

  void hang(int j, int from) {
    const Joint& joint = network.joints[static_cast<std::size_t>(j)];
    const HingeFrames frames = hinge_frames(network, joint);
    const bool outward = joint.parent.body == from;
    const PortRef &inner = outward ? joint.parent : joint.child, &outer = outward ? joint.child : joint.parent;
    HingedBody& b = add(outer.body);
    result.hinge[static_cast<std::size_t>(j)] = result.body[static_cast<std::size_t>(outer.body)];
    b.parent = result.body[static_cast<std::size_t>(from)];
    b.inner_port = inner.port;
    b.outer_port = outer.port;
    b.kind = kind_of(joint);
    b.reversed = !outward;
    b.inner_axes = outward ? frames.parent : frames.child;
    b.outer_axes = outward ? frames.child : frames.parent;
    b.stiffness = Eigen::VectorXd::Constant(b.dofs(), joint.stiffness);
    b.damping = Eigen::VectorXd::Constant(b.dofs(), joint.damping);
    b.inertia = Eigen::VectorXd::Constant(b.dofs(), joint.inertia);
  }

  void close(int j) {
    const Joint& joint = network.joints[static_cast<std::size_t>(j)];
    if (carries_drive(joint))
      throw ModelError(
          fmt::format("joint '{}' closes a loop and carries a drive, as every joint of the loop does; finite "
                      "motion takes drives only in joints of the tree",
                      joint.name),
          "Take stiffness, damping and inertia from one joint of the loop");
    const HingeFrames frames = hinge_frames(network, joint);
    Closure c;
    c.name = joint.name;
    c.inner = {result.body[static_cast<std::size_t>(joint.parent.body)], joint.parent.port};
    c.outer = {result.body[static_cast<std::size_t>(joint.child.body)], joint.child.port};
    c.kind = kind_of(joint);
    c.inner_axes = frames.parent;
    c.outer_axes = frames.child;
    result.closure[static_cast<std::size_t>(j)] = static_cast<int>(result.system.closures.size());
    result.system.closures.push_back(std::move(c));
  }

  void ground(const PortRef& ref) {
    Closure c;
    c.name = "ground of " + name(network, ref);
    c.inner = {-1, -1};
    c.outer = {result.body[static_cast<std::size_t>(ref.body)], ref.port};
    c.inner_position = place_of(ref.body, port_of(network, ref).position);
    c.outer_axes = R(ref.body).transpose();
    result.system.closures.push_back(std::move(c));
  }

  bool reached(int body) const { return result.body[static_cast<std::size_t>(body)] >= 0; }

  // Breadth first along the joints of the tree, from the bodies listed from `first` on.
  void grow(std::size_t first, std::vector<int>& order) {
    for (std::size_t at = first; at < order.size(); ++at)
      for (std::size_t j = 0; j < network.joints.size(); ++j) {
        const Joint& joint = network.joints[j];
        if (!in_tree[j] || (joint.parent.body != order[at] && joint.child.body != order[at])) continue;
        const int other = joint.parent.body == order[at] ? joint.child.body : joint.parent.body;
        if (reached(other)) continue;
        hang(static_cast<int>(j), order[at]);
        order.push_back(other);
      }
  }

  void add_lump(const LumpedMass& lump) {
    HingedBody b;
    b.name = lump.name;
    b.body = std::make_shared<const ReducedBody>(reduction::rigid_body(
        lump.name, lump.mass, Vec3::Zero(), lump.inertia, {{"centre", Vec3::Zero(), Mat3::Identity(), {}}}));
    b.parent = result.body[static_cast<std::size_t>(lump.at.body)];
    b.inner_port = lump.at.port;
    b.outer_port = 0;
    result.system.bodies.push_back(std::move(b));
  }
};

}  // namespace

NetworkMultibody make_multibody(const Network& network) {
  MultibodyBuilder b(network);
  std::vector<int> order;
  for (std::size_t g = 0; g < network.ground.size(); ++g) {
    const PortRef& ref = network.ground[g];
    if (b.reached(ref.body)) continue;
    b.used_ground[g] = true;
    b.add_root(ref.body, ref.port);
    order.push_back(ref.body);
    b.grow(order.size() - 1, order);
  }
  for (const int body : b.placement.order) {
    if (b.reached(body)) continue;
    b.add_root(body, -1);
    order.push_back(body);
    b.grow(order.size() - 1, order);
  }
  for (std::size_t j = 0; j < network.joints.size(); ++j)
    if (!b.in_tree[j]) b.close(static_cast<int>(j));
  for (std::size_t g = 0; g < network.ground.size(); ++g)
    if (!b.used_ground[g]) b.ground(network.ground[g]);
  for (const LumpedMass& lump : network.masses) b.add_lump(lump);
  index(b.result.system);
  return std::move(b.result);
}

}  // namespace tenon::assembly
