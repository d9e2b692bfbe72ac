#include "fem/shell_directors.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <numbers>

#include "tests/unit/fem/elements/small_assembly.hpp"

using namespace tenon;
using namespace tenon::fem;

namespace {

using Surface = std::function<Vec3(double, double)>;

/// n×m cells over (u, v) in the unit square, each cut in two.
Model triangles(int n, int m, const Surface& at) {
  Model model;
  for (int j = 0; j <= m; ++j)
    for (int i = 0; i <= n; ++i) model.nodes.push_back(at(double(i) / n, double(j) / m));
  for (int j = 0; j < m; ++j)
    for (int i = 0; i < n; ++i) {
      const int k = j * (n + 1) + i;
      model.elements.emplace_back(Tria3{.nodes = {k, k + 1, k + n + 2}});
      model.elements.emplace_back(Tria3{.nodes = {k, k + n + 2, k + n + 1}});
    }
  return model;
}

/// A part of the unit sphere, its edges included; distances between nodes vary.
Vec3 sphere(double u, double v) {
  const double around = 0.3 + 0.8 * u + 0.1 * u * v, up = 0.2 + 0.7 * v + 0.1 * v * v;
  return {std::cos(up) * std::cos(around), std::cos(up) * std::sin(around), std::sin(up)};
}

/// The same cells, not cut.
Model quads(int n, int m, const Surface& at) {
  Model model = triangles(n, m, at);
  model.elements.clear();
  for (int j = 0; j < m; ++j)
    for (int i = 0; i < n; ++i) {
      const int k = j * (n + 1) + i;
      model.elements.emplace_back(Quad4{.nodes = {k, k + 1, k + n + 2, k + n + 1}});
    }
  return model;
}

enum class Cells { quads, triangles };

std::span<const int> nodes_of(const Element& element) {
  if (const auto* quad = std::get_if<Quad4>(&element)) return quad->nodes;
  return std::get<Tria3>(element).nodes;
}

/// Largest angle between directors and the sphere's normals, inside and on the edge.
std::pair<double, double> angles(int n) {
  const Model model = triangles(n, n, sphere);
  const std::vector<Vec3> directors = shell_directors(model);
  double inside = 0.0, edge = 0.0;
  for (int j = 0; j <= n; ++j)
    for (int i = 0; i <= n; ++i) {
      const auto k = static_cast<std::size_t>(j * (n + 1) + i);
      const double angle = directors[k].cross(model.nodes[k]).norm();
      double& worst = i == 0 || j == 0 || i == n || j == n ? edge : inside;
      worst = std::max(worst, angle);
    }
  return {inside, edge};
}

}  // namespace

TEST(ShellDirectors, AreTheNormalsOfASphere) {
  const auto [inside_8, edge_8] = angles(8);
  const auto [inside_16, edge_16] = angles(16);
  EXPECT_LT(inside_16, 1e-3);
  EXPECT_LT(edge_16, 3e-3);
  EXPECT_GT(std::log2(inside_8 / inside_16), 1.8);
  EXPECT_GT(std::log2(edge_8 / edge_16), 1.8);
}

// A quadric is fitted exactly, at edges and corners too.
TEST(ShellDirectors, AreExactOnAQuadric) {
  const Model model = triangles(5, 4, [](double u, double v) {
    const double x = u - 0.3 + 0.1 * v, y = 0.8 * v - 0.2;
    return Vec3(x, y, 0.2 * x * x - 0.1 * x * y + 0.15 * y * y);
  });
  const std::vector<Vec3> directors = shell_directors(model);
  // the quadric's axis is z, the fitted one the mean normal: equal to the square of the slope
  for (std::size_t i = 0; i < directors.size(); ++i) {
    const double x = model.nodes[i].x(), y = model.nodes[i].y();
    const Vec3 exact = Vec3(-0.4 * x + 0.1 * y, 0.1 * x - 0.3 * y, 1.0).normalized();
    EXPECT_LT((directors[i] - exact).norm(), 4e-3) << i;
  }
}

