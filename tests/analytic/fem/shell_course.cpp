#include "tests/analytic/fem/shell_course.hpp"

#include <fmt/format.h>

#include <Eigen/SparseCholesky>
#include <cmath>
#include <map>
#include <numbers>

#include "fem/shell_directors.hpp"

namespace tenon::fem::testing {
namespace {

constexpr double pi = std::numbers::pi;

/// Where node (i, j) of a grid lies in the unit square.
Eigen::Vector2d grid_point(Grid grid, int N, int i, int j) {
  if (grid == Grid::regular) return {double(i) / N, double(j) / N};
  if (grid == Grid::mirrored) {
    const Eigen::Vector2d p = grid_point(Grid::distorted, N, N - i, j);
    return {1.0 - p.x(), p.y()};
  }
  const auto divide = [N](int k) { return double(k * (k + 1)) / (N * (N + 1)); };
  const double bottom = divide(i), top = 1.0 - divide(N - i), left = divide(j), right = 1.0 - divide(N - j);
  const double u = (bottom + (top - bottom) * left) / (1.0 - (top - bottom) * (right - left));
  return {u, left + (right - left) * u};
}

/// Takes quadrilaterals to elements.
SmallAssembly assembled(std::vector<Vec3> nodes, const std::vector<std::array<int, 4>>& quads, Cells cells, double t,
                        const Material& material) {
  SmallAssembly a;
  a.nodes = std::move(nodes);
  const ShellSection section{.name = "s", .thickness = t};
  ElementMatrices e;
  Model model;
  model.nodes = a.nodes;
  if (cells == Cells::quads) {
    for (const auto& q : quads) model.elements.emplace_back(Quad4{.nodes = q});
    const std::vector<Vec3> directors = shell_directors(model);
    for (const auto& q : quads) {
      quad4_matrices({.nodes = q}, section, material, a.nodes, e, directors);
      a.add(q, e);
    }
    return a;
  }
  const std::size_t d = cells == Cells::diagonal_13 ? 0 : 1;
  for (const auto& q : quads) {
    model.elements.emplace_back(Tria3{.nodes = {q[d], q[d + 1], q[d + 2]}});
    model.elements.emplace_back(Tria3{.nodes = {q[d], q[d + 2], q[(d + 3) % 4]}});
  }
  const std::vector<Vec3> directors = shell_directors(model);
  for (const Element& element : model.elements) {
    const Tria3& tria = std::get<Tria3>(element);
    tria3_matrices(tria, section, material, a.nodes, e, directors);
    a.add(tria.nodes, e);
  }
  return a;
}

/// Cells of an n×m grid of nodes.
std::vector<std::array<int, 4>> grid_cells(int n, int m) {
  std::vector<std::array<int, 4>> quads;
  for (int j = 0; j < m; ++j)
    for (int i = 0; i < n; ++i) {
      const int k = j * (n + 1) + i;
      quads.push_back({k, k + 1, k + n + 2, k + n + 1});
    }
  return quads;
}

Eigen::VectorXd no_load(const SmallAssembly& a) {
  return Eigen::VectorXd::Zero(6 * static_cast<Eigen::Index>(a.nodes.size()));
}

/// Loads of a unit force per area along `direction`, consistent with the mass of density 1.
Eigen::VectorXd pressure(const SmallAssembly& a, double t, int direction) {
  Eigen::VectorXd along = no_load(a);
  for (Eigen::Index i = direction; i < along.size(); i += 6) along[i] = 1.0;
  Sparse M(along.size(), along.size());
  M.setFromTriplets(a.M.begin(), a.M.end());
  return M * along / t;
}

bool zero(double x) { return std::abs(x) < 1e-9; }

/// The plane normal to `axis` through the origin is one of symmetry: u along it and both rotations in it are held.
bool held_by_symmetry(const Vec3& x, int d, int axis) { return zero(x[axis]) && (d < 3 ? d == axis : d - 3 != axis); }

/// Poles of the hemispheres' quarter: symmetry planes x = 0, y = 0.
bool free_in_quarter(const Vec3& x, int d) { return !held_by_symmetry(x, d, 0) && !held_by_symmetry(x, d, 1); }

/// At s of the arc from a to b on the unit sphere.
Vec3 along_arc(const Vec3& a, const Vec3& b, double s) {
  const double angle = std::acos(a.dot(b));
  return (std::sin((1.0 - s) * angle) * a + std::sin(s * angle) * b) / std::sin(angle);
}

}  // namespace

std::string name(const Cover& c) {
  static constexpr std::array<const char*, 3> grids{"regular", "distorted", "mirrored"}, cells{"", "_13", "_24"};
  return fmt::format("{}{}", grids[static_cast<std::size_t>(c.grid)], cells[static_cast<std::size_t>(c.cells)]);
}

Material elastic(double E, double nu) { return {"m", E, E / (2 * (1 + nu)), nu, 1.0}; }

SmallAssembly cover(const Cover& c, double t, const Material& material, const Surface& at) {
  std::vector<Vec3> nodes;
  for (int j = 0; j <= c.N; ++j)
    for (int i = 0; i <= c.N; ++i) {
      const Eigen::Vector2d p = grid_point(c.grid, c.N, i, j);
      nodes.push_back(at(p.x(), p.y()));
    }
  return assembled(std::move(nodes), grid_cells(c.N, c.N), c.cells, t, material);
}

Eigen::VectorXd displacements(const SmallAssembly& a, const Free& free, const Eigen::VectorXd& load) {
  const System s = restrict_to(a, free);
  Eigen::VectorXd f(s.K.rows()), all = Eigen::VectorXd::Zero(load.size());
  for (std::size_t i = 0; i < s.index.size(); ++i)
    if (s.index[i] >= 0) f[s.index[i]] = load[static_cast<Eigen::Index>(i)];
  const Eigen::VectorXd u = Eigen::SimplicialLDLT<Sparse>(s.K).solve(f);
  for (std::size_t i = 0; i < s.index.size(); ++i)
    if (s.index[i] >= 0) all[static_cast<Eigen::Index>(i)] = u[s.index[i]];
  return all;
}

double pinched_cylinder(const Cover& c) {
  const SmallAssembly a = cover(c, 3.0, elastic(3e6, 0.3), [](double u, double v) {
    return Vec3(300 * std::sin(0.5 * pi * u), 300 * v, 300 * std::cos(0.5 * pi * u));
  });
  Eigen::VectorXd load = no_load(a);
  load[2] = -0.25;
  return -displacements(
      a,
      [](const Vec3& x, int d) {
        for (int axis = 0; axis < 3; ++axis)
          if (held_by_symmetry(x, d, axis)) return false;
        return !(zero(x.y() - 300) && (d == 0 || d == 2));
      },
      load)[2];
}

double scordelis_lo(const Cover& c) {
  const double t = 0.25;
  const SmallAssembly a = cover(c, t, elastic(4.32e8, 0.0), [](double u, double v) {
    const double angle = 40.0 / 180.0 * pi * u;
    return Vec3(25 * std::sin(angle), 25 * v, 25 * std::cos(angle));
  });
  return -displacements(
      a, [](const Vec3& x, int d) { return free_in_quarter(x, d) && !(zero(x.y() - 25) && (d == 0 || d == 2)); },
      -90.0 * pressure(a, t, 2))[6 * c.N + 2];
}

double hemisphere(const Cover& c, double t) {
  const SmallAssembly a = cover(c, t, elastic(6.825e7, 0.3), [](double u, double v) {
    const double around = 0.5 * pi * u, up = 0.4 * pi * v;
    return Vec3(10 * std::cos(up) * std::cos(around), 10 * std::cos(up) * std::sin(around), 10 * std::sin(up));
  });
  Eigen::VectorXd load = no_load(a);
  load[0] = 1.0;
  load[6 * c.N + 1] = -1.0;
  const auto free = [](const Vec3& x, int d) {
    return free_in_quarter(x, d) && !(d == 2 && zero(x.y()) && zero(x.z()));  // u_z at one node
  };
  return std::pow(t / 0.04, 3) * displacements(a, free, load)[0];
}

double full_hemisphere(const Cover& c, double t) {
  std::vector<Vec3> nodes;
  std::map<std::array<long, 3>, int> known;  // patches share the nodes of their sides
  const auto node = [&](Vec3 x) {
    for (int d = 0; d < 3; ++d)
      if (std::abs(x[d]) < 1e-12) x[d] = 0.0;
    const std::array<long, 3> key{std::lround(1e7 * x.x()), std::lround(1e7 * x.y()), std::lround(1e7 * x.z())};
    const auto [at, added] = known.emplace(key, static_cast<int>(nodes.size()));
    if (added) nodes.push_back(10.0 * x);
    return at->second;
  };
  const std::array<Vec3, 3> poles{Vec3::UnitX(), Vec3::UnitY(), Vec3::UnitZ()};
  const Vec3 centre = Vec3::Ones().normalized();
  std::vector<std::array<int, 4>> quads;
  for (std::size_t k = 0; k < 3; ++k) {
    const Vec3 &pole = poles[k], side = (pole + poles[(k + 1) % 3]).normalized(),
               other = (pole + poles[(k + 2) % 3]).normalized();
    const auto at = [&](int i, int j) {
      const double u = double(i) / c.N, v = double(j) / c.N;
      return node(along_arc(along_arc(pole, side, u), along_arc(other, centre, u), v));
    };
    for (int j = 0; j < c.N; ++j)
      for (int i = 0; i < c.N; ++i) quads.push_back({at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)});
  }
  const int x = node(poles[0]), y = node(poles[1]);
  const SmallAssembly a = assembled(std::move(nodes), quads, c.cells, t, elastic(6.825e7, 0.3));
  Eigen::VectorXd load = no_load(a);
  load[6 * x] = 1.0;
  load[6 * y + 1] = -1.0;
  const auto free = [](const Vec3& p, int d) {
    return free_in_quarter(p, d) && !(d == 2 && zero(p.x()) && zero(p.y()));
  };
  return std::pow(t / 0.04, 3) * displacements(a, free, load)[6 * x];
}

