#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>
#include <atomic>
#include <cmath>
#include <thread>

#include "fem/error.hpp"
#include "reduction/block_lanczos.hpp"
#include "reduction/dense.hpp"
#include "reduction/dense_modes.hpp"
#include "reduction/eigenpairs.hpp"
#include "reduction/inertia.hpp"
#include "reduction/modes.hpp"
#include "reduction/shift.hpp"
#include "reduction/sparse.hpp"
#include "tests/refusal.hpp"
#include "tests/unit/reduction/structures.hpp"

using namespace tenon;
using namespace tenon::reduction;
using namespace tenon::tests;
using ::testing::HasSubstr;

namespace {

const Eigen::MatrixXd none;

// every test of a solver runs it sparse: no problem is small enough for the dense path
ModesOptions sparse(int count) { return {.count = count, .dense_below = 0}; }

}  // namespace

TEST(Modes, RepeatedEigenvaluesWiderThanTheBlockAreAllFound) {
  // eleven equal chains: multiplicity 11 against a block of 8; the inertia count sees the missing three
  const Pencil p = repeated(uniform_chain(70, 1.0, 1.0, true, true), 11);
  const Modes modes = solve_modes(p.K, p.M, none, sparse(22));
  ASSERT_EQ(modes.lambda.size(), 22);
  EXPECT_EQ(modes.counted, modes.found);
  for (int k = 0; k < 22; ++k) {
    const double s = std::sin((k / 11 + 1) * std::numbers::pi / (2.0 * 71.0));
    EXPECT_NEAR(modes.lambda[k], 4.0 * s * s, 1e-12);
  }
  EXPECT_LT(modes.max_orthogonality, 1e-12);
}

TEST(Modes, SpectraGivesTheSamePairsThroughTheSameOperator) {
  const Pencil p = grid(31, 24);
  ModesOptions options = sparse(15);
  const Modes ours = solve_modes(p.K, p.M, none, options);
  options.solver = EigenSolver::spectra;
  const Modes theirs = solve_modes(p.K, p.M, none, options);
  EXPECT_LT((ours.lambda - theirs.lambda).cwiseAbs().maxCoeff(), 1e-12);
  const Eigen::MatrixXd mac = ours.shapes.transpose() * theirs.shapes;  // M = 1, all eigenvalues distinct
  EXPECT_LT((mac - Eigen::MatrixXd::Identity(15, 15)).norm(), 1e-7);
}

TEST(Modes, SpectraOnAFreeChainWithDeflatedRigidMotion) {
  const Pencil p = uniform_chain(300, 1.0, 1.0, false, false);
  ModesOptions options = sparse(6);
  options.solver = EigenSolver::spectra;
  const Modes modes = solve_modes(p.K, p.M, Eigen::MatrixXd::Ones(300, 1), options);
  EXPECT_EQ(modes.rigid, 1);
  EXPECT_EQ(modes.lambda[0], 0.0);
  const double s = std::sin(std::numbers::pi / 600.0);
  EXPECT_NEAR(modes.lambda[1], 4.0 * s * s, 1e-10 * 4.0 * s * s);
}

TEST(Modes, ADroppedVectorIsReported) {
  // the count at the cut is compared with the pairs at hand: take one away and the numbers differ
  const Pencil p = grid(20, 13);
  const ShiftedFactor at = choose_shift(p.K, p.M, Eigen::MatrixXd(p.K.rows(), 0));
  const ShiftInvert op(at.factor, p.M);
  const Eigen::MatrixXd unlocked(p.K.rows(), 0);
  const ModesOptions options = sparse(9);
  const LanczosResult run = find_pairs(op, options, unlocked, 9, 8, 1, 0.0, std::nullopt);
  const Cut cut = choose_cut(run.ritz, 9, 0.0, 1e-8, std::nullopt).value();
  // a second search that keeps the first pair out never finds it: one short of the count
  const LanczosResult blind = find_pairs(op, options, run.vectors.leftCols(1), 8, 8, 1, 0.0, cut.sigma);
  const int found = static_cast<int>((blind.ritz.theta.head(blind.vectors.cols()).array() > 1.0 / cut.sigma).count());
  EXPECT_EQ(count_below(p.K, p.M, cut.sigma), cut.modes);
  EXPECT_EQ(found, cut.modes - 1);
}

