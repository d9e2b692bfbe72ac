#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "fem/error.hpp"
#include "reduction/reduce.hpp"
#include "tests/unit/reduction/beams.hpp"

using namespace tenon;
using namespace tenon::reduction;
using namespace tenon::tests;

namespace {

constexpr Basis every_basis[] = {Basis::craig_bampton, Basis::craig_bampton_inertia_relief, Basis::clamped_free,
                                 Basis::clamped_free_static, Basis::rubin};

// An L-shaped frame with three ports, a mass beside its axis and no symmetry.
fem::Structure frame(int elements, fem::BeamMass mass = fem::BeamMass::consistent) {
  BeamData data;
  data.elements = elements;
  data.mass = mass;
  fem::Model model = beam(data, {{"P", 0}, {"C1", elements / 2}, {"C2", elements}});
  for (int k = elements / 2 + 1; k <= elements; ++k) {
    const double along = data.length * (k - elements / 2) / elements;
    model.nodes[static_cast<std::size_t>(k)] =
        model.nodes[static_cast<std::size_t>(elements / 2)] + along * fem::Vec3(0.3, 0.1, 0.9).normalized();
  }
  model.elements.emplace_back(fem::PointMass{.node = elements - 2, .mass = 0.4, .offset = {0.0, 0.2, 0.1}, .id = 500});
  return fem::assemble(model);
}

Eigen::MatrixXd full(const fem::SparseMatrix& A) {
  const Eigen::MatrixXd lower = A;
  return lower.selfadjointView<Eigen::Lower>();
}

// motion of port `to` per wrench at port `from` of the unreduced structure, free, at ω
Eigen::MatrixXd receptance(const fem::Structure& s, int to, int from, double omega) {
  const auto port = [&](int p) {
    Eigen::MatrixXd B = Eigen::MatrixXd::Zero(s.n(), 6);
    for (int d = 0; d < 6; ++d) B(s.dofs.row({s.ports[static_cast<std::size_t>(p)].node, d}), d) = 1.0;
    return B;
  };
  return port(to).transpose() * (full(s.K) - omega * omega * full(s.M)).partialPivLu().solve(port(from));
}

// the worst relative difference of a body's receptances from the structure's, all pairs of ports, weighed by diag
double worst_error(const fem::Structure& s, const ReducedBody& body, double omega) {
  double worst = 0.0;
  for (int to = 0; to < 3; ++to)
    for (int from = 0; from < 3; ++from) {
      const Eigen::MatrixXd exact = receptance(s, to, from, omega);
      const Eigen::MatrixXd found = tests::receptance(body, to, from, omega);
      worst = std::max(worst, (found - exact).norm() / exact.norm());
    }
  return worst;
}

}  // namespace

// With every mode kept all five bases span the whole space. The rounding of K and M, 1e-16 λ_max/ω², leaves 1e-8.
TEST(Bases, AllModesReproduceTheStructure) {
  const fem::Structure s = frame(8);
  for (const Basis basis : every_basis) {
    const ReducedBody body = reduce(s, "P", {.basis = basis, .all_modes = true});
    EXPECT_EQ(body.n(), s.n() - 6) << body.certificate.basis;
    for (const double omega : {20.0, 700.0}) EXPECT_LT(worst_error(s, body, omega), 1e-7) << body.certificate.basis;
  }
}

// Truncated, every basis with static shapes converges fast at low frequency; hung by another port it is the same body.
TEST(Bases, ConvergeAndMayBeHungByAnyPort) {
  const fem::Structure s = frame(16);
  for (const Basis basis : every_basis) {
    const ReducedBody few = reduce(s, "P", {.basis = basis, .modes = 6}),
                      many = reduce(s, "P", {.basis = basis, .modes = 36});
    const double coarse = worst_error(s, few, 100.0), fine = worst_error(s, many, 100.0);
    EXPECT_LT(fine, basis == Basis::clamped_free ? 0.5 * coarse : 0.1 * coarse) << few.certificate.basis;
    if (basis != Basis::clamped_free) {
      EXPECT_LT(fine, 1e-4) << many.certificate.basis;
    }
    const ReducedBody moved = rebase(few, 2);
    EXPECT_NO_THROW(check(moved));
    for (int to = 0; to < 3; ++to)
      EXPECT_LT((tests::receptance(moved, to, 1, 100.0) - tests::receptance(few, to, 1, 100.0)).norm(),
                1e-8 * tests::receptance(few, to, 1, 100.0).norm());
  }
}

// Static responses between the ports are exact whatever the modes, but for the basis that has none.
TEST(Bases, StaticFlexibilityIsExact) {
  const fem::Structure s = frame(16);
  const Eigen::MatrixXd K = full(s.K);
  const int n = s.n();
  std::vector<int> rows, ports;
  for (int row = 0; row < n; ++row)
    if (s.dofs.free[static_cast<std::size_t>(row)].node != 0) rows.push_back(row);
  Eigen::MatrixXd B = Eigen::MatrixXd::Zero(n, 12);
  for (int p = 1; p < 3; ++p)
    for (int d = 0; d < 6; ++d) B(s.dofs.row({s.ports[static_cast<std::size_t>(p)].node, d}), 6 * (p - 1) + d) = 1.0;
  const Eigen::MatrixXd held = B(rows, Eigen::all);
  const Eigen::MatrixXd exact = held.transpose() * K(rows, rows).ldlt().solve(held);
  for (const Basis basis : every_basis)
    for (const int modes : {0, 7}) {
      if (basis == Basis::clamped_free) continue;
      const ReducedBody body = reduce(s, "P", {.basis = basis, .modes = modes});
      Eigen::MatrixXd Phi(12, body.n());
      Phi << body.ports[1].Phi, body.ports[2].Phi;
      const Eigen::MatrixXd F = Phi * body.omega.cwiseAbs2().cwiseInverse().asDiagonal() * Phi.transpose();
      EXPECT_LT((F - exact).norm(), 1e-9 * exact.norm()) << body.certificate.basis;
    }
}

// The free body's first frequencies fall to the structure's as inertia relief and modes are added; a Ritz value is
// never below.
TEST(Bases, InertiaReliefNeverHurts) {
  const fem::Structure s = frame(16);
  const Modes exact = solve_modes(s, {.count = 12});
  ASSERT_EQ(exact.rigid, 6);
  const auto flexible = [&](Basis basis) {
    const ReducedBody body = reduce(s, "P", {.basis = basis, .modes = 8});
    return Eigen::VectorXd(frequencies(body, {}).segment(6, 6));
  };
  const Eigen::VectorXd plain = flexible(Basis::craig_bampton), relief = flexible(Basis::craig_bampton_inertia_relief),
                        rubin = flexible(Basis::rubin);
  for (int k = 0; k < 6; ++k) {
    const double omega = std::sqrt(exact.lambda[6 + k]);
    EXPECT_GT(relief[k], omega * (1.0 - 1e-8));
    EXPECT_LT(relief[k], plain[k] * (1.0 + 1e-8));
    EXPECT_NEAR(rubin[k], omega, 1e-7 * omega) << "free-free modes are in the basis";
  }
}
