#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>
#include <cmath>
#include <functional>
#include <iostream>
#include <numbers>

#include "fem/structure.hpp"

using namespace tenon::fem;

namespace {

constexpr double pi = std::numbers::pi;

using Keep = std::function<bool(const Vec3&, int)>;  // position, direction

struct Loaded {
  Model model;
  Structure structure;
  Eigen::MatrixXd K;  // both triangles
};

Loaded loaded(Model model) {
  Loaded l{std::move(model), {}, {}};
  l.structure = assemble(l.model);
  l.K = Eigen::MatrixXd(l.structure.K).selfadjointView<Eigen::Lower>();
  return l;
}

std::vector<int> rows(const Loaded& l, const Keep& keep) {
  std::vector<int> kept;
  for (int row = 0; row < l.structure.n(); ++row) {
    const Dof& dof = l.structure.dofs.free[static_cast<std::size_t>(row)];
    if (keep(l.structure.nodes[static_cast<std::size_t>(dof.node)], dof.direction)) kept.push_back(row);
  }
  return kept;
}

Eigen::MatrixXd stress_stiffness(const Loaded& l, const Eigen::VectorXd& u) {
  return Eigen::MatrixXd(geometric_stiffness(l.model, l.structure, u)).selfadjointView<Eigen::Lower>();
}

// least λ > 0 with K + λ K_σ singular over the kept rows
double buckling_load(const Loaded& l, const Eigen::VectorXd& u, const Keep& keep) {
  const std::vector<int> kept = rows(l, keep);
  const Eigen::MatrixXd K = l.K(kept, kept), K_sigma = stress_stiffness(l, u)(kept, kept);
  const Eigen::GeneralizedSelfAdjointEigenSolver<Eigen::MatrixXd> e(-K_sigma, K, Eigen::EigenvaluesOnly);
  return 1.0 / e.eigenvalues().maxCoeff();
}

// displacement from a field, u(x) and no rotation
Eigen::VectorXd field(const Loaded& l, const std::function<Vec3(const Vec3&)>& u) {
  Eigen::VectorXd values = Eigen::VectorXd::Zero(l.structure.n());
  for (int row = 0; row < l.structure.n(); ++row) {
    const Dof& dof = l.structure.dofs.free[static_cast<std::size_t>(row)];
    if (dof.direction < 3) values[row] = u(l.structure.nodes[static_cast<std::size_t>(dof.node)])[dof.direction];
  }
  return values;
}

struct Column {
  int elements = 8;
  double kappa = 0.0;
  Vec3 offset = Vec3::Zero();
};

constexpr double length = 2.0;
const Vec3 along = Vec3(2.0, -1.0, 0.5).normalized();
const Material steel{.name = "steel", .E = 2e11, .G = 8e10, .nu = 0.25, .rho = 7800.0};
const BeamSection bar{.name = "bar", .A = 4e-4, .Iy = 3e-8, .Iz = 7e-8, .Iyz = 1e-8, .J = 5e-8};
// the softer principal axis of [7 1; 1 3]e-8
const double weak = 1e-8 * (5.0 - std::sqrt(5.0));

// askew in space, clamped at node 0; its axis runs beside the nodes by `offset`
Loaded column(const Column& c) {
  Model model;
  model.materials = {steel};
  model.beam_sections = {bar};
  model.beam_sections[0].kappa_y = model.beam_sections[0].kappa_z = c.kappa;
  for (int k = 0; k <= c.elements; ++k) {
    model.nodes.push_back(length * k / c.elements * along);
    model.node_ids.push_back(k + 1);
  }
  for (int k = 0; k < c.elements; ++k)
    model.elements.emplace_back(
        Beam{.nodes = {k, k + 1}, .orientation = Vec3(0.3, 1.0, 0.2), .offsets = {c.offset, c.offset}, .id = k + 1});
  return loaded(std::move(model));
}

double critical(const Column& c) {
  const Loaded l = column(c);
  const Keep held = [](const Vec3& p, int) { return p.norm() > 1e-9; };
  // unit compression along the axis: its displacement is −x/EA exactly, without rotation
  return buckling_load(l, field(l, [](const Vec3& p) { return Vec3(-p / (steel.E * bar.A)); }), held);
}

// What order p leaves of the difference that halving h makes, 1/(2^p − 1) of it (Richardson), a quarter more for the
// terms after the first.
double left_by(int order, double coarse, double fine) {
  return 1.25 * std::abs(coarse - fine) / (std::exp2(order) - 1.0);
}

void report(const char* what, double coarse, double fine) {
  std::cout << what << ": errors " << coarse << ", " << fine << " with half the size\n";
}

const double euler = pi * pi * steel.E * weak / (4.0 * length * length);

}  // namespace

