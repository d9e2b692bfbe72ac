// Shells of published tables, through mesh files and scenes.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <Eigen/SparseCholesky>
#include <cmath>
#include <functional>
#include <numbers>

#include "assembly/build.hpp"
#include "assembly/scene.hpp"
#include "fem/formats/write_gmsh.hpp"
#include "fem/structure.hpp"
#include "reduction/modes.hpp"
#include "tests/analytic/fem/shell_course.hpp"
#include "tests/support/temporary_folder.hpp"

using namespace tenon;
using fem::Vec3;
using fem::testing::Cover;
using fem::testing::Grid;

namespace {

constexpr double tau = 2.0 * std::numbers::pi;

class ShellRows : public ::testing::Test {
 protected:
  /// Cells between (nu+1) × (nv+1) points, whose edges are the sets u0, u1, v0, v1; `closed`: u1 is u0.
  void grid(int nu, int nv, const std::function<Vec3(int, int)>& at, bool closed = false) {
    const int across = closed ? nu : nu + 1;
    const auto node = [&](int i, int j) { return j * across + i % across; };
    fem::Mesh mesh;
    fem::CellBlock cells{.type = fem::CellType::quad, .nodes = {}, .ids = {}};
    for (int j = 0; j <= nv; ++j)
      for (int i = 0; i < across; ++i) mesh.points.push_back(at(i, j));
    for (int j = 0; j < nv; ++j)
      for (int i = 0; i < nu; ++i) {
        mesh.cell_sets["skin"].resize(1);
        mesh.cell_sets["skin"][0].push_back(cells.size());
        for (const int k : {node(i, j), node(i + 1, j), node(i + 1, j + 1), node(i, j + 1)}) cells.nodes.push_back(k);
      }
    mesh.cells.push_back(cells);
    for (int j = 0; j <= nv && !closed; ++j) mesh.point_sets["u0"].push_back(node(0, j));
    for (int j = 0; j <= nv && !closed; ++j) mesh.point_sets["u1"].push_back(node(nu, j));
    for (int i = 0; i < across; ++i) mesh.point_sets["v0"].push_back(node(i, 0));
    for (int i = 0; i < across; ++i) mesh.point_sets["v1"].push_back(node(i, nv));
    mesh.point_sets["first"] = {0};
    fem::write_gmsh(folder_.path() / "skin.msh", mesh);
  }

  /// The nodes of the obstacle course.
  void grid(const Cover& cover, const fem::testing::Surface& at) {
    const auto course = fem::testing::cover(cover, 1.0, fem::testing::elastic(1.0, 0.0), at);
    grid(cover.N, cover.N, [&](int i, int j) { return course.nodes[static_cast<std::size_t>(j * (cover.N + 1) + i)]; });
  }

  fem::Structure structure(double E, double nu, double rho, double t, const std::string& fix) const {
    const auto scene = folder_.write(
        "scene.yaml", fmt::format("units: SI\nbodies:\n  part:\n    fe: skin.msh\n    material: {{E: {}, nu: {}, rho: "
                                  "{}}}\n    sections: {{skin: {{shell: {}}}}}\n    fix: {{{}}}\n    ports: {{first: "
                                  "{{set: first}}}}\n",
                                  E, nu, rho, t, fix));
    return fem::assemble(assembly::build_model(assembly::read_scene(scene).bodies.front()));
  }

  TemporaryFolder folder_;
};

/// Displacement of a dof under forces on dofs.
double deflection(const fem::Structure& s, fem::Dof of, const std::vector<std::pair<fem::Dof, double>>& forces) {
  Eigen::VectorXd f = Eigen::VectorXd::Zero(s.n());
  for (const auto& [dof, force] : forces)
    if (const int row = s.dofs.row(dof); row >= 0) f[row] += force;
  return Eigen::SimplicialLDLT<fem::SparseMatrix, Eigen::Lower>(s.K).solve(f)[s.dofs.row(of)];
}

/// Whether a mode has that frequency, n times over.
void expect_mode(const reduction::Modes& modes, double hertz, int n, double tolerance) {
  Eigen::Index near = 0;
  for (Eigen::Index i = modes.rigid; i < modes.lambda.size(); ++i)
    near += std::abs(std::sqrt(modes.lambda[i]) / tau / hertz - 1.0) < tolerance ? 1 : 0;
  EXPECT_EQ(near, n) << hertz
                     << " Hz: " << (modes.lambda.tail(modes.lambda.size() - modes.rigid).cwiseSqrt() / tau).transpose();
}

}  // namespace

// R = .1, L = .4, t = .002 between diaphragms, one half wave along, n = 2 to 5 around, each twice: thin-shell theory
// (Flügge's equations give .1 to .3 % more). 64 cells around: 13 a wave at n = 5.
TEST_F(ShellRows, SimplySupportedCylinder) {
  constexpr int around = 64, along = 32;
  grid(
      around, along,
      [](int i, int j) {
        const double angle = tau * i / around;
        return Vec3(0.4 * j / along, 0.1 * std::cos(angle), 0.1 * std::sin(angle));
      },
      true);
  const reduction::Modes modes =
      reduction::solve_modes(structure(200e9, 0.3, 7800, 0.002, "v0: [y, z], v1: [y, z]"), {.count = 14});
  EXPECT_EQ(modes.rigid, 1) << "along its axis";
  for (const double hertz : {963.89, 627.91, 791.18, 1190.71}) expect_mode(modes, hertz, 2, 1e-2);
}

