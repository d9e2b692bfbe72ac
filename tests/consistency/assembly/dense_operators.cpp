#include "tests/consistency/assembly/dense_operators.hpp"

namespace tenon::assembly::testing {

MatrixXd DenseOperators::mass() const { return H * Phi * M_m * Phi.transpose() * H.transpose() + rotors; }

Mat6 twist_matrix(const RigidMotion& X) {
  Mat6 T = Mat6::Zero();
  T.topLeftCorner<3, 3>() = T.bottomRightCorner<3, 3>() = X.R.transpose();
  T.topRightCorner<3, 3>() = -X.R.transpose() * fem::skew(X.r);
  return T;
}

DenseOperators dense_operators(const Multibody& mb, const Sweeps& sweeps) {
  DenseOperators d;
  Index rows = 0;
  for (const HingedBody& b : mb.bodies) {
    d.row.push_back(rows);
    rows += b.modes() + 6;
  }
  d.H = MatrixXd::Zero(mb.nv, rows);
  d.E_phi = MatrixXd::Zero(rows, rows);
  d.M_m = MatrixXd::Zero(rows, rows);
  d.rotors = MatrixXd::Zero(mb.nv, mb.nv);
  for (std::size_t k = 0; k < mb.bodies.size(); ++k) {
    const HingedBody& b = mb.bodies[k];
    const BodySweep& s = sweeps.bodies[k];
    const Index n = b.modes(), r = b.dofs(), first = mb.v_offset[k];
    d.M_m.block(d.row[k], d.row[k], n + 6, n + 6) = s.M;
    d.H.block(first, d.row[k], n, n).setIdentity();  // (13)
    if (s.Pi_F.cols() > 0) d.H.block(first, d.row[k] + n, n, 6) = -s.Pi_F.transpose();
    d.H.block(first + n, d.row[k] + n, r, 6) = s.H_F.transpose();
    d.rotors.diagonal().segment(first + n, r) = b.inertia;
    if (b.parent < 0) continue;
    const auto p = static_cast<std::size_t>(b.parent);
    const Index n_p = mb.bodies[p].modes();
    const Mat6 wrench = twist_matrix(s.X).transpose();
    MatrixXd A(n_p + 6, 6);  // (15)
    A.topRows(n_p).setZero();
    if (s.Pi_t.cols() > 0) A.topRows(n_p) = s.Pi_t.transpose();
    A.bottomRows<6>() = fem::tau(s.to_node).transpose();
    d.E_phi.block(d.row[p], d.row[k] + n, n_p + 6, 6) = A * wrench;  // (12)
  }
  d.Phi = (MatrixXd::Identity(rows, rows) - d.E_phi).inverse();
  return d;
}

}  // namespace tenon::assembly::testing
