#include <fmt/format.h>
#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>
#include <cmath>
#include <functional>
#include <numbers>
#include <sstream>

#include "tests/analytic/calculix/block.hpp"
#include "tests/analytic/calculix/ccx.hpp"
#include "tests/support/oracle.hpp"
#include "tests/unit/fem/formats/matrices/op4_files.hpp"
#include "tests/unit/interfaces/program.hpp"

// From the files of other programs to coupled modes through the program, against dense matrices that this file makes
// or reads by itself.
namespace {

using Eigen::Matrix3d;
using Eigen::MatrixXd;
using Eigen::Vector3d;
using Eigen::VectorXd;
using tenon::calculix::Block;

Matrix3d cross_matrix(const Vector3d& r) {
  return (Matrix3d() << 0, -r.z(), r.y(), r.z(), 0, -r.x(), -r.y(), r.x(), 0).finished();
}

/// Of a rigid body about a point, the centre of mass at c from there, J about the centre.
MatrixXd rigid_mass_about(double m, const Vector3d& c, const Vector3d& J) {
  const Matrix3d C = cross_matrix(c);
  MatrixXd M(6, 6);
  M << m * Matrix3d::Identity(), -m * C, m * C, Matrix3d(J.asDiagonal()) - m * C * C;
  return M;
}

/// The frequencies of K φ = λ M φ above those of the rigid motions, rising; `sigma` about the first λ. The shift makes
/// both sides of M φ = (K + σM) φ / (λ + σ) sound where K or M is singular, and the lowest λ the best known.
std::vector<double> dense_frequencies(const MatrixXd& K, const MatrixXd& M, double sigma, int rigid, int count) {
  const VectorXd mu = Eigen::GeneralizedSelfAdjointEigenSolver<MatrixXd>(M, MatrixXd(K + sigma * M),
                                                                         Eigen::EigenvaluesOnly | Eigen::Ax_lBx)
                          .eigenvalues();
  std::vector<double> hertz;
  for (int k = rigid; k < rigid + count; ++k)
    hertz.push_back(std::sqrt(1.0 / mu[mu.size() - 1 - k] - sigma) / (2.0 * std::numbers::pi));
  return hertz;
}

/// What was asked of files with all digits.
constexpr double all_digits = 1e-8;

void expect_frequencies(const json& found, std::size_t first, const std::vector<double>& expected) {
  ASSERT_GE(found.size(), first + expected.size());
  double worst = 0.0;
  for (std::size_t k = 0; k < expected.size(); ++k)
    worst = std::max(worst, std::abs(found[first + k].get<double>() / expected[k] - 1.0));
  testing::Test::RecordProperty("worst_error", fmt::format("{:.2e}", worst));
  EXPECT_LT(worst, all_digits);
}

/// CalculiX's block of solids in millimetres, tonnes and seconds: held and free, by both of its ways.
class CalculixScene : public Program {
 protected:
  void SetUp() override {
    TENON_SKIP_WITHOUT(tenon::calculix::installed(), "CalculiX (calculix-ccx)");
    for (const auto& [job, deck] : {std::pair("held", block_.deck("SOLVER=MATRIXSTORAGE")),
                                    std::pair("free", block_.deck("SOLVER=MATRIXSTORAGE", false)),
                                    std::pair("own", block_.deck("STORAGE=YES"))}) {
      folder_.write(std::string(job) + ".inp", deck);
      ASSERT_TRUE(tenon::calculix::run(folder_.path(), job)) << text(folder_.path() / (std::string(job) + ".log"));
    }
    for (const double lambda : tenon::calculix::stored_eigenvalues(text(folder_.path() / "own.eig")))
      own_.push_back(std::sqrt(lambda) / (2.0 * std::numbers::pi));
    ASSERT_EQ(own_.size(), 10U) << "the .eig file is not laid out as in CalculiX 2.20";
  }

  MatrixXd dense(const std::string& file, int n) const {
    MatrixXd A = MatrixXd::Zero(n, n);
    std::istringstream lines(text(folder_.path() / file));
    int row = 0, column = 0;
    for (double value = 0.0; lines >> row >> column >> value;) A(row - 1, column - 1) = A(column - 1, row - 1) = value;
    return A;
  }

