#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <sstream>

#include "tests/unit/interfaces/blade_scene.hpp"
#include "tests/unit/interfaces/program.hpp"

// `tenon simulate` from outside.
namespace {

using testing::HasSubstr;
using testing::Not;

class Simulate : public Program {
 protected:
  std::string last_line(const char* file) const {
    std::istringstream lines(text(folder_.path() / file));
    std::string line, last;
    while (std::getline(lines, line)) last = line;
    return last;
  }
  /// A column of numbers of a history, by its head.
  std::vector<double> column(const char* file, const std::string& head) const {
    std::istringstream lines(text(folder_.path() / file));
    std::string line, word;
    std::getline(lines, line);
    std::istringstream heads(line);
    int at = 0;
    while (std::getline(heads, word, ',') && word != head) ++at;
    EXPECT_EQ(word, head);
    std::vector<double> numbers;
    while (std::getline(lines, line)) {
      std::istringstream row(line);
      for (int k = 0; k <= at; ++k) std::getline(row, word, ',');
      numbers.push_back(std::stod(word));
    }
    return numbers;
  }
  static json channel(const json& run, const std::string& name) {
    for (const json& c : run["channels"])
      if (c["name"] == name) return c;
    ADD_FAILURE() << "no channel " << name;
    return {};
  }
};

/// A blade on a flywheel that is spun up to 6 rad/s in 15 s: the data of REFERENCES' spin-up, ρA 1.2, EI 1.4e4, L 10.
const std::string spun_blade = tenon::blade_scene(R"(inputs: {drive: {at: axle}, ease: {at: axle}}
outputs: {turn: {at: axle, measure: angle}, tip: {at: blade.C, displacement: [x, y]}}
simulation:
  time: 8
  step: 0.005
  sample: 0.02
  forces: {drive: 4e9, ease: {sine: -4e9, frequency: 0.0666666666666667 Hz, phase: 90 deg}}
)");

// Ω̇ = 0.4 (1 − cos(2πt/15)): the tip lags most at 6.760 s, by 0.57437 m in the linearised equation with centrifugal
// stiffening, without rotary inertia and stretch (an independent Ritz computation). Those are 1e-3 of it here, as is
// the nonlinear rest; a row stands every 0.02 s.
TEST_F(Simulate, ABladeLagsAsPublished) {
  const std::string scene = folder_.write("blade.yaml", spun_blade).string();
  const Ended run = tenon("simulate " + scene + " --out run");
  ASSERT_EQ(run.status, 0) << run.err;
  EXPECT_THAT(run.out, Not(HasSubstr("no geometric stiffening")));  // meshes and beams carry it
  EXPECT_THAT(run.out, Not(HasSubstr("no shape integrals")));
  EXPECT_THAT(run.out, HasSubstr("energy.total leaves out the work of geometric stiffening"));
  for (const char* file : {"history.csv", "history.npz", "energy.svg", "checkpoint.json"})
    EXPECT_TRUE(fs::exists(folder_.path() / "run" / file)) << file;
  const auto t = column("run/history.csv", "t_s"), turn = column("run/history.csv", "turn [rad]"),
             x = column("run/history.csv", "tip.x [m]"), y = column("run/history.csv", "tip.y [m]");
  double least = 0.0, at = 0.0;
  for (std::size_t k = 0; k < t.size(); ++k) {
    const double lag = y[k] * std::cos(turn[k]) - (10.0 + x[k]) * std::sin(turn[k]);
    if (lag < least) least = lag, at = t[k];
  }
  EXPECT_NEAR(least, -0.57437, 1e-3);
  EXPECT_NEAR(at, 6.760, 0.02);
}

// What deformation does is said for each body. Under the load of the spin-up, which grows with the radius, the tip
// turns by 15/11 of its lag over the length (w₀L³/8EI beside 11 w₀L⁴/120EI); tension and swing change that by some per
// cent.
TEST_F(Simulate, BodiesDeformAsTheSceneSays) {
  const auto run = [&](const std::string& level) {
    std::string scene = spun_blade;
    scene.replace(scene.find("  time: 8"), 9, "  deformation: " + level + "\n  time: 7");
    return object("simulate " + folder_.write("blade.yaml", scene).string());
  };
  const json full = run("{blade: full}"), dropped = run("dropped"), rigid = run("{hub: full, blade: rigid}");
  ASSERT_EQ(full["deformation"].size(), 1u);
  EXPECT_NEAR(full["deformation"][0]["largest_deflection_of_size"].get<double>(), 15.0 / 11.0 * 0.057437, 0.05 * 0.078);
  EXPECT_EQ(full["notes"].size(), 0u);
  EXPECT_EQ(dropped["deformation"][0]["taken"], "dropped");
  EXPECT_THAT(dropped["notes"].dump(), HasSubstr("while its deformation is dropped"));
  EXPECT_EQ(rigid["deformation"].size(), 0u);
  for (const json& channel : rigid["channels"]) {
    if (channel["name"] != "energy.elastic") continue;
    EXPECT_EQ(channel["most"].get<double>(), 0.0);
  }
  std::string scene = spun_blade;
  scene.replace(scene.find("  time: 8"), 9, "  deformation: {blad: rigid}\n  time: 8");
  const Ended refused = tenon("simulate " + folder_.write("blade.yaml", scene).string());
  EXPECT_EQ(refused.status, 2);
  EXPECT_THAT(refused.err, HasSubstr("Did you mean 'blade'"));
}

TEST_F(Simulate, ABladeGoesOnBitForBit) {
  const std::string scene = folder_.write("blade.yaml", spun_blade).string();
  ASSERT_EQ(tenon("simulate " + scene + " --time 2 --out whole").status, 0);
  ASSERT_EQ(tenon("simulate " + scene + " --time 1 --out half").status, 0);
  ASSERT_EQ(tenon("simulate " + scene + " --time 2 --resume half/checkpoint.json --out rest").status, 0);
  EXPECT_EQ(last_line("rest/history_from_1.02.csv"), last_line("whole/history.csv"));
  const Ended other = tenon("simulate " + scene + " --time 2 --step 0.002 --resume half/checkpoint.json");
  EXPECT_EQ(other.status, 2);
  EXPECT_THAT(other.err, HasSubstr("another of 0.002 s is given"));
  const Ended again = tenon("simulate " + scene + " --time 1 --resume half/checkpoint.json");
  EXPECT_EQ(again.status, 2);
  EXPECT_THAT(again.err, HasSubstr("stands at 1 s already"));
}

std::string pendulum_scene(const std::string& rest) {
  return R"(units: SI
bodies:
  base: {rigid: {mass: 1, inertia: [1, 1, 1]}, ports: {o: [0, 0, 0], p: [0, 0, 0]}}
  arm: {rigid: {mass: 2, inertia: [0.1, 0.1, 0.1], com: [0.5, 0, 0]}, ports: {p: [0, 0, 0]}}
joints: {pin: {parent: base.p, child: arm.p, revolute: y}}
ground: [base.o]
inputs: {torque: {at: pin}, more: {at: pin}}
outputs: {angle: {at: pin, measure: angle}}
)" + rest;
}