// NAFEMS Test 21: 10 × 10 × 1 m, simply supported, edges held across and nothing moves in the plane.
TEST_F(ShellRows, ThickSimplySupportedPlate) {
  grid(16, 16, [](int i, int j) { return Vec3(10.0 * i / 16, 10.0 * j / 16, 0.0); });
  const reduction::Modes modes = reduction::solve_modes(
      structure(200e9, 0.3, 8000, 1.0, "everywhere: [x, y, rz], u0: [z, rx], u1: [z, rx], v0: [z, ry], v1: [z, ry]"),
      {.count = 8});
  EXPECT_EQ(modes.rigid, 0);
  for (const auto& [hertz, n] : {std::pair{45.895, 1}, {109.444, 2}, {167.886, 1}, {204.513, 2}, {256.502, 2}})
    expect_mode(modes, hertz, n, 1e-2);
}

// Statics, N = 16: what the file and the scene make of them is the course's own deflection, but for the digits that
// the solution of thin shells keeps, and within what MITC4+ is quoted with.
TEST_F(ShellRows, HemisphereWithHole) {
  for (const auto& [mesh, quoted] : {std::pair{Grid::regular, 1.003}, {Grid::distorted, 0.9958}}) {
    grid({mesh}, [](double u, double v) {
      const double around = 0.25 * tau * u, up = 0.2 * tau * v;
      return Vec3(10 * std::cos(up) * std::cos(around), 10 * std::cos(up) * std::sin(around), 10 * std::sin(up));
    });
    const fem::Structure s = structure(6.825e7, 0.3, 1, 0.04, "u0: [y, rx, rz], u1: [x, ry, rz], first: [z]");
    const double u = deflection(s, {0, 0}, {{{0, 0}, 1.0}, {{16, 1}, -1.0}});
    EXPECT_NEAR(u / fem::testing::hemisphere({mesh}, 0.04), 1.0, 1e-6);
    EXPECT_LE(std::abs(u / 0.093 - 1.0), std::abs(quoted - 1.0) + 0.002);
  }
}

TEST_F(ShellRows, PinchedCylinder) {
  for (const auto& [mesh, quoted] : {std::pair{Grid::regular, 0.9313}, {Grid::distorted, 0.9321}}) {
    grid({mesh}, [](double u, double v) {
      return Vec3(300 * std::sin(0.25 * tau * u), 300 * v, 300 * std::cos(0.25 * tau * u));
    });
    const fem::Structure s =
        structure(3e6, 0.3, 1, 3.0, "v0: [y, rx, rz], v1: [x, z], u0: [x, ry, rz], u1: [z, rx, ry]");
    const double u = -deflection(s, {0, 2}, {{{0, 2}, -0.25}});
    EXPECT_NEAR(u / fem::testing::pinched_cylinder({mesh}), 1.0, 1e-7);
    EXPECT_LE(std::abs(u / 1.8248e-5 - 1.0), std::abs(quoted - 1.0) + 0.002);
    EXPECT_NEAR(u / 1.8248e-5, 1.0, 0.015) << "the element's own error, about a per cent";
  }
}

// Under its weight, 90 per area: what M of the free roof says a unit acceleration takes. Reference:
// test_shell_obstacles.
TEST_F(ShellRows, ScordelisLoRoof) {
  for (const auto& [mesh, quoted] : {std::pair{Grid::regular, 0.9973}, {Grid::distorted, 0.9942}}) {
    grid({mesh}, [](double u, double v) {
      const double angle = 40.0 / 360.0 * tau * u;
      return Vec3(25 * std::sin(angle), 25 * v, 25 * std::cos(angle));
    });
    const fem::Structure free = structure(4.32e8, 0.0, 360, 0.25, "");
    Eigen::VectorXd up = Eigen::VectorXd::Zero(free.n());
    for (int k = 0; k < 17 * 17; ++k) up[free.dofs.row({k, 2})] = 1.0;
    const Eigen::VectorXd weight = free.M.selfadjointView<Eigen::Lower>() * up;
    std::vector<std::pair<fem::Dof, double>> forces;
    for (int row = 0; row < free.n(); ++row)
      forces.emplace_back(free.dofs.free[static_cast<std::size_t>(row)], -weight[row]);
    const fem::Structure s = structure(4.32e8, 0.0, 360, 0.25, "u0: [x, ry, rz], v0: [y, rx, rz], v1: [x, z]");
    const double u = -deflection(s, {16, 2}, forces);
    EXPECT_NEAR(u / fem::testing::scordelis_lo({mesh}), 1.0, 1e-7);
    EXPECT_LE(std::abs(u / 0.3006 - 1.0), std::abs(quoted - 1.0) + 0.002);
  }
}

TEST_F(ShellRows, TwistedBeam) {
  grid(96, 16, [](int i, int j) {
    const double angle = 0.25 * tau * i / 96, y = 1.1 * (j / 16.0 - 0.5);
    return Vec3(12.0 * i / 96, y * std::cos(angle), y * std::sin(angle));
  });
  const int tip = 8 * 97 + 96;
  const fem::Structure s = structure(29e6, 0.22, 1, 0.32, "u0: all");
  for (const auto& [direction, deflected, quoted] :
       {std::tuple{2, 5.424535e-3, 0.9971}, std::tuple{1, 1.753248e-3, 0.9973}})
    EXPECT_LE(std::abs(deflection(s, {tip, direction}, {{{tip, direction}, 1.0}}) / deflected - 1.0),
              std::abs(quoted - 1.0) + 0.002);
}
