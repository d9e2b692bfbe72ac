#include <fmt/format.h>

#include <Eigen/LU>

#include "fem/error.hpp"
#include "reduction/eq1.hpp"
#include "reduction/geometric_stiffness.hpp"
#include "reduction/reduced_body.hpp"
#include "reduction/shape_integrals.hpp"

namespace tenon::reduction {

// x_Q = τ_Q x_ref + Φ_Q η, so x_ref = τ_Q⁻¹(x_Q − Φ_Q η): the congruence S = [τ_Q⁻¹ −τ_Q⁻¹Φ_Q; 0 1] of
// M = [D Lᵀ; L 1] leaves K = diag(0, Ω²), and η is now the motion relative to port Q:
//   D' = τ⁻ᵀDτ⁻¹,  M_ηQ = (L − Φ_QᵀD̄)τ⁻¹ with D̄ = τ⁻ᵀD,  M_ηη = 1 − Lτ⁻¹Φ_Q − (·)ᵀ + Φ_QᵀD'Φ_Q.
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
  const Eigen::MatrixXd L_Q = body.L * inverse;  // participation with the reference moved rigidly to Q

  RelativeForm relative;
  relative.K_zz = body.omega.cwiseAbs2().asDiagonal();
  relative.M_zz = Eigen::MatrixXd::Identity(body.n(), body.n()) - L_Q * Phi_Q - (L_Q * Phi_Q).transpose() +
                  Phi_Q.transpose() * D * Phi_Q;
  relative.M_zP = L_Q - Phi_Q.transpose() * D;
  const ModalForm modal = modal_form(relative);

  ReducedBody result = body;
  result.kind = ReducedBody::Kind::cantilever;
  result.reference = hung.position;
  result.parent = port;
  result.omega = modal.omega;
  result.L = modal.L;
  result.D = 0.5 * (D + D.transpose());
  if (body.C.size() > 0 || body.zeta.cwiseAbs().sum() > 0.0)
    set_damping(result, modal.V.transpose() * damping(body) * modal.V);
  for (BodyPort& p : result.ports)  // x_k = τ_k τ_Q⁻¹ x_Q + (Φ_k − τ_k τ_Q⁻¹ Φ_Q) η
    p.Phi = (p.Phi - fem::tau(p.position - hung.position) * Phi_Q) * modal.V;
  result.ports[static_cast<std::size_t>(port)].Phi = Mat6X::Zero(6, modal.V.cols());
  if (body.node_shapes.size() > 0) {
    Eigen::MatrixXd shapes = body.node_shapes;
    for (std::size_t k = 0; k < body.node_positions.size(); ++k)
      shapes.middleRows<6>(6 * static_cast<Eigen::Index>(k)) -=
          fem::tau(body.node_positions[k] - hung.position) * Phi_Q;
    result.node_shapes = shapes * modal.V;
  }
  if (body.shape_integrals)
    result.shape_integrals = std::make_shared<const ShapeIntegrals>(rebased(body, hung.position, Phi_Q, modal.V));
  if (body.stiffening)
    result.stiffening = std::make_shared<const GeometricStiffness>(rebased_stiffness(body, port, modal.V));
  return result;
}

}  // namespace tenon::reduction
