#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstring>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <nlohmann/json.hpp>

#include "assembly/integration/checkpoint.hpp"
#include "fem/error.hpp"
#include "tests/analytic/assembly/mechanisms.hpp"
#include "tests/analytic/assembly/runs.hpp"

// How runs begin, end, fail and go on.
namespace tenon::assembly {
namespace {

using Eigen::VectorXd;
using testing::all_methods;
using testing::DoublePendulum;
using testing::LagrangeTop;
using testing::Ran;
using testing::run;
using testing::SliderCrank;

// Rows stand at the samples and at the end, also where no step ends; and the run goes on from there with the same bits.
TEST(Runs, TheEndIsSeenWhereverItFalls) {
  const DoublePendulum pendulum;
  const Multibody mb = pendulum.system();
  for (const Method method : all_methods) {
    IntegrationOptions options{.method = method, .until = 1.0, .step = 0.007, .sample = 0.3};
    std::vector<double> times, whole;
    MotionState one, two;
    long kept = 0;
    const auto see = [&](const Sample& s) { return times.push_back(s.t), one = s.state, true; };
    IntegrationState state = begin(mb, rest_state(mb)), other = state;
    const auto keep = [&](const IntegrationState&) { ++kept; };
    EXPECT_EQ(integrate(mb, {}, state, options, see, keep).failure, "");
    EXPECT_GT(kept, 0) << name(method);
    ASSERT_EQ(times.size(), 5u) << name(method);
    EXPECT_EQ(times.back(), 1.0);
    EXPECT_TRUE(integrate(mb, {}, state, options, see).failure.empty());
    EXPECT_EQ(times.size(), 5u);  // it stands there already
    options.until = 1.25;
    integrate(mb, {}, state, options, see);
    integrate(mb, {}, other, options, [&](const Sample& s) { return whole.push_back(s.t), two = s.state, true; });
    times.erase(times.begin() + 4);  // the end of the first call
    ASSERT_EQ(times.size(), whole.size());
    for (std::size_t k = 0; k < times.size(); ++k) EXPECT_NEAR(times[k], whole[k], 1e-15);
    if (method == Method::bdf || method == Method::adams) continue;  // within the tolerance only
    EXPECT_EQ((one.q - two.q).norm() + (one.v - two.v).norm(), 0.0);
  }
}

TEST(Runs, ARunMayGoOnWithOtherSamplesButNotWithOtherSteps) {
  const DoublePendulum pendulum;
  const Multibody mb = pendulum.system();
  for (const Method method : {Method::midpoint, Method::dormand_prince, Method::bdf}) {
    IntegrationOptions options{.method = method, .until = 0.45, .step = 0.01, .sample = 0.1};
    IntegrationState state = begin(mb, rest_state(mb));
    integrate(mb, {}, state, options, {});
    EXPECT_EQ(state.sample, 0.1);
    options.until = 0.81;
    options.sample = 0.2;
    std::vector<double> times;
    IntegrationState on = state;
    integrate(mb, {}, on, options, [&](const Sample& s) { return times.push_back(s.t), true; });
    ASSERT_EQ(times.size(), 3u) << name(method);
    EXPECT_NEAR(times[0], 0.6, 1e-15);
    EXPECT_NEAR(times[1], 0.8, 1e-15);
    EXPECT_DOUBLE_EQ(times[2], 0.81);
    if (fixed_steps(method)) {
      options.sample = 0.015;
      EXPECT_THROW(integrate(mb, {}, on = state, options, {}), ModelError);
      options.sample = 0.1;
    }
    options.step = 0.005;
    if (method == Method::bdf)  // starts anew
      EXPECT_NO_THROW(integrate(mb, {}, on = state, options, {}));
    else
      EXPECT_THROW(integrate(mb, {}, on = state, options, {}), ModelError);
  }
}

TEST(Runs, StepsThatAreUsedUpAreSaid) {
  const DoublePendulum pendulum;
  for (const Method method : all_methods) {
    IntegrationOptions options{.method = method, .until = 1.0, .step = 1e-3, .sample = 0.1};
    options.most_steps = 5;
    const Multibody mb = pendulum.system();
    EXPECT_THAT(run(mb, rest_state(mb), options).result.failure, ::testing::HasSubstr("after 5 steps"));
  }
}

// A zero at the very end of a step belongs to that step, from whichever side it is reached; what lies behind the end of
// the run is not told, and what was told is not told again.
TEST(Runs, EventsAreFoundOnceAndWithinTheRun) {
  const testing::FallingWeight weight;
  const Multibody mb = weight.system();
  const MotionState start = weight.start(mb);
  for (const Method method : all_methods) {
    IntegrationOptions options{.method = method, .until = 0.55, .step = 0.125, .sample = 0.125};
    options.events = {{"rising", [](double t, const MotionState&) { return t - 0.5; }, false},
                      {"falling", [](double t, const MotionState&) { return 0.5 - t; }, false},
                      {"soon", [](double t, const MotionState&) { return 0.5625 - t; }, false},
                      {"later", [](double, const MotionState& s) { return s.q[0] - 0.4; }, true}};  // at 0.5711 s
    IntegrationState state = begin(mb, start);
    const Integration first = integrate(mb, {}, state, options, {});
    EXPECT_EQ(first.stopped_by, "") << name(method);
    ASSERT_EQ(first.events.size(), 2u) << name(method);
    EXPECT_NEAR(first.events[0].t, 0.5, 2e-12);
    EXPECT_NEAR(first.events[1].t, 0.5, 2e-12);
    options.until = 2.0;
    const Integration second = integrate(mb, {}, state, options, {});
    EXPECT_EQ(second.stopped_by, "later") << name(method);
    ASSERT_EQ(second.events.size(), 2u) << name(method);
    EXPECT_NEAR(second.events[0].t, 0.5625, 2e-12);
    EXPECT_NEAR(second.events[1].t, weight.passes(0.4),
                method == Method::bdf || method == Method::adams ? 1e-6 : 1e-10);
  }
}

bool same_bits(const VectorXd& a, const VectorXd& b) {
  return a.size() == b.size() &&
         std::memcmp(a.data(), b.data(), static_cast<std::size_t>(a.size()) * sizeof(double)) == 0;
}

// Stopped half-way, written, read and continued: the same bits as in one go, at the same samples.
TEST(Runs, CheckpointsContinueBitForBit) {
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
      write_checkpoint(path, mb, {method, whole.tolerance, b});
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

// A file that was changed by hand, or a system that was: refused with what differs, before anything is computed.
TEST(Runs, CheckpointsAreNotTrusted) {
  const auto path = std::filesystem::temp_directory_path() / "tenon_checkpoint_trust.json";
  const LagrangeTop top;
  const Multibody mb = top.system();
  IntegrationState state = begin(mb, top.start(mb));
  integrate(mb, {}, state, {.until = 0.1, .step = 0.01}, {});
  write_checkpoint(path, mb, {Method::generalized_alpha, {}, state});
  std::ifstream stream(path);
  const nlohmann::json good = nlohmann::json::parse(stream);
  const auto message = [&](const nlohmann::json& file, const Multibody& system) -> std::string {
    std::ofstream(path) << file;
    try {
      read_checkpoint(path, system);
    } catch (const Error& fault) {
      return fault.what();
    }
    return "";
  };
  EXPECT_EQ(message(good, mb), "");
  using ::testing::HasSubstr;
  nlohmann::json bad = good;
  bad["v_dot"].erase(2);
  EXPECT_THAT(message(bad, mb), HasSubstr("of another size"));
  for (const char* key : {"a", "v_dot"}) {
    bad = good;
    bad[key][0] = "nan";
    EXPECT_THAT(message(bad, mb), HasSubstr("no numbers"));
  }
  bad = good;
  bad["q"][0] = "0x1p+1";
  EXPECT_THAT(message(bad, mb), HasSubstr("quaternion of length"));
  bad = good;
  bad["v"][1] = "inf";
  EXPECT_THAT(message(bad, mb), HasSubstr("body 'top' is no number"));
  bad = good;
  bad["steps"] = -1;
  EXPECT_THAT(message(bad, mb), HasSubstr("no run has"));
  for (const char* key : {"step_s", "sample_s", "seen_s"}) {
    bad = good;
    bad[key] = "-0x1p+0";
    EXPECT_THAT(message(bad, mb), HasSubstr("no run has")) << key;
  }
  EXPECT_THAT(message(good, LagrangeTop{.mass = 0.5001}.system()), HasSubstr("body 'top' has another mass matrix"));
  EXPECT_THAT(message(good, LagrangeTop{.g = 9.8}.system()), HasSubstr("another gravity"));
  Multibody sprung = mb;
  sprung.bodies[0].stiffness = VectorXd::Constant(3, 1.0);
  EXPECT_THAT(message(good, sprung), HasSubstr("another joint spring"));
  std::filesystem::remove(path);
}

TEST(Runs, WhatCameBeforeAFailureIsKept) {
  const DoublePendulum pendulum;
  const Multibody mb = pendulum.system();
  const Loads broken = [](double t, const MotionState&, Sweeps&, VectorXd& T) {
    if (t > 0.52) T[1] = std::nan("");
  };
  const Loads empty = [](double t, const MotionState&, Sweeps&, VectorXd&) {
    if (t > 0.52) throw ModelError("the tank of body 'lower' is empty", "Fill it");
  };
  for (const Method method : all_methods)
    for (const Loads* loads : {&broken, &empty}) {
      const Ran r = run(mb, rest_state(mb), {.method = method, .until = 1.0, .step = 0.01, .sample = 0.1}, *loads);
      EXPECT_THAT(r.result.failure, ::testing::HasSubstr("body 'lower'")) << name(method);
      std::cout << r.result.failure << "\n";
      EXPECT_EQ(r.samples, 6) << name(method);  // 0 ... 0.5
    }
}

// Where nothing can be kept, the fault itself comes through.
TEST(Runs, AFaultAtTheStartIsThrown) {
  const DoublePendulum pendulum;
  const Multibody mb = pendulum.system();
  const Loads broken = [](double, const MotionState&, Sweeps&, VectorXd& T) { T[1] = std::nan(""); };
  for (const Method method : all_methods)
    EXPECT_THROW(run(mb, rest_state(mb), {.method = method, .until = 1.0, .step = 0.01}, broken), NumericalError)
        << name(method);
}

TEST(Runs, OptionsThatAreNoNumbersAreRefused) {
  const DoublePendulum pendulum;
  const Multibody mb = pendulum.system();
  const double nan = std::nan("");
  const IntegrationOptions good{.until = 0.1, .step = 0.01, .sample = 0.05};
  EXPECT_NO_THROW(run(mb, rest_state(mb), good));
  const auto refused = [&](auto&& change) {
    IntegrationOptions bad = good;
    change(bad);
    EXPECT_THROW(run(mb, rest_state(mb), bad), ModelError);
  };
  refused([&](IntegrationOptions& o) { o.step = nan; });
  refused([&](IntegrationOptions& o) { o.sample = nan; });
  refused([&](IntegrationOptions& o) { o.sample = -1.0; });
  refused([&](IntegrationOptions& o) { o.tolerance.relative = 0.0; });
  refused([&](IntegrationOptions& o) { o.tolerance.absolute = nan; });
  refused([&](IntegrationOptions& o) { o.implicit.rho_infinity = 1.5; });
  refused([&](IntegrationOptions& o) { o.implicit.tolerance = -1.0; });
}

TEST(Runs, StatesThatMakeNoSenseAreRefused) {
  const SliderCrank crank;
  const Multibody mb = crank.system();
  EXPECT_THROW(run(mb, crank.start(mb, 0.3, 1.0), {.method = Method::adams}), ModelError);  // takes no loops
  const auto message = [&](const MotionState& state) -> std::string {
    try {
      begin(mb, state);
    } catch (const ModelError& fault) {
      return fault.what();
    }
    return "";
  };
  MotionState open = crank.start(mb, 0.3, 1.0);
  open.q[2] += 1e-3;
  EXPECT_THAT(message(open), ::testing::HasSubstr("closure 'pin' gapes by 0.0009"));
  MotionState opening = crank.start(mb, 0.3, 1.0);
  opening.v[2] += 1e-3;
  EXPECT_THAT(message(opening), ::testing::HasSubstr("closure 'pin' opens at 0.0009"));
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
