#include "reduction/geometric_stiffness.hpp"
#include "reduction/shape_integrals.hpp"

// Unit loads of the body held at Q from those of the body held at P, d = x_Q − x_P, W the resultant of a load:
//   α about Q   = α about P − a(α × d),     ω_iω_j about Q = ω_iω_j about P − a(ω × (ω × d)),
// and the response with the reaction at Q is, but for a rigid motion without stress, that of the load and the wrench
// −W at Q with the reaction at P. Shapes ψ' = (ψ − Φ_lin − Φ_ang × (x − x_Q)) V; K_σ of rigid translations is zero.
namespace tenon::reduction {

GeometricStiffness rebased_stiffness(const ReducedBody& body, int port, const Eigen::MatrixXd& V) {
  const GeometricStiffness& old = *body.stiffening;
  const Eigen::Index n = V.rows(), m = V.cols(), loads = old.K.cols();
  constexpr int inertia = GeometricStiffness::inertia_loads;
  const BodyPort& Q = body.ports[static_cast<std::size_t>(port)];
  const Vec3 d = Q.position - body.reference;

  Eigen::MatrixXd X = Eigen::MatrixXd::Identity(loads, loads);  // new loads from old ones
  Eigen::MatrixXd W(6, loads);                                  // resultants of the old loads at P
  W.leftCols<6>() = -body.D;
  W.middleCols<6>(6) = old.spin;
  for (std::size_t p = 0; p < body.ports.size(); ++p)
    W.middleCols<6>(inertia + 6 * static_cast<Eigen::Index>(p)) =
        fem::tau(body.ports[p].position - body.reference).transpose();
  for (int c = 0; c < 3; ++c) X.block<3, 1>(0, 3 + c) = -Vec3::Unit(c).cross(d);
  for (int load = 0; load < 6; ++load) {
    const Vec3 e_i = Vec3::Unit(symmetric_row[load]), e_j = Vec3::Unit(symmetric_column[load]);
    X.block<3, 1>(0, 6 + load) = -e_i.cross(e_j.cross(d));
    if (load >= 3) X.block<3, 1>(0, 6 + load) -= e_j.cross(e_i.cross(d));
  }
  const Eigen::MatrixXd at_Q = fem::tau(-d).transpose() * W * X;
  X.middleRows<6>(inertia + 6 * port) -= at_Q;

  Eigen::MatrixXd T = Eigen::MatrixXd::Zero(n + 3, m + 3);
  T.topLeftCorner(n, m) = V;
  T.bottomLeftCorner(3, m) = -Q.Phi.bottomRows<3>() * V;
  T.bottomRightCorner<3, 3>().setIdentity();
  const Eigen::MatrixXd K = old.K * X;
  GeometricStiffness out{Eigen::MatrixXd((m + 3) * (m + 3), loads), at_Q.middleCols<6>(6)};
  for (Eigen::Index load = 0; load < loads; ++load)
    Eigen::Map<Eigen::MatrixXd>(out.K.col(load).data(), m + 3, m + 3) =
        T.transpose() * Eigen::Map<const Eigen::MatrixXd>(K.col(load).data(), n + 3, n + 3) * T;
  return out;
}

}  // namespace tenon::reduction
