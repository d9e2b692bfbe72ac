#include "fem/elements/shell.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <numeric>

#include "fem/error.hpp"
#include "tests/unit/fem/elements/small_assembly.hpp"

using namespace tenon;
using namespace tenon::fem;
using namespace tenon::fem::testing;

namespace {

const Material aluminium{"aluminium", 7.0e10, 7.0e10 / 2.6, 0.3, 2700.0};

ShellSection plate(double t) { return {.name = "plate", .thickness = t}; }

ElementMatrices quad(const std::vector<Vec3>& nodes, const ShellSection& s, const Material& m = aluminium) {
  ElementMatrices e;
  quad4_matrices({.nodes = {0, 1, 2, 3}, .id = 7}, s, m, nodes, e);
  return e;
}

ElementMatrices tria(const std::vector<Vec3>& nodes, const ShellSection& s, const Material& m = aluminium) {
  ElementMatrices e;
  tria3_matrices({.nodes = {0, 1, 2}, .id = 8}, s, m, nodes, e);
  return e;
}

const Mat3 askew = Eigen::AngleAxisd(0.7, Vec3(1.0, -2.0, 0.5).normalized()).toRotationMatrix();

std::vector<Vec3> turned(std::vector<Vec3> nodes) {
  for (Vec3& x : nodes) x = askew * x + Vec3(0.3, -0.2, 0.9);
  return nodes;
}

std::vector<std::vector<Vec3>> quads() {
  std::vector<std::vector<Vec3>> shapes{
      {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}},                           // square
      {{0, 0, 0}, {1.2, 0.1, 0}, {0.9, 1.1, 0}, {-0.2, 0.6, 0}},              // distorted
      {{0, 0, 0}, {8, 0, 0}, {8.5, 0.5, 0}, {0.5, 0.5, 0}},                   // slender, skew
      {{0, 0, 0.15}, {1.2, 0.1, -0.1}, {0.9, 1.1, 0.2}, {-0.2, 0.6, -0.15}},  // warped
      {{0, 0, 0.4}, {1, 0, -0.4}, {1, 1, 0.4}, {0, 1, -0.4}}};                // much warped
  const std::size_t n = shapes.size();
  for (std::size_t i = 0; i < n; ++i) shapes.push_back(turned(shapes[i]));
  return shapes;
}

std::vector<std::vector<Vec3>> triangles() {
  const std::vector<Vec3> flat{{0, 0, 0}, {1, 0, 0}, {0.2, 0.9, 0}}, needle{{0, 0, 0}, {5, 0, 0}, {3, 0.3, 0}};
  return {flat, needle, turned(flat), turned(needle)};
}

/// Exact rigid mass matrix about the origin of the quad's projection on its mean plane (or of a triangle).
Mat6 exact_rigid_mass(std::vector<Vec3> p, double per_area, double rotary) {
  if (p.size() == 4) {
    const Vec3 n = (p[2] - p[0]).cross(p[3] - p[1]).normalized(), centre = 0.25 * (p[0] + p[1] + p[2] + p[3]);
    for (Vec3& x : p) x -= n * n.dot(x - centre);
  }
  double area = 0.0;
  Vec3 first = Vec3::Zero(), normal = Vec3::Zero();
  Mat3 second = Mat3::Zero();  // ∫ x x' dA
  for (std::size_t k = 2; k < p.size(); ++k) {
    const Vec3 cross = 0.5 * (p[k - 1] - p[0]).cross(p[k] - p[0]), sum = p[0] + p[k - 1] + p[k];
    const double a = normal.isZero() ? cross.norm() : cross.dot(normal);  // signed: not every quad is convex at p[0]
    if (normal.isZero()) normal = cross.normalized();
    area += a;
    first += a / 3.0 * sum;
    second +=
        a / 12.0 *
        (p[0] * p[0].transpose() + p[k - 1] * p[k - 1].transpose() + p[k] * p[k].transpose() + sum * sum.transpose());
  }
  const Vec3 c = first / area;
  const Mat3 central = second - area * c * c.transpose();
  const Mat3 J = per_area * (central.trace() * Mat3::Identity() - central) +
                 rotary * area * (Mat3::Identity() - normal * normal.transpose());
  return rigid_mass(per_area * area, c, J);
}

