#include <gtest/gtest.h>

#include <cstring>
#include <filesystem>
#include <iostream>
#include <numbers>

#include "assembly/integration/checkpoint.hpp"
#include "assembly/integration/integrate.hpp"
#include "fem/error.hpp"
#include "tests/analytic/assembly/mechanisms.hpp"

// Whole runs through one door, against closed forms and references that know nothing of trees.
namespace tenon::assembly {
namespace {

using Eigen::VectorXd;
using testing::DoublePendulum;
using testing::LagrangeTop;
using testing::SliderCrank;

struct Ran {
  Integration result;
  MotionState last;
  double t = 0.0;
  long samples = 0;
};
Ran run(const Multibody& mb, const MotionState& start, const IntegrationOptions& options, const Loads& loads = {}) {
  Ran r;
  IntegrationState state = begin(mb, start);
  r.result = integrate(mb, loads, state, options, [&](const Sample& s) {
    r.last = s.state;
    r.t = s.t;
    ++r.samples;
    return true;
  });
  return r;
}

// Methods of order 2 err by (h/T)², of adaptive order by some hundred tolerances over 3 s of chaotic motion.
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
  const auto error = [&](const IntegrationOptions& options) {
    const Ran r = run(mb, start, options);
    EXPECT_EQ(r.result.failure, "");
    EXPECT_EQ(r.t, time);
    const MotionState& s = r.last;
    const double e = (Eigen::Vector4d(s.q[0], s.q[0] + s.q[1], s.v[0], s.v[0] + s.v[1]) - exact).norm();
    std::cout << name(options.method) << ": " << e << " in " << r.result.steps << " steps, " << r.result.rejected
              << " rejected, " << r.result.evaluations << " evaluations\n";
    return e;
  };
  const Tolerance tight{1e-10, 1e-12};
  EXPECT_LT(error({.method = Method::dormand_prince, .until = time, .sample = 0.1, .tolerance = tight}), 1e-7);
  EXPECT_LT(error({.method = Method::bdf, .until = time, .sample = 0.1, .tolerance = tight}), 1e-5);
  EXPECT_LT(error({.method = Method::adams, .until = time, .sample = 0.1, .tolerance = tight}), 1e-6);
  for (const Method method : {Method::midpoint, Method::generalized_alpha}) {
    const double coarse = error({.method = method, .until = time, .step = 4e-4, .sample = 0.1});
    const double fine = error({.method = method, .until = time, .step = 2e-4, .sample = 0.1});
    EXPECT_NEAR(std::log2(coarse / fine), 2.0, 0.1);
  }
}

TEST(Integrate, HeavyTopNutatesAsItsEllipticFunctionSays) {
  const LagrangeTop top;
  const Multibody mb = top.system();
  double worst = 0.0;
  for (const Method method : {Method::dormand_prince, Method::bdf, Method::adams}) {
    IntegrationState state = begin(mb, top.start(mb));
    const Integration result =
        integrate(mb, {}, state, {.method = method, .until = 2.0, .sample = 0.05, .tolerance = {1e-11, 1e-13}},
                  [&](const Sample& s) {
                    worst = std::max(worst, std::abs(LagrangeTop::cosine(s.state) - top.cosine(s.t)));
                    return true;
                  });
    EXPECT_EQ(result.failure, "");
    std::cout << name(method) << ": cos of the inclination within " << worst << "\n";
    EXPECT_LT(worst, method == Method::dormand_prince ? 1e-8 : 1e-7);
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
  for (const Method method : {Method::dormand_prince, Method::midpoint, Method::generalized_alpha}) {
    const bool fixed = fixed_steps(method);
    double worst = 0.0, slide = 0.0, end = 0.0;
    IntegrationState state = begin(mb, crank.start(mb, phi0, rate));
    const Integration result =
        integrate(mb, {}, state,
                  {.method = method,
                   .until = 3.0 * turn,
                   .step = turn / 2000.0,
                   .sample = turn / 40.0,
                   .tolerance = {1e-10, 1e-12}},
                  [&](const Sample& s) {
                    const double phi = s.state.q[0];
                    worst = std::max(worst, std::abs(s.state.v[0] / std::sqrt(twoE / crank.inertia(phi)) - 1.0));
                    slide = std::max(slide, std::abs(s.state.q[2] - crank.slider(phi)));
                    end = phi;
                    return true;
                  });
    EXPECT_EQ(result.failure, "");
    std::cout << name(method) << ": rate " << worst << ", slider " << slide << " m, angle after three turns "
              << end - phi0 - 6.0 * std::numbers::pi << ", gap " << result.worst_gap << " m\n";
    EXPECT_LT(slide, 1e-12);
    EXPECT_LT(worst, fixed ? 1e-4 : 1e-7);  // (h/T)² times 2π² and the derivatives of I
    EXPECT_LT(std::abs(end - phi0 - 6.0 * std::numbers::pi), fixed ? 1e-3 : 1e-6);
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
  // a step errs by the tolerance of 1e-9 of the speeds at most, 2e-9 of the energy, and all errors may add up
  EXPECT_LT(worst, 2e-9 * static_cast<double>(result.steps));
}

// A weight falls from 2 m: t = √(2h/g), a parabola that methods of one step follow exactly; Adams to its tolerance.
TEST(Integrate, EventsAreFoundToATenthOfANanosecond) {
  Multibody mb;
  mb.gravity = {0.0, 0.0, -9.81};
  mb.bodies.push_back(testing::rigid_on(HingeKind::prismatic, "weight", 2.0, Vec3::Zero(), Mat3::Identity()));
  index(mb);
  MotionState start = rest_state(mb);
  start.q[0] = 2.0;
  for (const Method method : {Method::generalized_alpha, Method::midpoint, Method::dormand_prince, Method::adams}) {
    IntegrationOptions options{.method = method, .until = 5.0, .step = 0.01, .sample = 0.1};
    options.events = {{"half", [](double, const MotionState& s) { return s.q[0] - 1.0; }, false},
                      {"ground", [](double, const MotionState& s) { return s.q[0]; }, true}};
    const double close = method == Method::adams ? 1e-8 : 1e-10;
    const Ran r = run(mb, start, options);
    EXPECT_EQ(r.result.failure, "");
    EXPECT_EQ(r.result.stopped_by, "ground");
    ASSERT_EQ(r.result.events.size(), 2u);
    EXPECT_NEAR(r.result.events[0].t, std::sqrt(2.0 / 9.81), close) << name(method);
    EXPECT_NEAR(r.result.events[1].t, std::sqrt(4.0 / 9.81), close) << name(method);
    EXPECT_EQ(r.t, r.result.events[1].t);
    EXPECT_EQ(r.samples, 8);  // 0, 0.1 ... 0.6, the event
  }
}

bool same_bits(const VectorXd& a, const VectorXd& b) {
  return a.size() == b.size() &&
         std::memcmp(a.data(), b.data(), static_cast<std::size_t>(a.size()) * sizeof(double)) == 0;
}

// Stopped half-way, written, read and continued: the same bits as in one go, at the same samples.
TEST(Integrate, CheckpointsContinueBitForBit) {
  const auto path = std::filesystem::temp_directory_path() / "tenon_checkpoint_test.json";
  const SliderCrank crank;
  const DoublePendulum pendulum;
  const Multibody loop = crank.system(), tree = pendulum.system();
  MotionState fall = rest_state(tree);
  fall.q << 0.3, 0.5;
  for (const Method method : {Method::generalized_alpha, Method::midpoint, Method::dormand_prince})
    for (const bool closed : {false, true}) {
      const Multibody& mb = closed ? loop : tree;
      const MotionState start = closed ? crank.start(loop, 0.3, 10.0) : fall;
      const IntegrationOptions whole{.method = method, .until = 1.0, .step = 0.007, .sample = 0.05};
      IntegrationOptions half = whole;
      half.until = 0.45;
      std::vector<double> times, again;
      MotionState one, two;
      IntegrationState a = begin(mb, start), b = begin(mb, start);
      integrate(mb, {}, a, whole, [&](const Sample& s) { return times.push_back(s.t), one = s.state, true; });
      const auto see = [&](const Sample& s) { return again.push_back(s.t), two = s.state, true; };
      integrate(mb, {}, b, half, see);
      write_checkpoint(path, mb, {method, b});
      Checkpoint c = read_checkpoint(path, mb);
      EXPECT_EQ(c.method, method);
      EXPECT_EQ(integrate(mb, {}, c.state, whole, see).failure, "");
      EXPECT_EQ(times, again) << name(method);
      EXPECT_TRUE(same_bits(one.q, two.q) && same_bits(one.v, two.v)) << name(method) << (closed ? ", loop" : ", tree");
      EXPECT_TRUE(same_bits(a.at.motion.q, c.state.at.motion.q));
    }
  EXPECT_THROW(read_checkpoint(path, tree), InputError);  // the last one was of the loop
  std::filesystem::remove(path);
}

TEST(Integrate, WhatCameBeforeAFailureIsKept) {
  const DoublePendulum pendulum;
  const Multibody mb = pendulum.system();
  const Loads broken = [](double t, const MotionState&, Sweeps&, VectorXd& T) {
    if (t > 0.52) T[1] = std::nan("");
  };
  for (const Method method : {Method::generalized_alpha, Method::midpoint, Method::dormand_prince, Method::bdf}) {
    const Ran r = run(mb, rest_state(mb), {.method = method, .until = 1.0, .step = 0.01, .sample = 0.1}, broken);
    EXPECT_NE(r.result.failure, "") << name(method);
    std::cout << r.result.failure << "\n";
    EXPECT_EQ(r.samples, 6) << name(method);  // 0 ... 0.5
  }
}

TEST(Integrate, StatesThatMakeNoSenseAreRefused) {
  const SliderCrank crank;
  const Multibody mb = crank.system();
  EXPECT_THROW(run(mb, crank.start(mb, 0.3, 1.0), {.method = Method::bdf}), ModelError);  // takes no loops
  MotionState open = crank.start(mb, 0.3, 1.0);
  open.q[2] += 1e-3;
  EXPECT_THROW(begin(mb, open), ModelError);
  MotionState opening = crank.start(mb, 0.3, 1.0);
  opening.v[2] += 1e-3;
  EXPECT_THROW(begin(mb, opening), ModelError);
  MotionState endless = crank.start(mb, 0.3, 1.0);
  endless.v[0] = std::numeric_limits<double>::infinity();
  EXPECT_THROW(begin(mb, endless), ModelError);
  const LagrangeTop top;
  const Multibody spinning = top.system();
  MotionState stretched = top.start(spinning);
  stretched.q *= 1.01;
  EXPECT_THROW(begin(spinning, stretched), ModelError);
}

}  // namespace
}  // namespace tenon::assembly
