// Published and closed-form frequencies through mesh files and scenes: values and traps as in
// tests/reference/values.hpp.
#include <fmt/format.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <numbers>

#include "assembly/build.hpp"
#include "assembly/scene.hpp"
#include "fem/structure.hpp"
#include "reduction/modes.hpp"
#include "tests/reference/values.hpp"

using namespace tenon;

namespace {

const std::filesystem::path data = std::filesystem::path(TENON_SOURCE_DIR) / "data" / "reference";

reduction::Modes modes_of_scene(const std::filesystem::path& scene, int count) {
  const assembly::Scene read = assembly::read_scene(scene);
  return reduction::solve_modes(fem::assemble(assembly::build_model(read.bodies.front())), {.count = count});
}

reduction::Modes modes_of_text(const std::string& text, int count) {
  const std::filesystem::path path =
      std::filesystem::temp_directory_path() / fmt::format("tenon_reference_{}.yaml", ::getpid());
  std::ofstream(path) << text;
  const reduction::Modes modes = modes_of_scene(path, count);
  std::filesystem::remove(path);
  return modes;
}

double hertz(double lambda) { return std::sqrt(lambda) / (2.0 * std::numbers::pi); }

void expect_frequencies(const reduction::Modes& modes, std::span<const double> target, double tolerance) {
  ASSERT_GE(modes.lambda.size(), modes.rigid + static_cast<Eigen::Index>(target.size()));
  for (std::size_t i = 0; i < target.size(); ++i)
    EXPECT_NEAR(hertz(modes.lambda(modes.rigid + static_cast<Eigen::Index>(i))), target[i], tolerance * target[i])
        << "mode " << i + 1;
}

}  // namespace

/// Ten pairs of end conditions on 16 elements: βL of modes 1–3 to 1e-5 with the default (high-order) mass.
/// The consistent mass is off by (kh)⁴/720 in λ, that is (kh)⁴/2880 in βL: up to 8e-5 here, and is tested against that.
TEST(ReferenceMeshes, EulerBernoulliEndConditions) {
  const double radius = 0.01, E = 7e10, rho = 2700.0;
  const double stiffness = E * std::numbers::pi * std::pow(radius, 4) / 4.0,
               mass = rho * std::numbers::pi * radius * radius;
  for (const reference::EndConditions& ends : reference::euler_bernoulli_roots)
    for (const bool consistent : {false, true}) {
      const auto fix = [](char end) {
        return end == 'c' ? "[y, rz]" : end == 'p' ? "[y]" : end == 's' ? "[rz]" : "[]";
      };
      const std::string text = fmt::format(
          "units: SI\nbodies:\n  beam:\n    fe: {}\n    material: {{E: {}, nu: 0.3, rho: {}}}\n"
          "    sections: {{beam: {{circle: {}, shear: euler-bernoulli}}}}\n    beam_mass: {}\n"
          "    fix: {{everywhere: [x, z, rx, ry], left: {}, right: {}}}\n    ports: {{middle: {{nearest: [0.5, 0, "
          "0]}}}}\n",
          (data / "beam_16.msh").string(), E, rho, radius, consistent ? "consistent" : "high-order", fix(ends.left),
          fix(ends.right));
      const reduction::Modes modes = modes_of_text(text, 6);
      EXPECT_EQ(modes.rigid, ends.rigid) << ends.left << ends.right;
      for (int i = 0; i < 3; ++i) {
        const double root = ends.roots[static_cast<std::size_t>(i)];
        const double beta = std::pow(modes.lambda(modes.rigid + i) * mass / stiffness, 0.25);
        const double error = beta / root - 1.0, predicted = std::pow(root / 16.0, 4) / 2880.0;
        if (consistent)
          EXPECT_NEAR(error, predicted, 0.05 * predicted + 1e-8) << ends.left << ends.right << " mode " << i + 1;
        else
          EXPECT_NEAR(error, 0.0, 1e-5) << ends.left << ends.right << " mode " << i + 1;
      }
    }
}

TEST(ReferenceMeshes, DoubleCrossFV2) {
  expect_frequencies(modes_of_scene(data / "fv2.yaml", 16), reference::fv2, 1e-4);
}

TEST(ReferenceMeshes, CantileverWithOffCentreMassesFV4) {
  expect_frequencies(modes_of_scene(data / "fv4.yaml", 6), reference::fv4, 5e-4);
}

TEST(ReferenceMeshes, SimplySupportedPlateSDLS03) {
  expect_frequencies(modes_of_scene(data / "sdls03.yaml", 6), reference::sdls03, 5e-3);
}

TEST(ReferenceMeshes, FreePlateFV12) {
  const reduction::Modes modes = modes_of_scene(data / "fv12.yaml", 16);
  EXPECT_EQ(modes.rigid, 6);
  expect_frequencies(modes, reference::fv12, 5e-3);
  for (const int i : {3, 5}) {  // two doublets
    const double a = modes.lambda(modes.rigid + i), b = modes.lambda(modes.rigid + i + 1);
    EXPECT_NEAR(a, b, 1e-7 * a);
  }
}

TEST(ReferenceMeshes, CantileverPlateFV16) {
  expect_frequencies(modes_of_scene(data / "fv16.yaml", 6), reference::fv16, 5e-3);
}
