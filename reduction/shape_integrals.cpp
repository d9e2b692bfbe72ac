#include "reduction/shape_integrals.hpp"

#include <fmt/format.h>

#include <array>
#include <cmath>

#include "fem/error.hpp"
#include "reduction/dense.hpp"
#include "reduction/sparse.hpp"

namespace tenon::reduction {

namespace {

using Columns = Eigen::MatrixXd;

// Velocity fields over the rows of some mass matrix M.
struct Fields {
  Columns R;                   // unit rotations about the reference, ×3
  Columns Pi;                  // shapes, ×n
  std::array<Columns, 3> X;    // E_c Π: the shapes under a unit rotation about c, ×n each
  std::array<Columns, 3> M_X;  // M E_c Π
};

// J(η) = R(η)ᵀ M R(η) and C(η)_i = R(η)ᵀ M Π_i with R(η)_c = R_c + X_c η
ShapeIntegrals integrals(const Fields& f) {
  const Eigen::Index n = f.Pi.cols();
  ShapeIntegrals out;
  out.J1.resize(6, n);
  out.J2.resize(6 * n, n);
  out.C1.resize(3 * n, n);
  std::array<Columns, 3> RMX;
  for (std::size_t c = 0; c < 3; ++c) {
    RMX[c] = transposed_product(f.R, f.M_X[c]);
    const Columns G = transposed_product(f.M_X[c], f.Pi);  // row k, column i: (e_c × ψ_k) · ψ_i = e_c · ψ_k × ψ_i
    for (Eigen::Index i = 0; i < n; ++i)
      for (Eigen::Index k = 0; k < n; ++k) out.C1(3 * i + static_cast<Eigen::Index>(c), k) = 0.5 * (G(k, i) - G(i, k));
  }
  for (Eigen::Index e = 0; e < 6; ++e) {
    const int c = symmetric_row[e], d = symmetric_column[e];
    const auto uc = static_cast<std::size_t>(c), ud = static_cast<std::size_t>(d);
    out.J1.row(e) = RMX[ud].row(c) + RMX[uc].row(d);
    const Columns G = transposed_product(f.X[uc], f.M_X[ud]);
    for (Eigen::Index i = 0; i < n; ++i)
      for (Eigen::Index k = 0; k < n; ++k) out.J2(6 * i + e, k) = G(i, k) + G(k, i);
  }
  return out;
}

// e_c × a
Vec3 cross_axis(std::size_t c, const Vec3& a) { return Vec3::Unit(static_cast<Eigen::Index>(c)).cross(a); }

NodeGyroscopics node_gyroscopics(std::span<const LumpedNode> nodes, const Eigen::Ref<const Eigen::MatrixXd>& shapes) {
  const Eigen::Index n = shapes.cols();
  NodeGyroscopics sum;
  sum.C0 = Eigen::Matrix3Xd::Zero(3, n);
  sum.A = Eigen::Matrix3Xd::Zero(3, 3 * n);
  sum.T = Eigen::MatrixXd::Zero(3 * n, n);
  sum.B = Eigen::MatrixXd::Zero(3 * n, n);
  sum.U = Eigen::MatrixXd::Zero(n * n, n);
  for (std::size_t j = 0; j < nodes.size(); ++j) {
    const Mat3& J = nodes[j].inertia;
    if (J.isZero(0.0)) continue;
    const Eigen::Matrix3Xd theta = shapes.middleRows<3>(6 * static_cast<Eigen::Index>(j) + 3);
    const Eigen::Matrix3Xd J_theta = J * theta;
    sum.J += J;
    sum.C0 += J_theta;
    for (Eigen::Index i = 0; i < n; ++i) {
      const Vec3 theta_i = theta.col(i);
      sum.A.middleCols<3>(3 * i) += fem::skew(theta_i) * J;
      for (Eigen::Index k = 0; k < n; ++k) {
        const Vec3 theta_ik = theta_i.cross(Vec3(theta.col(k)));
        sum.T.block<3, 1>(3 * i, k) += theta_i.cross(Vec3(J_theta.col(k)));
        sum.B.block<3, 1>(3 * i, k) += J * theta_ik;
        sum.U.row(i * n + k) += theta_ik.transpose() * J_theta;  // θ_i · (θ_k × Jθ_l) = (θ_i × θ_k) · Jθ_l
      }
    }
  }
  return sum;
}

}  // namespace

ShapeIntegrals shape_integrals(std::span<const LumpedNode> nodes, const Eigen::Ref<const Eigen::MatrixXd>& shapes,
                               const Vec3& reference) {
  const auto N = static_cast<Eigen::Index>(nodes.size()), n = shapes.cols();
  if (shapes.rows() != 6 * N)
    throw ModelError(fmt::format("the shapes have {} rows for {} lumped nodes", shapes.rows(), N),
                     "Give six rows a node: translation, rotation");
  // rows √m_j (·) of the nodes' centres of mass, so that M = 1
  Fields f{Columns(3 * N, 3), Columns(3 * N, n), {}, {}};
  for (Columns& X : f.X) X.resize(3 * N, n);
  for (Eigen::Index j = 0; j < N; ++j) {
    const LumpedNode& node = nodes[static_cast<std::size_t>(j)];
    if (!(node.mass >= 0.0))
      throw ModelError(fmt::format("lumped node {} has the mass {} kg", j, node.mass), "Give a mass >= 0");
    const double root = std::sqrt(node.mass);
    const Vec3 l = root * (node.position + node.offset - reference);
    const Eigen::Matrix3Xd psi = root * (shapes.middleRows<3>(6 * j) -  // ψ − p̃ θ
                                         fem::skew(node.offset) * shapes.middleRows<3>(6 * j + 3));
    f.R.middleRows<3>(3 * j) = -fem::skew(l);
    f.Pi.middleRows<3>(3 * j) = psi;
    for (std::size_t c = 0; c < 3; ++c)
      f.X[c].middleRows<3>(3 * j) = fem::skew(Vec3::Unit(static_cast<Eigen::Index>(c))) * psi;
  }
  f.M_X = f.X;
  ShapeIntegrals out = integrals(f);
  for (const LumpedNode& node : nodes)
    if (!node.inertia.isZero(0.0)) {
      out.nodes = node_gyroscopics(nodes, shapes);
      break;
    }
  return out;
}

ShapeIntegrals shape_integrals(const fem::Structure& structure, const Eigen::Ref<const Eigen::MatrixXd>& shapes,
                               const Vec3& reference) {
  if (shapes.rows() != structure.n())
    throw ModelError(fmt::format("the shapes have {} rows where the mass matrix has {}", shapes.rows(), structure.n()),
                     "Give one row a free dof");
  Fields f{fem::rigid_motions(structure, reference).rightCols<3>(), shapes, {}, {}};
  for (Columns& X : f.X) X = Columns::Zero(shapes.rows(), shapes.cols());
  std::vector<char> turns(structure.nodes.size(), 1);  // scalar points do not move with a rigid body
  for (const int point : structure.scalar_points) turns[static_cast<std::size_t>(point)] = 0;
  int node = -1;
  Mat6X u;
  for (Eigen::Index row = 0; row < shapes.rows(); ++row) {
    const fem::Dof& dof = structure.dofs.free[static_cast<std::size_t>(row)];
    if (!turns[static_cast<std::size_t>(dof.node)]) continue;
    if (dof.node != node) u = structure.dofs.expand_node(node = dof.node, shapes);
    const Eigen::Index first = dof.direction < 3 ? 0 : 3, direction = dof.direction - first;
    for (Eigen::Index i = 0; i < shapes.cols(); ++i)
      for (std::size_t c = 0; c < 3; ++c) f.X[c](row, i) = cross_axis(c, u.block<3, 1>(first, i))[direction];
  }
  for (std::size_t c = 0; c < 3; ++c) f.M_X[c] = symmetric_product(structure.M, f.X[c]);
  return integrals(f);
}

}  // namespace tenon::reduction