TEST(ShellDirectors, OfFlatShellsAreTheirNormal) {
  const Model model = triangles(3, 1, [](double u, double v) { return Vec3(u, 0.3 * v, 0.0); });
  for (const Vec3& n : shell_directors(model)) EXPECT_LT((n - Vec3::UnitZ()).norm(), 1e-14);
}

TEST(ShellDirectors, EndAtCreases) {
  // a right angle along v, at u = 1/2
  const Model model =
      triangles(4, 2, [](double u, double v) { return u < 0.5 ? Vec3(u, v, 0.0) : Vec3(0.5, v, u - 0.5); });
  const std::vector<Vec3> directors = shell_directors(model);
  for (std::size_t k = 0; k < directors.size(); ++k) {
    const std::size_t i = k % 5;
    const Vec3 expected = i == 2 ? Vec3(Vec3::Zero()) : i < 2 ? Vec3(Vec3::UnitZ()) : Vec3(-Vec3::UnitX());
    EXPECT_LT((directors[k] - expected).norm(), 1e-14) << k;
  }
}

TEST(ShellDirectors, DoNotDependOnTheSenseOfElements) {
  Model model = triangles(6, 6, sphere);
  const std::vector<Vec3> before = shell_directors(model);
  for (std::size_t e = 0; e < model.elements.size(); e += 3) {
    auto& nodes = std::get<Tria3>(model.elements[e]).nodes;
    std::swap(nodes[1], nodes[2]);
  }
  const std::vector<Vec3> after = shell_directors(model);
  for (std::size_t i = 0; i < after.size(); ++i) EXPECT_LT(before[i].cross(after[i]).norm(), 1e-12);
}

TEST(ShellDirectors, AreForShells) {
  Model model;
  model.nodes = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}, {2, 2, 2}};
  model.elements.emplace_back(Beam{.nodes = {0, 4}});
  EXPECT_TRUE(shell_directors(model).empty());
  model.elements.emplace_back(Quad4{.nodes = {0, 1, 2, 3}});
  const std::vector<Vec3> directors = shell_directors(model);
  EXPECT_LT((directors.at(0) - Vec3::UnitZ()).norm(), 1e-14);
  EXPECT_TRUE(directors.at(4).isZero(0.0));  // no shell there
}

/// A tube of R = 1, its cells skew, in its second inextensional mode: u_r = cos 2φ, u_φ = −½ sin 2φ, turned by
/// (3/2) sin 2φ about its axis; curvature −3 cos 2φ.
struct BentTube {
  static constexpr double length = 0.6;
  double t;
  const Material material{"m", 1.0, 0.5, 0.0, 1.0};
  ShellSection section;
  Model model;
  std::vector<Vec3> directors;

  // quads that do not resolve √(R t) are flat: thick enough that they do
  BentTube(int n, Cells cells) : t(cells == Cells::quads ? 0.05 : 1e-4), section{.name = "s", .thickness = t} {
    model = (cells == Cells::quads ? quads : triangles)(n, 4, [n](double u, double v) {
      const double phi = 2.0 * std::numbers::pi * (u + 0.25 / n * v);
      return Vec3(std::cos(phi), std::sin(phi), length * v);
    });
    directors = shell_directors(model);
    for (int j = 0; j <= 4; ++j)  // the seam is open; both sides of it get the tube's own normals
      for (const int i : {0, 1, n - 1, n}) {
        const auto k = static_cast<std::size_t>(j * (n + 1) + i);
        directors[k] = Vec3(model.nodes[k].x(), model.nodes[k].y(), 0.0);
      }
  }

  Eigen::VectorXd displacements(const Element& element) const {
    const std::span<const int> nodes = nodes_of(element);
    Eigen::VectorXd u(6 * static_cast<Eigen::Index>(nodes.size()));
    for (Eigen::Index i = 0; 6 * i < u.size(); ++i) {
      const Vec3& x = model.nodes[static_cast<std::size_t>(nodes[static_cast<std::size_t>(i)])];
      const double phi = std::atan2(x.y(), x.x()), c = std::cos(phi), s = std::sin(phi);
      const double radial = std::cos(2 * phi), hoop = -0.5 * std::sin(2 * phi), turn = 1.5 * std::sin(2 * phi);
      u.segment<6>(6 * i) << radial * c - hoop * s, radial * s + hoop * c, 0, 0, 0, turn;
    }
    return u;
  }
};

