#include "assembly/disjoint.hpp"

#include <fmt/format.h>

#include <Eigen/Eigenvalues>
#include <cmath>

#include "assembly/kinematics.hpp"
#include "reduction/roots.hpp"

namespace tenon::assembly {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::RowVectorXd;
using fem::Mat6;
using fem::Vec6;

namespace {

// Rows gathered one after the other; sized once.
struct Rows {
  MatrixXd matrix;
  Index used = 0;
  Rows(Index rows, Index columns) : matrix(MatrixXd::Zero(rows, columns)) {}
  auto next(Index count) {
    used += count;
    return matrix.middleRows(used - count, count);
  }
};

struct DisjointBuilder {
  const Network& network;
  DisjointSystem& d;
  Index n;

  const ReducedBody& body(int k) const { return network.bodies[static_cast<std::size_t>(k)]; }
  const Mat3& R(int k) const { return d.placement.R[static_cast<std::size_t>(k)]; }
  Index offset(int k) const { return d.offset[static_cast<std::size_t>(k)]; }

  // motion of a port over all of q
  MatrixXd port(const PortRef& ref) const {
    MatrixXd rows = MatrixXd::Zero(6, n);
    rows.middleCols(offset(ref.body), 6 + body(ref.body).n()) = port_rows(body(ref.body), ref.port, R(ref.body));
    return rows;
  }

  // motion of a joint's child port relative to its parent port
  MatrixXd relative(const Joint& joint) const { return port(joint.child) - port(joint.parent); }

  // relative angle of a joint, child against parent about the axis
  RowVectorXd angle(const Joint& joint) const {
    return joint_axis(network, d.placement, joint).transpose() * relative(joint).bottomRows<3>();
  }

  // the displacement an input works on or an output reads
  RowVectorXd motion(const std::optional<PortRef>& at, int direction, const std::optional<int>& joint) const {
    return at ? RowVectorXd(port(*at).row(direction)) : angle(network.joints[static_cast<std::size_t>(*joint)]);
  }