  const Block block_;
  std::vector<double> own_;
};

TEST_F(CalculixScene, HeldGivesCalculixsOwnFrequencies) {
  folder_.write("held.yaml", "units: mm-t-s\nbodies: {part: {matrices: {calculix: held, deck: held.inp}}}\n");
  expect_frequencies(object("modes held.yaml --count 10")["frequencies_hz"], 0, own_);
}

// The free matrices clamped at their port are what CalculiX solved when it held these nodes itself.
TEST_F(CalculixScene, ReducedClampedAtAFaceGivesCalculixsOwnFrequencies) {
  folder_.write("free.yaml",
                "units: mm-t-s\nbodies:\n  part:\n    matrices: {calculix: free, deck: free.inp}\n"
                "    ports: {root: {set: ROOT}}\n    reduction: {basis: clamped-free, modes: 10}\n");
  const json reduced = object("reduce free.yaml --body part -o part.body.json");
  expect_frequencies(reduced["frequencies_hz"], 0, own_);
  const json body = json::parse(text(folder_.path() / "part.body.json"));
  EXPECT_NEAR(body["D"][0][0].get<double>(), 7.8e-9 * 12.0 * 1e3, 1e-12);  // kg: ρ V
}

// Dense: u = T q with the face ROOT following a rigid hub, M = TᵀM T + M_hub.
TEST_F(CalculixScene, JoinedToAHubGivesDenseFrequencies) {
  folder_.write("whole.yaml",
                "units: mm-t-s\nbodies:\n"
                "  hub: {rigid: {mass: 2e-7, inertia: [1e-6, 2e-6, 1.5e-6], com: [1, 2, -3]}, ports: {p: [0, 0, 0]}}\n"
                "  part:\n    matrices: {calculix: free, deck: free.inp}\n    ports: {root: {set: ROOT}}\n"
                "    reduction: {basis: craig-bampton-inertia-relief, modes: 10}\n"
                "joints: {j: {parent: hub.p, child: part.root, weld: true}}\n");
  const json modes = object("modes whole.yaml --full --count 16");

  std::vector<std::pair<long, int>> rows;
  std::istringstream labels(text(folder_.path() / "free.dof"));
  for (std::string label; labels >> label;) rows.emplace_back(std::stol(label), label.back() - '1');  // "12.3"
  const auto n = static_cast<int>(rows.size());
  ASSERT_EQ(n, 267);  // 89 nodes
  Vector3d centroid = Vector3d::Zero();
  int face = 0;
  for (const auto& [id, x] : block_.positions)
    if (x.z() == 0.0) centroid += x, ++face;
  centroid /= face;
  MatrixXd T = MatrixXd::Zero(n, n - 3 * face + 6);
  for (int i = 0, next = 6; i < n; ++i) {
    const auto& [node, direction] = rows[static_cast<std::size_t>(i)];
    const Vector3d r = block_.positions.at(node) - centroid;
    if (r.z() != 0.0) {
      T(i, next++) = 1.0;
      continue;
    }
    T(i, direction) = 1.0;
    T.block<1, 3>(i, 3) = -cross_matrix(r).row(direction);  // u = t + θ × r
  }
  const MatrixXd K = T.transpose() * dense("free.sti", n) * T;
  MatrixXd M = T.transpose() * dense("free.mas", n) * T;
  M.topLeftCorner(6, 6) += rigid_mass_about(2e-7, {1, 2, -3}, {1e-6, 2e-6, 1.5e-6});
  const std::vector<double> expected = dense_frequencies(K, M, 4e10, 6, 10);
  expect_frequencies(modes["full"]["frequencies_hz"], 6, expected);
  // Ritz: a reduced frequency is never below the full one
  for (std::size_t k = 0; k < expected.size(); ++k)
    EXPECT_GT(modes["frequencies_hz"][6 + k].get<double>(), expected[k] * (1.0 - all_digits));
}

// The walk of docs/calculix.md: status 0 says that the reduced frequencies meet the scene's tolerance beside the full
// ones.
TEST_F(CalculixScene, TheShippedBoomMeetsItsTolerance) {
  for (const char* file : {"boom.inp", "scene.yaml"})
    fs::copy_file(fs::path(TENON_SOURCE_DIR) / "data" / "calculix" / file, folder_.path() / file);
  ASSERT_TRUE(tenon::calculix::run(folder_.path(), "boom")) << text(folder_.path() / "boom.log");
  const json modes = object("modes scene.yaml --full --count 12");
  EXPECT_EQ(modes["rigid_modes"], 6);
  // a cantilever of ℓ/h = 40: (1.8751/ℓ)² h √(E/12ρ) / 2π; the clamped face restrains the width by some per cent
  const double beam = std::pow(1.875104 / 0.4, 2) * 0.01 * std::sqrt(70e9 / (12.0 * 2700.0)) / (2.0 * std::numbers::pi);
  const json boom = object("reduce scene.yaml --body boom -o boom.body.json");
  folder_.write("clamped.yaml",
                "units: SI\nbodies:\n  boom: {matrices: {calculix: boom, deck: boom.inp}, fix: {ROOT: all}}\n");
  const double lowest = object("modes clamped.yaml --count 1")["frequencies_hz"][0].get<double>();
  EXPECT_NEAR(lowest / beam, 1.0, 0.03);
  // Ritz: the clamped mode among the body's shapes
  EXPECT_NEAR(boom["frequencies_hz"][0].get<double>() / lowest, 1.0, 1e-6);
}

/// A free beam along x of ten cubic elements, six dofs a node (ux uy uz rx ry rz).
struct FreeBeam {
  static constexpr int elements = 10, n = 6 * (elements + 1);
  static constexpr double length = 2.0, EA = 2.1e7, GJ = 150.0, mass = 0.8, polar = 1e-5;  // mass: kg/m; polar: kg m
  static constexpr double EI[2] = {180.0, 260.0};                                          // of uy and rz, of uz and ry
  MatrixXd K = MatrixXd::Zero(n, n), M = K;

