#include <fmt/format.h>

#include "fem/error.hpp"
#include "reduction/eq1.hpp"
#include "reduction/geometric_stiffness.hpp"
#include "reduction/reduced_body.hpp"
#include "reduction/roots.hpp"
#include "reduction/shape_integrals.hpp"

namespace tenon::reduction {

namespace {

constexpr double massless_mode = 1e-13;  // of the largest 1/ω: below, a direction has no mass but rounding

}  // namespace

// x_Q = τ_Q x_ref + Φ_Q η. With M = [D Lᵀ; L 1] = WᵀW, W = [S 0; L 1], SᵀS = D − LᵀL, the motion relative to port Q is
// (−τ_Q⁻¹Φ_Q η, η), its mass root A = [−Sτ_Q⁻¹Φ_Q; 1 − Lτ_Q⁻¹Φ_Q], that of the motion with port Q W_Q = [S; L] τ_Q⁻¹.
//   A Ω⁻¹ = U σ Yᵀ gives ω = 1/σ, V = Ω⁻¹Y σ⁻¹, L' = Vᵀ Aᵀ W_Q = Uᵀ W_Q, D' = τ_Q⁻ᵀ D τ_Q⁻¹:
// neither mass nor ω is ever squared, so a load of ratio times the body costs the others ε √ratio at most, not ε ratio.
ReducedBody rebase(const ReducedBody& body, int port) {
  if (port < 0 || port >= static_cast<int>(body.ports.size()))
    throw ModelError(fmt::format("body '{}' has no port number {}", body.name, port),
                     fmt::format("Its ports are numbered from 0 to {}", static_cast<int>(body.ports.size()) - 1));
  if (body.kind == ReducedBody::Kind::cantilever && port == body.parent) return body;
  if (body.n() > 0 && !(body.omega.minCoeff() > 0.0))
    throw ModelError(
        fmt::format("body '{}' has a mode of zero frequency and cannot be hung by another port", body.name),
        "Remove the mechanism inside it");
  const BodyPort& hung = body.ports[static_cast<std::size_t>(port)];
  const Mat6 inverse = fem::tau(body.reference - hung.position);  // τ_Q⁻¹
  const Mat6X Phi_Q = hung.Phi;
  const Mat6 D = inverse.transpose() * body.D * inverse;
  const Eigen::Index n = body.n();
  const Mat6 S = mass_root(body.D - body.L.transpose() * body.L, body.D.diagonal());
  Eigen::MatrixXd W_Q(6 + n, 6);
  W_Q << S * inverse, body.L * inverse;
  Eigen::MatrixXd A = -W_Q * Phi_Q;
  A.bottomRows(n) += Eigen::MatrixXd::Identity(n, n);
  const Eigen::VectorXd flexibility = body.omega.cwiseInverse();  // its root
  const ThinSvd svd = thin_svd(A * flexibility.asDiagonal());
  Eigen::Index finite = 0;
  while (finite < n && svd.sigma[finite] > massless_mode * svd.sigma[0]) ++finite;
  if (n > 0 && finite == 0)
    throw ModelError(fmt::format("body '{}' has stiffness but no mass at all", body.name), "Give it mass");
  Eigen::VectorXd omega = svd.sigma.cwiseInverse();
  omega.tail(n - finite).setConstant(finite > 0 ? massless_frequency * omega[finite - 1] : 0.0);
  const Eigen::MatrixXd V = flexibility.asDiagonal() * svd.V * omega.asDiagonal();

  ReducedBody result = body;
  result.kind = ReducedBody::Kind::cantilever;
  result.reference = hung.position;
  result.parent = port;
  result.omega = omega;
  result.L = svd.U.transpose() * W_Q;
  result.L.bottomRows(n - finite).setZero();
  result.D = 0.5 * (D + D.transpose());
  if (body.C.size() > 0 || body.zeta.cwiseAbs().sum() > 0.0) set_damping(result, V.transpose() * damping(body) * V);
  for (BodyPort& p : result.ports)  // x_k = τ_k τ_Q⁻¹ x_Q + (Φ_k − τ_k τ_Q⁻¹ Φ_Q) η
    p.Phi = (p.Phi - fem::tau(p.position - hung.position) * Phi_Q) * V;
  result.ports[static_cast<std::size_t>(port)].Phi = Mat6X::Zero(6, V.cols());
  if (body.node_shapes.size() > 0) {
    Eigen::MatrixXd shapes = body.node_shapes;
    for (std::size_t k = 0; k < body.node_positions.size(); ++k)
      shapes.middleRows<6>(6 * static_cast<Eigen::Index>(k)) -=
          fem::tau(body.node_positions[k] - hung.position) * Phi_Q;
    result.node_shapes = shapes * V;
  }
  if (body.shape_integrals)
    result.shape_integrals = std::make_shared<const ShapeIntegrals>(rebased(body, hung.position, Phi_Q, V));
  if (body.stiffening) result.stiffening = std::make_shared<const GeometricStiffness>(rebased_stiffness(body, port, V));
  return result;
}

}  // namespace tenon::reduction
