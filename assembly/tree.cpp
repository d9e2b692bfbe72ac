#include "assembly/tree.hpp"

#include "assembly/kinematics.hpp"
#include "assembly/spanning_tree.hpp"

namespace tenon::assembly {

using Eigen::Index;
using Eigen::MatrixXd;
using fem::Mat6;
using fem::Mat6X;

namespace {

// M_m(k) over (η, x_ref), eq (23), with the lumped masses at the body's ports: [Πᵀ; φ] M_l [Π φ*]
MatrixXd modal_mass(const Network& network, int k, const Mat3& R) {
  const ReducedBody& body = network.bodies[static_cast<std::size_t>(k)];
  const Index n = body.n();
  const Mat6 R6 = fem::rotation6(R);
  MatrixXd M(n + 6, n + 6);
  M << MatrixXd::Identity(n, n), body.L * R6.transpose(),  //
      R6 * body.L.transpose(), R6 * body.D * R6.transpose();
  for (const LumpedMass& lump : network.masses) {
    if (lump.at.body != k) continue;
    const MatrixXd port = port_rows(body, lump.at.port, R);
    MatrixXd swapped(6, n + 6);
    swapped << port.rightCols(n), port.leftCols<6>();
    M += swapped.transpose() * lumped_mass(lump, R) * swapped;
  }
  return M;
}

// How a body hangs: hinge map, the vectors to the hinge and the shapes on both sides of it.
void hang(TreeBody& t, const Branch& branch, const std::vector<Branch>& branches, const Network& network,
          const Placement& placement) {
  const auto body_at = [&](int k) -> const ReducedBody& { return network.bodies[static_cast<std::size_t>(k)]; };
  const auto shapes = [&](int k, int port) {
    return Mat6X(fem::rotation6(placement.R[static_cast<std::size_t>(k)]) *
                 body_at(k).ports[static_cast<std::size_t>(port)].Phi);
  };
  const auto to_port = [&](int k, int port) {
    const ReducedBody& body = body_at(k);
    return Vec3(placement.R[static_cast<std::size_t>(k)] *
                (body.ports[static_cast<std::size_t>(port)].position - body.reference));
  };
  t.Pi_d = Mat6X::Zero(6, t.modes());
  t.Pi_t.resize(6, 0);
  t.H_star.resize(6, 0);
  if (branch.outer_port < 0) {  // free root: six coordinates of its own frame
    t.H_star = Mat6::Identity();
  } else {
    t.Pi_d = shapes(branch.body, branch.outer_port);
    t.reference_to_hinge = to_port(branch.body, branch.outer_port);
  }
  double stiffness = 0.0, inertia = 0.0;
  if (branch.parent >= 0) {
    const int parent = branches[static_cast<std::size_t>(branch.parent)].body;
    t.Pi_t = shapes(parent, branch.inner_port);
    t.parent_to_hinge = to_port(parent, branch.inner_port);
    const Joint& joint = network.joints[static_cast<std::size_t>(branch.joint)];
    if (joint.kind == JointKind::revolute) {
      t.H_star = Mat6X::Zero(6, 1);
      t.H_star.bottomRows<3>() = (branch.outward ? 1.0 : -1.0) * joint_axis(network, placement, joint);
      stiffness = joint.stiffness;
      inertia = joint.inertia;
    }
  }
  t.hinge_stiffness = Eigen::VectorXd::Constant(t.hinge_dofs(), stiffness);
  t.hinge_inertia = Eigen::VectorXd::Constant(t.hinge_dofs(), inertia);
}

// φ*(O_k, k): a twist from the hinge to the body's reference
Mat6 hinge_to_reference(const TreeBody& t) { return fem::tau(-t.reference_to_hinge); }

// 𝓗*(k) = [1 0; −Π_F^d H_F*], (n+6)×(n+n_r), eq (13) with Π_F^d = φ*(d_k, k) Π^d: the deformation lives at node d_k
MatrixXd modal_hinge_map(const TreeBody& t) {
  const Index n = t.modes(), r = t.hinge_dofs();
  const Mat6 inward = hinge_to_reference(t);
  MatrixXd H = MatrixXd::Zero(n + 6, n + r);
  H.topLeftCorner(n, n).setIdentity();
  H.bottomLeftCorner(6, n) = -inward * t.Pi_d;
  H.bottomRightCorner(6, r) = inward * t.H_star;
  return H;
}

// 𝓐(parent) φ(t, k) = [Π_tᵀ; φ(parent, t)] φ(t, k), (n_parent+6)×6: wrenches at the child's reference to modal forces
// of the parent, eqs (12), (14), (15); its transpose takes the parent's modal velocity to the child's reference.
MatrixXd to_parent(const TreeBody& child) {
  const Mat6 phi = hinge_to_reference(child).transpose();  // φ(t, k), O_k⁺ at t
  const Index n = child.Pi_t.cols();
  MatrixXd A(n + 6, 6);
  A.topRows(n) = child.Pi_t.transpose() * phi;
  A.bottomRows<6>() = fem::tau(child.parent_to_hinge).transpose() * phi;
  return A;
}

}  // namespace

Tree make_tree(const Network& network) {
  const Placement placement = place(network);
  const std::vector<Branch> branches = spanning_tree(network, placement, "the recursive route");
  Tree tree;
  for (const Branch& branch : branches) {
    const ReducedBody& body = network.bodies[static_cast<std::size_t>(branch.body)];
    TreeBody t;
    t.name = body.name;
    t.body = branch.body;
    t.parent = branch.parent;
    t.M = modal_mass(network, branch.body, placement.R[static_cast<std::size_t>(branch.body)]);
    t.K = body.omega.cwiseAbs2().asDiagonal();
    hang(t, branch, branches, network, placement);
    tree.offset.push_back(tree.n);
    tree.n += t.modes() + t.hinge_dofs();
    tree.bodies.push_back(std::move(t));
  }
  return tree;
}

MatrixXd composite_mass_matrix(const Tree& tree) {
  const auto count = static_cast<int>(tree.bodies.size());
  const auto at = [&](int k) -> const TreeBody& { return tree.bodies[static_cast<std::size_t>(k)]; };
  const auto offset = [&](int k) { return tree.offset[static_cast<std::size_t>(k)]; };
  MatrixXd mass = MatrixXd::Zero(tree.n, tree.n);
  std::vector<MatrixXd> R, H_star, A;
  for (const TreeBody& t : tree.bodies) {
    R.push_back(t.M);
    H_star.push_back(modal_hinge_map(t));
    A.push_back(to_parent(t));
  }
  for (int k = count - 1; k >= 0; --k) {  // tip to base
    const auto b = static_cast<std::size_t>(k);
    MatrixXd X = R[b] * H_star[b];  // X(k) = R(k) 𝓗*(k)
    const Index width = X.cols();
    mass.block(offset(k), offset(k), width, width) = H_star[b].transpose() * X;  // M(k, k) = 𝓗(k) X(k)
    mass.diagonal().segment(offset(k) + at(k).modes(), at(k).hinge_dofs()) += at(k).hinge_inertia;
    for (int child = k, j = at(k).parent; j >= 0; child = j, j = at(j).parent) {
      const auto p = static_cast<std::size_t>(j);
      X = (A[static_cast<std::size_t>(child)] * X.bottomRows<6>()).eval();  // X(j) = 𝓐(j) φ(t_j, child) X^r(child)
      const MatrixXd block = H_star[p].transpose() * X;                     // M(j, k) = 𝓗(j) X(j)
      mass.block(offset(j), offset(k), block.rows(), width) = block;
      mass.block(offset(k), offset(j), width, block.rows()) = block.transpose();
    }
    if (at(k).parent >= 0)  // R(parent) += 𝓐 φ R^rr(k) φ* 𝓐*
      R[static_cast<std::size_t>(at(k).parent)] += A[b] * R[b].bottomRightCorner<6, 6>() * A[b].transpose();
  }
  return mass;
}

MatrixXd stiffness(const Tree& tree) {
  MatrixXd K = MatrixXd::Zero(tree.n, tree.n);
  for (std::size_t k = 0; k < tree.bodies.size(); ++k) {
    const TreeBody& t = tree.bodies[k];
    K.block(tree.offset[k], tree.offset[k], t.modes(), t.modes()) = t.K;
    K.diagonal().segment(tree.offset[k] + t.modes(), t.hinge_dofs()) = t.hinge_stiffness;
  }
  return K;
}

// V_m(k) = Φ*(parent, k) V_m(parent) + 𝓗*(k) χ(k), eq (11), base to tip, for unit χ
MatrixXd kinematic_map(const Tree& tree, const Network& network) {
  std::vector<Index> row{0};
  for (const ReducedBody& body : network.bodies) row.push_back(row.back() + 6 + body.n());
  MatrixXd J = MatrixXd::Zero(row.back(), tree.n);
  std::vector<MatrixXd> V;  // per body, over (η, x_ref)
  for (std::size_t k = 0; k < tree.bodies.size(); ++k) {
    const TreeBody& t = tree.bodies[k];
    const Index n = t.modes();
    MatrixXd motion = MatrixXd::Zero(n + 6, tree.n);
    if (t.parent >= 0) motion.bottomRows<6>() = to_parent(t).transpose() * V[static_cast<std::size_t>(t.parent)];
    motion.middleCols(tree.offset[k], n + t.hinge_dofs()) += modal_hinge_map(t);
    const Index first = row[static_cast<std::size_t>(t.body)];
    J.middleRows<6>(first) = motion.bottomRows<6>();
    J.middleRows(first + 6, n) = motion.topRows(n);
    V.push_back(std::move(motion));
  }
  return J;
}

}  // namespace tenon::assembly
