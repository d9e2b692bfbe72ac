#include "assembly/second_order.hpp"

#include <fmt/format.h>

#include <Eigen/LU>
#include <set>

#include "assembly/disjoint.hpp"
#include "assembly/kinematics.hpp"
#include "assembly/normal_basis.hpp"
#include "fem/error.hpp"

namespace tenon::assembly {

using Eigen::Index;
using Eigen::MatrixXcd;
using Eigen::MatrixXd;
using Eigen::VectorXd;

namespace {

// Bodies that take part in a motion over q.
std::string moving_bodies(const Network& network, const DisjointSystem& d, const VectorXd& motion) {
  std::set<std::string> names;
  const double largest = motion.cwiseAbs().maxCoeff();
  for (std::size_t k = 0; k < network.bodies.size(); ++k)
    if (motion.segment(d.offset[k], 6 + network.bodies[k].n()).cwiseAbs().maxCoeff() > 0.1 * largest)
      names.insert("'" + network.bodies[k].name + "'");
  return fmt::format("{}", fmt::join(names, ", "));
}

}  // namespace

SecondOrderSystem second_order(const Network& network) {
  DisjointSystem d = disjoint(network);
  const NormalBasis basis = normal_basis({d.G, d.stiffness_root, d.mass_root, d.scale},
                                         [&](const VectorXd& motion) { return moving_bodies(network, d, motion); });
  SecondOrderSystem s;
  s.rank = basis.rank;
  s.redundant = static_cast<int>(basis.redundant.size());
  for (const int i : basis.redundant) s.redundant_rows.push_back(d.row_names[static_cast<std::size_t>(i)]);
  s.rank_gap = basis.rank_gap;
  s.rigid = basis.rigid;
  s.massless = basis.massless;
  s.N = basis.N;
  s.G = basis.G;

  const Index n = s.N.cols(), f = basis.sigma.size();
  VectorXd stiffness = VectorXd::Zero(n), mass = VectorXd::Ones(n);  // n = 0: nothing can move
  stiffness.tail(f).setOnes();
  mass.tail(f) = basis.sigma.cwiseAbs2();
  s.K = stiffness.asDiagonal();
  s.M = mass.asDiagonal();
  const MatrixXd E = d.damping_root * s.N;
  s.C = E.transpose() * E;
  s.B = s.N.transpose() * d.B;
  const MatrixXd rows = d.position_rows * s.N;
  s.C_position = s.C_velocity = s.C_acceleration = MatrixXd::Zero(rows.rows(), n);
  for (Index i = 0; i < rows.rows(); ++i) {
    const Quantity quantity = network.outputs[static_cast<std::size_t>(i)].quantity;
    (quantity == Quantity::position   ? s.C_position
     : quantity == Quantity::velocity ? s.C_velocity
                                      : s.C_acceleration)
        .row(i) = rows.row(i);
  }
  s.offset = std::move(d.offset);
  s.placement = std::move(d.placement);
  return s;
}

SystemModes modes(const SecondOrderSystem& s) {
  const Index n = s.M.rows(), count = n - s.massless;
  SystemModes m{VectorXd::Zero(count), VectorXd::Zero(count), MatrixXd::Identity(n, count), s.rigid};
  for (Index i = s.rigid; i < count; ++i) {
    const double omega = 1.0 / std::sqrt(s.M(i, i));  // K = 1
    m.omega[i] = omega;
    m.shapes(i, i) = omega;
    m.zeta[i] = 0.5 * omega * s.C(i, i);  // (φᵀCφ)/(2ω), φ = ω e_i
  }
  return m;
}

MatrixXcd motion(const SecondOrderSystem& s, double omega) {
  if (omega == 0.0 && s.rigid > 0)
    throw ModelError(fmt::format("a network with {} rigid motions has no static response", s.rigid),
                     "Ask at a frequency above zero, or ground the network");
  if (s.M.rows() == 0) return MatrixXcd::Zero(0, s.B.cols());
  // scaled by the size of each diagonal entry, K + ω²M + ωC
  const VectorXd scale =
      (s.K.diagonal() + omega * omega * s.M.diagonal() + std::abs(omega) * s.C.diagonal()).cwiseSqrt().cwiseInverse();
  const std::complex<double> j(0.0, 1.0);
  MatrixXcd Z = scale.asDiagonal() * (j * omega * s.C) * scale.asDiagonal();
  Z.diagonal() += scale.cwiseAbs2().cwiseProduct(s.K.diagonal() - omega * omega * s.M.diagonal());
  const Eigen::PartialPivLU<MatrixXcd> lu(Z);
  if (!(lu.matrixLU().diagonal().cwiseAbs().minCoeff() > 0.0))
    throw NumericalError(fmt::format("the response at {} rad/s does not exist, it is an undamped resonance", omega),
                         0.0, "Ask beside it, or give the bodies damping");
  const MatrixXd B = scale.asDiagonal() * s.B;
  return scale.asDiagonal() * lu.solve(B.cast<std::complex<double>>());
}

MatrixXcd response(const SecondOrderSystem& s, double omega) {
  const std::complex<double> j(0.0, 1.0);
  return (s.C_position + j * omega * s.C_velocity - omega * omega * s.C_acceleration) * motion(s, omega);
}

namespace {

// Motions without mass follow the inputs statically: ξ0 = B0 u (K = 1). What that makes improper is refused; products
// below 1e-12 of their factors are round-off.
void check_static_part(const Network& network, const SecondOrderSystem& s) {
  const auto B0 = s.B.bottomRows(s.massless);
  if (s.C.bottomRows(s.massless).cwiseAbs().maxCoeff() > 1e-12 * s.C.cwiseAbs().maxCoeff())
    throw ModelError(
        fmt::format("the network has {} elastic motions without mass, some damped; they have no modal state space",
                    s.massless),
        "Give the bodies at damped joints an inertia, or use the frequency response");
  for (const MatrixXd* rows : {&s.C_velocity, &s.C_acceleration})
    for (Index i = 0; i < rows->rows(); ++i)
      for (Index u = 0; u < B0.cols(); ++u)
        if (std::abs(rows->row(i).tail(s.massless).dot(B0.col(u))) > 1e-12 * rows->row(i).norm() * s.B.col(u).norm())
          throw ModelError(
              fmt::format("output '{}' follows input '{}' through an elastic motion without mass, so it is improper",
                          network.outputs[static_cast<std::size_t>(i)].name,
                          network.inputs[static_cast<std::size_t>(u)].name),
              "Give the port of the input an inertia, or ask for the position");
}

}  // namespace

titop::StateSpace state_space(const Network& network, const SecondOrderSystem& s) {
  if (s.massless > 0) check_static_part(network, s);
  const SystemModes m = modes(s);
  const Index k = m.omega.size();
  const MatrixXd &T = m.shapes, B = T.transpose() * s.B, C = T.transpose() * s.C * T, Ca = s.C_acceleration * T;

  titop::StateSpace ss;
  ss.A = MatrixXd::Zero(2 * k, 2 * k);
  ss.A.topRightCorner(k, k).setIdentity();
  ss.A.bottomLeftCorner(k, k).diagonal() = -m.omega.cwiseAbs2();
  ss.A.bottomRightCorner(k, k) = -C;
  ss.B = MatrixXd::Zero(2 * k, B.cols());
  ss.B.bottomRows(k) = B;
  ss.C.resize(Ca.rows(), 2 * k);
  ss.C << s.C_position * T + Ca * ss.A.bottomLeftCorner(k, k), s.C_velocity * T - Ca * C;
  ss.D = Ca * B + s.C_position.rightCols(s.massless) * s.B.bottomRows(s.massless);
  for (const Input& input : network.inputs) ss.inputs.push_back(channel(input));
  for (const Output& output : network.outputs) ss.outputs.push_back(channel(output));
  titop::check(ss);
  return ss;
}

}  // namespace tenon::assembly
