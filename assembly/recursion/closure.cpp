#include "assembly/recursion/closure.hpp"

#include <fmt/format.h>

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <span>

#include "assembly/recursion/port_motion.hpp"
#include "fem/error.hpp"

namespace tenon::assembly {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

namespace {

// What a hinge forbids, in its inboard frame a and its outboard frame b, r from the origin of a to that of b:
// a_i·r = 0 and a_i·b_j = 0.
struct Forbidden {
  std::array<bool, 3> slides;
  std::span<const std::array<int, 2>> turns;
};
constexpr std::array<std::array<int, 2>, 3> all_turns{{{0, 2}, {1, 2}, {1, 0}}};
constexpr std::array<std::array<int, 2>, 1> cross{{{0, 1}}};  // universal: x of one side stays across y of the other

Forbidden forbidden(HingeKind kind) {
  const std::span<const std::array<int, 2>> turns(all_turns), tilts = turns.first(2), none = turns.first(0);
  switch (kind) {
    case HingeKind::weld:
      return {{true, true, true}, turns};
    case HingeKind::revolute:
      return {{true, true, true}, tilts};
    case HingeKind::prismatic:
      return {{true, true, false}, turns};
    case HingeKind::cylindrical:
      return {{true, true, false}, tilts};
    case HingeKind::universal:
      return {{true, true, true}, cross};
    case HingeKind::spherical:
      return {{true, true, true}, none};
    case HingeKind::planar:
      return {{false, false, true}, tilts};
    case HingeKind::free:
      break;
  }
  return {{false, false, false}, none};
}

constexpr double cancelled = 1e-13;  // of what was summed: a row below moves nothing, what is left is round-off

Index row_count(HingeKind kind) { return 6 - hinge_dofs(kind); }

double reach(const Multibody& system) {
  double length = 0.0;
  for (const HingedBody& b : system.bodies)
    for (const reduction::BodyPort& port : b.body->ports)
      length = std::max(length, (port.position - b.body->reference).norm());
  return length > 0.0 ? length : 1.0;
}

}  // namespace

ClosureRows make_closure_rows(const Multibody& system) {
  Index rows = 0, most = 0;
  for (const Closure& c : system.closures) rows += row_count(c.kind);
  for (const HingedBody& b : system.bodies) most = std::max<Index>(most, b.modes());
  ClosureRows r;
  r.gap = r.rate = r.gamma = VectorXd::Zero(rows);
  r.J_t = MatrixXd::Zero(system.nv, rows);
  r.on_outer = Mat6X::Zero(6, rows);
  r.length = reach(system);
  for (const Closure& c : system.closures)
    for (const PortRef& port : {c.inner, c.outer})
      r.shapes.push_back(
          Mat6X::Zero(6, port.body < 0 ? 0 : system.bodies[static_cast<std::size_t>(port.body)].modes()));
  return r;
}

void closure_rows(const Multibody& system, const Sweeps& sweeps, const VectorXd& q, const VectorXd& v,
                  ClosureRows& rows) {
  rows.J_t.setZero();
  Index row = 0;
  for (std::size_t c = 0; c < system.closures.size(); ++c) {
    const Closure& closure = system.closures[c];
    Mat6X &shapes_a = rows.shapes[2 * c], &shapes_b = rows.shapes[2 * c + 1];
    const PortMotion a = port_motion(system, sweeps, q, v, closure.inner, closure.inner_position, shapes_a);
    const PortMotion b = port_motion(system, sweeps, q, v, closure.outer, Vec3::Zero(), shapes_b);
    const Mat3 A = a.pose.R * closure.inner_axes, B = b.pose.R * closure.outer_axes;
    const Vec3 r = b.pose.r - a.pose.r, r_dot = b.V.head<3>() - a.V.head<3>();
    const Vec3 w_a = a.V.tail<3>(), w_b = b.V.tail<3>();
    const auto add = [&](double gap, double gamma, const Vec6& on_a, const Vec6& on_b) {
      rows.gap[row] = gap;
      rows.on_outer.col(row) = on_b;
      rows.rate[row] = on_a.dot(a.V) + on_b.dot(b.V);
      rows.gamma[row] = gamma + on_a.dot(a.bias) + on_b.dot(b.bias);
      auto column = rows.J_t.col(row);
      const double size = add_generalised_force(system, sweeps, a, closure.inner, shapes_a, on_a, column) +
                          add_generalised_force(system, sweeps, b, closure.outer, shapes_b, on_b, column);
      if (column.squaredNorm() <= cancelled * cancelled * size) column.setZero();
      ++row;
    };
    const Forbidden hinge = forbidden(closure.kind);
    for (int i = 0; i < 3; ++i) {
      if (!hinge.slides[static_cast<std::size_t>(i)]) continue;
      const Vec3 e = A.col(i), turning = w_a.cross(e);  // d/dt (e·r) = e·(v_b − v_a − ω_a × r)
      Vec6 on_a, on_b;
      on_a << -e, -r.cross(e);
      on_b << e, Vec3::Zero();
      add(e.dot(r), w_a.cross(turning).dot(r) + 2.0 * turning.dot(r_dot), on_a, on_b);
    }
    for (const auto& [i, j] : hinge.turns) {
      const Vec3 e = A.col(i), f = B.col(j), axis = rows.length * f.cross(e);  // d/dt (e·f) = (ω_b − ω_a)·(f × e)
      Vec6 on_a, on_b;
      on_a << Vec3::Zero(), -axis;
      on_b << Vec3::Zero(), axis;
      const Vec3 e_dot = w_a.cross(e), f_dot = w_b.cross(f);
      add(rows.length * e.dot(f),
          rows.length * (e.dot(w_b.cross(f_dot)) + f.dot(w_a.cross(e_dot)) + 2.0 * e_dot.dot(f_dot)), on_a, on_b);
    }
  }
}

ClosureInertia closure_inertia(const Multibody& system, Sweeps& sweeps, const ClosureRows& rows) {
  const Index m = rows.J_t.cols();
  ClosureInertia c;
  c.X.resize(system.nv, m);
  VectorXd x(system.nv);
  for (Index j = 0; j < m; ++j) {
    solve(system, sweeps, rows.J_t.col(j), x);
    c.X.col(j) = x;
  }
  const MatrixXd compliance = rows.J_t.transpose() * c.X;  // Λ⁻¹
  // rows in units of what a unit of each moves, so that their weights do not decide which count
  c.scale = compliance.diagonal().unaryExpr([](double d) { return d > 0.0 ? 1.0 / std::sqrt(d) : 1.0; });
  const MatrixXd scaled = c.scale.asDiagonal() * compliance * c.scale.asDiagonal();
  const Eigen::SelfAdjointEigenSolver<MatrixXd> eigen(0.5 * (scaled + scaled.transpose()));
  const VectorXd& w = eigen.eigenvalues();  // ascending
  constexpr double noise = 1e-11, clear = 1e3;
  Index redundant = 0;
  while (redundant < m && w[redundant] < noise) ++redundant;  // a row that moves has one on the diagonal
  if (redundant > 0 && redundant < m) {
    const double dropped = std::max(std::abs(w[redundant - 1]), std::numeric_limits<double>::epsilon());
    if (w[redundant] < clear * dropped)
      throw NumericalError(
          "the rows that close the loops are neither independent nor redundant: ratio of what the last "
          "kept and the first dropped let move",
          w[redundant] / dropped, "Move the mechanism out of the singular position");
  }
  c.Q = eigen.eigenvectors().rightCols(m - redundant);
  c.inverse = w.tail(m - redundant).cwiseInverse();
  c.redundant = eigen.eigenvectors().leftCols(redundant);
  return c;
}

namespace {

// λ of least norm (in scaled rows) with J X λ = −gap
void multipliers(const ClosureInertia& c, const VectorXd& missing, VectorXd& lambda) {
  const VectorXd scaled = c.scale.cwiseProduct(missing);
  lambda = -c.scale.cwiseProduct(c.Q * c.inverse.cwiseProduct(c.Q.transpose() * scaled));
}

}  // namespace

void close(const ClosureRows& rows, const ClosureInertia& c, VectorXd& v_dot, VectorXd& lambda) {
  multipliers(c, rows.J_t.transpose() * v_dot + rows.gamma, lambda);
  v_dot.noalias() += c.X * lambda;
}

double project(const Multibody& system, Sweeps& sweeps, ClosureRows& rows, MotionState& state) {
  constexpr int most_steps = 30;
  double first = 0.0, last = std::numeric_limits<double>::infinity();
  VectorXd lambda(rows.rows());
  for (int step = 0;; ++step) {
    set_state(system, state.q, state.v, sweeps);
    closure_rows(system, sweeps, state.q, state.v, rows);
    const double gap = rows.rows() > 0 ? rows.gap.cwiseAbs().maxCoeff() : 0.0;
    if (step == 0) first = gap;
    articulate(system, sweeps);
    const ClosureInertia c = closure_inertia(system, sweeps, rows);
    // quadratic convergence: what no longer halves is round-off, if small, or a loop that cannot close
    if (gap <= 1e-14 * rows.length || (gap <= 1e-9 * rows.length && gap > 0.5 * last)) {
      multipliers(c, rows.rate, lambda);
      state.v.noalias() += c.X * lambda;
      return first;
    }
    if (step == most_steps)
      throw NumericalError("the loops do not close by moving the joints; what stays open [m]", gap,
                           "Start nearer to a closed position, or correct the lengths");
    last = gap;
    multipliers(c, rows.gap, lambda);
    VectorXd delta = c.X * lambda;
    const double size = delta.cwiseAbs().maxCoeff();
    if (size > 0.5) delta *= 0.5 / size;  // far off: turn by half a radian at most
    move(system, delta, state.q);
  }
}

}  // namespace tenon::assembly
