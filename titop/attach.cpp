#include "titop/attach.hpp"

#include <fmt/format.h>

#include <Eigen/Eigenvalues>
#include <Eigen/SVD>
#include <cmath>

#include "fem/error.hpp"

namespace tenon::titop {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;
using fem::Mat3;
using fem::Mat6;
using fem::Vec3;
using reduction::ReducedBody;

namespace {

void require_port(const ReducedBody& body, int port) {
  if (port < 0 || port >= static_cast<int>(body.ports.size()))
    throw ModelError(fmt::format("body '{}' has no port number {}", body.name, port),
                     fmt::format("Its ports are numbered from 0 to {}", static_cast<int>(body.ports.size()) - 1));
}

// F with FᵀF = τ(c)ᵀ diag(m, J) τ(c), the rigid mass matrix about a point from which the mass centre is c away.
Mat6 mass_root(const std::string& name, double mass, const Vec3& c, const Mat3& inertia) {
  const Eigen::SelfAdjointEigenSolver<Mat3> J(inertia);
  const double largest = inertia.cwiseAbs().maxCoeff();
  const bool sound = std::isfinite(mass) && mass >= 0.0 && c.allFinite() && inertia.allFinite() &&
                     (inertia - inertia.transpose()).cwiseAbs().maxCoeff() <= 1e-12 * largest &&
                     J.eigenvalues()[0] >= -1e-12 * largest;
  if (!sound)
    throw ModelError(fmt::format("the mass of {} kg to attach to body '{}' has no physical mass matrix", mass, name),
                     "Give a mass ≥ 0 and a symmetric inertia about the mass centre without negative eigenvalue");
  Mat6 root = Mat6::Zero();
  root.topLeftCorner<3, 3>() = std::sqrt(mass) * Mat3::Identity();
  root.bottomRightCorner<3, 3>() =
      J.eigenvalues().cwiseMax(0.0).cwiseSqrt().asDiagonal() * J.eigenvectors().transpose();
  return root * fem::tau(c);
}

}  // namespace

// With x_C = τ x_ref + Φη the mass adds τᵀMτ to D, ΦᵀMτ to L and ΦᵀMΦ to 1. With M = FᵀF and ΦᵀFᵀ = U σ Wᵀ,
//   1 + ΦᵀMΦ = U (1 + σ²) Uᵀ, so V = U (1 + σ²)^{−1/2} R makes it 1, and R, ω are the right singular vectors and the
// singular values of Ω U (1 + σ²)^{−1/2}: neither the sum 1 + σ² nor ω² is ever rounded at the size of the largest.
ReducedBody attach_mass(const ReducedBody& body, int port, double mass, const Vec3& centre, const Mat3& inertia) {
  require_port(body, port);
  const reduction::BodyPort& at = body.ports[static_cast<std::size_t>(port)];
  const Mat6 F = mass_root(body.name, mass, centre - at.position, inertia);
  const Mat6 F_ref = F * reduction::tau(body, port);
  ReducedBody loaded = body;
  loaded.D += F_ref.transpose() * F_ref;
  const Index n = body.n();
  if (n == 0 || at.Phi.isZero(0.0)) return loaded;
  if (body.kind == ReducedBody::Kind::free_free)
    throw ModelError(fmt::format("body '{}' is free-free: a mass would move its mass centre", body.name),
                     "Rebase it to a port first");
  if (!(body.omega.minCoeff() > 0.0))
    throw ModelError(fmt::format("body '{}' has a mode of zero frequency", body.name),
                     "Remove the mechanism inside it");

  const Eigen::JacobiSVD<MatrixXd> svd(at.Phi.transpose() * F.transpose(), Eigen::ComputeFullU | Eigen::ComputeFullV);
  const VectorXd& sigma = svd.singularValues();
  VectorXd scale = VectorXd::Ones(n);  // (1 + σ²)^{−1/2}
  for (Index i = 0; i < sigma.size(); ++i) scale[i] = 1.0 / std::hypot(1.0, sigma[i]);
  const MatrixXd U = svd.matrixU() * scale.asDiagonal();
  const Eigen::JacobiSVD<MatrixXd> stiffness(body.omega.asDiagonal() * U, Eigen::ComputeFullV);
  const MatrixXd R = stiffness.matrixV().rowwise().reverse();
  const MatrixXd V = U * R;

  loaded.omega = stiffness.singularValues().reverse();
  MatrixXd carried = MatrixXd::Zero(n, 6);  // (1 + σ²)^{−1/2} σ Wᵀ F τ
  for (Index i = 0; i < sigma.size(); ++i)
    carried.row(i) = scale[i] * sigma[i] * svd.matrixV().col(i).transpose() * F_ref;
  loaded.L = V.transpose() * body.L + R.transpose() * carried;
  if (body.C.size() > 0 || body.zeta.cwiseAbs().sum() > 0.0)
    reduction::set_damping(loaded, V.transpose() * reduction::damping(body) * V);
  for (reduction::BodyPort& p : loaded.ports) p.Phi = (p.Phi * V).eval();
  if (body.node_shapes.size() > 0) loaded.node_shapes = body.node_shapes * V;
  return loaded;
}

ReducedBody move_port(const ReducedBody& body, int port, const Vec3& offset) {
  require_port(body, port);
  if (!offset.allFinite())
    throw ModelError(fmt::format("the offset of a port of body '{}' is not finite", body.name), "Give three lengths");
  ReducedBody moved = body;
  reduction::BodyPort& p = moved.ports[static_cast<std::size_t>(port)];
  p.position += offset;
  p.Phi = fem::tau(offset) * p.Phi;
  if (body.kind == ReducedBody::Kind::cantilever && port == body.parent) {
    const Mat6 back = fem::tau(-offset);  // x_P of the old point from the new one
    moved.reference += offset;
    moved.D = back.transpose() * body.D * back;
    moved.L = body.L * back;
  }
  return moved;
}

}  // namespace tenon::titop
