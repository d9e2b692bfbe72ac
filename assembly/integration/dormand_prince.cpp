#include "assembly/integration/dormand_prince.hpp"

#include <cmath>

namespace tenon::assembly {

using Eigen::Index;
using Eigen::VectorXd;

namespace {

constexpr double c[7] = {0.0, 1.0 / 5, 3.0 / 10, 4.0 / 5, 8.0 / 9, 1.0, 1.0};
constexpr double a[7][6] = {{},
                            {1.0 / 5},
                            {3.0 / 40, 9.0 / 40},
                            {44.0 / 45, -56.0 / 15, 32.0 / 9},
                            {19372.0 / 6561, -25360.0 / 2187, 64448.0 / 6561, -212.0 / 729},
                            {9017.0 / 3168, -355.0 / 33, 46732.0 / 5247, 49.0 / 176, -5103.0 / 18656},
                            {35.0 / 384, 0.0, 500.0 / 1113, 125.0 / 192, -2187.0 / 6784, 11.0 / 84}};
// weights of order 5 less those of order 4
constexpr double e[7] = {71.0 / 57600, 0.0, -71.0 / 16695, 71.0 / 1920, -17253.0 / 339200, 22.0 / 525, -1.0 / 40};
// continuous extension of order 4 (Hairer, Nørsett, Wanner, II.6)
constexpr double d[7] = {-12715105075.0 / 11282082432.0,  0.0,
                         87487479700.0 / 32700410799.0,   -10690763975.0 / 1880347072.0,
                         701980252875.0 / 199316789632.0, -1453857185.0 / 822651844.0,
                         69997945.0 / 29380423.0};

// Errors weighed: displacements against the coordinates they move (attitudes against 1 rad), speeds against themselves.
double weighed(const Multibody& system, const Tolerance& tolerance, const MotionState& from,
               const DormandPrince& work) {
  double sum = 0.0;
  const auto add = [&](double error, double size) {
    const double ratio = error / (tolerance.absolute + tolerance.relative * size);
    sum += ratio * ratio;
  };
  for (std::size_t k = 0; k < system.bodies.size(); ++k) {
    const HingedBody& b = system.bodies[k];
    const Index count = b.modes() + b.dofs(), first = system.v_offset[k], at = system.q_offset[k];
    const Index plain = hinge_coordinates(b.kind) > b.dofs() ? count - 3 : count;
    for (Index i = 0; i < count; ++i) {
      const double q = i < plain ? std::abs(from.q[at + i]) + std::abs(work.u[first + i]) : 1.0;
      add(work.u_error[first + i], q);
      add(work.v_error[first + i], std::max(std::abs(from.v[first + i]), std::abs(work.v[first + i])));
    }
  }
  return std::sqrt(sum / (2.0 * std::max(1, system.nv)));
}

}  // namespace

DormandPrince make_dormand_prince(const Multibody& system) {
  DormandPrince work;
  for (VectorXd& k : work.u_dot) k.setZero(system.nv);
  for (VectorXd& k : work.v_dot) k.setZero(system.nv);
  work.u = work.v = work.u_error = work.v_error = VectorXd::Zero(system.nv);
  work.stage = rest_state(system);
  return work;
}

double try_step(Dynamics& dynamics, double t, const MotionState& from, double h, const Tolerance& tolerance,
                DormandPrince& work, MotionState& to) {
  const Multibody& system = *dynamics.system;
  work.h = h;
  work.u_dot[0] = from.v;  // dexp⁻¹ at u = 0
  for (std::size_t i = 1; i < 7; ++i) {
    work.u.setZero();
    work.v = from.v;
    for (std::size_t j = 0; j < i; ++j) {
      work.u += h * a[i][j] * work.u_dot[j];
      work.v += h * a[i][j] * work.v_dot[j];
    }
    work.stage.q = from.q;
    move(system, work.u, work.stage.q);
    work.stage.v = work.v;
    increment_rates(system, work.u, work.v, work.u_dot[i]);
    accelerations(dynamics, t + c[i] * h, work.stage, work.v_dot[i]);
  }
  to.q = work.stage.q;  // the seventh stage is the new state
  to.v = work.stage.v;
  work.u_error.setZero();
  work.v_error.setZero();
  for (std::size_t i = 0; i < 7; ++i) {
    work.u_error += h * e[i] * work.u_dot[i];
    work.v_error += h * e[i] * work.v_dot[i];
  }
  return weighed(system, tolerance, from, work);
}

void interpolate(const Multibody& system, DormandPrince& work, const MotionState& from, double part, MotionState& at) {
  const double s = part, r = 1.0 - part, h = work.h;
  const auto extend = [&](const std::array<VectorXd, 7>& k, const VectorXd& difference, VectorXd& y) {
    // y = s (Δ + r (B + s (Δ − h k₇ − B + r h Σ d k))), B = h k₁ − Δ
    y.setZero();
    for (std::size_t i = 0; i < 7; ++i) y += h * d[i] * k[i];
    y = s * (difference + r * (h * k[0] - difference + s * (2.0 * difference - h * k[6] - h * k[0] + r * y)));
  };
  extend(work.u_dot, work.u, work.u_error);
  at.q = from.q;
  move(system, work.u_error, at.q);
  work.v_error = work.v - from.v;
  extend(work.v_dot, work.v_error, at.v);
  at.v += from.v;
}

double first_step(Dynamics& dynamics, double t, const MotionState& from, const Tolerance& tolerance, double longest,
                  DormandPrince& work) {
  const Multibody& system = *dynamics.system;
  const auto size = [&](const VectorXd& u_like, const VectorXd& v_like) {
    work.u_error = u_like;
    work.v_error = v_like;
    return weighed(system, tolerance, from, work);
  };
  work.u.setZero();
  work.v = from.v;
  accelerations(dynamics, t, from, work.v_dot[0]);
  const double d0 = size(from.v, from.v), d1 = size(from.v, work.v_dot[0]);
  const double h0 = std::min(longest, d0 < 1e-5 || d1 < 1e-5 ? 1e-6 : 0.01 * d0 / d1);
  work.u = h0 * from.v;  // an Euler step
  work.stage.q = from.q;
  move(system, work.u, work.stage.q);
  work.stage.v = from.v + h0 * work.v_dot[0];
  accelerations(dynamics, t + h0, work.stage, work.v_dot[1]);
  work.v = work.v_dot[1] - work.v_dot[0];
  const VectorXd change = work.v;
  work.v = from.v;
  const double d2 = size(h0 * work.v_dot[0], change) / h0;
  const double largest = std::max(d1, d2);
  const double h1 = largest <= 1e-15 ? std::max(1e-6, 1e-3 * h0) : std::pow(0.01 / largest, 0.2);
  return std::min({100.0 * h0, h1, longest});
}

}  // namespace tenon::assembly