// Nothing of the sampling is said: a thousandth of the first run's time, and the second goes on with it.
TEST_F(Simulate, ARunGoesOnWithItsOwnSamples) {
  const std::string scene = folder_.write("p.yaml", pendulum_scene("simulation: {gravity: [0, 0, -9.81]}\n")).string();
  for (const char* method : {"", " --method dormand-prince --tolerance 1e-8", " --method midpoint --step 3e-4"}) {
    SCOPED_TRACE(method);
    EXPECT_EQ(object("simulate " + scene + method + " --time 1 --out half")["samples"], 1001);
    const json rest = object("simulate " + scene + " --time 2 --resume half/checkpoint.json --out rest");
    EXPECT_EQ(rest["samples"], 1000);
    EXPECT_NEAR(rest["begin_s"].get<double>(), 1.001, 1e-15);
    if (!*method) continue;  // bdf starts anew, within its tolerance
    ASSERT_EQ(tenon("simulate " + scene + method + " --time 2 --sample 0.001 --out whole").status, 0);
    EXPECT_EQ(last_line("rest/history_from_1.001.csv"), last_line("whole/history.csv"));
  }
  EXPECT_EQ(object("simulate " + scene + " --time 1.5 --sample 0.1 --resume half/checkpoint.json")["samples"], 5);
}

