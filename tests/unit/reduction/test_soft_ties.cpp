// What a stiffness leaves on rigid motions: a soft tie to the ground, or the rounding of its numbers.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>
#include <random>

#include "fem/formats/matrices/digits.hpp"
#include "fem/formats/matrices/make_model.hpp"
#include "reduction/modes.hpp"
#include "reduction/reduce.hpp"
#include "tests/refusal.hpp"
#include "tests/unit/reduction/beams.hpp"
#include "tests/unit/reduction/structures.hpp"

using namespace tenon;
using namespace tenon::tests;
using ::testing::HasSubstr;

namespace {

/// Three springs to the ground at the middle node of a free beam.
fem::Model hung(double k) {
  fem::Model model = beam({}, {{"root", 0}});
  for (int d = 0; d < 3; ++d)
    model.elements.emplace_back(fem::Spring{.node_a = BeamData().elements / 2, .dof_a = d, .k = k});
  return model;
}

/// K and M of a structure as if a file had told them, after `write` of each entry of K.
template <class Write>
fem::Model told(const fem::Structure& s, Write write) {
  fem::MatrixData data;
  data.source = "file";
  for (const fem::Dof& dof : s.dofs.free) data.rows.push_back({dof.node + 1, dof.direction});
  for (std::size_t i = 0; i < s.nodes.size(); ++i) data.positions[static_cast<long>(i) + 1] = s.nodes[i];
  data.K = s.K;
  for (Eigen::Index i = 0; i < data.K.nonZeros(); ++i) data.K.valuePtr()[i] = write(data.K.valuePtr()[i]);
  data.M = s.M;
  return fem::make_model(std::move(data)).model;
}

double nine_digits(double x) { return std::stod(fmt::format("{:.8e}", x)); }
double single(double x) { return static_cast<double>(static_cast<float>(x)); }

}  // namespace

// ω² = k / m, from as stiff as the beam's second bending mode allows to 1e-11 of its elements' stiffness. The beam
// bends under its springs, k / (m ω₁²) of λ, and K is known to ε Σ|K_ij|.
TEST(SoftTies, HangABeamByItsMiddle) {
  const BeamData data;
  const double m = data.mass_total(), first = std::pow(22.3733, 2) * std::pow(data.bending(data.section.Iy), 2);
  double sum = 0.0;
  const fem::Structure free = fem::assemble(beam(data, {}));
  for (Eigen::Index i = 0; i < free.K.nonZeros(); ++i) sum += 2.0 * std::abs(free.K.valuePtr()[i]);
  for (const double k : {1e2, 1e0, 1e-1, 1e-2}) {
    const reduction::Modes modes = reduction::solve_modes(fem::assemble(hung(k)), {.count = 8});
    const double error = 2.0 * k / (m * first) + std::numeric_limits<double>::epsilon() * sum / k;
    ASSERT_EQ(modes.rigid, 3) << "turning about the middle, k = " << k;
    for (int i = 3; i < 6; ++i) EXPECT_NEAR(modes.lambda[i] / (k / m), 1.0, error) << k;
  }
}

TEST(SoftTies, ABodyToBeJoinedHasNone) {
  for (const double k : {1e4, 1e0, 1e-2})
    EXPECT_THAT(refusal([&] { reduction::reduce(fem::assemble(hung(k)), "root", {}); }), HasSubstr("node 13 ux")) << k;
}

// Files of single precision and of nine digits leave forces of their last digit on rigid motions: no tie to the ground,
// and the frequencies those of all digits but for what rounding takes: of the sums of |K|, relative to λ m.
TEST(SoftTies, RoundedFilesHaveNone) {
  BeamData data;
  data.elements = 6;
  data.length = 0.7 * std::numbers::pi;  // no round numbers
  const fem::Structure exact = fem::assemble(beam(data, {{"root", 0}}));
  const reduction::Modes expected = reduction::solve_modes(exact, {.count = 10});
  for (const auto& [write, unit] : {std::pair(&single, 6e-8), std::pair(&nine_digits, 5e-9)}) {
    const fem::Model model = told(exact, write);
    const fem::Structure read = fem::assemble(model);
    EXPECT_GT(read.rounding, unit);
    EXPECT_LT(read.rounding, 10.0 * unit);
    const reduction::Modes found = reduction::solve_modes(read, {.count = 10});
    EXPECT_EQ(found.rigid, 6);
    EXPECT_GT(found.rigid_force, 0.01 * unit) << "what a user is told";
    for (int i = 6; i < 10; ++i) {
      const Eigen::VectorXd x = expected.shapes.col(i).cwiseAbs();
      const double strain = x.dot(exact.K.cwiseAbs().selfadjointView<Eigen::Lower>() * x);
      EXPECT_NEAR(found.lambda[i], expected.lambda[i], unit * strain) << i;
    }
    fem::Model joined = model;
    joined.ports = exact.ports;
    EXPECT_NO_THROW(reduction::reduce(fem::assemble(joined), "root", {.modes = 2}));
  }
}