TEST(Modes, BandKeepsEverythingBelowIt) {
  const Pencil p = grid(25, 25);
  const std::vector<double> exact = grid_eigenvalues(25, 25);
  for (const int dense_below : {0, 1000}) {
    const double band = std::sqrt(0.5 * (exact[16] + exact[17]));
    const Modes modes = solve_modes(p.K, p.M, none, {.band = band, .dense_below = dense_below});
    const auto expected = std::count_if(exact.begin(), exact.end(), [&](double x) { return x < band * band; });
    ASSERT_EQ(modes.lambda.size(), expected);
    EXPECT_EQ(modes.counted, expected);
    EXPECT_NEAR(modes.next_lambda, exact[static_cast<std::size_t>(expected)], 1e-3 * modes.next_lambda);
  }
}

TEST(Modes, ABandBelowTheFirstModeIsEmptyAndNamesTheFirst) {
  const Pencil p = grid(30, 25);
  const Modes modes = solve_modes(p.K, p.M, none, {.band = 1e-3, .dense_below = 0});
  EXPECT_EQ(modes.lambda.size(), 0);
  EXPECT_NEAR(modes.next_lambda, grid_eigenvalues(30, 25)[0], 1e-12);
}

TEST(Modes, MasslessDofsAreCondensedAsGuyanDoes) {
  // every second mass of the chain is zero: exact condensation gives the finite pencil
  const int n = 101;
  std::vector<double> masses(n, 1.0), springs(n + 1);
  for (int i = 0; i <= n; ++i) springs[static_cast<std::size_t>(i)] = 1.0 + 0.3 * std::sin(i);
  std::vector<int> massive, massless;
  for (int i = 0; i < n; ++i) {
    if (i % 2 == 0) masses[static_cast<std::size_t>(i)] = 0.0;
    (i % 2 == 0 ? massless : massive).push_back(i);
  }
  const Pencil p = chain(springs, masses);
  const Eigen::MatrixXd K = dense_matrix(p.K);
  const Eigen::MatrixXd condensed =
      K(massive, massive) - K(massive, massless) * K(massless, massless).llt().solve(K(massless, massive));
  const Eigen::VectorXd exact = Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(condensed).eigenvalues();
  const Modes few = solve_modes(p.K, p.M, none, sparse(10));
  for (int k = 0; k < 10; ++k) EXPECT_NEAR(few.lambda[k], exact[k], 1e-12);
  const Modes all = solve_modes(p.K, p.M, none, {.count = n});  // more than there are: the finite ones
  ASSERT_EQ(all.lambda.size(), 50);
  EXPECT_EQ(all.next_lambda, 0.0);
  for (int k = 0; k < 50; ++k) EXPECT_NEAR(all.lambda[k], exact[k], 1e-12);
}

TEST(Modes, AllFiniteModesOfASparseProblemEndTheSearch) {
  // 400 dofs, 12 with mass: the Krylov space is exhausted after 12 finite modes
  std::vector<double> masses(400, 0.0);
  for (std::size_t i = 0; i < 12; ++i) masses[20 + 30 * i] = 2.0;
  const Pencil p = chain(std::vector<double>(401, 5.0), masses);
  const Modes modes = solve_modes(p.K, p.M, none, sparse(40));
  EXPECT_EQ(modes.lambda.size(), 12);
  EXPECT_EQ(modes.counted, 12);
  EXPECT_EQ(modes.next_lambda, 0.0);
}

TEST(Modes, StiffnessRatioOf1e12) {
  // ground –1e12– m –1– m: λ of the soft end is k/m (1 − 1e-12 + …), of the stiff one 1e12 (1 + 1e-12)
  const Pencil p = chain({1e12, 1.0, 0.0}, {1.0, 1.0});
  const Modes modes = solve_modes(p.K, p.M, none, {.count = 2});
  EXPECT_NEAR(modes.lambda[0], 1.0 - 1e-12, 1e-11);
  EXPECT_NEAR(modes.lambda[1] / 1e12, 1.0 + 1e-12, 1e-11);
}

// A free chain of springs of 1/3 in 13 digits, 0.3333333333333 and 0.6666666666667: each mass is held by 1e-13 that is
// rounding, 4e-6 of the lowest λ, and the rigid motion, taken as one, leaves a residual that K x in all digits would
// not.
TEST(Modes, NumbersOfThirteenDigits) {
  const int n = 8000;
  std::vector<Eigen::Triplet<double>> entries;
  for (int i = 0; i < n; ++i) {
    entries.emplace_back(i, i, i == 0 || i == n - 1 ? 0.3333333333333 : 0.6666666666667);
    if (i > 0) entries.emplace_back(i, i - 1, -0.3333333333333);
  }
  fem::SparseMatrix K(n, n), M(n, n);
  K.setFromTriplets(entries.begin(), entries.end());
  M.setIdentity();
  const Modes modes = solve_modes(K, M, Eigen::MatrixXd::Ones(n, 1), {.count = 5, .progress = {}});
  EXPECT_EQ(modes.rigid, 1);
  EXPECT_GT(modes.max_residual, ModesOptions().residual_limit);
  for (int j = 1; j < 5; ++j) {
    const double s = std::sin(j * std::numbers::pi / (2.0 * n));
    EXPECT_NEAR(modes.lambda[j] / (4.0 / 3.0 * s * s + 1e-13), 1.0, 1e-7) << j;
  }
}