void expect_sound(const ElementMatrices& e, const std::vector<Vec3>& nodes, double h) {
  EXPECT_LT((e.K * rigid_motions(nodes)).cwiseAbs().maxCoeff(), 1e-12 * e.K.cwiseAbs().maxCoeff());
  EXPECT_EQ(zero_modes(e.K, h, 1e-12), 6);
  EXPECT_EQ((e.K - e.K.transpose()).norm() + (e.M - e.M.transpose()).norm(), 0.0);  // copies, not computations
}

/// The distorted patch of MacNeal and Harder (Finite Elem. Anal. Des. 1 (1985) 3), lying anywhere in space.
struct Patch {
  std::vector<Vec3> flat{{0, 0, 0},       {0.24, 0, 0},    {0.24, 0.12, 0}, {0, 0.12, 0},
                         {0.04, 0.02, 0}, {0.18, 0.03, 0}, {0.16, 0.08, 0}, {0.08, 0.08, 0}};
  Mat3 R;
  SmallAssembly a;

  Patch(bool triangular, const ShellSection& s, const Material& m, const Mat3& axes) : R(axes) {
    for (const Vec3& x : flat) a.nodes.push_back(R * x);
    const int elements[5][4] = {{0, 1, 5, 4}, {1, 2, 6, 5}, {2, 3, 7, 6}, {3, 0, 4, 7}, {4, 5, 6, 7}};
    ElementMatrices e;
    for (const auto& n : elements)
      if (triangular) {
        for (const auto& t : {std::array<int, 3>{n[0], n[1], n[2]}, std::array<int, 3>{n[0], n[2], n[3]}}) {
          tria3_matrices({.nodes = t}, s, m, a.nodes, e);
          a.add(t, e);
        }
      } else {
        const std::array<int, 4> q{n[0], n[1], n[2], n[3]};
        quad4_matrices({.nodes = q}, s, m, a.nodes, e);
        a.add(q, e);
      }
  }

  /// Prescribes `field` (dofs in the patch's own axes) on the outer nodes; largest error of the inner nodes relative
  /// to the largest value, and the strain energy.
  std::pair<double, double> solve(const std::function<Vec6(const Vec3&)>& field) const {
    Eigen::VectorXd exact(48);
    for (int i = 0; i < 8; ++i) exact.segment<6>(6 * i) = rotation6(R) * field(flat[static_cast<std::size_t>(i)]);
    Sparse sparse(48, 48);
    sparse.setFromTriplets(a.K.begin(), a.K.end());
    const Eigen::MatrixXd K(sparse);
    Eigen::VectorXd u = exact;
    u.tail<24>() = K.bottomRightCorner<24, 24>().llt().solve(-K.bottomLeftCorner<24, 24>() * exact.head<24>());
    double error = 0.0;  // translations and rotations each against their own size
    for (int part = 0; part < 6; part += 3) {
      double size = 0.0, off = 0.0;
      for (int i = 0; i < 8; ++i) {
        size = std::max(size, exact.segment<3>(6 * i + part).norm());
        off = std::max(off, (u - exact).segment<3>(6 * i + part).norm());
      }
      error = std::max(error, off / (size > 0.0 ? size : exact.cwiseAbs().maxCoeff()));
    }
    return {error, 0.5 * u.dot(K * u)};
  }
};

}  // namespace

TEST(Quad4, SixZeroModesWhateverTheShape) {
  for (const auto& nodes : quads())
    for (const double t : {0.3, 0.01}) expect_sound(quad(nodes, plate(t)), nodes, 1.0);
}

TEST(Tria3, SixZeroModesWhateverTheShape) {
  for (const auto& nodes : triangles())
    for (const double t : {0.3, 0.01}) expect_sound(tria(nodes, plate(t)), nodes, 1.0);
}

TEST(Shell, RigidMassIsExact) {
  ShellSection s = plate(0.08);
  s.nsm = 11.0;
  const double per_area = aluminium.rho * 0.08 + 11.0, rotary = aluminium.rho * std::pow(0.08, 3) / 12;
  const auto check = [&](const ElementMatrices& e, const std::vector<Vec3>& nodes) {
    const Eigen::MatrixXd R = rigid_motions(nodes);
    const Mat6 exact = exact_rigid_mass(nodes, per_area, rotary);
    EXPECT_LT((R.transpose() * e.M * R - exact).norm(), 1e-13 * exact.norm());
  };
  for (const auto& nodes : quads()) check(quad(nodes, s), nodes);
  for (const auto& nodes : triangles()) check(tria(nodes, s), nodes);
}