double twisted_beam(const Cover& c, double t, int direction) {
  const int along = 6 * c.N;
  std::vector<Vec3> nodes;
  for (int j = 0; j <= c.N; ++j)
    for (int i = 0; i <= along; ++i) {
      const double u = double(i) / along, angle = 0.5 * pi * u, y = 1.1 * (double(j) / c.N - 0.5);
      nodes.emplace_back(12 * u, y * std::cos(angle), y * std::sin(angle));
    }
  const SmallAssembly a = assembled(std::move(nodes), grid_cells(along, c.N), c.cells, t, elastic(29e6, 0.22));
  Eigen::VectorXd load = no_load(a);
  const int tip = 6 * (c.N / 2 * (along + 1) + along) + (direction == 0 ? 2 : 1);  // there the section stands along z
  load[tip] = 1.0;
  return displacements(
      a, [](const Vec3& x, int) { return x.x() > 1e-9; }, load)[tip];
}

double ring(const Cover& c, double t) {
  const SmallAssembly a = cover(c, t, elastic(1.0, 0.0), [](double u, double v) {
    return Vec3(std::cos(0.5 * pi * u), v, std::sin(0.5 * pi * u));
  });
  Eigen::VectorXd load = no_load(a);
  const auto y = [&](int j) { return a.nodes[static_cast<std::size_t>(j * (c.N + 1))].y(); };
  for (int j = 0; j < c.N; ++j)
    for (const int k : {j, j + 1}) load[6 * k * (c.N + 1)] += 0.5 * 0.5 * (y(j + 1) - y(j));
  const auto free = [](const Vec3& x, int d) {
    return !held_by_symmetry(x, d, 0) && !held_by_symmetry(x, d, 1) && !held_by_symmetry(x, d, 2);
  };
  return 2.0 * displacements(a, free, load)[0];
}

