#include "assembly/recursion/closure.hpp"

#include <fmt/format.h>

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
// a_i·r = 0 and a_i·b_j = 0. The latter leave axes parallel or antiparallel: upright is parallel, z with two rows or
// more, x as well with three.
struct Forbidden {
  std::array<bool, 3> slides;
  std::span<const std::array<int, 2>> turns;

  bool upright(const Mat3& A, const Mat3& B) const {
    return (turns.size() < 2 || A.col(2).dot(B.col(2)) > 0.0) && (turns.size() < 3 || A.col(0).dot(B.col(0)) > 0.0);
  }
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
  check_closures(system);
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
  rows.turned_over = -1;
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
    if (rows.turned_over < 0 && !hinge.upright(A, B)) rows.turned_over = static_cast<int>(c);
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

void check_sides(const Multibody& system, const ClosureRows& rows) {
  if (rows.turned_over < 0) return;
  const Closure& closure = system.closures[static_cast<std::size_t>(rows.turned_over)];
  throw NumericalError(
      fmt::format("closure '{}' closes with its {} hinge turned over, axes opposed instead of parallel; gap [m]",
                  closure.name, name(closure.kind)),
      rows.gap.cwiseAbs().maxCoeff(), "Start nearer to the position wanted, or turn the hinge frame of one side");
}

void closure_inertia(const Multibody& system, Sweeps& sweeps, const ClosureRows& rows, ClosureInertia& c) {
  const Index m = rows.rows();
  c.X.resize(system.nv, m);
  c.compliance.resize(m, m);
  for (VectorXd* of_rows : {&c.scale, &c.inverse, &c.missing}) of_rows->resize(m);
  for (VectorXd* of_speeds : {&c.f, &c.x}) of_speeds->resize(system.nv);
  c.redundant = 0;
  if (m == 0) return;
  for (Index j = 0; j < m; ++j) {
    c.f = rows.J_t.col(j);
    solve(system, sweeps, c.f, c.x);
    c.X.col(j) = c.x;
  }
  for (Index j = 0; j < m; ++j)  // Λ⁻¹
    for (Index i = 0; i <= j; ++i)
      c.compliance(i, j) = c.compliance(j, i) =
          0.5 * (rows.J_t.col(i).dot(c.X.col(j)) + rows.J_t.col(j).dot(c.X.col(i)));
  // rows in units of what a unit of each moves, so that their weights do not decide which count
  for (Index j = 0; j < m; ++j) {
    const double moves = c.compliance(j, j);
    c.scale[j] = moves > 0.0 ? 1.0 / std::sqrt(moves) : 1.0;
  }
  for (Index j = 0; j < m; ++j)
    for (Index i = 0; i < m; ++i) c.compliance(i, j) *= c.scale[i] * c.scale[j];
  c.tridiagonal.compute(c.compliance);
  c.diagonal = c.tridiagonal.diagonal();
  c.beside = c.tridiagonal.subDiagonal();
  c.eigen.computeFromTridiagonal(c.diagonal, c.beside);
  c.directions = c.eigen.eigenvectors();
  c.tridiagonal.matrixQ().applyThisOnTheLeft(c.directions, c.work);
  const VectorXd& w = c.eigen.eigenvalues();  // ascending
  constexpr double noise = 1e-11, clear = 1e3;
  while (c.redundant < m && w[c.redundant] < noise) ++c.redundant;  // a row that moves has one on the diagonal
  if (c.redundant > 0 && c.redundant < m) {
    const double dropped = std::max(std::abs(w[c.redundant - 1]), std::numeric_limits<double>::epsilon());
    if (w[c.redundant] < clear * dropped)
      throw NumericalError(
          "the rows that close the loops are neither independent nor redundant: ratio of what the last "
          "kept and the first dropped let move",
          w[c.redundant] / dropped, "Move the mechanism out of the singular position");
  }
  for (Index j = 0; j < m; ++j) c.inverse[j] = j < c.redundant ? 0.0 : 1.0 / w[j];
}

ClosureInertia closure_inertia(const Multibody& system, Sweeps& sweeps, const ClosureRows& rows) {
  ClosureInertia inertia;
  closure_inertia(system, sweeps, rows, inertia);
  return inertia;
}

namespace {

// λ of least norm (in scaled rows) with J X λ = −missing
void multipliers(ClosureInertia& c, VectorXd& lambda) {
  lambda.setZero();
  if (c.missing.size() == 0) return;
  c.missing.array() *= c.scale.array();
  for (Index j = c.redundant; j < c.missing.size(); ++j) {
    const auto direction = c.directions.col(j);
    lambda -= c.inverse[j] * direction.dot(c.missing) * direction;
  }
  lambda.array() *= c.scale.array();
}

}  // namespace

void close(const ClosureRows& rows, ClosureInertia& c, VectorXd& v_dot, VectorXd& lambda) {
  c.missing = rows.gamma;
  c.missing.noalias() += rows.J_t.transpose() * v_dot;
  multipliers(c, lambda);
  v_dot.noalias() += c.X * lambda;
}

double project(const Multibody& system, Sweeps& sweeps, ClosureRows& rows, MotionState& state) {
  constexpr int most_steps = 30;
  double first = 0.0, last = std::numeric_limits<double>::infinity();
  VectorXd lambda(rows.rows());
  ClosureInertia c;
  for (int step = 0;; ++step) {
    set_state(system, state.q, state.v, sweeps);
    closure_rows(system, sweeps, state.q, state.v, rows);
    const double gap = rows.gap.lpNorm<Eigen::Infinity>();
    if (step == 0) first = gap;
    articulate(system, sweeps);
    closure_inertia(system, sweeps, rows, c);
    // quadratic convergence: what no longer halves is round-off, if small, or a loop that cannot close
    if (gap <= 1e-14 * rows.length || (gap <= 1e-9 * rows.length && gap > 0.5 * last)) {
      check_sides(system, rows);
      c.missing = rows.rate;
      multipliers(c, lambda);
      state.v.noalias() += c.X * lambda;
      return first;
    }
    if (step == most_steps)
      throw NumericalError("the loops do not close by moving the joints; what stays open [m]", gap,
                           "Start nearer to a closed position, or correct the lengths");
    last = gap;
    c.missing = rows.gap;
    multipliers(c, lambda);
    VectorXd delta = c.X * lambda;
    const double size = delta.lpNorm<Eigen::Infinity>();
    if (size > 0.5) delta *= 0.5 / size;  // far off: turn by half a radian at most
    move(system, delta, state.q);
  }
}

}  // namespace tenon::assembly
