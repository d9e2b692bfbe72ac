#include <gtest/gtest.h>

#include "reduction/modes.hpp"
#include "reduction/reduce.hpp"
#include "tests/unit/reduction/beams.hpp"

using namespace tenon;
using namespace tenon::reduction;
using namespace tenon::tests;

namespace {

double relative_difference(const Eigen::MatrixXd& a, const Eigen::MatrixXd& b) { return (a - b).norm() / b.norm(); }

// the same physics: receptances between all ports at a few frequencies
void expect_same_physics(const ReducedBody& a, const ReducedBody& b, double tolerance) {
  ASSERT_EQ(a.ports.size(), b.ports.size());
  for (const double omega : {3.0, 130.0, 900.0})
    for (int to = 0; to < static_cast<int>(a.ports.size()); ++to)
      for (int from = 0; from < static_cast<int>(a.ports.size()); ++from)
        EXPECT_LT(relative_difference(receptance(a, to, from, omega), receptance(b, to, from, omega)), tolerance)
            << to << " from " << from << " at " << omega;
}

}  // namespace

// With every fixed-interface mode kept, Craig-Bampton is a change of coordinates: the free body has the frequencies of
// the unreduced structure. Nastran's bars have no torsional inertia, so M is singular; what Tenon carries of the
// massless shapes errs by (ω/ω_massless)² < 1e-6 · (ω/ω_highest)², below 1e-7 in the first thirty of some sixty.
TEST(FullModel, AllModesReproduceTheStructure) {
  for (const fem::BeamMass mass : {fem::BeamMass::consistent, fem::BeamMass::nastran}) {
    BeamData data;
    data.elements = 10;
    data.mass = mass;
    fem::Model model = beam(data, {{"P", 0}, {"C1", 4}, {"C2", 10}});
    model.elements.emplace_back(fem::PointMass{.node = 7, .mass = 0.2, .offset = fem::Vec3(0.0, 0.3, 0.1), .id = 50});
    const fem::Structure structure = fem::assemble(model);
    const Modes full = solve_modes(structure, {.count = 30});
    ASSERT_EQ(full.rigid, 6);
    const FreeBody f = free_body(reduce(structure, "P", {.all_modes = true}));
    const double s = full.lambda[6];  // M x = μ (K + sM) x, for M of eq (1) may be singular too
    const Eigen::VectorXd mu =
        Eigen::GeneralizedSelfAdjointEigenSolver<Eigen::MatrixXd>(f.M, f.K + s * f.M, Eigen::EigenvaluesOnly)
            .eigenvalues();
    for (int k = 6; k < 30; ++k) {
      const double lambda = 1.0 / mu[mu.size() - 1 - k] - s;
      EXPECT_NEAR(lambda / full.lambda[k], 1.0, mass == fem::BeamMass::consistent ? 1e-8 : 1e-7) << "mode " << k;
    }
  }
}

TEST(FullModel, ThereAndBackIsTheSameBody) {
  const fem::Structure structure = fem::assemble(beam({}, {{"P", 0}, {"C1", 9}, {"C2", 24}}));
  const ReducedBody body = reduce(structure, "P", {.modes = 8, .zeta = 0.01});
  const ReducedBody there = rebase(body, 2), back = rebase(there, 0);
  EXPECT_EQ(there.parent, 2);
  EXPECT_LT((there.reference - structure.nodes[24]).norm(), 1e-15);
  expect_same_physics(there, body, 1e-8);
  expect_same_physics(back, body, 1e-8);
  EXPECT_LT(relative_difference(back.omega, body.omega), 1e-9);
  EXPECT_LT(relative_difference(back.D, body.D), 1e-12);
  EXPECT_LT(relative_difference(back.node_shapes.cwiseAbs(), body.node_shapes.cwiseAbs()), 1e-6);
  EXPECT_NO_THROW(check(there));
  EXPECT_GT((damping(there) - Eigen::MatrixXd(damping(there).diagonal().asDiagonal())).norm(), 1e-3);  // coupled there
  EXPECT_LT(relative_difference(damping(back).cwiseAbs(), damping(body)), 1e-7);
}

TEST(FullModel, RebasingEqualsReducingAtTheOtherPort) {
  BeamData data;
  data.elements = 12;
  const fem::Structure structure = fem::assemble(beam(data, {{"P", 0}, {"C1", 5}, {"C2", 12}}));
  const ReducedBody rebased = rebase(reduce(structure, "P", {.all_modes = true}), 1);
  const ReducedBody direct = reduce(structure, "C1", {.all_modes = true});
  EXPECT_LT(relative_difference(rebased.omega, direct.omega), 1e-8);
  expect_same_physics(rebased, direct, 1e-7);
}

TEST(FullModel, ABandKeepsTheModesBelowIt) {
  const fem::Structure structure = fem::assemble(beam({}, {{"P", 0}, {"C", 24}}));
  const ReducedBody many = reduce(structure, "P", {.modes = 12});
  const double band = many.certificate.valid_below * 0.999;
  const ReducedBody body = reduce(structure, "P", {.band = band});
  EXPECT_EQ(body.n(), many.n());
  EXPECT_EQ(body.certificate.modes_found, body.certificate.modes_counted);
  EXPECT_NEAR(body.certificate.valid_below, many.certificate.valid_below, 1e-3 * many.certificate.valid_below);
}
