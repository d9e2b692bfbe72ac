#include "reduction/body_terms.hpp"

#include <cassert>

#include "fem/rigid_motion.hpp"

namespace tenon::reduction {

namespace {

using fem::Vec6;

// One mode's sums over the others, in one pass: twelve independent chains of additions.
struct ModeSums {
  Vec6 J = Vec6::Zero();      // Σ_k J2_ik η_k
  Vec3 C = Vec3::Zero();      // Σ_k c_ki η_k
  Vec3 C_dot = Vec3::Zero();  // Σ_k c_ki η̇_k

  ModeSums(const ShapeIntegrals& s, Eigen::Index i, const double* eta, const double* eta_dot) {
    const Eigen::Index n = s.J1.cols();
    const double *J2 = s.J2.data() + 6 * i, *C1 = s.C1.data() + 3 * i;
    for (Eigen::Index k = 0; k < n; ++k, J2 += 6 * n, C1 += 3 * n) {
      J += eta[k] * Eigen::Map<const Vec6>(J2);
      const Eigen::Map<const Vec3> c(C1);
      C += eta[k] * c;
      C_dot += eta_dot[k] * c;
    }
  }
};

// the part of b that the nodes' rotary inertia adds; J_j's share of J0 and C0 is in there already
void add_nodes(const NodeGyroscopics& g, const double* eta_dot, const Vec3& w, Eigen::Ref<Eigen::VectorXd> b) {
  const Eigen::Index n = g.C0.cols();
  Vec3 b_w = Vec3::Zero();
  for (Eigen::Index i = 0; i < n; ++i) {
    const auto A = g.A.middleCols<3>(3 * i);
    const Vec3 A_w = A * w;
    Vec3 t = Vec3::Zero(), c = Vec3::Zero();
    double u = 0.0;
    for (Eigen::Index k = 0; k < n; ++k) {
      const Vec3 t_ik = g.T.block<3, 1>(3 * i, k);
      t += eta_dot[k] * t_ik;
      c += 0.5 * eta_dot[k] * (g.B.block<3, 1>(3 * i, k) - t_ik + g.T.block<3, 1>(3 * k, i));
      for (Eigen::Index l = 0; l < n; ++l) u += eta_dot[k] * eta_dot[l] * g.U(i * n + k, l);
    }
    b_w += eta_dot[i] * (A_w + A.transpose() * w + t);  // θ_i × Jω + J(ω × θ_i) and θ_i × Jθ_k
    b[i] += -w.dot(A_w) + 2.0 * w.dot(c) + u;
  }
  b.tail<3>() += b_w;
}

// J · pack = ωᵀ J ω, J packed
Vec6 products(const Vec3& w) {
  Vec6 ww;
  ww << w.cwiseAbs2(), 2.0 * w.x() * w.y(), 2.0 * w.x() * w.z(), 2.0 * w.y() * w.z();
  return ww;
}

}  // namespace

void ruthless_gyroscopics(const ReducedBody& body, const ShapeIntegrals* integrals, const Vec3& omega,
                          Eigen::Ref<Eigen::VectorXd> b) {
  const Eigen::Index n = b.size() - 6;
  const Vec3& w = omega;
  const Vec6 ww = products(w);
  for (Eigen::Index i = 0; i < n; ++i) {
    b[i] = integrals == nullptr ? 0.0 : -0.5 * integrals->J1.col(i).dot(ww);
    if (integrals != nullptr && integrals->has_nodes()) b[i] -= w.dot(integrals->nodes.A.middleCols<3>(3 * i) * w);
  }
  const Vec3 J_w = body.D.bottomRightCorner<3, 3>() * w;
  b.segment<3>(n) = w.cross(w.cross(fem::first_moment(body.D)));
  b.tail<3>() = w.cross(J_w);
}

void body_terms(const ReducedBody& body, const ShapeIntegrals* integrals, Nonlinearity nonlinearity, const double* eta,
                const double* eta_dot, const Vec3& omega, Eigen::Ref<Eigen::MatrixXd> M,
                Eigen::Ref<Eigen::VectorXd> b) {
  const Eigen::Index n = nonlinearity == Nonlinearity::rigid ? 0 : body.omega.size();
  assert(M.rows() == n + 6 && M.cols() == n + 6 && b.size() == n + 6);
  assert(n == 0 || integrals == nullptr || integrals->J1.cols() == n);
  M.topLeftCorner(n, n).setZero();
  M.diagonal().head(n).setOnes();
  M.topRightCorner(n, 6) = body.L.topRows(n);
  M.bottomRightCorner<6, 6>() = body.D;

  if (nonlinearity != Nonlinearity::full || integrals == nullptr) {
    M.bottomLeftCorner(6, n) = M.topRightCorner(n, 6).transpose();
    ruthless_gyroscopics(body, integrals, omega, b);
    return;
  }

  const Vec3& w = omega;
  const Vec6 ww = products(w);
  Vec3 s = fem::first_moment(body.D), S_dot = Vec3::Zero(), C_dot = Vec3::Zero();  // s, S η̇, C η̇
  Mat3 J = body.D.bottomRightCorner<3, 3>();
  Vec6 half = Vec6::Zero(), rate = Vec6::Zero();  // J − J0 and J̇
  Vec3 S_eta = Vec3::Zero();
  for (Eigen::Index i = 0; i < n; ++i) {
    const ModeSums sums(*integrals, i, eta, eta_dot);
    const Vec6 J_i = integrals->J1.col(i) + sums.J;
    half += 0.5 * eta[i] * (integrals->J1.col(i) + J_i);
    rate += eta_dot[i] * J_i;
    const Vec3 S_i = body.L.row(i).head<3>();
    const Vec3 C_i = body.L.row(i).tail<3>().transpose() + sums.C;
    S_eta += eta[i] * S_i;
    S_dot += eta_dot[i] * S_i;
    C_dot += eta_dot[i] * C_i;
    M.row(i).tail<3>() = C_i;
    b[i] = -0.5 * J_i.dot(ww) + 2.0 * w.dot(sums.C_dot);
  }
  s += S_eta;
  J += symmetric3(half);
  M.block<3, 3>(n + 3, n) += fem::skew(S_eta);
  M.block<3, 3>(n, n + 3) -= fem::skew(S_eta);
  M.bottomRightCorner<3, 3>() = J;
  M.bottomLeftCorner(6, n) = M.topRightCorner(n, 6).transpose();

  b.segment<3>(n) = w.cross(w.cross(s)) + 2.0 * w.cross(S_dot);
  b.tail<3>() = symmetric3(rate) * w + w.cross(J * w + C_dot);
  if (n > 0 && integrals->has_nodes()) add_nodes(integrals->nodes, eta_dot, w, b);
}

}  // namespace tenon::reduction
