#include "assembly/steady_motion.hpp"

#include <fmt/format.h>

#include <Eigen/QR>
#include <algorithm>
#include <cmath>
#include <limits>

#include "assembly/rank.hpp"
#include "assembly/recursion/closure.hpp"
#include "fem/error.hpp"
#include "fem/rotation.hpp"
#include "reduction/roots.hpp"

namespace tenon::assembly {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

namespace {

// A floating piece: where its three translations stand among the nv and the nq; three turns follow, four numbers there.
struct Floating {
  Index v, q;
};

std::vector<Floating> floating(const Multibody& system) {
  std::vector<Floating> pieces;
  for (std::size_t k = 0; k < system.bodies.size(); ++k)
    if (system.bodies[k].kind == HingeKind::free)
      pieces.push_back({system.v_offset[k] + system.bodies[k].modes(), system.q_offset[k] + system.bodies[k].modes()});
  return pieces;
}

Mat3 attitude(const MotionState& state, const Floating& piece) {
  return Eigen::Quaterniond(state.q.data() + piece.q + 3).toRotationMatrix();
}

// ω, world axes
Vec3 spin(const MotionState& state, const Floating& piece) {
  return attitude(state, piece) * state.v.segment<3>(piece.v + 3);
}

// What steady turning brings in: ω² of spins, g over the size of the system.
double own_frequency(const Multibody& system, const VectorXd& v) {
  double square = 0.0;
  for (std::size_t k = 0; k < system.bodies.size(); ++k) {
    const HingedBody& b = system.bodies[k];
    const Index first = system.v_offset[k] + b.modes() + (b.kind == HingeKind::free ? 3 : 0);
    const Index last = system.v_offset[k] + b.modes() + b.dofs();
    square = std::max(square, v.segment(first, last - first).squaredNorm());
  }
  return std::sqrt(square + system.gravity.norm() / make_closure_rows(system).length);
}

// m L w² in coordinates of unit mass, the load that motion or gravity makes of the heaviest body: √m L w².
double natural_force(const Multibody& system, double frequency) {
  double mass = 0.0;
  for (const HingedBody& b : system.bodies) mass = std::max(mass, b.body->D(0, 0));
  return std::sqrt(mass) * make_closure_rows(system).length * frequency * frequency;
}

// Displacements δ about a motion whose spins stand in space: a floating piece that moves keeps ω and circles with it.
void displace(const Multibody& system, const VectorXd& delta, SteadyMotion& motion) {
  const std::vector<Floating> pieces = floating(system);
  std::vector<Vec3> omega;
  for (const Floating& piece : pieces) omega.push_back(spin(motion.state, piece));
  move(system, delta, motion.state.q);
  for (std::size_t k = 0; k < pieces.size(); ++k) {
    const Floating& piece = pieces[k];
    motion.state.v.segment<3>(piece.v) += omega[k].cross(Vec3(delta.segment<3>(piece.v)));
    motion.state.v.segment<3>(piece.v + 3) = attitude(motion.state, piece).transpose() * omega[k];
    motion.v_dot.segment<3>(piece.v) = omega[k].cross(Vec3(motion.state.v.segment<3>(piece.v)));
  }
}

ClosureRows closures(const Multibody& system, const MotionState& state) {
  Sweeps sweeps = make_sweeps(system);
  set_state(system, state.q, state.v, sweeps);
  ClosureRows rows = make_closure_rows(system);
  closure_rows(system, sweeps, state.q, state.v, rows);
  return rows;
}

// Joints that turn at a rate: the search leaves them.
bool spun(const HingedBody& b, Index i, double rate) {
  return i >= b.modes() && b.kind != HingeKind::free && rate != 0.0;
}

// The coordinates that the search may move. Joints that turn must leave closed loops as they are.
std::vector<Index> searched(const Multibody& system, const MotionState& state) {
  std::vector<Index> list;
  const MatrixXd J_t = closures(system, state).J_t;
  const double size = J_t.size() > 0 ? J_t.cwiseAbs().maxCoeff() : 0.0;
  for (std::size_t k = 0; k < system.bodies.size(); ++k) {
    const HingedBody& b = system.bodies[k];
    for (Index i = 0; i < b.modes() + b.dofs(); ++i) {
      const Index at = system.v_offset[k] + i;
      if (!spun(b, i, state.v[at]))
        list.push_back(at);
      else if (size > 0.0 && J_t.row(at).cwiseAbs().maxCoeff() > 1e-9 * size)
        throw ModelError(fmt::format("the initial motion is not steady: '{}' runs in a closed loop",
                                     coordinate_names(system)[static_cast<std::size_t>(at)]),
                         "Keep to rates that leave the loops as they are, or use `tenon simulate`");
    }
  }
  return list;
}

// Newton's step, δ = N y − J⁺ gap, Nᵀ K N y = −Nᵀ r, in coordinates of unit mass; directions without stiffness stay.
struct Step {
  VectorXd delta;                 // nv
  double open = 0.0, size = 0.0;  // what is out of balance, and of what should be in it, in coordinates of unit mass
  double gap = 0.0;               // of loops, relative
  Index worst = 0;                // coordinate that is most out of balance
};

Step newton_step(const Multibody& system, const SteadyMotion& motion, const std::vector<Index>& at) {
  const LinearMotion linear = linearise(system, motion);
  const Imbalance r = imbalance(system, motion);
  const VectorXd d = linear.M.diagonal()(at).cwiseSqrt().cwiseInverse();
  const MatrixXd K = d.asDiagonal() * MatrixXd(linear.K(at, at)) * d.asDiagonal();
  const MatrixXd J = linear.J(Eigen::all, at) * d.asDiagonal();
  const VectorXd force = d.cwiseProduct(VectorXd(r.force(at)));
  MatrixXd N = MatrixXd::Identity(d.size(), d.size());
  VectorXd step = VectorXd::Zero(d.size());
  Step result;
  result.delta = VectorXd::Zero(system.nv);
  if (J.rows() > 0) {
    N = row_space(J, J.rowwise().norm(), "the rows that close the loops").null;
    const ClosureRows rows = closures(system, motion.state);
    const VectorXd closing = -rows.gap;
    step = J.completeOrthogonalDecomposition().solve(closing);
    result.gap = rows.gap.cwiseAbs().maxCoeff() / rows.length;
  }
  const VectorXd out = N.transpose() * (force + K * step);
  const reduction::ThinSvd svd = reduction::thin_svd(N.transpose() * K * N);
  const VectorXd& sigma = svd.sigma;
  const double least =
      std::max(1e-9 * motion.frequency * motion.frequency, 1e-14 * (sigma.size() > 0 ? sigma[0] : 0.0));
  VectorXd y = svd.U.transpose() * out;
  for (Index i = 0; i < y.size(); ++i) y[i] = sigma[i] > least ? -y[i] / sigma[i] : 0.0;
  step += N * (svd.V * y);
  result.delta(at) = d.cwiseProduct(step);
  const VectorXd open = N * (N.transpose() * force);
  result.open = open.norm();
  result.size = d.cwiseProduct(VectorXd(r.size(at))).norm();
  open.cwiseAbs().maxCoeff(&result.worst);
  result.worst = at[static_cast<std::size_t>(result.worst)];
  return result;
}

// Largest angle among the displacements.
double largest_turn(const Multibody& system, const VectorXd& delta) {
  double most = 0.0;
  for (std::size_t k = 0; k < system.bodies.size(); ++k) {
    const HingedBody& b = system.bodies[k];
    const Index turns = std::min(b.dofs(), 3);  // the last
    const Index first = system.v_offset[k] + b.modes() + b.dofs() - turns;
    if (turns > 0) most = std::max(most, delta.segment(first, turns).cwiseAbs().maxCoeff());
  }
  return most;
}

}  // namespace

Imbalance imbalance(const Multibody& system, const SteadyMotion& motion) {
  Sweeps sweeps = make_sweeps(system);
  set_state(system, motion.state.q, motion.state.v, sweeps);
  VectorXd T(system.nv), passive(system.nv);
  inverse_dynamics(system, sweeps, motion.v_dot, T);
  passive_forces(system, motion.state.q, motion.state.v, passive);
  MatrixXd force = (T - passive).transpose(), size = (T.cwiseAbs() + passive.cwiseAbs()).transpose();
  turn_columns(system, motion, force);
  return {force.transpose(), size.transpose()};
}

void turn_columns(const Multibody& system, const SteadyMotion& motion, MatrixXd& columns) {
  for (const Floating& piece : floating(system)) {
    const Vec3 angle = motion.time * spin(motion.state, piece);
    const MatrixXd turned = columns.middleCols<3>(piece.v) * fem::rotation_matrix(angle);
    columns.middleCols<3>(piece.v) = turned;
  }
}

LinearMotion linearise(const Multibody& system, const SteadyMotion& motion) {
  LinearMotion linear = linearise(system, motion.state, motion.v_dot);
  for (MatrixXd* matrix : {&linear.M, &linear.C, &linear.K}) {
    turn_columns(system, motion, *matrix);
    MatrixXd rows = matrix->transpose();
    turn_columns(system, motion, rows);
    *matrix = rows.transpose();
  }
  turn_columns(system, motion, linear.J);
  for (const Floating& piece : floating(system)) {
    const Mat3 Omega = fem::skew(spin(motion.state, piece));  // ω is the same in both axes
    const MatrixXd M = linear.M.middleCols<3>(piece.v), C = linear.C.middleCols<3>(piece.v);
    linear.C.middleCols<3>(piece.v) += 2.0 * M * Omega;
    linear.K.middleCols<3>(piece.v) += C * Omega + M * Omega * Omega;
  }
  return linear;
}

SteadyMotion later(const Multibody& system, SteadyMotion motion, double time) {
  const std::vector<Floating> pieces = floating(system);
  std::vector<Vec3> omega;
  for (const Floating& piece : pieces) omega.push_back(spin(motion.state, piece));
  move(system, time * motion.state.v, motion.state.q);  // where a floating piece is makes no difference
  for (std::size_t k = 0; k < pieces.size(); ++k) {
    const Mat3 Q = fem::rotation_matrix(time * omega[k]);
    for (VectorXd* rates : {&motion.state.v, &motion.v_dot})
      rates->segment<3>(pieces[k].v) = Q * Vec3(rates->segment<3>(pieces[k].v));
  }
  motion.time += time;
  return motion;
}

SteadyMotion steady_motion(const Multibody& system, const MotionState& start) {
  constexpr int most_steps = 50;
  constexpr double balanced = 1e-9, still = 1e-13;  // of the forces that balance; below the second: round-off
  SteadyMotion motion;
  motion.state = start;
  motion.v_dot = VectorXd::Zero(system.nv);
  motion.frequency = own_frequency(system, start.v);
  for (std::size_t k = 0; k < system.bodies.size(); ++k)
    motion.state.v.segment(system.v_offset[k], system.bodies[k].modes()).setZero();
  displace(system, VectorXd::Zero(system.nv), motion);
  {
    Sweeps sweeps = make_sweeps(system);
    set_state(system, motion.state.q, motion.state.v, sweeps);
    articulate(system, sweeps);  // names what has no inertia
  }
  const std::vector<Index> at = searched(system, motion.state);
  double last = std::numeric_limits<double>::infinity(), size = natural_force(system, motion.frequency);
  const bool rests = motion.frequency == 0.0 && imbalance(system, motion).size.isZero(0.0);
  for (int count = 0; !rests && !at.empty(); ++count) {
    Step step = newton_step(system, motion, at);
    size = std::max(size, step.size);
    const double ratio = std::max(step.gap, size > 0.0 ? step.open / size : 0.0);
    if (ratio <= still || (ratio <= balanced && ratio > 0.5 * last)) break;
    if (count == most_steps || step.delta.isZero(0.0))
      throw NumericalError(
          fmt::format("there is no steady motion near the initial one: '{}' stays out of balance, relative force",
                      coordinate_names(system)[static_cast<std::size_t>(step.worst)]),
          ratio, "Start near an equilibrium, spin about a principal axis, hold what falls, or leave the rate out");
    last = ratio;
    if (const double turn = largest_turn(system, step.delta); turn > 0.5) step.delta *= 0.5 / turn;
    displace(system, step.delta, motion);
  }
  const Imbalance rest = imbalance(system, motion);
  motion.force = size;
  for (std::size_t k = 0; k < system.bodies.size(); ++k)
    if (system.bodies[k].kind == HingeKind::revolute) {
      const Index hinge = system.q_offset[k] + system.bodies[k].modes();
      motion.turned = std::max(motion.turned, std::abs(motion.state.q[hinge] - start.q[hinge]));
    }
  motion.held = rest.force;
  for (const Index i : at) motion.held[i] = 0.0;
  return motion;
}

std::vector<std::string> coordinate_names(const Multibody& system) {
  std::vector<std::string> names;
  constexpr const char* six[] = {"x", "y", "z", "rx", "ry", "rz"};
  for (const HingedBody& b : system.bodies) {
    for (int i = 1; i <= b.modes(); ++i) names.push_back(fmt::format("{}.mode {}", b.name, i));
    if (b.kind == HingeKind::free)
      for (const char* direction : six) names.push_back(fmt::format("{}.{}", b.name, direction));
    else
      for (int i = 0; i < b.dofs(); ++i) names.push_back(fmt::format("{}.turn", b.name));
  }
  return names;
}

}  // namespace tenon::assembly