// Energy ½ D ∫ κ² (ν = 0): bending alone takes part. What the next terms of (2)–(4) in tria3.cpp leave, h⁴ in the
// strain and h⁸ in its energy, is 3 % of it with 64 triangles around; without directors the membrane takes hundreds of
// times as much. Quads, which are thicker here: the energy of the membrane alone.
TEST(ShellDirectors, InextensionalBendingStrainsNoMembrane) {
  const auto ratio = [&](Cells cells, int n, bool curved, double bending, bool plies = false) {
    BentTube tube(n, cells);
    tube.section.bending_ratio = bending;
    if (plies)  // E = 1 below, 2 above: B ≠ 0, and D is 3/2 of that of E = 1
      tube.section.plies = {{.thickness = 0.5 * tube.t, .E1 = 1.0, .E2 = 1.0, .G12 = 0.5},
                            {.thickness = 0.5 * tube.t, .E1 = 2.0, .E2 = 2.0, .G12 = 1.0}};
    const std::span<const Vec3> directors = curved ? std::span<const Vec3>(tube.directors) : std::span<const Vec3>();
    double energy = 0.0;
    ElementMatrices e;
    for (const Element& element : tube.model.elements) {
      if (const auto* quad = std::get_if<Quad4>(&element))
        quad4_matrices(*quad, tube.section, tube.material, tube.model.nodes, e, directors);
      else
        tria3_matrices(std::get<Tria3>(element), tube.section, tube.material, tube.model.nodes, e, directors);
      const Eigen::VectorXd u = tube.displacements(element);
      energy += 0.5 * u.dot(e.K * u);
    }
    return energy / (0.5 * std::pow(tube.t, 3) / 12.0 * 9.0 * std::numbers::pi * tube.length);
  };
  EXPECT_NEAR(ratio(Cells::triangles, 64, true, 1.0), 1.0, 0.04);
  EXPECT_GT(ratio(Cells::triangles, 64, false, 1.0), 100.0);
  EXPECT_LT(ratio(Cells::quads, 64, true, 1e-9), 0.02 * ratio(Cells::quads, 64, false, 1e-9));
  for (const Cells cells : {Cells::quads, Cells::triangles}) {
    EXPECT_NEAR(ratio(cells, 128, true, 1.0), 1.0, 0.005);
    EXPECT_NEAR(ratio(cells, 128, true, 1.0, true), 1.5, 0.0075);
  }
}

// Nor does it leave stress for the geometric stiffness: what remains falls with h⁴, without directors with h².
TEST(ShellDirectors, InextensionalBendingLeavesNoStress) {
  const auto largest = [&](Cells cells, int n, bool curved) {
    const BentTube tube(n, cells);
    const std::span<const Vec3> directors = curved ? std::span<const Vec3>(tube.directors) : std::span<const Vec3>();
    double worst = 0.0;
    ElementMatrices::Matrix K;
    for (const Element& element : tube.model.elements) {
      const Eigen::VectorXd u = tube.displacements(element);
      if (const auto* quad = std::get_if<Quad4>(&element))
        quad4_geometric_stiffness(*quad, tube.section, tube.material, tube.model.nodes, u, K, directors);
      else
        tria3_geometric_stiffness(std::get<Tria3>(element), tube.section, tube.material, tube.model.nodes, u, K,
                                  directors);
      for (Eigen::Index i = 0; i < u.size(); i += 6) worst = std::max(worst, K.block<3, 3>(i, i).cwiseAbs().maxCoeff());
    }
    return worst;
  };
  for (const Cells cells : {Cells::quads, Cells::triangles}) {
    EXPECT_LT(largest(cells, 64, true), 0.1 * largest(cells, 64, false));
    EXPECT_GT(std::log2(largest(cells, 64, true) / largest(cells, 128, true)),
              std::log2(largest(cells, 64, false) / largest(cells, 128, false)) + 1.0);
  }
}

