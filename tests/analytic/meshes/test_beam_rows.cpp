// Beams of published tables and closed forms, through mesh files and scenes.
#include <fmt/format.h>
#include <fmt/ostream.h>
#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <numbers>

#include "assembly/build.hpp"
#include "assembly/scene.hpp"
#include "fem/structure.hpp"
#include "reduction/modes.hpp"
#include "tests/support/temporary_folder.hpp"

using namespace tenon;

namespace {

constexpr double pi = std::numbers::pi;

class BeamRows : public ::testing::Test {
 protected:
  /// A line of n elements (MSH 2.2): set `beam`, end points `left` and `right`; closed: none of these two.
  template <class Place>
  std::string line_mesh(int n, bool closed, Place place) const {
    const std::filesystem::path path = folder_.path() / "line.msh";
    std::ofstream out(path);
    const int nodes = closed ? n : n + 1;
    fmt::print(out,
               "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$PhysicalNames\n3\n0 1 \"left\"\n0 2 \"right\"\n1 3 \"beam\"\n"
               "$EndPhysicalNames\n$Nodes\n{}\n",
               nodes);
    for (int k = 0; k < nodes; ++k) {
      const fem::Vec3 x = place(static_cast<double>(k) / n);
      fmt::print(out, "{} {:.17g} {:.17g} {:.17g}\n", k + 1, x.x(), x.y(), x.z());
    }
    fmt::print(out, "$EndNodes\n$Elements\n{}\n", closed ? n : n + 2);
    for (int k = 0; k < n; ++k) fmt::print(out, "{} 1 2 3 1 {} {}\n", k + 1, k + 1, (k + 1) % nodes + 1);
    if (!closed) fmt::print(out, "{} 15 2 1 2 1\n{} 15 2 2 3 {}\n", n + 1, n + 2, nodes);
    fmt::print(out, "$EndElements\n");
    return path.string();
  }
  std::string straight_mesh(int n, double length) const {
    return line_mesh(n, false, [length](double t) { return fem::Vec3(t * length, 0.0, 0.0); });
  }

  reduction::Modes modes(const std::string& mesh, const std::string& rest, int count) const {
    const auto scene =
        folder_.write("scene.yaml", fmt::format("units: SI\nbodies:\n  part: {{fe: {}, {}}}\n", mesh, rest));
    return reduction::solve_modes(fem::assemble(assembly::build_model(assembly::read_scene(scene).bodies.front())),
                                  {.count = count});
  }

  TemporaryFolder folder_;
};

double in_hertz(double lambda) { return std::sqrt(lambda) / (2.0 * pi); }

void expect_lowest(const reduction::Modes& modes, std::initializer_list<double> expected, double tolerance) {
  Eigen::Index i = modes.rigid;
  ASSERT_GE(modes.lambda.size(), modes.rigid + static_cast<Eigen::Index>(expected.size()));
  for (const double f : expected) EXPECT_NEAR(in_hertz(modes.lambda(i++)) / f, 1.0, tolerance) << f << " Hz";
}

}  // namespace

// SDLL09: tapered cantilevers of 30 elements, bending in one plane; case 2, mode 2 as corrected (175.19 is a misprint).
TEST_F(BeamRows, TaperedCantileversSDLL09) {
  const std::string mesh = straight_mesh(30, 1.0);
  const auto row = [&](double height, double width) {  // bends along the section's y, which is z
    return modes(
        mesh,
        fmt::format("material: {{E: 2e11, nu: 0.3, rho: 7800}}, sections: {{beam: {{rectangle: [{}, {}], tip: "
                    "[0.01, 0.01], along: [[0, 0, 0], [1, 0, 0]], shear: euler-bernoulli, orientation: [0, 0, 1]}}}}, "
                    "fix: {{left: all, everywhere: [x, y, rx, rz]}}, ports: {{tip: {{set: right}}}}",
                    height, width),
        5);
  };
  expect_lowest(row(0.04, 0.04), {54.189, 171.970, 384.53, 697.43, 1112.47}, 1e-3);
  expect_lowest(row(0.04, 0.05), {56.559, 175.830, 389.11, 702.44, 1117.77}, 1e-3);
}