TEST(Shell, ANormalRotationHasNoMassButStiffness) {
  const auto nodes = quads()[1];
  const ElementMatrices e = quad(nodes, plate(0.02));
  for (int i = 0; i < 4; ++i) {
    EXPECT_EQ(e.M.row(6 * i + 5).norm(), 0.0);
    EXPECT_GT(e.K(6 * i + 5, 6 * i + 5), 0.0);
  }
}

TEST(Shell, NumberingDoesNotMatter) {
  const auto compare = [](const std::vector<Vec3>& nodes, std::vector<int> order, auto element) {
    std::vector<Vec3> moved;
    for (const int i : order) moved.push_back(nodes[static_cast<std::size_t>(i)]);
    const ElementMatrices a = element(nodes), b = element(moved);
    double worst_K = 0.0, worst_M = 0.0;
    for (std::size_t i = 0; i < order.size(); ++i)
      for (std::size_t j = 0; j < order.size(); ++j) {
        const auto of_b = [&](const auto& A) {
          return Mat6(A.template block<6, 6>(6 * Eigen::Index(i), 6 * Eigen::Index(j)));
        };
        const auto of_a = [&](const auto& A) { return Mat6(A.template block<6, 6>(6 * order[i], 6 * order[j])); };
        worst_K = std::max(worst_K, (of_b(b.K) - of_a(a.K)).cwiseAbs().maxCoeff());
        worst_M = std::max(worst_M, (of_b(b.M) - of_a(a.M)).cwiseAbs().maxCoeff());
      }
    EXPECT_LT(worst_K, 1e-12 * a.K.cwiseAbs().maxCoeff());
    EXPECT_LT(worst_M, 1e-12 * a.M.cwiseAbs().maxCoeff());
  };
  for (const auto& nodes : quads())
    for (const auto& order : {std::vector<int>{1, 2, 3, 0}, std::vector<int>{3, 2, 1, 0}})
      compare(nodes, order, [](const auto& n) { return quad(n, plate(0.05)); });
  for (const auto& nodes : triangles())
    for (const auto& order : {std::vector<int>{1, 2, 0}, std::vector<int>{1, 0, 2}})
      compare(nodes, order, [](const auto& n) { return tria(n, plate(0.05)); });
}

// Constant states on the distorted patch: displacements and energy exact, thick and thin. The thinnest lies in the x-y
// plane: askew, the membrane's round-off, (h/t)² ε of the bending, would show.
TEST(Shell, PatchTests) {
  const double area = 0.24 * 0.12;
  for (const bool triangular : {false, true})
    for (const double t : {0.1, 0.01, 1e-4}) {
      const Patch patch(triangular, plate(t), aluminium, t < 1e-3 ? Mat3::Identity() : askew);
      const double plane = aluminium.E / (1 - 0.09);
      const auto energy = [&](double a, double b, double c, double scale) {  // of (a, b, c) = strains or curvatures
        return 0.5 * scale * area * (plane * (a * a + b * b + 0.6 * a * b) + aluminium.G * c * c);
      };
      struct State {
        std::string name;
        std::function<Vec6(const Vec3&)> field;
        double energy;
      };
      const double D_scale = t * t * t / 12;
      for (const State& state :
           {State{"membrane",
                  [](const Vec3& x) {  // θz = ½ (v,x − u,y) = −0.15e-3
                    Vec6 u;
                    u << 1e-3 * (x.x() + 0.5 * x.y()), 1e-3 * (0.4 * x.y() + 0.2 * x.x()), 0, 0, 0, -0.15e-3;
                    return u;
                  },
                  energy(1e-3, 0.4e-3, 0.7e-3, t)},
            State{"bending",
                  [](const Vec3& x) {
                    Vec6 u;
                    u << 0, 0, 1e-3 * (x.x() * x.x() + 0.5 * x.y() * x.y()), 1e-3 * x.y(), -2e-3 * x.x(), 0;
                    return u;
                  },
                  energy(2e-3, 1e-3, 0, D_scale)},
            State{"twist",
                  [](const Vec3& x) {
                    Vec6 u;
                    u << 0, 0, 1e-3 * x.x() * x.y(), 1e-3 * x.x(), -1e-3 * x.y(), 0;
                    return u;
                  },
                  energy(0, 0, 2e-3, D_scale)}}) {
        const auto [error, work] = patch.solve(state.field);
        EXPECT_LT(error, 1e-10) << state.name << " t = " << t << " triangles " << triangular;
        EXPECT_NEAR(work / state.energy, 1.0, 1e-10) << state.name << " t = " << t;
      }
    }
}

