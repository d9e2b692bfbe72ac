#include "tests/unit/reduction/lumped_body.hpp"

#include <Eigen/Cholesky>
#include <random>
#include <span>

namespace tenon::tests {

Eigen::Matrix3Xd LumpedBody::psi(std::size_t j) const {
  return shapes.middleRows<3>(6 * static_cast<Eigen::Index>(j)) - fem::skew(nodes[j].offset) * theta(j);
}

Eigen::MatrixXd LumpedBody::motion(std::size_t j, const Eigen::VectorXd& eta) const {
  const Eigen::Index n = shapes.cols();
  Eigen::MatrixXd T = Eigen::MatrixXd::Zero(6, n + 6);
  T.topLeftCorner(3, n) = psi(j);
  T.bottomLeftCorner(3, n) = theta(j);
  T.rightCols<6>() = fem::tau(position(j) + psi(j) * eta);
  return T;
}

fem::Mat6 LumpedBody::spatial_inertia(std::size_t j) const {
  return fem::rigid_mass(nodes[j].mass, Vec3::Zero(), nodes[j].inertia);
}

void fill(LumpedBody& lumped) {
  const Eigen::Index n = lumped.shapes.cols();
  Eigen::MatrixXd M = Eigen::MatrixXd::Zero(n + 6, n + 6);
  for (std::size_t j = 0; j < lumped.nodes.size(); ++j) {
    const Eigen::MatrixXd T = lumped.motion(j, Eigen::VectorXd::Zero(n));
    M += T.transpose() * lumped.spatial_inertia(j) * T;
  }
  lumped.body.reference = lumped.reference;
  lumped.body.omega = Eigen::VectorXd::LinSpaced(n, 1.0, 2.0);
  lumped.body.zeta = Eigen::VectorXd::Zero(n);
  lumped.body.L = M.topRightCorner(n, 6);
  lumped.body.D = M.bottomRightCorner<6, 6>();
  lumped.body.ports = {
      {.name = "root", .position = lumped.reference, .axes = Mat3::Identity(), .Phi = Mat6X::Zero(6, n)}};
  lumped.body.shape_integrals = std::make_shared<const reduction::ShapeIntegrals>(
      reduction::shape_integrals(std::span<const LumpedNode>(lumped.nodes), lumped.shapes, lumped.reference));
}

LumpedBody random_lumped(unsigned seed, int nodes, int modes, bool inertia, bool offsets) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> uniform(-1.0, 1.0);
  const auto draw = [&](Eigen::Index rows, Eigen::Index columns) {
    return Eigen::MatrixXd(Eigen::MatrixXd::NullaryExpr(rows, columns, [&] { return uniform(random); }));
  };
  LumpedBody lumped;
  lumped.reference = draw(3, 1);
  for (int j = 0; j < nodes; ++j) {
    const Mat3 A = draw(3, 3);
    lumped.nodes.push_back({.position = 2.0 * draw(3, 1),
                            .mass = 1.0 + 0.5 * uniform(random),
                            .offset = offsets ? Vec3(0.3 * draw(3, 1)) : Vec3::Zero(),
                            .inertia = inertia ? Mat3(0.2 * A * A.transpose()) : Mat3::Zero()});
  }
  lumped.shapes = draw(6 * nodes, modes);
  Eigen::MatrixXd Mff = Eigen::MatrixXd::Zero(modes, modes);
  for (std::size_t j = 0; j < lumped.nodes.size(); ++j) {
    const Eigen::MatrixXd T = lumped.motion(j, Eigen::VectorXd::Zero(modes)).leftCols(modes);
    Mff += T.transpose() * lumped.spatial_inertia(j) * T;
  }
  const Eigen::MatrixXd L = Mff.llt().matrixL();
  lumped.shapes = L.triangularView<Eigen::Lower>().solve(lumped.shapes.transpose()).transpose().eval();
  fill(lumped);
  return lumped;
}

NodeSums node_sums(const LumpedBody& lumped, const Eigen::VectorXd& eta, const Eigen::VectorXd& eta_dot,
                   const Vec3& w) {
  const Eigen::Index n = lumped.shapes.cols();
  NodeSums sums{Eigen::MatrixXd::Zero(n + 6, n + 6), Eigen::VectorXd::Zero(n + 6)};
  for (std::size_t j = 0; j < lumped.nodes.size(); ++j) {
    const Eigen::MatrixXd T = lumped.motion(j, eta);
    const fem::Mat6 M_s = lumped.spatial_inertia(j);
    const Vec3 l = lumped.position(j) + lumped.psi(j) * eta, delta_v = lumped.psi(j) * eta_dot,
               delta_w = lumped.theta(j) * eta_dot, w_j = w + delta_w;
    Vec6 a, b;
    a << w.cross(w.cross(l)) + 2.0 * w.cross(delta_v), w.cross(delta_w);  // (28)
    b << Vec3::Zero(), w_j.cross(Vec3(lumped.nodes[j].inertia * w_j));    // (31), p = 0
    sums.M += T.transpose() * M_s * T;                                    // (23)
    sums.b += T.transpose() * (b + M_s * a);                              // (37)
  }
  return sums;
}

}  // namespace tenon::tests