  // the next row of G, and the unit of what it transmits
  void name_row(std::string row, const char* unit) const {
    d.row_names.push_back(std::move(row));
    d.row_units.emplace_back(unit);
  }
};

// E with EᵀE = C
MatrixXd damping_root(const ReducedBody& body) {
  if (body.C.size() == 0) return Eigen::VectorXd((2.0 * body.zeta.cwiseProduct(body.omega)).cwiseSqrt()).asDiagonal();
  const Eigen::SelfAdjointEigenSolver<MatrixXd> eigen(body.C);
  return eigen.eigenvalues().cwiseMax(0.0).cwiseSqrt().asDiagonal() * eigen.eigenvectors().transpose();
}

// [D Lᵀ; L 1] in world axes and its root [S 0; L 1], SᵀS = D − LᵀL
void add_body(const DisjointBuilder& b, int k, Rows& W, Rows& E, Rows& F) {
  const ReducedBody& body = b.body(k);
  const Index o = b.offset(k), m = body.n();
  const Mat6 R6 = fem::rotation6(b.R(k));
  const MatrixXd L = body.L * R6.transpose();
  b.d.M.block<6, 6>(o, o) = R6 * body.D * R6.transpose();
  b.d.M.block(o, o + 6, 6, m) = L.transpose();
  b.d.M.block(o + 6, o, m, 6) = L;
  b.d.M.block(o + 6, o + 6, m, m).setIdentity();
  b.d.K.diagonal().segment(o + 6, m) = body.omega.cwiseAbs2();
  b.d.C.block(o + 6, o + 6, m, m) = reduction::damping(body);
  W.next(6).middleCols<6>(o) =
      reduction::mass_root(body.D - body.L.transpose() * body.L, body.D.diagonal()) * R6.transpose();
  auto flexible = W.next(m);
  flexible.middleCols<6>(o) = L;
  flexible.middleCols(o + 6, m).setIdentity();
  F.next(m).middleCols(o + 6, m).diagonal() = body.omega;
  E.next(m).middleCols(o + 6, m) = damping_root(body);
}

// 1 m, 1/length rad and the natural amplitude of each mode. (A mode that stands for a massless direction moves its port
// many orders more than its neighbours.)
void scale_body(const DisjointBuilder& b, int k) {
  const ReducedBody& body = b.body(k);
  const Index o = b.offset(k);
  const double length = natural_length(b.d.placement);
  b.d.scale.segment<3>(o).setOnes();
  b.d.scale.segment<3>(o + 3).setConstant(1.0 / length);
  b.d.scale.segment(o + 6, body.n()) = natural_amplitudes(body, length);
}

void add_joint_rows(const DisjointBuilder& b, const Joint& joint, Rows& G) {
  const MatrixXd relative = b.relative(joint);
  const auto label = [&](const char* what, const char* unit) {
    b.name_row(fmt::format("joint '{}', {}", joint.name, what), unit);
  };
  if (joint.kind == JointKind::weld) {
    G.next(6) = relative;
    for (std::size_t i = 0; i < 6; ++i) label(direction_names[i], i < 3 ? "N" : "N m");
    return;
  }
  const Vec3 axis = joint_axis(b.network, b.d.placement, joint), e1 = axis.unitOrthogonal(), e2 = axis.cross(e1);
  G.next(3) = relative.topRows<3>();
  for (std::size_t i = 0; i < 3; ++i) label(direction_names[i], "N");
  G.next(1) = e1.transpose() * relative.bottomRows<3>();
  G.next(1) = e2.transpose() * relative.bottomRows<3>();
  label("rotation across the axis", "N m");
  label("second rotation across the axis", "N m");
}

}  // namespace

DisjointSystem disjoint(const Network& network) {
  DisjointSystem d;
  d.placement = place(network);
  Index n = 0;
  for (const ReducedBody& body : network.bodies) {
    d.offset.push_back(static_cast<int>(n));
    n += 6 + body.n();
  }
  const auto bodies = static_cast<int>(network.bodies.size());
  const auto joints = static_cast<Index>(network.joints.size());
  const Index modes = n - 6 * bodies;
  d.M = d.C = d.K = MatrixXd::Zero(n, n);
  d.scale.resize(n);
  const DisjointBuilder b{network, d, n};

  Rows W(n + 6 * static_cast<Index>(network.masses.size()) + joints, n), E(modes + joints, n), F(modes + joints, n);
  for (int k = 0; k < bodies; ++k) {
    add_body(b, k, W, E, F);
    scale_body(b, k);
  }
  for (const LumpedMass& lump : network.masses) {
    const MatrixXd rows = b.port(lump.at);
    const Mat6 M = lumped_mass(lump, b.R(lump.at.body));
    Vec6 scale;
    scale << Vec3::Constant(lump.mass), Vec3::Constant(lump.inertia.trace());
    d.M += rows.transpose() * M * rows;
    W.next(6) = reduction::mass_root(M, scale) * rows;
  }
  Rows G(6 * joints + 6 * static_cast<Index>(network.ground.size()), n);
  for (const Joint& joint : network.joints) {
    add_joint_rows(b, joint, G);
    if (joint.kind != JointKind::revolute) continue;
    const RowVectorXd angle = b.angle(joint);
    d.M += joint.inertia * angle.transpose() * angle;
    d.C += joint.damping * angle.transpose() * angle;
    d.K += joint.stiffness * angle.transpose() * angle;
    if (joint.inertia > 0.0) W.next(1) = std::sqrt(joint.inertia) * angle;
    if (joint.damping > 0.0) E.next(1) = std::sqrt(joint.damping) * angle;
    if (joint.stiffness > 0.0) F.next(1) = std::sqrt(joint.stiffness) * angle;
  }
  for (const PortRef& ref : network.ground) {
    G.next(6) = b.port(ref);
    for (std::size_t i = 0; i < 6; ++i)
      b.name_row(fmt::format("ground of {}, {}", name(network, ref), direction_names[i]), i < 3 ? "N" : "N m");
  }
  d.mass_root = W.matrix.topRows(W.used);
  d.damping_root = E.matrix.topRows(E.used);
  d.stiffness_root = F.matrix.topRows(F.used);
  d.G = G.matrix.topRows(G.used);

  d.B = MatrixXd::Zero(n, static_cast<Index>(network.inputs.size()));
  for (std::size_t i = 0; i < network.inputs.size(); ++i) {
    const Input& input = network.inputs[i];
    d.B.col(static_cast<Index>(i)) = b.motion(input.at, input.direction, input.joint).transpose();
  }
  d.position_rows = MatrixXd::Zero(static_cast<Index>(network.outputs.size()), n);
  for (std::size_t i = 0; i < network.outputs.size(); ++i) {
    const Output& output = network.outputs[i];
    d.position_rows.row(static_cast<Index>(i)) = b.motion(output.at, output.direction, output.joint);
  }
  return d;
}

}  // namespace tenon::assembly
