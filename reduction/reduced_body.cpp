#include "reduction/reduced_body.hpp"

#include <fmt/format.h>

#include <Eigen/Eigenvalues>
#include <algorithm>

#include "fem/error.hpp"
#include "fem/mesh.hpp"
#include "reduction/geometric_stiffness.hpp"
#include "reduction/shape_integrals.hpp"

namespace tenon::reduction {

int port_index(const ReducedBody& body, const std::string& port) {
  std::vector<std::string> names;
  for (std::size_t k = 0; k < body.ports.size(); ++k) {
    if (body.ports[k].name == port) return static_cast<int>(k);
    names.push_back(body.ports[k].name);
  }
  const std::string near = fem::near_miss(port, names);
  throw ModelError(fmt::format("body '{}' has no port '{}'", body.name, port),
                   near.empty() ? fmt::format("Its ports are: {}", fmt::join(names, ", "))
                                : fmt::format("Did you mean '{}'?", near));
}

ReducedBody rigid_body(std::string name, double mass, const Vec3& centre, const Mat3& inertia,
                       std::vector<BodyPort> ports) {
  ReducedBody body;
  body.name = std::move(name);
  body.ports = std::move(ports);
  body.reference = body.ports.empty() ? Vec3::Zero() : body.ports.front().position;
  for (BodyPort& port : body.ports) port.Phi = Mat6X::Zero(6, 0);
  body.L.resize(0, 6);
  body.D = fem::rigid_mass(mass, centre - body.reference, inertia);
  body.certificate.basis = "rigid";
  return body;
}

Eigen::MatrixXd damping(const ReducedBody& body) {
  if (body.C.size() > 0) return body.C;
  return Eigen::VectorXd(2.0 * body.zeta.cwiseProduct(body.omega)).asDiagonal();
}

void set_damping(ReducedBody& body, const Eigen::MatrixXd& C) {
  body.C = 0.5 * (C + C.transpose());
  for (Eigen::Index j = 0; j < body.omega.size(); ++j)
    body.zeta[j] = body.omega[j] > 0.0 ? 0.5 * body.C(j, j) / body.omega[j] : 0.0;
}

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
  if (const double least = least_scaled(body.D, body.D); least < -tolerance)
    broken(body, fmt::format("its mass matrix D has the negative scaled eigenvalue {:.3g}", least), redo);
  const Mat6 residual = body.D - body.L.transpose() * body.L;
  if (const double least = least_scaled(residual, body.D); least < -tolerance)
    broken(body, fmt::format("its modes carry more mass than it has: D − LᵀL has the scaled eigenvalue {:.3g}", least),
           redo);
  if (body.shape_integrals) check(*body.shape_integrals, body);
  if (body.stiffening) check(*body.stiffening, body);
}

EffectiveMass effective_mass(const ReducedBody& body) {
  EffectiveMass table;
  table.per_mode = body.L.cwiseAbs2();
  table.total = table.per_mode.colwise().sum().transpose();
  table.remainder = body.D.diagonal() - table.total;
  return table;
}

}  // namespace tenon::reduction