TEST(Buckling, OfACantileverColumn) {
  // P = π²EI/4L² about the softer principal axis; Hermite shapes err by (kh)⁴/720, k = π/2L
  double last = 0.0;
  for (const int elements : {2, 4}) {
    const double kh = pi / (2.0 * elements), error = critical({.elements = elements}) / euler - 1.0;
    EXPECT_GT(error, 0.0);
    EXPECT_LT(error, kh * kh * kh * kh / 500.0);
    if (last > 0.0) {
      EXPECT_NEAR(last / error, 16.0, 1.0);
    }
    last = error;
  }
}

TEST(Buckling, OfAColumnBesideItsNodesIsTheSame) {
  const Vec3 across = along.cross(Vec3::UnitZ()).normalized();
  EXPECT_NEAR(critical({.elements = 4, .offset = 0.1 * across}) / critical({.elements = 4}), 1.0, 1e-9);
}

TEST(Buckling, OfAColumnThatShearsIsEngessers) {
  // v' − s = P v'/κGA and B s'' + P v' = 0: P = P_E / (1 + P_E/κGA), here with the P_E/κGA = 0.5
  const double kappa = euler / (0.5 * steel.G * bar.A);
  const double coarse = critical({.elements = 20, .kappa = kappa}) / (euler / 1.5) - 1.0,
               fine = critical({.elements = 40, .kappa = kappa}) / (euler / 1.5) - 1.0;
  report("column that shears", coarse, fine);
  EXPECT_LT(std::abs(fine), left_by(2, coarse, fine));  // the shapes have a shear strain of their own
}

namespace {

enum class Cells { quads, triangles };

// a×b in a plane turned in space would hide which direction is which: x-y plane, nx×ny cells
Model panel_model(double a, double b, int nx, int ny, double t, double nu, Cells cells, double distortion = 0.0) {
  Model model;
  model.materials = {{.name = "unit", .E = 1.0, .G = 0.5 / (1.0 + nu), .nu = nu, .rho = 1.0}};
  model.shell_sections = {{.name = "plate", .thickness = t}};
  for (int j = 0; j <= ny; ++j)
    for (int i = 0; i <= nx; ++i) {
      const bool inner = i > 0 && i < nx && j > 0 && j < ny;
      const double off = inner ? distortion : 0.0;
      model.nodes.emplace_back(a * (i + off * ((7 * i + 13 * j) % 5 - 2)) / nx,
                               b * (j + off * ((11 * i + 3 * j) % 5 - 2)) / ny, 0.0);
      model.node_ids.push_back(static_cast<long>(model.nodes.size()));
    }
  for (int j = 0; j < ny; ++j)
    for (int i = 0; i < nx; ++i) {
      const int k = j * (nx + 1) + i;
      const std::array<int, 4> q{k, k + 1, k + nx + 2, k + nx + 1};
      if (cells == Cells::quads) {
        model.elements.emplace_back(Quad4{.nodes = q, .id = k + 1});
      } else {
        model.elements.emplace_back(Tria3{.nodes = {q[0], q[1], q[2]}, .id = 2 * k + 1});
        model.elements.emplace_back(Tria3{.nodes = {q[0], q[2], q[3]}, .id = 2 * k + 2});
      }
    }
  return model;
}

Loaded panel(double a, double b, int nx, int ny, double t, double nu, Cells cells, double distortion = 0.0) {
  return loaded(panel_model(a, b, nx, ny, t, nu, cells, distortion));
}

// the middle surface lies `offset` above the nodes
Model off_its_nodes(Model model, double offset) {
  for (Element& element : model.elements) {
    if (auto* quad = std::get_if<Quad4>(&element)) quad->offset = offset;
    if (auto* tria = std::get_if<Tria3>(&element)) tria->offset = offset;
  }
  return model;
}

// k of N = k π² D / b² of a simply supported unit square under N_x = −1, N_y = −biaxial
double plate_factor(Cells cells, int n, double biaxial, double distortion = 0.0) {
  const double t = 1e-3, nu = 0.3, D = t * t * t / (12.0 * (1.0 - nu * nu));
  const Loaded l = panel(1.0, 1.0, n, n, t, nu, cells, distortion);
  const Eigen::VectorXd u = field(
      l, [&](const Vec3& p) { return Vec3(-(1.0 - nu * biaxial) * p.x() / t, -(biaxial - nu) * p.y() / t, 0.0); });
  const double N = buckling_load(l, u, [](const Vec3& p, int d) {
    if (d < 2 || d > 4) return false;
    const bool x = p.x() < 1e-9 || p.x() > 1 - 1e-9, y = p.y() < 1e-9 || p.y() > 1 - 1e-9;
    return d == 2 ? !x && !y : d == 3 ? !x : !y;
  });
  return N / (pi * pi * D);
}

}  // namespace

