// What the numbers of a body must fulfil, wherever they come from.
#include <fmt/format.h>

#include <Eigen/Eigenvalues>
#include <algorithm>

#include "fem/error.hpp"
#include "reduction/geometric_stiffness.hpp"
#include "reduction/reduced_body.hpp"
#include "reduction/shape_integrals.hpp"

namespace tenon::reduction {
namespace {

[[noreturn]] void broken(const ReducedBody& body, const std::string& what, const std::string& cure) {
  throw ModelError(fmt::format("reduced body '{}': {}", body.name, what), cure);
}

// least eigenvalue of a symmetric matrix scaled to a unit diagonal (rows without a diagonal entry left as they are)
double least_scaled(const Mat6& A, const Mat6& scale_by) {
  Eigen::Matrix<double, 6, 1> s = scale_by.diagonal().cwiseMax(0.0).cwiseSqrt();
  for (double& x : s) x = x > 0.0 ? 1.0 / x : 1.0;
  const Eigen::MatrixXd scaled = s.asDiagonal() * A * s.asDiagonal();
  return Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(scaled, Eigen::EigenvaluesOnly).eigenvalues()[0];
}

}  // namespace

void check(const ShapeIntegrals& integrals, const ReducedBody& body) {
  const Eigen::Index n = body.omega.size();
  const NodeGyroscopics& nodes = integrals.nodes;
  const bool sizes =
      integrals.J1.rows() == 6 && integrals.J1.cols() == n && integrals.J2.rows() == 6 * n &&
      integrals.J2.cols() == n && integrals.C1.rows() == 3 * n && integrals.C1.cols() == n &&
      (!integrals.has_nodes() ||
       (nodes.C0.cols() == n && nodes.A.cols() == 3 * n && nodes.T.rows() == 3 * n && nodes.T.cols() == n &&
        nodes.B.rows() == 3 * n && nodes.B.cols() == n && nodes.U.rows() == n * n && nodes.U.cols() == n));
  const std::string redo = "They are damaged or of another body: reduce it again";
  if (!sizes)
    throw ModelError(fmt::format("the shape integrals of body '{}' do not fit its {} modes", body.name, n), redo);
  if (!(integrals.J1.allFinite() && integrals.J2.allFinite() && integrals.C1.allFinite() && nodes.J.allFinite() &&
        nodes.C0.allFinite() && nodes.A.allFinite() && nodes.T.allFinite() && nodes.B.allFinite() &&
        nodes.U.allFinite()))
    throw ModelError(fmt::format("a shape integral of body '{}' is not finite", body.name), redo);
}

void check(const GeometricStiffness& stiffening, const ReducedBody& body) {
  const Eigen::Index n = body.omega.size();
  const auto loads = GeometricStiffness::inertia_loads + 6 * static_cast<Eigen::Index>(body.ports.size());
  const std::string redo = "It is damaged or of another body: compute it again";
  if (stiffening.K.rows() != (n + 3) * (n + 3) || stiffening.K.cols() != loads)
    throw ModelError(fmt::format("the geometric stiffness of body '{}' is {}×{} where {}×{} is expected", body.name,
                                 stiffening.K.rows(), stiffening.K.cols(), (n + 3) * (n + 3), loads),
                     redo);
  if (!(stiffening.K.allFinite() && stiffening.spin.allFinite()))
    throw ModelError(fmt::format("the geometric stiffness of body '{}' is not finite", body.name), redo);
}

void check(const ReducedBody& body) {
  const Eigen::Index n = body.omega.size();
  const std::string redo = "The body's data are damaged or were put together wrongly: reduce it again";
  const bool sizes =
      body.zeta.size() == n && (body.C.size() == 0 || (body.C.rows() == n && body.C.cols() == n)) &&
      body.L.rows() == n && body.L.cols() == 6 &&
      std::all_of(body.ports.begin(), body.ports.end(), [&](const BodyPort& port) { return port.Phi.cols() == n; }) &&
      (body.node_shapes.size() == 0 ||
       (body.node_shapes.cols() == n &&
        body.node_shapes.rows() == 6 * static_cast<Eigen::Index>(body.node_positions.size())));
  if (!sizes)
    broken(body, fmt::format("its {} frequencies, ratios, participation, shapes disagree in number", n), redo);
  const bool cantilever = body.kind == ReducedBody::Kind::cantilever;
  if (cantilever ? body.parent < 0 || body.parent >= static_cast<int>(body.ports.size()) : body.parent != -1)
    broken(body, fmt::format("its parent port has the number {}, of {} ports", body.parent, body.ports.size()), redo);
  bool finite = body.omega.allFinite() && body.zeta.allFinite() && body.C.allFinite() && body.L.allFinite() &&
                body.D.allFinite() && body.reference.allFinite() && body.node_shapes.allFinite();
  for (const BodyPort& port : body.ports)
    finite = finite && port.Phi.allFinite() && port.position.allFinite() && port.axes.allFinite();
  if (!finite) broken(body, "a number in it is not finite", redo);
  if (n > 0 && body.omega.minCoeff() < 0.0) broken(body, "a frequency is negative", redo);
  if ((body.D - body.D.transpose()).cwiseAbs().maxCoeff() > 1e-12 * body.D.cwiseAbs().maxCoeff())
    broken(body, "its mass matrix D is not symmetric", redo);
  if (body.C.size() > 0) {
    if ((body.C - body.C.transpose()).cwiseAbs().maxCoeff() > 1e-12 * body.C.cwiseAbs().maxCoeff())
      broken(body, "its damping matrix C is not symmetric", redo);
    const double least =
        Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(body.C, Eigen::EigenvaluesOnly).eigenvalues()[0];
    if (least < -1e-12 * body.C.cwiseAbs().maxCoeff() * static_cast<double>(n))
      broken(body, fmt::format("its damping matrix C has the negative eigenvalue {:.3g} rad/s", least), redo);
  }
  // round-off of D and L, scaled to unit diagonal; a body that is all modes has D − LᵀL = 0 in some directions
  const double tolerance = 1e-9;
  if (const double least = least_scaled(body.D, body.D); !(least >= -tolerance))
    broken(body, fmt::format("its mass matrix D has the negative scaled eigenvalue {:.3g}", least), redo);
  const Mat6 residual = body.D - body.L.transpose() * body.L;
  if (const double least = least_scaled(residual, body.D); !(least >= -tolerance))
    broken(body, fmt::format("its modes carry more mass than it has: D − LᵀL has the scaled eigenvalue {:.3g}", least),
           redo);
  if (body.shape_integrals) check(*body.shape_integrals, body);
  if (body.stiffening) check(*body.stiffening, body);
}

}  // namespace tenon::reduction
