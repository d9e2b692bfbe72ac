#include <gtest/gtest.h>

#include <iostream>
#include <numbers>

#include "tests/analytic/assembly/mechanisms.hpp"
#include "tests/analytic/assembly/runs.hpp"

// Whole runs through one door, against closed forms and references that know nothing of trees.
namespace tenon::assembly {
namespace {

using Eigen::VectorXd;
using testing::DoublePendulum;
using testing::LagrangeTop;
using testing::Ran;
using testing::run;
using testing::SliderCrank;

// What adaptive steps lead to at most: each errs by the tolerance of its state's size (root mean square over `count`
// numbers) with either sign, so that errors add as the root of their number; `growth` is what the motion makes of one.
double adaptive_bound(const Integration& result, double tolerance, double size, int count, double growth) {
  return growth * std::sqrt(static_cast<double>(result.steps)) * tolerance * size * std::sqrt(count);
}

// Fixed steps err by order 2; adaptive ones by no more than their steps' errors, grown by the motion's own sensitivity.
TEST(Integrate, DoublePendulumFollowsLagrange) {
  const DoublePendulum pendulum;
  const Multibody mb = pendulum.system();
  MotionState start = rest_state(mb);
  start.q << 0.3, 0.5;
  start.v << 0.2, -0.4;
  const double time = 3.0;
  const auto f = [&](const Eigen::Vector4d& y) { return pendulum.rates(y); };
  const Eigen::Vector4d from(0.3, 0.8, 0.2, -0.2), exact = testing::extrapolate(f, from, time, 400);
  const Eigen::Vector4d check = testing::extrapolate(f, from, time, 300);
  ASSERT_LT((exact - check).norm(), 1e-10);
  double growth = 0.0, size = 0.0;  // of a change on the way until the end; of the state
  for (int k = 0; k < 12; ++k) {
    const Eigen::Vector4d y = k == 0 ? from : testing::extrapolate(f, from, 0.25 * k, 100);
    size = std::max(size, y.cwiseAbs().maxCoeff());
    Eigen::Matrix4d change;
    for (int i = 0; i < 4; ++i)
      change.col(i) =
          (testing::extrapolate(f, y + 1e-6 * Eigen::Vector4d::Unit(i), time - 0.25 * k, 200) - exact) / 1e-6;
    growth = std::max(growth, change.norm());
  }
  const Tolerance tight{1e-10, 1e-12};
  const auto error = [&](const IntegrationOptions& options) {
    const Ran r = run(mb, start, options);
    EXPECT_EQ(r.result.failure, "");
    EXPECT_EQ(r.t, time);
    const MotionState& s = r.last;
    const double e = (Eigen::Vector4d(s.q[0], s.q[0] + s.q[1], s.v[0], s.v[0] + s.v[1]) - exact).norm();
    std::cout << name(options.method) << ": " << e << " in " << r.result.steps << " steps, " << r.result.rejected
              << " rejected, " << r.result.evaluations << " evaluations\n";
    if (!fixed_steps(options.method)) {
      const double bound = adaptive_bound(r.result, tight.relative, size, 4, growth);
      std::cout << "  at most " << bound << "\n";
      EXPECT_LT(e, bound);
    }
    return e;
  };
  for (const Method method : {Method::dormand_prince, Method::bdf, Method::adams})
    error({.method = method, .until = time, .sample = 0.1, .tolerance = tight});
  for (const Method method : {Method::midpoint, Method::generalized_alpha}) {
    const double coarse = error({.method = method, .until = time, .step = 4e-4, .sample = 0.1});
    const double fine = error({.method = method, .until = time, .step = 2e-4, .sample = 0.1});
    EXPECT_NEAR(std::log2(coarse / fine), 2.0, 0.1);
  }
}

// The inclination's sensitivity to each number that the motion is made of, by differences of the closed form.
double growth_of(const LagrangeTop& top, double time) {
  double growth = 0.0;
  for (int k = 1; k <= 40; ++k) {
    const double t = time * k / 40.0;
    double sum = 0.0;
    for (double LagrangeTop::*number : {&LagrangeTop::theta0, &LagrangeTop::spin, &LagrangeTop::precession}) {
      LagrangeTop other = top;
      const double step = 1e-6 * top.*number;
      other.*number += step;
      sum += std::abs((other.cosine(t) - top.cosine(t)) / step);
    }
    growth = std::max(growth, sum);
  }
  return growth;
}

TEST(Integrate, HeavyTopNutatesAsItsEllipticFunctionSays) {
  const LagrangeTop top;
  const Multibody mb = top.system();
  const double time = 2.0, tolerance = 1e-11, growth = growth_of(top, time);
  for (const Method method : {Method::dormand_prince, Method::bdf, Method::adams}) {
    double worst = 0.0;
    IntegrationState state = begin(mb, top.start(mb));
    const Integration result = integrate(
        mb, {}, state, {.method = method, .until = time, .sample = 0.05, .tolerance = {tolerance, 0.01 * tolerance}},
        [&](const Sample& s) {
          worst = std::max(worst, std::abs(LagrangeTop::cosine(s.state) - top.cosine(s.t)));
          return true;
        });
    const double bound = adaptive_bound(result, tolerance, top.spin, 7, growth);
    EXPECT_EQ(result.failure, "");
    std::cout << name(method) << ": cos of the inclination within " << worst << ", at most " << bound << "\n";
    EXPECT_LT(worst, bound);
  }
}

// One degree of freedom: I(φ) φ̇² stays, and the time of a turn is ∫ √(I/2E) dφ (the trapezium rule is spectral there).
TEST(Integrate, SliderCrankKeepsItsOneIntegral) {
  const SliderCrank crank;
  const Multibody mb = crank.system();
  const double rate = 150.0, phi0 = 0.3;
  const double twoE = crank.inertia(phi0) * rate * rate;
  double turn = 0.0;
  for (int k = 0; k < 400; ++k)
    turn += std::sqrt(crank.inertia(2.0 * std::numbers::pi * k / 400.0) / twoE) * 2.0 * std::numbers::pi / 400.0;
  struct Errors {
    double rate = 0.0, angle = 0.0;
    Integration result;
  };
  const double tolerance = 1e-10;
  const auto errors = [&](Method method, double step) {
    Errors e;
    double slide = 0.0, end = 0.0;
    IntegrationState state = begin(mb, crank.start(mb, phi0, rate));
    e.result = integrate(mb, {}, state,
                         {.method = method,
                          .until = 3.0 * turn,
                          .step = step,
                          .sample = turn / 40.0,
                          .tolerance = {tolerance, 0.01 * tolerance}},
                         [&](const Sample& s) {
                           const double phi = s.state.q[0];
                           e.rate =
                               std::max(e.rate, std::abs(s.state.v[0] / std::sqrt(twoE / crank.inertia(phi)) - 1.0));
                           slide = std::max(slide, std::abs(s.state.q[2] - crank.slider(phi)));
                           end = phi;
                           return true;
                         });
    e.angle = std::abs(end - phi0 - 6.0 * std::numbers::pi);
    EXPECT_EQ(e.result.failure, "");
    EXPECT_LT(slide, 1e-12);  // projected, or closed by the step's own iterations: round-off
    std::cout << name(method) << ", " << e.result.steps << " steps: rate " << e.rate << ", slider " << slide
              << " m, angle after three turns " << e.angle << ", gap " << e.result.worst_gap << " m\n";
    return e;
  };
  // errors of the steps add up in the one rate; over the time T of the run the angle drifts by that rate × T
  for (const Method method : {Method::dormand_prince, Method::bdf}) {
    const Errors adaptive = errors(method, 0.0);
    const double bound = adaptive_bound(adaptive.result, tolerance, 6.0 * std::numbers::pi, 6, 1.0);
    EXPECT_LT(adaptive.rate, bound);
    EXPECT_LT(adaptive.angle, 6.0 * std::numbers::pi * bound);
  }
  for (const Method method : {Method::midpoint, Method::generalized_alpha}) {
    const Errors coarse = errors(method, turn / 1000.0), fine = errors(method, turn / 2000.0);
    EXPECT_NEAR(std::log2(coarse.rate / fine.rate), 2.0, 0.1);
    EXPECT_NEAR(std::log2(coarse.angle / fine.angle), 2.0, 0.1);
  }
}

TEST(Integrate, FourBarTurnsAThousandTimesAndStaysClosed) {
  using testing::rod;
  Multibody mb;  // crank rocker: ground 1 m, crank .3 m, coupler .9 m, follower .7 m
  mb.bodies = {rod("crank", 1.0, 0.3, 0.02), rod("coupler", 0.5, 0.9, 0.04), rod("follower", 0.4, 0.7, 0.02)};
  mb.bodies[1].parent = 0;
  mb.bodies[1].inner_port = 1;
  mb.bodies[2].inner_position = {1.0, 0.0, 0.0};
  mb.closures.push_back({"pin", {1, 1}, {2, 1}, Vec3::Zero(), HingeKind::revolute, Mat3::Identity(), Mat3::Identity()});
  index(mb);
  MotionState start = rest_state(mb);
  start.q << 1.5, -0.9, 1.8;  // near closed: projected
  start.v << 20.0, -20.0, 0.0;
  Dynamics dynamics = make_dynamics(mb);
  project(mb, dynamics.sweeps, dynamics.rows, start);
  const auto energy_of = [&](const MotionState& s) {
    set_state(mb, s.q, s.v, dynamics.sweeps);
    return energy(mb, dynamics.sweeps, s.q, s.v).total();
  };
  const double before = energy_of(start);
  double gap = 0.0, worst = 0.0, angle = 0.0;
  IntegrationState state = begin(mb, start);
  const auto look = [&](const Sample& s) {
    closure_rows(mb, s.dynamics.sweeps, s.state.q, s.state.v, dynamics.rows);
    gap = std::max(gap, dynamics.rows.gap.cwiseAbs().maxCoeff());
    worst = std::max(worst, std::abs(energy_of(s.state) / before - 1.0));
    angle = s.state.q[0] - start.q[0];
    return angle < 2000.0 * std::numbers::pi;
  };
  const Integration result = integrate(
      mb, {}, state, {.method = Method::dormand_prince, .until = 1e6, .sample = 0.5, .tolerance = {1e-9, 1e-11}}, look);
  std::cout << angle / (2.0 * std::numbers::pi) << " turns in " << result.steps << " steps: gap at samples " << gap
            << " m, before projection " << result.worst_gap << " m, energy " << worst << "\n";
  EXPECT_EQ(result.failure, "");
  EXPECT_GE(angle, 2000.0 * std::numbers::pi);
  EXPECT_LT(gap, 1e-9);
  EXPECT_LT(worst, adaptive_bound(result, 1e-9, 1.0, 6, 2.0));  // twice that of speeds
  EXPECT_LT(result.worst_gap, 1e-9 * angle);                    // of one step: the tolerance of its angles over 1 m
}

// A weight falls from 2 m: t = √(2h/g), a parabola that methods of one step follow exactly; Adams to its tolerance.
TEST(Integrate, EventsAreFoundToATenthOfANanosecond) {
  const testing::FallingWeight weight;
  const Multibody mb = weight.system();
  const MotionState start = weight.start(mb);
  for (const Method method : {Method::generalized_alpha, Method::midpoint, Method::dormand_prince, Method::adams}) {
    IntegrationOptions options{.method = method, .until = 5.0, .step = 0.01, .sample = 0.1};
    options.events = {{"half", [](double, const MotionState& s) { return s.q[0] - 1.0; }, false},
                      {"ground", [](double, const MotionState& s) { return s.q[0]; }, true}};
    const double close = method == Method::adams ? 1e-8 : 1e-10;
    const Ran r = run(mb, start, options);
    EXPECT_EQ(r.result.failure, "");
    EXPECT_EQ(r.result.stopped_by, "ground");
    ASSERT_EQ(r.result.events.size(), 2u);
    EXPECT_NEAR(r.result.events[0].t, weight.passes(1.0), close) << name(method);
    EXPECT_NEAR(r.result.events[1].t, weight.passes(0.0), close) << name(method);
    EXPECT_EQ(r.t, r.result.events[1].t);
    EXPECT_EQ(r.samples, 8);  // 0, 0.1 ... 0.6, the event
  }
}

// A parallelogram linkage hangs and swings as one pendulum: I φ̇² = 2 S g (cos φ − cos φ₀), φ from the vertical. Three
// of its closure's rows are redundant, and steps of 1e-6 s make of a round-off of the gap speeds beside which it is
// slow.
TEST(Integrate, AParallelogramLeavesItsRestWithShortSteps) {
  using testing::rod;
  constexpr double g = 9.81, r = 0.5, phi0 = 0.6;
  Multibody mb;
  mb.bodies = {rod("crank", 1.0, r, 0.02), rod("coupler", 2.0, 1.0, 0.04), rod("follower", 1.0, r, 0.02)};
  mb.bodies[1].parent = 0;
  mb.bodies[1].inner_port = 1;
  mb.bodies[2].inner_position = {1.0, 0.0, 0.0};
  mb.closures.push_back({"pin", {1, 1}, {2, 1}, Vec3::Zero(), HingeKind::revolute, Mat3::Identity(), Mat3::Identity()});
  mb.gravity = {0.0, -g, 0.0};
  index(mb);
  const Eigen::MatrixXd& crank = mb.bodies[0].body->D;
  const double I = 2.0 * crank(5, 5) + 2.0 * r * r, S = 2.0 * crank(5, 1) + 2.0 * r;  // about the pivots
  MotionState start = rest_state(mb);
  start.q << phi0 - 0.5 * std::numbers::pi, 0.5 * std::numbers::pi - phi0, phi0 - 0.5 * std::numbers::pi;
  for (const Method method : {Method::midpoint, Method::generalized_alpha})
    for (const double h : {1e-4, 1e-6}) {
      IntegrationState state = begin(mb, start);
      const Integration result = integrate(
          mb, {}, state, {.method = method, .until = 300.0 * h, .step = h, .sample = 300.0 * h, .tolerance = {}},
          [](const Sample&) { return true; });
      EXPECT_EQ(result.failure, "") << name(method) << " " << h;
      const double phi = state.at.motion.q[0] + 0.5 * std::numbers::pi;
      const double drop = std::sin(0.5 * (phi0 + phi)) * std::sin(0.5 * (phi0 - phi));  // ½ (cos φ − cos φ₀)
      const double rate = -std::sqrt(4.0 * S * g * drop / I);
      std::cout << name(method) << " " << h << " s: " << state.at.motion.v[0] / rate - 1.0 << ", gap "
                << result.worst_gap << " m\n";
      EXPECT_LT(result.worst_gap, 1e-14);
      const double bound =
          h * h * S * g / I + 1e-15 / (phi0 - phi);  // second order; round-off of angles over their change
      EXPECT_NEAR(state.at.motion.v[0] / rate, 1.0, bound);
    }
}

}  // namespace
}  // namespace tenon::assembly