TEST(Buckling, OfASimplySupportedPlate) {
  // (m² + n²)²/(m² + β n²): 4 in one direction, 2 in both; linked deflections err by O(h⁴) in rectangles
  for (const double biaxial : {0.0, 1.0}) {
    const double exact = biaxial == 0.0 ? 4.0 : 2.0, coarse = plate_factor(Cells::quads, 4, biaxial) - exact,
                 fine = plate_factor(Cells::quads, 8, biaxial) - exact;
    report("plate of quads", coarse, fine);
    EXPECT_LT(std::abs(fine), left_by(4, coarse, fine)) << biaxial;
  }
  // distorted cells: O(h²), below the (kh)²/12 of bilinear shapes
  EXPECT_NEAR(plate_factor(Cells::quads, 8, 0.0, 0.1) / 4.0, 1.0, pi * pi / (64.0 * 12.0));
}

TEST(Buckling, OfASimplySupportedPlateOfTriangles) {
  const double coarse = plate_factor(Cells::triangles, 6, 0.0) - 4.0,
               fine = plate_factor(Cells::triangles, 12, 0.0) - 4.0;
  report("plate of triangles", coarse, fine);
  EXPECT_LT(std::abs(fine), left_by(2, coarse, fine));  // O(h²), from six cells a half-wave on
}

TEST(Buckling, OfAStripInItsPlane) {
  // a cantilever strip b = L/50 wide, ν = 0, pressed along its length, may bend in its plane: π² E t b³/48L². Its shear
  // flexibility takes P/κGA < 1e-3 off; linear v over h = L/20 adds (kh)²/12 to the slopes' square
  const double L = 1.0, b = 0.02, t = 0.05;
  for (const Cells cells : {Cells::quads, Cells::triangles}) {
    const Loaded l = panel(L, b, 20, 1, t, 0.0, cells);
    const Eigen::VectorXd u = field(l, [&](const Vec3& p) { return Vec3(-p.x() / (t * b), 0.0, 0.0); });
    const double P =
        buckling_load(l, u, [](const Vec3& p, int d) { return p.x() > 1e-9 && (d == 0 || d == 1 || d == 5); });
    EXPECT_NEAR(P / (pi * pi * t * b * b * b / (48.0 * L * L)), 1.0, 2e-3);
  }
}