double clamped_plate(const Cover& c, double t, PlateLoad kind) {
  const SmallAssembly a =
      cover(c, t, elastic(1.0, 0.3), [](double u, double v) { return Vec3(0.5 * u, 0.5 * v, 0.0); });
  Eigen::VectorXd load = no_load(a);
  load[2] = 0.25;
  if (kind == PlateLoad::pressure) load = pressure(a, t, 2);
  const auto free = [](const Vec3& x, int d) {
    return d > 1 && d < 5 && !zero(x.x() - 0.5) && !zero(x.y() - 0.5) && free_in_quarter(x, d);
  };
  return t * t * t / (12 * 0.91) * displacements(a, free, load)[2];
}

double supported_plate(const Cover& c, double t) {
  const SmallAssembly a =
      cover(c, t, elastic(1.0, 0.3), [](double u, double v) { return Vec3(0.5 * u, 0.5 * v, 0.0); });
  Eigen::VectorXd load = no_load(a);
  load[2] = 0.25;
  const auto free = [](const Vec3& x, int d) {
    if (d < 2 || d > 4 || !free_in_quarter(x, d)) return false;
    const bool edge_x = zero(x.x() - 0.5), edge_y = zero(x.y() - 0.5);
    return d == 2 ? !edge_x && !edge_y : d == 3 ? !edge_x : !edge_y;
  };
  return t * t * t / (12 * 0.91) * displacements(a, free, load)[2];
}

double cooks_membrane(const Cover& c) {
  const SmallAssembly a = cover(c, 1.0, elastic(1.0, 1.0 / 3.0),
                                [](double u, double v) { return Vec3(48 * u, 44 * u + v * (44 - 28 * u), 0.0); });
  const auto side = [&c](int j) { return j * (c.N + 1) + c.N; };
  const auto y = [&](int j) { return a.nodes[static_cast<std::size_t>(side(j))].y(); };
  Eigen::VectorXd load = no_load(a);
  for (int j = 0; j < c.N; ++j)
    for (const int k : {j, j + 1}) load[6 * side(k) + 1] += 0.5 * (y(j + 1) - y(j)) / 16.0;
  const Eigen::VectorXd u = displacements(
      a, [](const Vec3& x, int d) { return (d < 2 || d == 5) && !zero(x.x()); }, load);
  int j = 0;
  while (y(j + 1) < 52.0 - 1e-9) ++j;
  const double s = (52.0 - y(j)) / (y(j + 1) - y(j));  // the middle may lie between two nodes
  return (1.0 - s) * u[6 * side(j) + 1] + s * u[6 * side(j + 1) + 1];
}

}  // namespace tenon::fem::testing
