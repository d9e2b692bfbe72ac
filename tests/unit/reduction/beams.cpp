#include "tests/unit/reduction/beams.hpp"

#include <Eigen/Eigenvalues>
#include <Eigen/LU>

namespace tenon::tests {

fem::Model beam(const BeamData& data, const std::vector<std::pair<std::string, int>>& ports) {
  fem::Model model;
  for (int k = 0; k <= data.elements; ++k) {
    model.nodes.emplace_back(data.length * k / data.elements, 0.0, 0.0);
    model.node_ids.push_back(k + 1);
  }
  model.materials = {data.material};
  model.beam_sections = {data.section};
  for (int k = 0; k < data.elements; ++k) {
    fem::Beam element;
    element.nodes = {k, k + 1};
    element.orientation = fem::Vec3::UnitY();
    element.mass = data.mass;
    element.rotary_inertia = false;
    element.id = k + 1;
    model.elements.emplace_back(element);
  }
  for (const auto& [name, node] : ports) model.ports.push_back({name, node, fem::Mat3::Identity()});
  return model;
}

FreeBody free_body(const reduction::ReducedBody& body) {
  const int n = body.n();
  FreeBody f{Eigen::MatrixXd::Identity(6 + n, 6 + n), Eigen::MatrixXd::Zero(6 + n, 6 + n)};
  f.M.topLeftCorner(6, 6) = body.D;
  f.M.bottomLeftCorner(n, 6) = body.L;
  f.M.topRightCorner(6, n) = body.L.transpose();
  f.K.diagonal().tail(n) = body.omega.cwiseAbs2();
  return f;
}

Eigen::MatrixXd port_rows(const reduction::ReducedBody& body, int port) {
  Eigen::MatrixXd G(6, 6 + body.n());
  G << reduction::tau(body, port), body.ports[static_cast<std::size_t>(port)].Phi;
  return G;
}

Eigen::VectorXd frequencies(const reduction::ReducedBody& body, const std::vector<int>& held) {
  const FreeBody f = free_body(body);
  Eigen::MatrixXd N = Eigen::MatrixXd::Identity(f.M.rows(), f.M.rows());
  if (!held.empty()) {
    Eigen::MatrixXd G(6 * static_cast<Eigen::Index>(held.size()), f.M.rows());
    for (std::size_t k = 0; k < held.size(); ++k)
      G.middleRows<6>(6 * static_cast<Eigen::Index>(k)) = port_rows(body, held[k]);
    const Eigen::VectorXd scale = G.rowwise().norm().cwiseInverse();
    Eigen::FullPivLU<Eigen::MatrixXd> lu(scale.asDiagonal() * G);
    N = lu.kernel();
  }
  const Eigen::MatrixXd M = N.transpose() * f.M * N, K = N.transpose() * f.K * N;
  return Eigen::GeneralizedSelfAdjointEigenSolver<Eigen::MatrixXd>(K, M, Eigen::EigenvaluesOnly)
      .eigenvalues()
      .cwiseMax(0.0)
      .cwiseSqrt();
}

Eigen::MatrixXd receptance(const reduction::ReducedBody& body, int to, int from, double omega) {
  const FreeBody f = free_body(body);
  return port_rows(body, to) * (f.K - omega * omega * f.M).partialPivLu().solve(port_rows(body, from).transpose());
}

}  // namespace tenon::tests