TEST(GeometricStiffness, TurnsTheNodeForcesWithARigidRotation) {
  // K_σ (φ × x) = φ × F where F = K u are the forces of a uniform stress
  const double nu = 0.3;
  const auto turned = [&](const Loaded& l, const Eigen::VectorXd& u) {
    const Eigen::VectorXd F = l.K * u, phi = Vec3(0.3, -0.5, 0.7);
    const Eigen::VectorXd G = stress_stiffness(l, u) * rigid_motions(l.structure, Vec3::Zero()).rightCols<3>() * phi;
    double error = 0.0;
    for (std::size_t node = 0; node < l.structure.nodes.size(); ++node) {
      Vec3 force, change;
      for (int d = 0; d < 3; ++d) {
        force[d] = F[l.structure.dofs.row({static_cast<int>(node), d})];
        change[d] = G[l.structure.dofs.row({static_cast<int>(node), d})];
      }
      error = std::max(error, (change - Vec3(phi).cross(force)).norm());
    }
    return error / F.norm();
  };
  const Loaded beam = column({});
  EXPECT_LT(turned(beam, field(beam, [](const Vec3& p) { return p; })), 1e-12);
  for (const Cells cells : {Cells::quads, Cells::triangles}) {
    const Loaded plate = panel(1.0, 0.7, 4, 3, 0.1, nu, cells, 0.1);
    EXPECT_LT(turned(plate, field(plate,
                                  [](const Vec3& p) {
                                    return Vec3(0.4 * p.x() + 0.3 * p.y(), 0.3 * p.x() - 0.2 * p.y(), 0.0);
                                  })),
              1e-12);
  }
}

namespace {

// Nodes and directions of a plate simply supported at its edges and free in its plane, but for one corner.
bool supported_square(const Vec3& p, int d) {
  const bool x = p.x() < 1e-9 || p.x() > 1 - 1e-9, y = p.y() < 1e-9 || p.y() > 1 - 1e-9;
  if (d < 2) return p.norm() > 1e-9;
  return d == 2 ? !x && !y : d == 3 ? !x : d == 4 ? !y : false;
}

// N L²/D of a strip of length L that is pressed through its own plane and hinged beside it, at distance e, by hinges
// that do not give way: the chord stretches by e times the difference of the end rotations, so each end of a symmetric
// mode feels a rotational spring k = 2 E t e²/L, and  tan x = −D (2x/L)/k = −(t/e)² x/12,  N = D (2x/L)².
double hinged_beside(double e_by_t) {
  double low = 0.5 * pi, high = pi;
  for (int k = 0; k < 60; ++k) {
    const double x = 0.5 * (low + high);
    (std::sin(x) + x / (12.0 * e_by_t * e_by_t) * std::cos(x) > 0.0 ? low : high) = x;
  }
  return 4.0 * low * low;
}

// ν = 0, rigid in shear; as one ply off its nodes, or with an empty ply of the same thickness below it: e = t/2
enum class Hinges { offset, empty_ply };

double strip_factor(Cells cells, int n, Hinges hinges) {
  const double t = 1e-4, b = 1.0 / n;  // so thin that the stretch before, N/EA ~ 2 t², does not show
  Model model = panel_model(1.0, b, n, 1, t, 0.0, cells);
  model.shell_sections[0].shear_ratio = 0.0;
  const Ply ply{.thickness = t, .E1 = 1.0, .E2 = 1.0, .G12 = 0.5},
      empty{.thickness = t, .E1 = 1e-10, .E2 = 1e-10, .G12 = 5e-11};
  if (hinges == Hinges::empty_ply)
    model.shell_sections[0].plies = {empty, ply};
  else
    model = off_its_nodes(std::move(model), 0.5 * t);
  const Loaded l = loaded(std::move(model));
  const Eigen::VectorXd u = field(l, [&](const Vec3& p) { return Vec3(-p.x() / t, 0.0, 0.0); });
  const double N = buckling_load(l, u, [](const Vec3& p, int d) {
    const bool end = p.x() < 1e-9 || p.x() > 1 - 1e-9;
    return d == 4 || (!end && (d == 0 || d == 2));
  });
  return N / (t * t * t / 12.0);
}

}  // namespace

TEST(Buckling, OfAPlateBesideItsNodesIsTheSame) {
  // one edge of the plane is as good as another where the edges may move in it
  const double t = 0.01, nu = 0.3;
  for (const Cells cells : {Cells::quads, Cells::triangles}) {
    const auto load = [&](double offset) {
      const Loaded l = loaded(off_its_nodes(panel_model(1.0, 1.0, 6, 6, t, nu, cells, 0.1), offset));
      return buckling_load(l, field(l, [&](const Vec3& p) { return Vec3(-p.x() / t, nu * p.y() / t, 0.0); }),
                           supported_square);
    };
    EXPECT_NEAR(load(0.03) / load(0.0), 1.0, 1e-8);
  }
}