// Two masses of one, k between them and 1 from the first to the ground: λ = k + ½ ∓ √(k² + ¼). Seven digits, all of
// them exact: the force on the rigid motion stands in one row, so no rounding made it.
TEST(SoftTies, RoundNumbersAreNotRounded) {
  for (const double k : {1e3, 1e6, 1e8}) {
    fem::MatrixData data;
    data.source = "file";
    data.rows = {{1, 0}, {2, 0}};
    data.positions = {{1, {0, 0, 0}}, {2, {1, 0, 0}}};
    data.K = lower(2, {{0, 0, k + 1.0}, {1, 0, -k}, {1, 1, k}});
    data.M = lower(2, {{0, 0, 1.0}, {1, 1, 1.0}});
    const fem::Structure read = fem::assemble(fem::make_model(std::move(data)).model);
    const reduction::Modes found = reduction::solve_modes(read, {.count = 2});
    EXPECT_EQ(found.rigid, 0);
    EXPECT_NEAR(found.lambda[0], k / (k + 0.5 + std::sqrt(k * k + 0.25)), 4.0 * k * 2.3e-16) << k;
  }
}

// Coupling of modal coordinates to the boundary at the rounding of both: rows that no rigid motion moves.
TEST(SoftTies, NoiseBesideModalCoordinatesIsNone) {
  BeamData data;
  data.elements = 1;
  const fem::Structure s = fem::assemble(beam(data, {{"root", 0}}));
  std::mt19937 random(7);
  std::uniform_real_distribution<double> noise(-1.0, 1.0);
  const int n = s.n();
  Eigen::MatrixXd K = Eigen::MatrixXd::Zero(n + 2, n + 2), M = K;
  K.topLeftCorner(n, n) = s.K.selfadjointView<Eigen::Lower>() * Eigen::MatrixXd::Identity(n, n);
  M.topLeftCorner(n, n) = s.M.selfadjointView<Eigen::Lower>() * Eigen::MatrixXd::Identity(n, n);
  fem::MatrixData data_of_file;
  for (const fem::Dof& dof : s.dofs.free) data_of_file.rows.push_back({dof.node + 1, dof.direction});
  for (int q = 0; q < 2; ++q) {
    K(n + q, n + q) = 1e6 * (q + 1);
    M(n + q, n + q) = 1.0;
    for (int i = 0; i < n; ++i) K(n + q, i) = 1e-13 * noise(random) * std::sqrt(K(i, i) * K(n + q, n + q));
    data_of_file.rows.push_back({101 + q, 0, true});
  }
  data_of_file.source = "file";
  data_of_file.positions = {{1, s.nodes[0]}, {2, s.nodes[1]}};
  data_of_file.K = lower(K);
  data_of_file.M = lower(M);
  fem::Model model = fem::make_model(std::move(data_of_file)).model;
  model.ports = s.ports;
  const fem::Structure read = fem::assemble(model);
  EXPECT_EQ(reduction::solve_modes(read, {.count = 8}).rigid, 6);
  EXPECT_NO_THROW(reduction::reduce(read, "root", {.modes = 1}));
}

TEST(SoftTies, DigitsAreCounted) {
  const auto unit = [](auto write) {
    Triplets entries;
    for (int i = 0; i < 40; ++i) entries.emplace_back(i, i, write(1.0 / (3.0 + i)));
    return fem::unit_of_digits(lower(40, entries));
  };
  EXPECT_EQ(unit([](double x) { return x; }), std::numeric_limits<double>::epsilon() / 2.0);
  EXPECT_EQ(unit(single), std::numeric_limits<float>::epsilon() / 2.0);
  EXPECT_NEAR(unit(nine_digits), 5e-9, 1e-20);
  EXPECT_EQ(unit([](double x) { return std::round(1e3 * x); }), std::numeric_limits<double>::epsilon() / 2.0);
}