// A pendulum let go level, θ̈ = −m g l cos θ / (J + m l²): half its swing is π, and it swings over no more.
TEST_F(Simulate, RunGivesTimeAndGravityWhereSimulationIsSilent) {
  const std::string by_run =
      folder_.write("run.yaml", pendulum_scene("run: {duration: 3, gravity: [0, 0, -9.81]}\n")).string();
  const std::string by_both = folder_
                                  .write("both.yaml", pendulum_scene("run: {duration: 7, gravity: [0, 0, -2]}\n"
                                                                     "simulation: {time: 3, gravity: [0, 0, -9.81]}\n"))
                                  .string();
  const json run = object("simulate " + by_run);
  EXPECT_EQ(run["end_s"], 3.0);
  EXPECT_NEAR(channel(run, "angle")["most"].get<double>(), std::numbers::pi, 1e-4);
  EXPECT_EQ(object("simulate " + by_both)["channels"], run["channels"]);
  EXPECT_THAT(tenon("modes " + by_run).err, HasSubstr("gravity changes the state of rest"));
}

// Two forces whose sum is no number: what is wrong is said, at the start and after a checkpoint.
TEST_F(Simulate, AFailureAtTheStartIsSaid) {
  const std::string good = folder_.write("p.yaml", pendulum_scene("")).string();
  const std::string bad =
      folder_.write("b.yaml", pendulum_scene("simulation: {forces: {torque: 1e308, more: 1e308}}\n")).string();
  ASSERT_EQ(tenon("simulate " + good + " --time 1 --out half").status, 0);
  for (const char* resume : {" --time 1", " --time 2 --resume half/checkpoint.json"}) {
    const Ended run = tenon("simulate " + bad + resume);
    EXPECT_NE(run.status, 0);
    EXPECT_THAT(run.err, HasSubstr("the force of body 'arm'"));
    EXPECT_THAT(run.err, Not(HasSubstr("stands at")));
  }
}

TEST_F(Simulate, OptionsThatContradictAreRefused) {
  const std::string scene =
      folder_.write("p.yaml", pendulum_scene("simulation: {time: 1, step: 0.01, tolerance: 1e-7}\n")).string();
  EXPECT_EQ(object("simulate " + scene)["method"], "bdf");  // a tolerance is given: the step is the first
  EXPECT_EQ(object("simulate " + scene + " --step 0.01")["method"], "generalized-alpha");
  EXPECT_EQ(object("simulate " + scene + " --tolerance 1e-6")["method"], "bdf");
  for (const char* arguments : {" --method midpoint --tolerance 1e-6", " --time nan", " --step inf", " --sample -1",
                                " --tolerance 0", " --method midpont"}) {
    const Ended run = tenon("simulate " + scene + arguments);
    EXPECT_EQ(run.status, 2) << arguments;
    EXPECT_EQ(run.out, "") << arguments;
  }
  EXPECT_THAT(tenon("simulate " + scene + " --method midpoint --tolerance 1e-6").err,
              HasSubstr("midpoint takes fixed steps"));
  EXPECT_THAT(tenon("simulate " + scene + " --time nan").err, HasSubstr("'nan' is no positive number"));
}