TEST(Buckling, OfAStripHingedBesideItsPlane) {
  const double exact = hinged_beside(0.5);  // 24.1, π² hinged in its plane, 4π² clamped
  for (const Hinges hinges : {Hinges::offset, Hinges::empty_ply})
    for (const Cells cells : {Cells::quads, Cells::triangles}) {
      const double coarse = strip_factor(cells, 8, hinges) / exact - 1.0,
                   fine = strip_factor(cells, 16, hinges) / exact - 1.0;
      report("strip hinged beside its plane", coarse, fine);
      EXPECT_LT(std::abs(fine), left_by(cells == Cells::quads ? 4 : 2, coarse, fine));
    }
}

TEST(GeometricStiffness, TakesTheMembraneForcesOfBending) {
  // bent to constant curvatures, a surface off its nodes or a laminate with B ≠ 0 has the constant N = A (ε + e κ) + B
  // κ; node forces in the plane turn, K_σ (φ × x) = φ × F. Those across it come from the twisting moment, which has no
  // part.
  const Vec3 phi(0.3, -0.5, 0.7), kappa(0.4, -0.7, 0.5);
  const auto ply = [](double angle) {
    return Ply{
        .thickness = 0.03, .angle = angle, .E1 = 25.0, .E2 = 1.0, .nu12 = 0.25, .G12 = 0.5, .G13 = 0.5, .G23 = 0.2};
  };
  for (const bool laminate : {false, true})
    for (const double offset : {0.0, 0.05})
      for (const Cells cells : {Cells::quads, Cells::triangles}) {
        if (!laminate && offset == 0.0) continue;
        Model model = off_its_nodes(panel_model(1.0, 0.7, 4, 3, 0.1, 0.3, cells, 0.1), offset);
        if (laminate) model.shell_sections[0].plies = {ply(0.0), ply(0.5), ply(1.3)};
        for (Element& element : model.elements) {
          if (auto* quad = std::get_if<Quad4>(&element)) quad->material_axis = Vec3::UnitX();
          if (auto* tria = std::get_if<Tria3>(&element)) tria->material_axis = Vec3::UnitX();
        }
        const Loaded l = loaded(std::move(model));
        Eigen::VectorXd u(l.structure.n());
        for (int row = 0; row < l.structure.n(); ++row) {
          const Dof& dof = l.structure.dofs.free[static_cast<std::size_t>(row)];
          const Vec3& p = l.structure.nodes[static_cast<std::size_t>(dof.node)];
          const double beta_x = kappa[0] * p.x() + 0.5 * kappa[2] * p.y(),
                       beta_y = kappa[1] * p.y() + 0.5 * kappa[2] * p.x();
          const Vec6 bent =
              (Vec6() << 0.02 * p.x(), 0.01 * p.y(), -0.5 * (beta_x * p.x() + beta_y * p.y()), -beta_y, beta_x, 0.0)
                  .finished();
          u[row] = bent[dof.direction];
        }
        const Eigen::VectorXd F = l.K * u;
        const Eigen::VectorXd G =
            stress_stiffness(l, u) * rigid_motions(l.structure, Vec3::Zero()).rightCols<3>() * phi;
        double error = 0.0, largest = 0.0;
        for (int node = 0; node < static_cast<int>(l.structure.nodes.size()); ++node) {
          const auto at = [&](const Eigen::VectorXd& of, int d) { return of[l.structure.dofs.row({node, d})]; };
          const Vec3 force(at(F, 0), at(F, 1), 0.0), change(at(G, 0), at(G, 1), at(G, 2));
          error = std::max(error, (change - phi.cross(force)).norm());
          largest = std::max(largest, force.norm());
        }
        EXPECT_LT(error, 1e-11 * largest) << laminate << offset;
      }
}