  FreeBeam() {
    const double l = length / elements;
    Eigen::Matrix4d k, m;
    k << 12, 6 * l, -12, 6 * l, 6 * l, 4 * l * l, -6 * l, 2 * l * l, -12, -6 * l, 12, -6 * l, 6 * l, 2 * l * l, -6 * l,
        4 * l * l;
    m << 156, 22 * l, 54, -13 * l, 22 * l, 4 * l * l, 13 * l, -3 * l * l, 54, 13 * l, 156, -22 * l, -13 * l, -3 * l * l,
        -22 * l, 4 * l * l;
    for (int e = 0; e < elements; ++e) {
      const int a = 6 * e, b = a + 6;
      bar(a, b, EA / l, mass * l / 6.0);
      bar(a + 3, b + 3, GJ / l, polar * l / 6.0);
      bend({a + 1, a + 5, b + 1, b + 5}, {1, 1, 1, 1}, EI[0] / (l * l * l) * k, mass * l / 420.0 * m);
      bend({a + 2, a + 4, b + 2, b + 4}, {1, -1, 1, -1}, EI[1] / (l * l * l) * k, mass * l / 420.0 * m);
    }
  }
  /// The hub of scene() at the first node.
  std::vector<double> with_hub(int count) const {
    MatrixXd whole = M;
    whole.topLeftCorner(6, 6) += rigid_mass_about(3.0, {-0.1, 0.05, 0.2}, {0.2, 0.3, 0.25});
    return dense_frequencies(K, whole, 1e3, 6, count);
  }
  static std::string scene(const std::string& source) {
    return "units: SI\nbodies:\n"
           "  hub: {rigid: {mass: 3, inertia: [0.2, 0.3, 0.25], com: [-0.1, 0.05, 0.2]}, ports: {p: [0, 0, 0]}}\n"
           "  beam:\n    matrices: {" +
           source +
           "}\n    ports: {root: {node: 1}, tip: {node: 11}}\n    reduction: {basis: craig-bampton-inertia-relief, "
           "modes: 24}\n"
           "joints: {j: {parent: hub.p, child: beam.root, weld: true}}\n";
  }
  static double x(int node) { return length * (node - 1) / elements; }
  /// Calls write(row, column, value) for the lower triangle's entries.
  static void each_entry(const MatrixXd& A, const std::function<void(int, int, double)>& write) {
    for (int j = 0; j < n; ++j)
      for (int i = j; i < n; ++i)
        if (A(i, j) != 0.0) write(i, j, A(i, j));
  }