TEST(Modes, CountBelowRefusesAShiftOnAnEigenvalue) {
  const Pencil p = uniform_chain(50, 1.0, 1.0, true, true);
  const double s = std::sin(3.0 * std::numbers::pi / 102.0), lambda = 4.0 * s * s;
  EXPECT_EQ(count_below(p.K, p.M, lambda * (1.0 + 1e-6)), 3);
  EXPECT_EQ(count_below(p.K, p.M, lambda * (1.0 - 1e-6)), 2);
  EXPECT_EQ(count_below(p.K, p.M, -1.0), 0);
  EXPECT_THROW(count_below(p.K, p.M, lambda), NumericalError);
}

TEST(Modes, AMotionWithoutStiffnessOrMassIsRefused) {
  const Pencil p = chain({1.0, 1.0, 0.0, 0.0}, {1.0, 1.0, 0.0});  // the third dof hangs in the air
  EXPECT_THROW(solve_modes(p.K, p.M, none, {.count = 1}), Error);
  Eigen::MatrixXd candidate = Eigen::MatrixXd::Zero(3, 1);
  candidate(2, 0) = 1.0;
  EXPECT_THAT(refusal([&] { solve_modes(p.K, p.M, candidate, {.count = 1}); }),
              HasSubstr("a rigid motion of the structure, of row 2 most, carries no mass"));
}

// A membrane's or a truss's dofs across it: masses of their own that nothing holds, between those of a chain.
TEST(Modes, MassesThatNothingHoldsAreZeroModes) {
  constexpr int n = 84;
  const Pencil chain = uniform_chain(n, 3e9, 0.5, true, false);
  std::vector<Eigen::Triplet<double>> k, m;
  for (int j = 0; j < n; ++j)
    for (fem::SparseMatrix::InnerIterator it(chain.K, j); it; ++it)
      k.emplace_back(2 * static_cast<int>(it.row()), 2 * j, it.value());
  for (int i = 0; i < 2 * n; ++i) m.emplace_back(i, i, 0.5);
  fem::SparseMatrix K(2 * n, 2 * n), M(2 * n, 2 * n);
  K.setFromTriplets(k.begin(), k.end());
  M.setFromTriplets(m.begin(), m.end());
  for (const int dense_below : {0, 600}) {
    ModesOptions options{.count = n + 16};
    options.dense_below = dense_below;
    const Modes modes = solve_modes(K, M, none, options);
    EXPECT_EQ(modes.rigid, n);
    for (int j = 0; j < 16; ++j) {
      const double s = std::sin((2 * j + 1) * std::numbers::pi / (2.0 * (2 * n + 1)));
      EXPECT_NEAR(modes.lambda[n + j] / (4.0 * 6e9 * s * s), 1.0, 1e-11) << j;
    }
  }
}

// A mass at the end of an arm on a spring, free to turn: the spring carries m − m² e² / (J + m e²) = m J / (J + m e²).
TEST(Modes, AnArmThatNothingTurnsTakesMassAway) {
  const Pencil p{lower(2, {{0, 0, 1000.0}}), lower(2, {{0, 0, 2.0}, {1, 0, 2.0 * 0.1}, {1, 1, 0.01 + 2.0 * 0.01}})};
  const Modes modes = solve_modes(p.K, p.M, none, {.count = 2});
  EXPECT_EQ(modes.rigid, 1);
  EXPECT_NEAR(modes.lambda[1], 1000.0 / (2.0 * 0.01 / 0.03), 1e-8);
}

