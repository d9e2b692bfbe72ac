#include "assembly/loop_kinematics.hpp"

#include <algorithm>
#include <cmath>

#include "assembly/kinematics.hpp"

namespace tenon::assembly {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;
using fem::Mat6X;

LoopCoordinates loop_coordinates(const Network& network, const OpenLoops& open, const PortTree& tree) {
  LoopCoordinates c;
  const double length = natural_length(tree.placement);
  std::vector<double> scale;
  const auto add = [&](int& first, Index count, double size) {
    first = static_cast<int>(scale.size());
    scale.insert(scale.end(), static_cast<std::size_t>(count), size);
  };
  c.root.assign(tree.branches.size(), -1);
  c.joint.assign(open.network.joints.size(), -1);
  c.body.assign(network.bodies.size(), -1);
  c.cut.assign(open.cuts.size(), -1);
  for (std::size_t k = 0; k < tree.branches.size(); ++k) {
    const Branch& branch = tree.branches[k];
    int rotations = 0;
    if (branch.parent < 0 && branch.outer_port < 0) {
      add(c.root[k], 3, 1.0);
      add(rotations, 3, 1.0 / length);
    }
    const auto j = static_cast<std::size_t>(std::max(branch.joint, 0));
    if (branch.joint >= 0 && open.network.joints[j].kind == JointKind::revolute) add(c.joint[j], 1, 1.0 / length);
    const auto b = static_cast<std::size_t>(branch.body);
    const ReducedBody& body = tree.bodies[b];
    c.body[b] = static_cast<int>(scale.size());
    for (const double amplitude : natural_amplitudes(body, length)) scale.push_back(amplitude);
  }
  for (std::size_t k = 0; k < open.cuts.size(); ++k)
    if (const int j = open.cuts[k].joint;
        j >= 0 && network.joints[static_cast<std::size_t>(j)].kind == JointKind::revolute)
      add(c.cut[k], 1, 1.0 / length);
  c.size = static_cast<Index>(scale.size());
  c.scale = Eigen::Map<const VectorXd>(scale.data(), c.size);
  return c;
}

LoopMotions::LoopMotions(const Network& network, const PortTree& tree, const LoopCoordinates& c) : tree_(tree), c_(c) {
  x_.assign(network.bodies.size(), Mat6X::Zero(6, c.size));
  for (std::size_t k = 0; k < tree.branches.size(); ++k) {
    const Branch& branch = tree.branches[k];
    Mat6X& x = x_[static_cast<std::size_t>(branch.body)];
    if (branch.parent < 0) {
      if (branch.outer_port < 0) x.middleCols<6>(c.root[k]).setIdentity();
      continue;
    }
    x = port({tree.branches[static_cast<std::size_t>(branch.parent)].body, branch.inner_port});
    if (branch.joint < 0) continue;
    const auto j = static_cast<std::size_t>(branch.joint);
    if (const int at = c.joint[j]; at >= 0)  // the joint's child turns against its parent
      x.col(at).tail<3>() += (branch.outward ? 1.0 : -1.0) * joint_axis(network, tree.placement, network.joints[j]);
  }
}

Mat6X LoopMotions::port(const PortRef& ref) const {
  const auto b = static_cast<std::size_t>(ref.body);
  const ReducedBody& body = tree_.bodies[b];
  const MatrixXd rows = port_rows(body, ref.port, tree_.placement.R[b]);
  Mat6X motion = rows.leftCols<6>() * x_[b];
  motion.middleCols(c_.body[b], body.n()) += rows.rightCols(body.n());
  return motion;
}

}  // namespace tenon::assembly
