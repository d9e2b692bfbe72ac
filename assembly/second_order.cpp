#include "assembly/second_order.hpp"

#include <fmt/format.h>

#include <Eigen/LU>
#include <set>

#include "assembly/disjoint.hpp"
#include "assembly/kinematics.hpp"
#include "assembly/rank.hpp"
#include "fem/error.hpp"
#include "reduction/roots.hpp"

namespace tenon::assembly {

using Eigen::Index;
using Eigen::MatrixXcd;
using Eigen::MatrixXd;
using Eigen::VectorXd;

namespace {

[[noreturn]] void refuse_massless(const Network& network, const DisjointSystem& d, const VectorXd& motion) {
  std::set<std::string> names;
  const double largest = motion.cwiseAbs().maxCoeff();
  for (std::size_t k = 0; k < network.bodies.size(); ++k)
    if (motion.segment(d.offset[k], 6 + network.bodies[k].n()).cwiseAbs().maxCoeff() > 0.1 * largest)
      names.insert("'" + network.bodies[k].name + "'");
  throw ModelError(
      fmt::format("the network can move with neither mass nor stiffness; moving: {}", fmt::join(names, ", ")),
      "Give that motion an inertia, a spring or a joint that holds it");
}

VectorXd row_lengths(const MatrixXd& rows) { return rows.rowwise().norm(); }

}  // namespace

// 1. null(G) in scaled coordinates q̂ (q = S q̂):                        q̂ = N0 x
// 2. null(F N0) by the rows' directions alone: rigid motions X, rest Y:   q̂ = X a + Y y
// 3. F Y P = Q R, y = P R⁻¹ z gives unit stiffness:                       K = zᵀz
// 4. W X = Q_x R_x, a = R_x⁻¹ α − (W X)⁺ W Y y: unit rigid mass, M-orthogonal
// 5. SVD of what remains of W: (1 − Q_x Q_xᵀ) W Y P R⁻¹ = U Σ Vᵀ, z = V ζ:  M = Σ², so ω = 1/σ
SecondOrderSystem second_order(const Network& network) {
  DisjointSystem d = disjoint(network);
  SecondOrderSystem s;
  const auto S = d.scale.asDiagonal();
  const MatrixXd G = d.G * S, F = d.stiffness_root * S, W = d.mass_root * S;
  const RowSpace held = row_space(G, row_lengths(G), "the joint rows");
  s.rank = held.rank;
  s.redundant = static_cast<int>(held.redundant.size());
  for (const int i : held.redundant) s.redundant_rows.push_back(d.row_names[static_cast<std::size_t>(i)]);
  s.rank_gap = held.gap;
  s.G = row_lengths(G).cwiseInverse().asDiagonal() * d.G;

  const RowSpace stiff = row_space(F * held.null, row_lengths(F), "the stiffness");
  const MatrixXd X = held.null * stiff.null, Y = held.null * stiff.range;
  const Index r = X.cols(), f = Y.cols(), n = r + f;
  const VectorXd mass_lengths = row_lengths(W);
  if (row_rank(W * X, mass_lengths, "the mass of the rigid motions") < r)
    refuse_massless(network, d, X * row_space(W * X, mass_lengths, "the mass of the rigid motions").null.col(0));
  s.rigid = static_cast<int>(r);
  s.massless = static_cast<int>(n) - row_rank(W * held.null, mass_lengths, "the mass");

  const MatrixXd Z = graded_qr(F * Y).times_inverse(Y);
  const GradedQR rigid = graded_qr(W * X, W * Z);
  const MatrixXd X_unit = rigid.times_inverse(X);
  const MatrixXd Z_free = Z - X_unit * rigid.Qt_apply.topRows(r);
  MatrixXd N(d.scale.size(), n);
  VectorXd sigma = VectorXd::Zero(f);
  N.leftCols(r) = X_unit;
  if (f > 0) {
    const MatrixXd rest = rigid.Qt_apply.bottomRows(W.rows() - r);
    const reduction::ThinSvd svd = reduction::thin_svd(rest);
    sigma.head(svd.sigma.size()) = svd.sigma;
    sigma.tail(s.massless).setZero();
    N.rightCols(f) = Z_free * svd.V;
  }
  s.N = S * N;

  VectorXd stiffness = VectorXd::Zero(n), mass = VectorXd::Ones(n);  // n = 0: nothing can move
  stiffness.tail(f).setOnes();
  mass.tail(f) = sigma.cwiseAbs2();
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
