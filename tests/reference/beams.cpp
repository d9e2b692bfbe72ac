#include "tests/reference/beams.hpp"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <cmath>
#include <numbers>

namespace tenon::reference {

ReducedBody planar_beam(const std::string& name, const Eigen::VectorXd& omega, const Eigen::MatrixXd& L,
                        const Eigen::MatrixXd& Phi_C) {
  ReducedBody body;
  body.name = name;
  body.omega = omega;
  body.zeta = Eigen::VectorXd::Zero(omega.size());
  body.D = fem::rigid_mass(1.0, {0.5, 0.0, 0.0}, fem::Vec3(0.0, 1.0 / 12.0, 1.0 / 12.0).asDiagonal());
  body.L = Eigen::MatrixXd::Zero(omega.size(), 6);
  body.L.col(1) = L.col(0);
  body.L.col(5) = L.col(1);
  reduction::BodyPort P, C;
  P.name = "P";
  P.Phi = fem::Mat6X::Zero(6, omega.size());
  C.name = "C";
  C.position = {1.0, 0.0, 0.0};
  C.Phi = P.Phi;
  C.Phi.row(1) = Phi_C.row(0);
  C.Phi.row(5) = Phi_C.row(1);
  body.ports = {P, C};
  return body;
}

double clamped_free_root(int i) {
  const auto f = [](double b) { return std::cos(b) + 1.0 / std::cosh(b); };
  const double centre = (i - 0.5) * std::numbers::pi;
  double a = i == 1 ? 1.5 : centre - 0.3, b = i == 1 ? 2.5 : centre + 0.3;
  for (int step = 0; step < 200 && b - a > 0.0; ++step) {
    const double c = 0.5 * (a + b);
    if (c == a || c == b) break;
    (f(a) * f(c) <= 0.0 ? b : a) = c;
  }
  return 0.5 * (a + b);
}

ReducedBody clamped_free_beam(const std::string& name, int modes) {
  Eigen::VectorXd omega(modes);
  Eigen::MatrixXd L(modes, 2), Phi(2, modes);
  for (int i = 0; i < modes; ++i) {
    const double b = clamped_free_root(i + 1), e = std::exp(-b), sign = i % 2 ? -1.0 : 1.0;
    const double sigma = (1.0 - 2.0 * e * std::sin(b) - e * e) / (1.0 + 2.0 * e * std::cos(b) + e * e);
    omega[i] = b * b;
    L.row(i) << 2.0 * sigma / b, 2.0 / (b * b);
    Phi.col(i) << 2.0 * sign, 2.0 * b * sigma * sign;
  }
  return planar_beam(name, omega, L, Phi);
}

ReducedBody polynomial_beam(const std::string& name) {
  Eigen::Matrix<double, 6, 6> M;
  M << 55440, 27720, 462, 27720, -5544, 462,  //
      27720, 18480, 198, 19800, -3432, 264,   //
      462, 198, 6, 181, -52, 5,               //
      27720, 19800, 181, 21720, -3732, 281,   //
      -5544, -3432, -52, -3732, 832, -69,     //
      462, 264, 5, 281, -69, 6;
  M /= 55440.0;
  Eigen::MatrixXd K(4, 4);
  K << 6, -30, 8, 1, -30, 1200, -600, 30, 8, -600, 384, -22, 1, 30, -22, 6;
  K /= 70.0;
  Eigen::Matrix<double, 2, 4> Phi;
  Phi << 0, 1, 0, 0, 0, 0, 1, 0;
  const Eigen::GeneralizedSelfAdjointEigenSolver<Eigen::MatrixXd> eigen(K,
                                                                        Eigen::MatrixXd(M.bottomRightCorner<4, 4>()));
  const Eigen::MatrixXd V = eigen.eigenvectors();
  return planar_beam(name, eigen.eigenvalues().cwiseSqrt(), V.transpose() * M.bottomLeftCorner<4, 2>(), Phi * V);
}

}  // namespace tenon::reference
