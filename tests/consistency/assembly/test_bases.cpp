#include <gtest/gtest.h>

#include "assembly/second_order.hpp"
#include "reduction/reduce.hpp"
#include "tests/unit/reduction/beams.hpp"

using namespace tenon;
using reduction::Basis;

namespace {

constexpr Basis every_basis[] = {Basis::craig_bampton, Basis::craig_bampton_inertia_relief, Basis::clamped_free,
                                 Basis::clamped_free_static, Basis::rubin};

}  // namespace

// A clamped beam cut in two, each half by each basis, welded again: the frequencies of the whole. The first half
// carries the second, so it needs static shapes; the second may be clamped-free, which is exact for it.
TEST(Bases, AnyTwoBasesMakeTheSameSystem) {
  tests::BeamData data;
  fem::Model whole = tests::beam(data, {});
  for (int d = 0; d < 6; ++d) whole.supports.push_back({{0, d}});
  const reduction::Modes exact = reduction::solve_modes(fem::assemble(whole), {.count = 6});
  tests::BeamData half = data;
  half.length /= 2.0;
  half.elements /= 2;
  const fem::Structure structure = fem::assemble(tests::beam(half, {{"root", 0}, {"tip", half.elements}}));
  const auto reduced = [&](Basis basis) { return reduction::reduce(structure, "root", {.basis = basis, .modes = 20}); };
  for (const Basis first : every_basis)
    for (const Basis second : every_basis) {
      if (first == Basis::clamped_free) continue;
      assembly::Network network;
      network.bodies = {reduced(first), reduced(second)};
      network.joints = {{.name = "weld", .parent = {0, 1}, .child = {1, 0}}};
      network.ground = {{0, 0}};
      const assembly::SystemModes modes = assembly::modes(assembly::second_order(network));
      ASSERT_EQ(modes.rigid, 0);
      for (int k = 0; k < 6; ++k)
        EXPECT_NEAR(modes.omega[k] / std::sqrt(exact.lambda[k]), 1.0, 1e-5)
            << network.bodies[0].certificate.basis << " and " << network.bodies[1].certificate.basis << ", mode " << k;
    }
}
