#include <vector>

#include "fem/rigid_motion.hpp"
#include "reduction/body_terms.hpp"

// Motion relative to x_Q: χ_i = ψ_i − t_i − r_i × l', l' = x − x_Q, [t_i; r_i] = Φ_i; then ψ_k' = Σ_i V_ik χ_i.
// Everything is a second moment of mass. With l = x − x_ref, d = x_Q − x_ref:
//   P = ∫ l lᵀ,  F_i = ∫ ψ_i lᵀ,  W_ik = ∫ ψ_i ψ_kᵀ
// are what J0, (J1, C0), (J2, C1) hold: for Y any of them, 2 tr(Y) 1 − Y − Yᵀ is the inertia and the axial vector of
// Y − Yᵀ the moment.
namespace tenon::reduction {

namespace {

Mat3 inertia(const Mat3& Y) { return 2.0 * Y.trace() * Mat3::Identity() - Y - Y.transpose(); }

// [Y_zy − Y_yz, ...]: Σ b × a of Y = Σ a bᵀ
Vec3 axial(const Mat3& Y) { return {Y(2, 1) - Y(1, 2), Y(0, 2) - Y(2, 0), Y(1, 0) - Y(0, 1)}; }

// Y back from its inertia 2 tr(Y) 1 − Y − Yᵀ and its axial vector
Mat3 moments(const Mat3& inertia, const Vec3& axial) {
  return 0.5 * (0.5 * inertia.trace() * Mat3::Identity() - inertia + fem::skew(axial));
}

// Σ_ik V_ip V_kq A_ik, blocks of `Rows` entries: rows Rows i.., column k
template <int Rows>
Eigen::MatrixXd congruence(const Eigen::MatrixXd& A, const Eigen::MatrixXd& V) {
  const Eigen::Index n = V.rows(), m = V.cols();
  const Eigen::MatrixXd AV = A * V;
  Eigen::MatrixXd out = Eigen::MatrixXd::Zero(Rows * m, m);
  for (Eigen::Index p = 0; p < m; ++p)
    for (Eigen::Index i = 0; i < n; ++i) out.middleRows<Rows>(Rows * p) += V(i, p) * AV.middleRows<Rows>(Rows * i);
  return out;
}

NodeGyroscopics rebased(const NodeGyroscopics& g, const Eigen::Matrix3Xd& r, const Eigen::MatrixXd& V) {
  const Eigen::Index n = V.rows(), m = V.cols();
  const auto A = [&](Eigen::Index i) { return g.A.middleCols<3>(3 * i); };
  const auto R = [&](Eigen::Index i) { return Vec3(r.col(i)); };
  NodeGyroscopics out;
  out.J = g.J;
  out.C0 = (g.C0 - g.J * r) * V;
  out.A = Eigen::Matrix3Xd::Zero(3, 3 * m);
  for (Eigen::Index i = 0; i < n; ++i)
    for (Eigen::Index p = 0; p < m; ++p)
      out.A.middleCols<3>(3 * p) += V(i, p) * (A(i) - fem::skew(R(i)) * g.J);  // (θ_i − r_i)~ J
  Eigen::MatrixXd T(3 * n, n), B(3 * n, n), U(n * n, n);
  for (Eigen::Index i = 0; i < n; ++i)
    for (Eigen::Index k = 0; k < n; ++k) {
      T.block<3, 1>(3 * i, k) = g.T.block<3, 1>(3 * i, k) - A(i) * R(k) - R(i).cross(Vec3(g.C0.col(k) - g.J * R(k)));
      B.block<3, 1>(3 * i, k) =
          g.B.block<3, 1>(3 * i, k) + A(i).transpose() * R(k) - A(k).transpose() * R(i) + g.J * R(i).cross(R(k));
    }
  for (Eigen::Index i = 0; i < n; ++i)
    for (Eigen::Index k = 0; k < n; ++k)
      for (Eigen::Index l = 0; l < n; ++l)
        U(i * n + k, l) = g.U(i * n + k, l) - R(l).dot(Vec3(g.B.block<3, 1>(3 * i, k))) +
                          R(k).dot(Vec3(g.T.block<3, 1>(3 * i, l))) - R(l).dot(A(i).transpose() * R(k)) -
                          R(i).dot(Vec3(T.block<3, 1>(3 * k, l)));
  out.T = congruence<3>(T, V);
  out.B = congruence<3>(B, V);
  const Eigen::MatrixXd UV = U * V;
  out.U = Eigen::MatrixXd::Zero(m * m, m);
  for (Eigen::Index i = 0; i < n; ++i)
    for (Eigen::Index k = 0; k < n; ++k)
      for (Eigen::Index p = 0; p < m; ++p)
        for (Eigen::Index q = 0; q < m; ++q) out.U.row(p * m + q) += V(i, p) * V(k, q) * UV.row(i * n + k);
  return out;
}

}  // namespace

ShapeIntegrals rebased(const ReducedBody& body, const Vec3& x_Q, const Mat6X& Phi, const Eigen::MatrixXd& V) {
  const ShapeIntegrals& old = *body.shape_integrals;
  const Eigen::Index n = V.rows();
  const Eigen::Matrix3Xd t = Phi.topRows<3>(), r = Phi.bottomRows<3>();
  const Eigen::Matrix3Xd S = body.L.leftCols<3>().transpose();
  Eigen::Matrix3Xd C0 = body.L.rightCols<3>().transpose();
  Mat3 J0 = body.D.bottomRightCorner<3, 3>();
  if (old.has_nodes()) {  // translational parts
    C0 -= old.nodes.C0;
    J0 -= old.nodes.J;
  }
  const double m = body.D(0, 0);
  const Vec3 d = x_Q - body.reference, s0 = fem::first_moment(body.D), s = s0 - m * d;
  const Mat3 P = moments(2.0 * J0, Vec3::Zero()) - d * s0.transpose() - s0 * d.transpose() + m * d * d.transpose();

  std::vector<Mat3> F(static_cast<std::size_t>(n)), R(static_cast<std::size_t>(n));  // ∫ ψ_i l'ᵀ, r̃_i
  Eigen::MatrixXd J1(6, n), J2(6 * n, n), C1(3 * n, n);
  for (Eigen::Index i = 0; i < n; ++i) {
    const auto u = static_cast<std::size_t>(i);
    F[u] = moments(symmetric3(old.J1.col(i)), C0.col(i)) - S.col(i) * d.transpose();
    R[u] = fem::skew(Vec3(r.col(i)));
    J1.col(i) = packed(inertia(F[u] - t.col(i) * s.transpose() - R[u] * P));
  }
  for (Eigen::Index i = 0; i < n; ++i)
    for (Eigen::Index k = 0; k < n; ++k) {
      const auto u = static_cast<std::size_t>(i), v = static_cast<std::size_t>(k);
      const Vec3 t_i = t.col(i), t_k = t.col(k);
      const Mat3 W = moments(symmetric3(old.J2.block<6, 1>(6 * i, k)), old.C1.block<3, 1>(3 * i, k)) -
                     S.col(i) * t_k.transpose() - t_i * S.col(k).transpose() + m * t_i * t_k.transpose() + F[u] * R[v] -
                     R[u] * F[v].transpose() - t_i * s.transpose() * R[v] + R[u] * s * t_k.transpose() -
                     R[u] * P * R[v];
      J2.block<6, 1>(6 * i, k) = packed(inertia(W));
      C1.block<3, 1>(3 * i, k) = axial(W);
    }
  ShapeIntegrals out;
  out.J1 = J1 * V;
  out.J2 = congruence<6>(J2, V);
  out.C1 = congruence<3>(C1, V);
  if (old.has_nodes()) out.nodes = rebased(old.nodes, r, V);
  return out;
}

}  // namespace tenon::reduction