// Constant transverse shear (w = x, no rotation) where the plate is thick against its elements: γ²/2 κGt A.
TEST(Shell, ThickLimitHasTheShearEnergy) {
  for (const bool triangular : {false, true}) {
    const double t = 1e3;  // φ ~ (t/h)² ~ 1e8
    const Patch patch(triangular, plate(t), aluminium, askew);
    Eigen::VectorXd u = Eigen::VectorXd::Zero(48);
    for (int i = 0; i < 8; ++i) u.segment<3>(6 * i) = patch.R * Vec3(0, 0, patch.flat[static_cast<std::size_t>(i)].x());
    Sparse K(48, 48);
    K.setFromTriplets(patch.a.K.begin(), patch.a.K.end());
    EXPECT_NEAR(u.dot(K * u) / (5.0 / 6.0 * aluminium.G * t * 0.24 * 0.12), 1.0, 1e-7);
  }
}

TEST(Shell, SectionRatiosScaleTheirParts) {
  const auto nodes = quads()[1];
  ShellSection s = plate(0.05), stiff = s;
  stiff.bending_ratio = 8.0;  // as a thickness doubled in bending; the shear is kept the same relative to it
  stiff.shear_ratio = 8.0 * s.shear_ratio;
  const auto across = [](const ElementMatrices& e) {  // dofs w θx θy of a plate in the x-y plane
    Eigen::MatrixXd K(12, 12);
    for (int i = 0; i < 12; ++i)
      for (int j = 0; j < 12; ++j) K(i, j) = e.K(6 * (i / 3) + 2 + i % 3, 6 * (j / 3) + 2 + j % 3);
    return K;
  };
  const ElementMatrices a = quad(nodes, s), b = quad(nodes, stiff);
  EXPECT_LT((8.0 * across(a) - across(b)).norm(), 1e-13 * across(b).norm());
  EXPECT_NEAR(a.K(0, 0), b.K(0, 0), 1e-14 * a.K(0, 0));  // the membrane is untouched
  // rigid in shear (0) is the limit of large ratios
  ShellSection rigid = s, nearly = s;
  rigid.shear_ratio = 0.0;
  nearly.shear_ratio = 1e8;
  EXPECT_LT((across(quad(nodes, rigid)) - across(quad(nodes, nearly))).norm(), 1e-8 * across(a).norm());
}

TEST(Shell, RefusesWhatIsNoShell) {
  using ::testing::AllOf;
  using ::testing::HasSubstr;
  const auto refusal = [](auto make) -> std::string {
    try {
      make();
    } catch (const ModelError& error) {
      return error.what();
    }
    return "nothing was refused";
  };
  const auto square = quads()[0];
  const std::vector<Vec3> line{{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {3, 0, 0}};
  const std::vector<Vec3> crossed{{0, 0, 0}, {1, 1, 0}, {1, 0, 0}, {0, 1.5, 0}};
  const std::vector<Vec3> dart{{0, 0, 0}, {1, 0, 0}, {0.2, 0.2, 0}, {0, 1, 0}};
  const std::vector<Vec3> collapsed{{0, 0, 0}, {1, 0, 0}, {1, 0, 0}, {0, 1, 0}};
  EXPECT_THAT(refusal([&] { quad(line, plate(0.1)); }), AllOf(HasSubstr("quad element 7"), HasSubstr("area is zero")));
  for (const auto& bad : {crossed, dart, collapsed})
    EXPECT_THAT(refusal([&] { quad(bad, plate(0.1)); }), AllOf(HasSubstr("quad element 7"), HasSubstr("folded")));
  EXPECT_THAT(refusal([&] { tria(line, plate(0.1)); }),
              AllOf(HasSubstr("triangle element 8"), HasSubstr("area is zero")));
  EXPECT_THAT(refusal([&] { quad(square, plate(0.0)); }), HasSubstr("thickness"));
  EXPECT_THAT(refusal([&] { tria(square, plate(-1.0)); }), HasSubstr("thickness"));
  Material m = aluminium;
  m.E = 0.0;
  EXPECT_THAT(refusal([&] { quad(square, plate(0.1), m); }), HasSubstr("E 0"));
  m = aluminium;
  m.rho = 0.0;
  EXPECT_EQ(refusal([&] { quad(square, plate(0.1), m); }), "nothing was refused");
}
