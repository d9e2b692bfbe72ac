#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <tuple>

#include "tests/unit/interfaces/blade_scene.hpp"
#include "tests/unit/interfaces/program.hpp"

// What commands other than `tenon simulate` do for finite motion, from outside.
namespace {

using FiniteMotion = Program;

/// A blade on a flywheel: ρA 1.2, EI 1.4e4, L 10.
const std::string blade = tenon::blade_scene(R"(inputs: {drive: {at: axle}}
outputs: {turn: {at: axle, measure: rate}}
simulation: {time: 2, step: 0.002, sample: 0.01, forces: {drive: {table: [[0, 0], [1, 4e9], [2, 4e9]]}}}
)");

// A body reduced to a file carries what large motion needs: the spun-up blade from its file runs as the blade itself.
TEST_F(FiniteMotion, ReducedBodiesCarryWhatLargeMotionNeeds) {
  const std::string scene = folder_.write("blade.yaml", blade).string();
  ASSERT_EQ(tenon("reduce " + scene + " --body blade -o blade.body.json").status, 0);
  const json body = json::parse(text(folder_.path() / "blade.body.json"));
  EXPECT_TRUE(body["shape_integrals"].is_object());
  EXPECT_TRUE(body["geometric_stiffness"].is_object());
  std::string from_file = blade;
  const std::size_t first = from_file.find("  blade:"), last = from_file.find("joints:");
  from_file.replace(first, last - first, "  blade: {reduced: blade.body.json}\n");
  folder_.write("from_file.yaml", from_file);
  const auto energies = [&](const std::string& file) {
    std::vector<double> values;
    const json run = object("simulate " + file + " --time 0.5");
    for (const json& channel : run["channels"]) values.push_back(channel["last"]);
    return values;
  };
  const std::vector<double> direct = energies(scene), read = energies("from_file.yaml");
  ASSERT_EQ(direct.size(), read.size());
  for (std::size_t k = 0; k < direct.size(); ++k)  // digits are written to the last: only the order of sums may differ
    EXPECT_NEAR(read[k], direct[k], 1e-9 * (1.0 + std::abs(direct[k]))) << k;
  ASSERT_EQ(tenon("reduce " + scene + " --body blade --linear -o linear.body.json").status, 0);
  EXPECT_TRUE(json::parse(text(folder_.path() / "linear.body.json"))["shape_integrals"].is_null());
}

// The shipped spacecraft and four-bar linearised at rest are their linear systems.
TEST_F(FiniteMotion, AssembleLinearisesTheRecursiveModel) {
  for (const char* name : {"data/spacecraft/scene.yaml", "data/fourbar/scene.yaml"}) {
    const std::string scene = (fs::path(TENON_SOURCE_DIR) / name).string();
    const json linear = object("assemble " + scene), recursive = object("assemble " + scene + " --linearise");
    ASSERT_EQ(recursive["frequencies_hz"].size(), linear["frequencies_hz"].size()) << name;
    EXPECT_EQ(recursive["rigid_modes"], linear["rigid_modes"]);
    EXPECT_EQ(recursive["inputs"], linear["inputs"]);
    EXPECT_EQ(recursive["outputs"], linear["outputs"]);
    for (std::size_t k = linear["rigid_modes"]; k < linear["frequencies_hz"].size(); ++k)
      EXPECT_NEAR(recursive["frequencies_hz"][k].get<double>() / linear["frequencies_hz"][k].get<double>(), 1.0, 1e-9);
  }
}

// A blade on a turning flywheel flaps and swings as the rotating cantilever.
TEST_F(FiniteMotion, AssembleLinearisesAboutASpin) {
  // (λ, first flap) of tests/reference/rotating_beam.hpp; chord² = flap² − λ²
  for (const auto& [lambda, flap] : {std::pair(0.0, 3.516015), {4.0, 5.585001}, {12.0, 13.17015}}) {
    // slender enough for λ = 12: r²/L² = 3e-11, EI/ρAL⁴ = (2e11)(3e-14)/(1200)(1e-3)(1e4) = 5e-7
    const double unit = std::sqrt(2e11 * 3e-14 / (1200.0 * 1e-3 * 1e4));
    std::string scene = blade;
    const auto replace = [&](const std::string& from, const std::string& to) {
      ASSERT_NE(scene.find(from), std::string::npos) << from;
      scene.replace(scene.find(from), from.size(), to);
    };
    replace("Iy: 7e-8, Iz: 7e-8, J: 1.4e-7", "Iy: 3e-14, Iz: 3e-14, J: 6e-14");
    replace("elements: 20", "elements: 160");  // tension is constant in an element: 0.4 (h/L)² of its stiffening
    replace("{modes: 6}", "{modes: 24}");
    scene.replace(scene.find("simulation:"), std::string::npos,
                  fmt::format("simulation: {{initial: {{axle: {{rate: {}}}}}}}\n", lambda * unit));
    folder_.write("spun.yaml", scene);
    const json found = object("assemble spun.yaml --linearise -o spun.json");
    const json file = json::parse(text(folder_.path() / "spun.json"));
    EXPECT_EQ(file["second_order"]["coordinates"].back(), "axle");
    EXPECT_EQ(file["A"].size(), 2 * file["second_order"]["M"].size());
    std::vector<double> omega;
    for (const json& f : found["frequencies_hz"]) omega.push_back(2.0 * std::numbers::pi * f.get<double>() / unit);
    const std::size_t free = found["rigid_modes"];
    EXPECT_EQ(free, 1u);  // the flywheel's turn
    EXPECT_NEAR(omega[free] / std::sqrt(flap * flap - lambda * lambda), 1.0, 1e-4) << lambda;
    EXPECT_NEAR(omega[free + 1] / flap, 1.0, 1e-4) << lambda;
  }
}

// A flywheel turned by the torque T loads the blade with w = ρA (T/1e10) x, so that its tip turns by ρA L⁴
// (T/1e10)/8EI, more than it moves over L = 10 m; twice that when the torque steps. First frequency:
// 3.516 √(EI/ρAL⁴) = 3.80 rad/s.
TEST_F(FiniteMotion, ThePlanTakesWhatTheMotionRequires) {
  const auto run = [&](double torque, const std::string& level, const std::string& band) {
    const std::string rest = fmt::format(
        "inputs: {{drive: {{at: axle}}}}\noutputs: {{tip: {{at: blade.C, displacement: y}}}}\n"
        "requires: {{tolerance: 1e-3{}}}\n"
        "simulation: {{time: 2, tolerance: 1e-8, deformation: {}, forces: {{drive: {}}}}}\n",
        band, level, torque);
    folder_.write("plan.yaml", tenon::blade_scene(rest));
    return object("simulate plan.yaml");
  };
  for (const auto& [torque, band, level] : {std::tuple(4e9, "", "full"),
                                            {4e6, "", "dropped"},
                                            {4e3, "", "dropped"},
                                            {4e3, ", band: [0, 0.1 Hz]", "dropped"},
                                            {4e3, ", band: [0, 0.01 Hz]", "rigid"}}) {
    SCOPED_TRACE(fmt::format("{} N m{}", torque, band));
    const json planned = run(torque, "auto", band), full = run(torque, "full", band);
    ASSERT_EQ(planned["plan"].size(), 1u);
    EXPECT_EQ(full["plan"].size(), 0u);
    EXPECT_EQ(planned["plan"][0]["body"], "blade");
    EXPECT_EQ(planned["plan"][0]["taken"], level);
    const double foreseen = planned["plan"][0]["deflection_of_size"], turn = 1.2e4 * torque / 1e10 / (8.0 * 1.4e4);
    EXPECT_NEAR(foreseen / (2.0 * turn), 1.0, 1e-5);  // static shapes are kept; beside the flywheel it weighs 4e-8
    const double most = 1.05 * foreseen;              // the second mode's share
    EXPECT_LE(full["deformation"][0]["largest_deflection_of_size"].get<double>(), most);
    const auto tip = [](const json& of) { return of["channels"][0]["last"].get<double>(); };
    EXPECT_NEAR(tip(planned), tip(full), level == std::string("full") ? 1e-12 : most * 10.0);  // its bending left out
  }
}

}  // namespace