// Beams in closed form come without shape integrals.
TEST_F(Simulate, BodiesWithoutShapeIntegralsAreNamed) {
  std::string scene = spun_blade;
  scene.replace(scene.find("elements: 20"), 12, "model: titop-polynomial");
  scene.replace(scene.find("    reduction: {modes: 6}\n"), 26, "");
  const std::string file = folder_.write("closed.yaml", scene).string();
  EXPECT_THAT(tenon("simulate " + file + " --time 0.1").out, HasSubstr("Body 'blade' carries no shape integrals"));
  scene.replace(scene.find("  time: 8"), 9, "  deformation: dropped\n  time: 8");
  folder_.write("closed.yaml", scene);
  EXPECT_THAT(tenon("simulate " + file + " --time 0.1").out, Not(HasSubstr("no shape integrals")));
}

// A crank-rocker (0.3, 0.9, 0.7 on 1 m) cut open at one joint or at another: the same angles, turns of the crank
// counted, and the same reactions in its plane (out of it the joints hold more than they need).
TEST_F(Simulate, LoopsMoveAndHoldAlikeWhereverTheyAreCut) {
  const std::string bodies = R"(units: SI
bodies:
  frame: {rigid: {mass: 1, inertia: [1, 1, 1]}, ports: {base: [0, 0, 0], a: [0, 0, 0], d: [1, 0, 0]}}
  crank: {rigid: {mass: 1, inertia: [1e-3, 0.01, 0.01], com: [0.15, 0, 0]}, ports: {p: [0, 0, 0], q: [0.3, 0, 0]}}
  coupler: {rigid: {mass: 0.5, inertia: [1e-3, 0.04, 0.04], com: [0.45, 0, 0]}, ports: {p: [0, 0, 0], q: [0.9, 0, 0]}}
  follower: {rigid: {mass: 0.4, inertia: [1e-3, 0.02, 0.02], com: [0.35, 0, 0]}, ports: {p: [0, 0, 0], q: [0.7, 0, 0]}}
ground: [frame.base]
inputs: {push: {at: a}}
outputs: {a: {at: a, measure: angle}, b: {at: b, measure: angle}, c: {at: c, measure: angle}, d: {at: d, measure: angle}}
simulation: {time: 1, tolerance: 1e-10, sample: 0.01, gravity: [0, -9.81, 0], forces: {push: 5}}
joints:
)";
  const std::string a = "  a: {parent: frame.a, child: crank.p, revolute: z, angle: 90 deg}\n",
                    b = "  b: {parent: crank.q, child: coupler.p, revolute: z, near: -65 deg}\n",
                    c = "  c: {parent: coupler.q, child: follower.q, revolute: z, near: 80 deg}\n",
                    d = "  d: {parent: frame.d, child: follower.p, revolute: z, near: 105 deg}\n";
  const json at_c = object("simulate " + folder_.write("c.yaml", bodies + a + b + c + d).string());
  const json at_b = object("simulate " + folder_.write("b.yaml", bodies + d + c + b + a).string());
  EXPECT_GT(std::abs(channel(at_b, "b")["last"].get<double>() - channel(at_b, "b")["first"].get<double>()),
            2.0 * std::numbers::pi);
  const auto compare = [&](const std::string& name, double tolerance) {
    for (const char* key : {"first", "last", "least", "most"})
      EXPECT_NEAR(channel(at_b, name)[key].get<double>(), channel(at_c, name)[key].get<double>(), tolerance)
          << name << ", " << key;
  };
  for (const char* joint : {"a", "b", "c", "d"}) {
    compare(joint, 1e-6);  // some thousand steps of 1e-10 of angles and rates up to 50
    for (const char* part : {"fx", "fy", "tz"}) compare(std::string("reaction.") + joint + "." + part, 1e-3);
  }
  EXPECT_GT(channel(at_c, "reaction.c.fx")["most"].get<double>(), 10.0);
}

}  // namespace