// NAFEMS FV5: a deep beam on pins, of its two versions the one with κ = .85 and Saint-Venant's J = .1406 h⁴.
TEST_F(BeamRows, DeepBeamFV5) {
  const reduction::Modes found =
      modes(straight_mesh(20, 10.0),
            fmt::format("material: {{E: 200e9, nu: 0.3, rho: 8000}}, sections: {{beam: {{general: {{A: 4, Iy: {0}, Iz: "
                        "{0}, J: {1}, kappa_y: 0.85, kappa_z: 0.85}}, orientation: [0, 1, 0]}}}}, "
                        "fix: {{left: [x, y, z, rx], right: [y, z]}}, ports: {{right: {{set: right}}}}",
                        16.0 / 12.0, 0.1406 * 16.0),
            9);
  expect_lowest(found, {42.650, 42.650, 71.20, 125.0, 148.15, 148.15, 213.61, 283.47, 283.47}, 5e-4);
}

// SDLL11: a free thin ring, modes 2, 3, 4 in and out of its plane, doubled (the printed ones to a hertz out of plane).
TEST_F(BeamRows, FreeRingSDLL11) {
  const std::string mesh = line_mesh(
      64, true, [](double t) { return fem::Vec3(0.1 * std::cos(2.0 * pi * t), 0.1 * std::sin(2.0 * pi * t), 0.0); });
  const reduction::Modes found =
      modes(mesh,
            "material: {E: 7.2e10, nu: 0.3, rho: 2700}, sections: {beam: {rectangle: [0.01, 0.005], shear: "
            "euler-bernoulli, orientation: "
            "[0, 0, 1]}}, ports: {start: {nearest: [0.1, 0, 0]}}",
            20);
  EXPECT_EQ(found.rigid, 6);
  expect_lowest(found,
                {318.36, 318.36, 511, 511, 900.46, 900.46, 1590, 1590, 1726.55, 1726.55, 2791.8, 2791.8, 3184, 3184},
                5e-3);
}

// SDLL01: a short beam on simple supports. Timoshenko's equation for sin kx, k = nπ/L:
//   (ρ²I/κG) ω⁴ − (ρA + ρI k² + E I ρ k²/κG) ω² + E I k⁴ = 0; the printed fourth bending mode,
// 4377.84 Hz, is approximate.
TEST_F(BeamRows, ShortBeamOnSupportsSDLL01) {
  const double E = 200e9, G = E / 2.6, rho = 7800.0, A = 0.02, I = 6.6666667e-5, kappa = 1.0 / 1.17692;
  const auto exact = [&](int n) {
    const double k = n * pi, a = rho * rho * I / (kappa * G), c = E * I * std::pow(k, 4),
                 b = rho * A + rho * I * k * k + E * I * rho * k * k / (kappa * G);
    return std::sqrt(2.0 * c / (b + std::sqrt(b * b - 4.0 * a * c))) / (2.0 * pi);
  };
  EXPECT_NEAR(exact(4), 4361.25, 0.005);
  const reduction::Modes found =
      modes(straight_mesh(40, 1.0),
            fmt::format("material: {{E: {}, nu: 0.3, rho: {}}}, sections: {{beam: {{general: {{A: {}, Iy: {}, Iz: {}, "
                        "J: 1e-4, kappa_y: {}, kappa_z: {}}}, orientation: [0, 0, 1]}}}}, "
                        "fix: {{everywhere: [x, y, rx, rz], left: [z], right: [z]}}, ports: {{middle: {{nearest: "
                        "[0.5, 0, 0]}}}}",
                        E, rho, A, I, I, kappa, kappa),
            5);
  // the high-order mass leaves O((kr)⁴ (kh)²) of shear and rotary inertia together, r² = I/A: .1 at mode 5
  expect_lowest(found, {exact(1), exact(2), exact(3), exact(4), exact(5)}, 5e-4);
}