 private:
  void bar(int a, int b, double k, double m) {
    K(a, a) += k, K(b, b) += k, K(a, b) -= k, K(b, a) -= k;
    M(a, a) += 2 * m, M(b, b) += 2 * m, M(a, b) += m, M(b, a) += m;
  }
  void bend(const std::array<int, 4>& at, const std::array<double, 4>& sign, const Eigen::Matrix4d& k,
            const Eigen::Matrix4d& m) {
    for (std::size_t i = 0; i < 4; ++i)
      for (std::size_t j = 0; j < 4; ++j) {
        K(at[i], at[j]) += sign[i] * sign[j] * k(static_cast<int>(i), static_cast<int>(j));
        M(at[i], at[j]) += sign[i] * sign[j] * m(static_cast<int>(i), static_cast<int>(j));
      }
  }
};

using ForeignBeam = Program;

// The model itself: ω = (4.7300408/ℓ)² √(EI/ρA) of a free beam; ten cubic elements err by (βh)⁴/720 = 7e-5 in ω².
TEST_F(ForeignBeam, IsABeam) {
  const FreeBeam beam;
  const double hertz = dense_frequencies(beam.K, beam.M, 1e3, 6, 1)[0];
  const double beta = 4.730040744862704 / FreeBeam::length;
  EXPECT_NEAR(hertz * 2.0 * std::numbers::pi / (beta * beta * std::sqrt(FreeBeam::EI[0] / FreeBeam::mass)), 1.0, 5e-5);
}

TEST_F(ForeignBeam, OfAbaqusJoinedToAHubGivesDenseFrequencies) {
  const FreeBeam beam;
  for (const auto& [name, A] : {std::pair("beam_STIF1.mtx", &beam.K), std::pair("beam_MASS1.mtx", &beam.M)}) {
    std::string lines = "** written by a test\n";
    FreeBeam::each_entry(*A, [&](int i, int j, double value) {
      lines += fmt::format("{},{}, {},{}, {:.17e}\n", i / 6 + 1, i % 6 + 1, j / 6 + 1, j % 6 + 1, value);
    });
    folder_.write(name, lines);
  }
  std::string deck = "*NODE, NSET=ALL\n";
  for (int node = 1; node <= 11; ++node) deck += fmt::format("{}, {:.17g}, 0., 0.\n", node, FreeBeam::x(node));
  folder_.write("beam.inp", deck);
  folder_.write("whole.yaml", FreeBeam::scene("abaqus: beam, deck: beam.inp"));
  expect_frequencies(object("modes whole.yaml --full --count 18")["full"]["frequencies_hz"], 6, beam.with_hub(12));
}

TEST_F(ForeignBeam, OfNastranJoinedToAHubGivesDenseFrequencies) {
  const FreeBeam beam;
  // EXTSEOUT's files; the superelement's own numbers are those of the assembly
  std::string description = "SECONCT        1       0              NO\n";
  for (int node = 1; node <= 11; ++node)
    description += fmt::format("{}{:8}{:8}{}", node % 4 == 1 ? "        " : "", node, node,
                               node % 4 == 0 || node == 11 ? "\n" : "");
  for (int node = 1; node <= 11; ++node)
    description += fmt::format("GRID*   {:16}{:16}{:16.9E}{:16.9E}\n*       {:16.9E}{:16}\n", node, 0,
                               FreeBeam::x(node), 0.0, 0.0, 0);
  folder_.write("beam.asm", description);
  using tenon::fem::testing::Layout, tenon::fem::testing::op4_binary;
  folder_.write("beam.op4", op4_binary("KXX", beam.K, {.layout = Layout::big}) +
                                op4_binary("MXX", beam.M, {.layout = Layout::big}));
  folder_.write("whole.yaml", FreeBeam::scene("nastran: beam.asm"));
  expect_frequencies(object("modes whole.yaml --full --count 18")["full"]["frequencies_hz"], 6, beam.with_hub(12));
}

TEST_F(ForeignBeam, OfMatrixMarketJoinedToAHubGivesDenseFrequencies) {
  const FreeBeam beam;
  for (const auto& [name, A] : {std::pair("k.mtx", &beam.K), std::pair("m.mtx", &beam.M)}) {
    std::string lines;
    int count = 0;
    FreeBeam::each_entry(*A, [&](int i, int j, double value) {
      lines += fmt::format("{} {} {:.17g}\n", i + 1, j + 1, value);
      ++count;
    });
    folder_.write(
        name,
        fmt::format("%%MatrixMarket matrix coordinate real symmetric\n{0} {0} {1}\n", FreeBeam::n, count) + lines);
  }
  std::string labels;
  for (int row = 0; row < FreeBeam::n; ++row)
    labels += fmt::format("{} {}{}\n", row / 6 + 1, row % 6 + 1,
                          row % 6 == 0 ? fmt::format(" {:.17g} 0 0", FreeBeam::x(row / 6 + 1)) : "");
  folder_.write("rows.txt", labels);
  folder_.write("whole.yaml", FreeBeam::scene("K: k.mtx, M: m.mtx, labels: rows.txt"));
  expect_frequencies(object("modes whole.yaml --full --count 18")["full"]["frequencies_hz"], 6, beam.with_hub(12));
}

}  // namespace
