#include <gtest/gtest.h>

#include <iostream>

#include "assembly/integration/dormand_prince.hpp"
#include "assembly/integration/implicit.hpp"
#include "tests/analytic/assembly/tops.hpp"

// Single methods with fixed steps against closed forms: their order, and what they conserve.
namespace tenon::assembly {
namespace {

using Eigen::VectorXd;
using testing::FreeTop;
using testing::LagrangeTop;

MotionState explicit_steps(const Multibody& mb, const MotionState& start, double time, int steps) {
  Dynamics dynamics = make_dynamics(mb);
  DormandPrince work = make_dormand_prince(mb);
  MotionState from = start, to = start;
  const double h = time / steps;
  accelerations(dynamics, 0.0, from, work.v_dot[0]);
  for (int k = 0; k < steps; ++k) {
    try_step(dynamics, k * h, from, h, {}, work, to);
    std::swap(work.v_dot[0], work.v_dot[6]);
    std::swap(from, to);
  }
  return from;
}

using Step = void (*)(Dynamics&, double, double, const ImplicitOptions&, ImplicitWork&, ImplicitState&);

MotionState implicit_steps(Step step, const Multibody& mb, const MotionState& start, double time, int steps,
                           int* most_iterations = nullptr, const ImplicitOptions& options = {}) {
  Dynamics dynamics = make_dynamics(mb);
  ImplicitWork work = make_implicit_work(dynamics);
  ImplicitState state{start, VectorXd::Zero(mb.nv), {}};
  accelerations(dynamics, 0.0, start, state.v_dot);
  state.a = state.v_dot;
  const double h = time / steps;
  int most = 0;
  for (int k = 0; k < steps; ++k) {
    step(dynamics, k * h, h, options, work, state);
    most = std::max(most, work.iterations);
  }
  if (most_iterations) *most_iterations = most;
  return state.motion;
}

double top_error(const MotionState& s, double t) { return std::abs(LagrangeTop::cosine(s) - LagrangeTop().cosine(t)); }

// The global error of a method of order p falls by 2^p when the step is halved.
TEST(TimeSteps, DormandPrinceHasOrderFive) {
  const LagrangeTop top;
  const Multibody mb = top.system();
  const double time = 1.3;
  const double coarse = top_error(explicit_steps(mb, top.start(mb), time, 400), time);
  const double fine = top_error(explicit_steps(mb, top.start(mb), time, 800), time);
  std::cout << "top: " << coarse << ", " << fine << ", order " << std::log2(coarse / fine) << "\n";
  EXPECT_NEAR(std::log2(coarse / fine), 5.0, 0.5);
}

TEST(TimeSteps, ContinuousExtensionHasOrderFour) {
  const LagrangeTop top;
  const Multibody mb = top.system();
  const auto worst = [&](double h) {
    Dynamics dynamics = make_dynamics(mb);
    DormandPrince work = make_dormand_prince(mb);
    MotionState from = top.start(mb), to = from, at = from;
    accelerations(dynamics, 0.0, from, work.v_dot[0]);
    try_step(dynamics, 0.0, from, h, {}, work, to);
    double error = 0.0;
    for (const double part : {0.25, 0.5, 0.75}) {
      interpolate(mb, work, from, part, at);
      error = std::max(error, top_error(at, part * h));
    }
    interpolate(mb, work, from, 1.0, at);
    EXPECT_LT((at.v - to.v).norm(), 1e-12 * to.v.norm());
    EXPECT_LT((at.q - to.q).norm(), 1e-14);
    return error;
  };
  const double order = std::log2(worst(0.02) / worst(0.01));
  std::cout << "order of one interpolated step " << order << "\n";
  EXPECT_GT(order, 4.5);  // an error of order 5 within a step
}

TEST(TimeSteps, ImplicitMethodsHaveOrderTwo) {
  const LagrangeTop top;
  const Multibody mb = top.system();
  const double time = 0.7;
  for (const Step step : {&midpoint_step, &generalized_alpha_step}) {
    int most = 0;
    const double coarse = top_error(implicit_steps(step, mb, top.start(mb), time, 2000), time);
    const double fine = top_error(implicit_steps(step, mb, top.start(mb), time, 4000, &most), time);
    std::cout << "top: " << coarse << ", " << fine << ", order " << std::log2(coarse / fine) << ", iterations " << most
              << "\n";
    EXPECT_NEAR(std::log2(coarse / fine), 2.0, 0.2);
  }
}

// Euler's top in Jacobi's functions; the attitude by R I ω = const.
TEST(TimeSteps, FreeTopTumblesAsEulerSays) {
  const FreeTop top;
  const Multibody mb = top.system();
  const double time = 10.0;
  const MotionState s = explicit_steps(mb, top.start(mb), time, 2000);
  EXPECT_LT((s.v.tail<3>() - top.rates(time)).norm(), 1e-9);
  const Vec3 momentum = Eigen::Quaterniond(s.q.data() + 3) * Vec3(top.I.cwiseProduct(s.v.tail<3>()));
  EXPECT_LT((momentum - top.I.cwiseProduct(top.rates(0.0))).norm(), 1e-9);

  const MotionState m = implicit_steps(&midpoint_step, mb, top.start(mb), time, 2000);
  const Vec3 kept = Eigen::Quaterniond(m.q.data() + 3) * Vec3(top.I.cwiseProduct(m.v.tail<3>()));
  const double before = top.I.dot(top.rates(0.0).cwiseAbs2()), after = top.I.dot(Vec3(m.v.tail<3>().cwiseAbs2()));
  std::cout << "midpoint: momentum " << (kept - top.I.cwiseProduct(top.rates(0.0))).norm() << ", energy "
            << std::abs(after / before - 1.0) << ", rates " << (m.v.tail<3>() - top.rates(time)).norm() << "\n";
  EXPECT_LT((kept - top.I.cwiseProduct(top.rates(0.0))).norm(), 1e-12);
  EXPECT_LT(std::abs(after / before - 1.0), 1e-12);
}

}  // namespace
}  // namespace tenon::assembly