// A cylinder of R = 1, y around it, bent along its axis without hoop strain or shear: w = x²/2, v = −x² φ/2, u = x φ²/2
// have ε_x = φ²/2 alone, a parabola over the quad whose mean is α²/6 for |φ| < α and not the edges' α²/2. K_σ shows it:
// xᵀ K_σ x = ∫ N_x over the corners' x. Errors are of the order α².
TEST(ShellDirectors, ABentCylinderStrainsInParabolas) {
  const double alpha = 0.03, b = 0.05, t = 0.05;
  const ShellSection section{.name = "s", .thickness = t};
  const Material material{"m", 1.0, 0.5, 0.0, 1.0};
  for (const double skew : {0.0, 0.4}) {
    std::vector<Vec3> nodes, normals;
    Eigen::VectorXd u(24);
    Eigen::Index row = 0;
    for (const auto& [r, s] : {std::pair{-1.0, -1.0}, {1.0, -1.0}, {1.0, 1.0}, {-1.0, 1.0}}) {
      const double x = b * (r + skew * s), phi = alpha * (s + skew * r), c = std::cos(phi), d = std::sin(phi);
      nodes.emplace_back(x, d, c);
      normals.emplace_back(0.0, d, c);
      const double w = 0.5 * x * x, v = -0.5 * x * x * phi;
      // θ = n × β: β_x = −w,x, β_φ = v − w,φ; about the normal ½(v,x − u,φ) = v,x
      const double beta_x = -x, beta_phi = v, spin = -x * phi;
      const Vec3 hoop(0.0, c, -d), normal(0.0, d, c);
      u.segment<3>(row) = Vec3(0.5 * x * phi * phi, 0.0, 0.0) + v * hoop + w * normal;
      u.segment<3>(row + 3) = beta_x * normal.cross(Vec3::UnitX()) + beta_phi * normal.cross(hoop) + spin * normal;
      row += 6;
    }
    const double mean = alpha * alpha * (1.0 + skew * skew) / 6.0;  // of φ²/2 over r, s
    ElementMatrices::Matrix K;
    quad4_geometric_stiffness({.nodes = {0, 1, 2, 3}}, section, material, nodes, u, K, normals);
    double N_x = 0.0;
    for (int i = 0; i < 4; ++i)
      for (int j = 0; j < 4; ++j)
        N_x += K(6 * i, 6 * j) * nodes[static_cast<std::size_t>(i)].x() * nodes[static_cast<std::size_t>(j)].x();
    const double area = 4.0 * b * alpha * (1.0 - skew * skew);
    EXPECT_NEAR(N_x / (t * area * mean), 1.0, 0.01) << skew;
  }
}

// Rigid motions stay free of stress on curved cells, and nothing else does.
TEST(ShellDirectors, LeaveSixZeroModes) {
  for (const Model& model : {quads(1, 1, sphere), triangles(1, 1, sphere)}) {
    const std::vector<Vec3>& normals = model.nodes;  // those of the sphere
    ElementMatrices e;
    for (const Element& element : model.elements)
      for (const double t : {0.3, 1e-2, 2e-2}) {
        ShellSection section{.name = "s", .thickness = t};
        if (t == 2e-2)  // unsymmetric
          section.plies = {{.thickness = 0.5 * t, .angle = 0.4, .E1 = 25.0, .E2 = 1.0, .nu12 = 0.25, .G12 = 0.5},
                           {.thickness = 0.5 * t, .angle = 1.3, .E1 = 25.0, .E2 = 1.0, .nu12 = 0.25, .G12 = 0.5}};
        const Material material{"m", 1.0, 0.4, 0.25, 1.0};
        if (const auto* quad = std::get_if<Quad4>(&element))
          quad4_matrices(*quad, section, material, model.nodes, e, normals);
        else
          tria3_matrices(std::get<Tria3>(element), section, material, model.nodes, e, normals);
        std::vector<Vec3> corners;
        for (const int i : nodes_of(element)) corners.push_back(model.nodes[static_cast<std::size_t>(i)]);
        EXPECT_LT((e.K * fem::testing::rigid_motions(corners)).cwiseAbs().maxCoeff(),
                  1e-12 * e.K.cwiseAbs().maxCoeff());
        EXPECT_EQ(fem::testing::zero_modes(e.K, 1.0, 1e-10), 6);
      }
  }
}