// Two chains joined by a spring of −c to the ground: a mode that decays by e^−κ a mass to both sides, 2 cosh κ = √(4 +
// c²) and λ = 2 − √(4 + c²) of a long chain.
TEST(Modes, ANegativeSpringIsRefusedByName) {
  constexpr int n = 201, middle = 100;
  Pencil p = uniform_chain(n, 1.0, 1.0, true, true);
  p.K.coeffRef(middle, middle) -= 1.0;
  for (const int dense_below : {0, 600}) {
    ModesOptions options{.count = 4, .dense_below = dense_below};
    try {
      solve_modes(p.K, p.M, none, options);
      ADD_FAILURE() << dense_below;
    } catch (const NumericalError& error) {
      EXPECT_THAT(error.what(), HasSubstr("a motion x, of row 100 most"));
      EXPECT_LT(error.figure(), -0.01) << "a Rayleigh quotient, so from above";
      EXPECT_GE(error.figure(), 2.0 - std::sqrt(5.0));
    }
    options.row_name = [](int row) { return fmt::format("mass {}", row + 1); };
    EXPECT_THAT(refusal([&] { solve_modes(p.K, p.M, none, options); }), HasSubstr("of mass 101 most"));
  }
}

// A massless dof on a negative spring: no shift makes K + sM positive, and the message says where.
TEST(Modes, ANegativeSpringWithoutMassIsRefusedByName) {
  const Pencil p = chain({1.0, 1.0, 1.0, -3.0}, {1.0, 1.0, 0.0});
  const auto name = [](int row) { return fmt::format("mass {}", row + 1); };
  EXPECT_THAT(refusal([&] { solve_modes(p.K, p.M, none, {.count = 1, .row_name = name}); }), HasSubstr("of mass 3"));
  EXPECT_THAT(refusal([&] { dense_modes(dense_matrix(p.K), dense_matrix(p.M), 1.0, 1, none, name); }),
              HasSubstr("of mass 3"));
}

TEST(Modes, MatricesUnderWayAreRefused) {
  fem::SparseMatrix K(2, 2), M(2, 2);
  K.insert(0, 0) = K.insert(1, 1) = 1.0;
  M.setIdentity();
  EXPECT_THROW(solve_modes(K, M, none, {.count = 1}), ModelError);
  K.makeCompressed();
  EXPECT_EQ(solve_modes(K, M, none, {.count = 1}).lambda[0], 1.0);
}

TEST(Modes, SizesMustAgree) {
  const Pencil p = grid(3, 3), q = grid(2, 2);
  EXPECT_THROW(solve_modes(p.K, q.M, none, {}), ModelError);
}

TEST(BlockLanczos, TheSameInputGivesTheSameDigits) {
  const Pencil p = grid(28, 22);
  const Modes a = solve_modes(p.K, p.M, none, sparse(12)), b = solve_modes(p.K, p.M, none, sparse(12));
  EXPECT_EQ(a.lambda, b.lambda);
  EXPECT_EQ(a.shapes, b.shapes);
}

TEST(BlockLanczos, DigitsDoNotDependOnTheThreadsThatOthersTake) {
  const Pencil p = grid(28, 22);
  const Modes a = solve_modes(p.K, p.M, none, sparse(12));
  std::atomic<bool> done = false;
  std::thread other([&] {  // as counts do that begin and end beside the search
    while (!done) {
      const ThreadLimit limit;
      std::this_thread::yield();
    }
  });
  int equal = 0;
  for (int run = 0; run < 8; ++run) {
    const Modes b = solve_modes(p.K, p.M, none, sparse(12));
    equal += a.lambda == b.lambda && a.shapes == b.shapes;
  }
  done = true;
  other.join();
  EXPECT_EQ(equal, 8);
}

TEST(BlockLanczos, RestartsKeepTheRelation) {
  // a basis of 40 columns for 12 modes of a long chain: many restarts, the same values
  const Pencil p = uniform_chain(2000, 1.0, 1.0, true, true);
  const ShiftedFactor at = choose_shift(p.K, p.M, Eigen::MatrixXd(p.K.rows(), 0));
  const ShiftInvert op(at.factor, p.M);
  const Eigen::MatrixXd unlocked(p.K.rows(), 0);
  const LanczosOptions options{.wanted = 12, .block = 4, .max_basis = 30};
  const LanczosResult run = block_lanczos(
      op, options, unlocked,
      [](const RitzValues& r) {
        if (r.theta.size() < 12) return false;
        return (r.residual.head(12).array() <= 1e-12 * r.theta[0]).all();
      },
      [](const RitzValues&) { return 12; });
  ASSERT_TRUE(run.converged);
  EXPECT_GT(run.steps, 8);  // 8 blocks of 4 do not fit: it has restarted
  for (int k = 0; k < 12; ++k) {
    const double s = std::sin((k + 1) * std::numbers::pi / 4002.0);
    EXPECT_NEAR(run.ritz.theta[k] * 4.0 * s * s, 1.0, 1e-10);
  }
}
