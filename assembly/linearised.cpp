#include "assembly/linearised.hpp"

#include <fmt/format.h>

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

#include "assembly/kinematics.hpp"
#include "assembly/normal_basis.hpp"
#include "assembly/recursion/port_motion.hpp"
#include "fem/error.hpp"
#include "reduction/roots.hpp"

namespace tenon::assembly {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::RowVectorXd;
using Eigen::VectorXd;

namespace {

std::size_t index(int k) { return static_cast<std::size_t>(k); }

// What an input works on or an output reads, 1×nv, and how its axis turns with the motion.
struct Row {
  RowVectorXd values;     // P: displacement P ξ
  RowVectorXd turned[2];  // (ω × P) and (ω × (ω × P)) along the same direction: of translations
  bool translation = false;
};

struct StateRows {
  const Network& network;
  const NetworkMultibody& bodies;
  const SteadyMotion& start;  // at time 0: ports' axes are world axes
  const SteadyMotion& motion;
  Sweeps sweeps, sweeps_start;

  StateRows(const Network& net, const NetworkMultibody& mb, const SteadyMotion& first, const SteadyMotion& now)
      : network(net), bodies(mb), start(first), motion(now), sweeps(make_sweeps(mb.system)), sweeps_start(sweeps) {
    set_state(mb.system, now.state.q, now.state.v, sweeps);
    set_state(mb.system, first.state.q, first.state.v, sweeps_start);
  }

  // columns over ξ of a port's displacement and rotation along three axes of the world
  MatrixXd along(const PortRef& port, const Mat3& axes, Vec3& omega) const {
    const Multibody& system = bodies.system;
    Mat6X Pi = system.bodies[index(port.body)].body->ports[index(port.port)].Phi;
    const PortMotion p = port_motion(system, sweeps, motion.state.q, motion.state.v, port, Vec3::Zero(), Pi);
    omega = axes.transpose() * p.V.tail<3>();
    MatrixXd rows(6, system.nv);
    for (int i = 0; i < 6; ++i) {
      Vec6 unit = Vec6::Zero();
      unit.segment<3>(i < 3 ? 0 : 3) = axes.col(i % 3);
      VectorXd column = VectorXd::Zero(system.nv);
      add_generalised_force(system, sweeps, p, port, Pi, unit, column);
      rows.row(i) = column;
    }
    turn_columns(system, motion, rows);
    return rows;
  }

  Row port(const PortRef& named, int direction) const {
    const PortRef ref{bodies.body[index(named.body)], named.port};
    const Mat3 axes = sweeps.bodies[index(ref.body)].world.R * sweeps_start.bodies[index(ref.body)].world.R.transpose();
    Vec3 omega;
    const MatrixXd rows = along(ref, axes, omega);
    Row row{rows.row(direction), {}, direction < 3};
    const Mat3 Omega = fem::skew(omega);
    const Index i = direction % 3, first = direction < 3 ? 0 : 3;
    row.turned[0] = Omega.row(i) * rows.middleRows(first, 3);
    row.turned[1] = (Omega * Omega).row(i) * rows.middleRows(first, 3);
    return row;
  }

  // the angle of a joint: no axes to turn
  Row joint(int j) const {
    const Multibody& system = bodies.system;
    MatrixXd row = MatrixXd::Zero(1, system.nv);
    if (const int body = bodies.hinge[index(j)]; body >= 0) {
      row(0, system.v_offset[index(body)] + system.bodies[index(body)].modes()) = 1.0;
    } else {
      const Closure& c = system.closures[index(bodies.closure[index(j)])];
      Vec3 omega;
      Mat6X Pi = system.bodies[index(c.inner.body)].body->ports[index(c.inner.port)].Phi;
      const PortMotion a = port_motion(system, sweeps, motion.state.q, motion.state.v, c.inner, Vec3::Zero(), Pi);
      const Vec3 axis = a.pose.R * c.inner_axes.col(2);
      row = axis.transpose() * (along(c.outer, Mat3::Identity(), omega).bottomRows<3>() -
                                along(c.inner, Mat3::Identity(), omega).bottomRows<3>());
    }
    return {row, {}, false};
  }

