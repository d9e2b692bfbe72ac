// The flexible slider-crank of the IVP test set (problem "crank"; B. Simeon, Arch. Mech. Eng. 43 (1996)): crank turning
// at 150 rad/s, rod with two bending and two longitudinal shapes, slider. Positions at t = 0.1 s as the set publishes
// them.
#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>
#include <iostream>
#include <numbers>

#include "assembly/recursion/closure.hpp"
#include "reduction/shape_integrals.hpp"
#include "tests/reference/slider_crank.hpp"

namespace tenon::assembly {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;
using reduction::LumpedNode;

constexpr reference::SliderCrank set;
constexpr double E = 2e11, width = 0.008, height = 0.008, rho = 7870.0, speed = 150.0;
constexpr int shapes = 4, panels = 32;

// y: sin πx/l, sin 2πx/l; x: 4 ξ(1 − ξ), ξ(2ξ − 1)
Eigen::Matrix<double, 6, shapes> shape(double x) {
  const double xi = x / set.L2, pi = std::numbers::pi;
  Eigen::Matrix<double, 6, shapes> u = Eigen::Matrix<double, 6, shapes>::Zero();
  u(1, 0) = std::sin(pi * xi);
  u(1, 1) = std::sin(2.0 * pi * xi);
  u(5, 0) = pi / set.L2 * std::cos(pi * xi);
  u(5, 1) = 2.0 * pi / set.L2 * std::cos(2.0 * pi * xi);
  u(0, 2) = 4.0 * xi * (1.0 - xi);
  u(0, 3) = xi * (2.0 * xi - 1.0);
  return u;
}

struct Rod {
  ReducedBody body;
  MatrixXd V;  ///< q = V η
};

// Integrals by Gauss points of order 8 in 32 panels: to round-off.
Rod rod() {
  const double pi = std::numbers::pi, A = width * height, EI = E * width * std::pow(height, 3) / 12.0;
  const double points[2] = {std::sqrt((3.0 - 2.0 * std::sqrt(1.2)) / 7.0),
                            std::sqrt((3.0 + 2.0 * std::sqrt(1.2)) / 7.0)};
  const double weights[2] = {(18.0 + std::sqrt(30.0)) / 36.0, (18.0 - std::sqrt(30.0)) / 36.0};
  std::vector<LumpedNode> nodes;
  const double panel = set.L2 / panels;
  for (int k = 0; k < panels; ++k)
    for (const int g : {0, 1})
      for (const double side : {-1.0, 1.0}) {
        LumpedNode node;
        node.position.x() = panel * (k + 0.5 + 0.5 * side * points[g]);
        node.mass = rho * A * 0.5 * panel * weights[g];
        nodes.push_back(node);
      }
  MatrixXd all(6 * nodes.size(), shapes), M = MatrixXd::Zero(shapes, shapes), M_zP = MatrixXd::Zero(shapes, 6);
  for (std::size_t j = 0; j < nodes.size(); ++j) {
    const Eigen::Matrix<double, 6, shapes> u = shape(nodes[j].position.x());
    all.middleRows<6>(6 * static_cast<Index>(j)) = u;
    const MatrixXd slides = u.topRows(3), rigid = fem::tau(nodes[j].position);
    M += nodes[j].mass * slides.transpose() * slides;
    M_zP += nodes[j].mass * slides.transpose() * rigid.topRows(3);
  }
  MatrixXd K = MatrixXd::Zero(shapes, shapes);
  K(0, 0) = 0.5 * EI * std::pow(pi, 4) / std::pow(set.L2, 3);
  K(1, 1) = 16.0 * K(0, 0);
  const double axial = E * A / set.L2;
  K(2, 2) = 16.0 / 3.0 * axial;
  K(3, 3) = 7.0 / 3.0 * axial;
  K(2, 3) = K(3, 2) = -8.0 / 3.0 * axial;
  const Eigen::GeneralizedSelfAdjointEigenSolver<MatrixXd> eigen(K, M);
  Rod r{reduction::rigid_body(
            "rod", set.M2, Vec3(0.5 * set.L2, 0.0, 0.0), Mat3::Identity(),
            {{"pin", Vec3::Zero(), Mat3::Identity(), {}}, {"end", set.L2 * Vec3::UnitX(), Mat3::Identity(), {}}}),
        eigen.eigenvectors()};
  r.body.D.bottomRightCorner<3, 3>() = Vec3(1e-5, set.J2, set.J2).asDiagonal();  // about the pin
  r.body.omega = eigen.eigenvalues().cwiseSqrt();
  r.body.zeta = VectorXd::Zero(shapes);
  r.body.L = r.V.transpose() * M_zP;
  r.body.ports[0].Phi = shape(0.0) * r.V;
  r.body.ports[1].Phi = shape(set.L2) * r.V;
  r.body.shape_integrals = std::make_shared<const reduction::ShapeIntegrals>(
      reduction::shape_integrals(std::span<const LumpedNode>(nodes), all * r.V, Vec3::Zero()));
  return r;
}

Multibody slider_crank(const Rod& rod) {
  Multibody system;
  HingedBody crank;
  crank.name = "crank";
  crank.body = std::make_shared<const ReducedBody>(reduction::rigid_body(
      "crank", set.M1, Vec3(0.5 * set.L1, 0.0, 0.0), set.J1 * Mat3::Identity(),
      {{"axle", Vec3::Zero(), Mat3::Identity(), {}}, {"pin", set.L1 * Vec3::UnitX(), Mat3::Identity(), {}}}));
  crank.outer_port = 0;
  crank.kind = HingeKind::revolute;
  crank.inertia = VectorXd::Constant(1, 1e9);  // a flywheel: the speed changes by 1e-9
  HingedBody bar;
  bar.name = "rod";
  bar.body = std::make_shared<const ReducedBody>(rod.body);
  bar.parent = 0;
  bar.inner_port = 1;  // of the crank; hung by its reference, so that the shapes' slope at the pin turns nothing
  bar.kind = HingeKind::revolute;
  HingedBody slider;
  slider.name = "slider";
  slider.body = std::make_shared<const ReducedBody>(reduction::rigid_body(
      "slider", set.M3, Vec3::Zero(), 1e-4 * Mat3::Identity(), {{"pin", Vec3::Zero(), Mat3::Identity(), {}}}));
  slider.outer_port = 0;
  slider.kind = HingeKind::prismatic;
  slider.inner_axes = slider.outer_axes = Eigen::AngleAxisd(0.5 * std::numbers::pi, Vec3::UnitY()).toRotationMatrix();
  system.bodies = {crank, bar, slider};
  Closure pin;
  pin.name = "wrist pin";
  pin.inner = {2, 0};
  pin.outer = {1, 1};
  pin.kind = HingeKind::spherical;
  system.closures = {pin};
  index(system);
  return system;
}

TEST(SliderCrank, ReachesThePublishedPositions) {
  const Rod bar = rod();
  const Multibody system = slider_crank(bar);
  // coordinates: crank angle, (η, rod angle), slider
  const Index rod_at = 1, angle_at = rod_at + shapes, slider_at = angle_at + 1;
  MotionState s = rest_state(system);
  const Eigen::PartialPivLU<MatrixXd> V(bar.V);
  s.q.segment(rod_at, shapes) = V.solve(Eigen::Vector4d(0.0, 0.0, 0.103339863e-4, 0.169327969e-4));
  s.q[slider_at] = 0.450016933;
  s.v[0] = speed;
  s.v.segment(rod_at, shapes) = V.solve(Eigen::Vector4d(0.444896105, 0.463434311e-2, -0.178591076e-5, -0.268938672e-5));
  s.v[angle_at] = -74.9957670 - speed;
  s.v[slider_at] = -0.268938672e-5;
  Sweeps sweeps = make_sweeps(system);
  ClosureRows rows = make_closure_rows(system);
  project(system, sweeps, rows, s);  // the set's initial values close the loop to nine digits

  VectorXd T(system.nv), lambda(rows.rows());
  ClosureInertia inertia;
  const auto rates = [&](const VectorXd& q, const VectorXd& v) {
    VectorXd v_dot(system.nv);
    set_state(system, q, v, sweeps);
    passive_forces(system, q, v, T);
    closure_rows(system, sweeps, q, v, rows);
    articulate(system, sweeps);
    forward_dynamics(system, sweeps, T, v_dot);
    closure_inertia(system, sweeps, rows, inertia);
    close(rows, inertia, v_dot, lambda);
    return v_dot;
  };
  constexpr int steps = 20000;
  const double h = 0.1 / steps;
  for (int k = 0; k < steps; ++k) {  // Runge and Kutta's fourth order; no attitudes, so q adds
    const VectorXd k1 = rates(s.q, s.v), v2 = s.v + 0.5 * h * k1, k2 = rates(s.q + 0.5 * h * s.v, v2),
                   v3 = s.v + 0.5 * h * k2, k3 = rates(s.q + 0.5 * h * v2, v3), v4 = s.v + h * k3,
                   k4 = rates(s.q + h * v3, v4);
    s.q += h / 6.0 * (s.v + 2.0 * v2 + 2.0 * v3 + v4);
    s.v += h / 6.0 * (k1 + 2.0 * k2 + 2.0 * k3 + k4);
    if (k % 100 == 99) project(system, sweeps, rows, s);
  }
  const double crank = s.q[0], rod_angle = s.q[angle_at] + s.q[0];
  const VectorXd q = bar.V * s.q.segment(rod_at, shapes);
  std::cout << "crank " << crank - 15.0 << ", rod " << rod_angle / -3.311734987910881e-1 - 1.0 << ", slider "
            << s.q[slider_at] / 1.697373326718410e-1 - 1.0 << ", bending " << q[0] / 1.893192460247178e-4 - 1.0 << " "
            << q[1] / 2.375751865617931e-5 - 1.0 << "\n";
  EXPECT_NEAR(crank, 15.0, 1e-8);
  EXPECT_NEAR(rod_angle / -3.311734987910881e-1, 1.0, 1e-4);
  EXPECT_NEAR(s.q[slider_at] / 1.697373326718410e-1, 1.0, 1e-4);
}

}  // namespace
}  // namespace tenon::assembly