// SDLL101: a slender rod on pins under tension P: ω² = (nπ/L)⁴ EI/m (1 + P L²/(n²π²EI)).
TEST_F(BeamRows, RodUnderTensionSDLL101) {
  const double E = 2e11, rho = 7800.0, d = 0.01, L = 2.0, A = pi * d * d / 4.0, I = pi * std::pow(d, 4) / 64.0;
  const auto scene = folder_.write(
      "scene.yaml",
      fmt::format("units: SI\nbodies:\n  part: {{fe: {}, material: {{E: {}, nu: 0.3, rho: {}}}, sections: {{beam: "
                  "{{circle: {}, shear: euler-bernoulli}}}}, fix: {{left: [x, y, z, rx], right: "
                  "[y, z]}}, ports: {{right: {{set: right}}}}}}\n",
                  straight_mesh(20, L), E, rho, 0.5 * d));
  const fem::Model model = assembly::build_model(assembly::read_scene(scene).bodies.front());
  const fem::Structure free = fem::assemble(model);
  const auto exact = [&](int n, double P) {
    const double k = n * pi / L;
    return std::sqrt(k * k * (E * I * k * k + P) / (rho * A)) / (2.0 * pi);
  };
  EXPECT_NEAR(exact(1, 0.0), 4.9713, 5e-5);
  EXPECT_NEAR(exact(2, 0.0), 19.8851, 5e-5);
  for (const double P : {0.0, 10.0, 100.0, 1000.0}) {
    Eigen::VectorXd u = Eigen::VectorXd::Zero(free.n());
    for (int row = 0; row < free.n(); ++row)
      if (const fem::Dof& dof = free.dofs.free[static_cast<std::size_t>(row)]; dof.direction == 0)
        u[row] = P / (E * A) * free.nodes[static_cast<std::size_t>(dof.node)].x();
    fem::Structure loaded = free;
    loaded.K += fem::geometric_stiffness(model, free, u);
    const reduction::Modes found = reduction::solve_modes(loaded, {.count = 6});
    // (kh)⁴/720 of λ, k = 3π/L
    expect_lowest(found, {exact(1, P), exact(1, P), exact(2, P), exact(2, P), exact(3, P), exact(3, P)},
                  std::pow(3.0 * pi / 20.0, 4) / 1440.0);
  }
}

// A tapered `beam:` is the mesh of its elements; off the mesh's way nothing is known of its section.
TEST_F(BeamRows, TaperedBeamBody) {
  const std::string section = "rectangle: [0.04, 0.05], tip: [0.01, 0.02], orientation: [0, 0, 1]";
  const auto lambda = [&](const std::string& body) {
    const auto scene = folder_.write("scene.yaml", "units: SI\nbodies:\n  part: " + body + "\n");
    return Eigen::VectorXd(
        reduction::solve_modes(fem::assemble(assembly::build_model(assembly::read_scene(scene).bodies.front())),
                               {.count = 12})
            .lambda.tail(6));
  };
  const std::string mesh = straight_mesh(12, 1.0);
  const auto of_mesh = [&](double reach) {
    return fmt::format(
        "{{fe: {}, material: steel, sections: {{beam: {{{}, along: [[0, 0, 0], [{}, 0, 0]]}}}}, ports: "
        "{{tip: {{set: right}}}}}}",
        mesh, section, reach);
  };
  const Eigen::VectorXd beam =
      lambda("{beam: {from: [0, 0, 0], to: [1, 0, 0], elements: 12, section: {" + section + "}, material: steel}}");
  EXPECT_LT((beam.array() / lambda(of_mesh(1.0)).array() - 1.0).abs().maxCoeff(), 1e-9);
  EXPECT_THROW(lambda(of_mesh(0.9)), InputError);
}