  Row of(const Input& input) const { return input.at ? port(*input.at, input.direction) : joint(*input.joint); }
  Row of(const Output& output) const { return output.at ? port(*output.at, output.direction) : joint(*output.joint); }
};

// Whether two rows or matrices differ by more than 1e-6 of `size`, entry by entry.
bool differ(const MatrixXd& a, const MatrixXd& b, const MatrixXd& size) {
  return ((a - b).array().abs() > 1e-6 * size.array()).any();
}

double turning_rate(const Multibody& system, const VectorXd& v) {
  double rate = 0.0;
  for (std::size_t k = 0; k < system.bodies.size(); ++k) {
    const HingedBody& b = system.bodies[k];
    const Index turns = std::min(b.dofs(), 3);  // the last
    rate = std::max(rate, v.segment(system.v_offset[k] + b.modes() + b.dofs() - turns, turns).norm());
  }
  return rate;
}

// The same equations when the fastest joint has turned by 1 rad, no part of a turn that symmetry could repeat: else no
// constant matrices describe the motion.
void check_steady(const Network& network, const NetworkMultibody& bodies, const SteadyMotion& now,
                  const LinearMotion& linear) {
  const Multibody& system = bodies.system;
  const double w = turning_rate(system, now.state.v);
  if (w == 0.0) return;
  const SteadyMotion then = later(system, now, 1.0 / w);
  const LinearMotion other = linearise(system, then);
  const VectorXd d = linear.M.diagonal().cwiseSqrt();
  const MatrixXd dd = d * d.transpose();
  const double least = 1e-8 * d.cwiseInverse().maxCoeff();  // rows that move nothing are round-off
  const auto row_size = [&](const MatrixXd& rows) -> MatrixXd {
    return (rows * d.cwiseInverse().asDiagonal()).rowwise().lpNorm<Eigen::Infinity>().cwiseMax(least) * d.transpose();
  };
  const Imbalance a = imbalance(system, now), b = imbalance(system, then);
  if (differ(other.M, linear.M, dd) || differ(other.C, linear.C, w * dd + linear.C.cwiseAbs()) ||
      differ(other.K, linear.K, w * w * dd + linear.K.cwiseAbs()) || differ(other.J, linear.J, row_size(linear.J)) ||
      differ(b.force, a.force, now.force * d))
    throw ModelError(
        "the initial motion is not steady: its equations change as it goes on, so that no constant A, B, C, D describe "
        "it",
        "Keep to rates about axes round which everything looks alike, without gravity across them, or use `tenon "
        "simulate`");
  const StateRows first(network, bodies, now, now), second(network, bodies, now, then);
  const auto check = [&](const auto& channel, const char* what) {
    const Row p = first.of(channel), q = second.of(channel);
    const MatrixXd size = row_size(p.values);
    if (differ(q.values, p.values, size) || (p.translation && (differ(q.turned[0], p.turned[0], w * size) ||
                                                               differ(q.turned[1], p.turned[1], w * w * size))))
      throw ModelError(
          fmt::format("{} '{}' moves with a body that turns against what it rests on: what it does changes "
                      "round the turn, so that no constant matrices describe it",
                      what, channel.name),
          "Put it on a port of a body that does not turn, or leave it out");
  };
  for (const Input& input : network.inputs) check(input, "input");
  for (const Output& output : network.outputs) check(output, "output");
}

void set_channels(const Network& network, const NetworkMultibody& bodies, LinearisedNetwork& l) {
  const StateRows rows(network, bodies, l.about, l.about);
  const Index nv = bodies.system.nv;
  l.B.resize(nv, static_cast<Index>(network.inputs.size()));
  for (std::size_t i = 0; i < network.inputs.size(); ++i)
    l.B.col(static_cast<Index>(i)) = rows.of(network.inputs[i]).values.transpose();
  l.C_position = l.C_velocity = l.C_acceleration = MatrixXd::Zero(static_cast<Index>(network.outputs.size()), nv);
  for (std::size_t k = 0; k < network.outputs.size(); ++k) {
    const auto i = static_cast<Index>(k);
    const Row row = rows.of(network.outputs[k]);
    const bool port = network.outputs[k].at.has_value();
    switch (network.outputs[k].quantity) {
      case Quantity::position:
        l.C_position.row(i) = row.values;
        break;
      case Quantity::velocity:  // (Pξ)˙ + ω × Pξ; of an attitude the rate in axes that turn is (Pξ)˙ alone
        l.C_velocity.row(i) = row.values;
        if (row.translation) l.C_position.row(i) = row.turned[0];
        break;
      case Quantity::acceleration:  // (Pξ)¨ + 2 ω × (Pξ)˙ + ω × (ω × Pξ); of an attitude (Pξ)¨ + ω × (Pξ)˙
        l.C_acceleration.row(i) = row.values;
        if (port) l.C_velocity.row(i) = (row.translation ? 2.0 : 1.0) * row.turned[0];
        if (row.translation) l.C_position.row(i) = row.turned[1];
        break;
    }
  }
}

// ξ = T ζ by springs and modes alone; then the rigid ones that nothing holds first.
void set_basis(const Multibody& system, bool loaded, LinearisedNetwork& l) {
  VectorXd f(system.nv);
  for (std::size_t k = 0; k < system.bodies.size(); ++k) {
    const HingedBody& b = system.bodies[k];
    f.segment(system.v_offset[k], b.modes()) = b.body->omega;
    f.segment(system.v_offset[k] + b.modes(), b.dofs()) = b.stiffness.cwiseSqrt();
  }
  std::vector<Index> stiff;
  for (Index i = 0; i < f.size(); ++i)
    if (f[i] > 0.0) stiff.push_back(i);
  const MatrixXd F = MatrixXd(f.asDiagonal())(stiff, Eigen::all);
  const VectorXd d = l.M.diagonal().cwiseSqrt(), scale = d.cwiseInverse();
  const Eigen::LLT<MatrixXd> llt(MatrixXd(scale.asDiagonal() * l.M * scale.asDiagonal()));
  if (llt.info() != Eigen::Success)
    throw NumericalError("the mass matrix of the motion is not positive definite, smallest diagonal entry",
                         l.M.diagonal().minCoeff(), "Give every joint and every mode an inertia");
  const MatrixXd W = MatrixXd(llt.matrixU()) * d.asDiagonal();
  const NormalBasis basis = normal_basis({l.J, F, W, scale}, [&](const VectorXd& motion) {
    Index most = 0;
    motion.cwiseAbs().maxCoeff(&most);
    return l.coordinates[static_cast<std::size_t>(most)];
  });
  const Index r = basis.rigid;
  l.rank = basis.rank;
  l.T = basis.N;
  l.omega = VectorXd::Zero(l.T.cols());
  l.omega.tail(basis.sigma.size()) = basis.sigma.cwiseInverse();
  for (Index i = r; i < l.T.cols(); ++i) l.T.col(i) *= l.omega[i];
  l.free = basis.rigid;
  if (!loaded || r == 0) return;
  const MatrixXd K_rigid = l.T.transpose() * (l.K * l.T.leftCols(r));
  const reduction::ThinSvd svd = reduction::thin_svd(K_rigid);
  l.free = static_cast<int>((svd.sigma.array() <= 1e-9 * l.about.frequency * l.about.frequency).count());
  l.T.leftCols(r) = MatrixXd(l.T.leftCols(r) * svd.V.rowwise().reverse());
}

void set_state_space(const Network& network, const Multibody& system, bool loaded, LinearisedNetwork& l) {
  const Index n = l.T.cols();
  MatrixXd K = l.omega.cwiseAbs2().asDiagonal();
  if (loaded) {  // what motion and gravity add to springs and modes
    MatrixXd added = l.K;
    for (std::size_t k = 0; k < system.bodies.size(); ++k) {
      const HingedBody& b = system.bodies[k];
      const Index first = system.v_offset[k];
      added.diagonal().segment(first, b.modes()) -= b.body->omega.cwiseAbs2();
      added.diagonal().segment(first + b.modes(), b.dofs()) -= b.stiffness;
    }
    K += l.T.transpose() * added * l.T;
  }
  K.leftCols(l.free).setZero();
  const MatrixXd C = l.T.transpose() * l.C * l.T, Ca = l.C_acceleration * l.T, B = l.T.transpose() * l.B;
  titop::StateSpace& ss = l.ss;
  ss.A = MatrixXd::Zero(2 * n, 2 * n);
  ss.A.topRightCorner(n, n).setIdentity();
  ss.A.bottomLeftCorner(n, n) = -K;
  ss.A.bottomRightCorner(n, n) = -C;
  ss.B = MatrixXd::Zero(2 * n, B.cols());
  ss.B.bottomRows(n) = B;
  ss.C.resize(Ca.rows(), 2 * n);
  ss.C << l.C_position * l.T - Ca * K, l.C_velocity * l.T - Ca * C;
  ss.D = Ca * B;
  for (const Input& input : network.inputs) ss.inputs.push_back(channel(input));
  for (const Output& output : network.outputs) ss.outputs.push_back(channel(output));
  titop::check(ss);
}

}  // namespace

LinearisedNetwork linearised(const Network& network, const Simulation& simulation) {
  const NetworkMultibody& bodies = simulation.bodies;
  const Multibody& system = bodies.system;
  LinearisedNetwork l;
  l.about = steady_motion(system, simulation.start);
  LinearMotion linear = linearise(system, l.about);
  check_steady(network, bodies, l.about, linear);
  l.coordinates = coordinate_names(system);
  for (std::size_t j = 0; j < network.joints.size(); ++j)
    if (const int k = bodies.hinge[j]; k >= 0 && network.joints[j].kind == JointKind::revolute)
      l.coordinates[index(system.v_offset[index(k)] + system.bodies[index(k)].modes())] = network.joints[j].name;
  l.M = std::move(linear.M);
  l.C = std::move(linear.C);
  l.K = std::move(linear.K);
  l.J = std::move(linear.J);
  set_channels(network, bodies, l);
  const bool loaded = l.about.frequency > 0.0;
  set_basis(system, loaded, l);
  set_state_space(network, system, loaded, l);
  return l;
}

LinearisedModes modes(const LinearisedNetwork& l) {
  const Index n = l.T.cols(), f = l.free;
  const MatrixXd K = -l.ss.A.bottomLeftCorner(n, n), C = -l.ss.A.bottomRightCorner(n, n);
  LinearisedModes m;
  if (l.about.frequency == 0.0) {
    m.omega = l.omega;
    m.zeta = VectorXd::Zero(n);
    for (Index i = f; i < n; ++i) m.zeta[i] = 0.5 * C(i, i) / m.omega[i];
    return m;
  }
  // x = (S ζ beyond the free ones, ζ̇), S of the size of frequencies; the free ones are integrators
  const double w = l.about.frequency;
  const VectorXd S = K.diagonal().tail(n - f).cwiseAbs().cwiseMax(w * w).cwiseSqrt();
  MatrixXd A = MatrixXd::Zero(2 * n - f, 2 * n - f);
  A.topRightCorner(n - f, n - f) = S.asDiagonal();
  A.bottomLeftCorner(n, n - f) = -K.rightCols(n - f) * S.cwiseInverse().asDiagonal();
  A.bottomRightCorner(n, n) = -C;
  const Eigen::VectorXcd lambda = Eigen::EigenSolver<MatrixXd>(A, false).eigenvalues();
  m.poles.assign(lambda.begin(), lambda.end());
  m.poles.resize(static_cast<std::size_t>(2 * n), 0.0);
  std::stable_sort(m.poles.begin(), m.poles.end(), [](auto a, auto b) { return std::abs(a) < std::abs(b); });
  constexpr double noise = 1e-5;  // double poles split by the root of what differences leave
  std::vector<std::complex<double>> oscillations;
  for (const std::complex<double> pole : m.poles) {
    if (std::abs(pole) < noise * w) continue;
    if (pole.real() > noise * std::abs(pole)) m.growth = std::max(m.growth, pole.real());
    if (pole.imag() > noise * std::abs(pole)) oscillations.push_back(pole);
  }
  const auto count = static_cast<Index>(oscillations.size());
  m.omega = m.zeta = VectorXd::Zero(f + count);
  for (Index i = 0; i < count; ++i) {
    const std::complex<double> pole = oscillations[index(static_cast<int>(i))];
    m.omega[f + i] = std::abs(pole);
    m.zeta[f + i] = -pole.real() / std::abs(pole);
  }
  return m;
}

}  // namespace tenon::assembly
