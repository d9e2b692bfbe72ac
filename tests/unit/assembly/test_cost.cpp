#include <gtest/gtest.h>

#include "assembly/recursion/cost.hpp"

// Counts of section 8 of the spatial-operator paper, and that what is counted computes the same.
namespace tenon::assembly {
namespace {

// "Over a factor of 3 for 5 modes per body, and over a factor of 7 for 10": 3.68 and 7.27, multiplications and
// additions of bodies k = 1..10 together.
TEST(Cost, PolynomialsGiveThePapersRatios) {
  const auto ratio = [](int modes) {
    return composite_flops(10, modes).total() / articulated_flops(10, modes).total();
  };
  EXPECT_NEAR(ratio(5), 3.68, 5e-3);
  EXPECT_NEAR(ratio(10), 7.27, 5e-3);
}

// One body with no mode, term by term: 90 + 13 + 206 + (1/6 + 3/2 − 2/3) = 310 M, 116 + 13 + 143 + 1 + 0 = 273 A;
// articulated 180 + 49 + 52 = 281 M, 164 + 50 + 42 = 256 A.
TEST(Cost, CountsOfOneBodyByHand) {
  EXPECT_DOUBLE_EQ(composite_flops(1, 0).multiplications, 310.0);
  EXPECT_DOUBLE_EQ(composite_flops(1, 0).additions, 273.0);
  EXPECT_DOUBLE_EQ(articulated_flops(1, 0).multiplications, 281.0);
  EXPECT_DOUBLE_EQ(articulated_flops(1, 0).additions, 256.0);
}

// From eight modes on D_f⁻¹ is had indirectly: 12·64 + 255·8 + 572 = 3380 M in (63).
TEST(Cost, EightModesAreInvertedIndirectly) {
  EXPECT_DOUBLE_EQ(articulated_flops(1, 8).multiplications, 3380.0 + (64.0 + 200.0 + 49.0) + (144.0 + 52.0));
}

TEST(Cost, BothAlgorithmsAccelerateTheChainAlike) {
  const Multibody chain = beam_chain(6, 4);
  EXPECT_EQ(chain.nv, 30);
  MotionState state = rest_state(chain);
  for (Eigen::Index i = 0; i < chain.nv; ++i) state.v[i] = 0.1 * static_cast<double>(i % 7) - 0.3;
  Sweeps sweeps = make_sweeps(chain);
  set_state(chain, state.q, state.v, sweeps);
  const Eigen::VectorXd T = Eigen::VectorXd::LinSpaced(chain.nv, -1.0, 2.0);
  Eigen::VectorXd by_articulated(chain.nv), by_composite(chain.nv);
  Eigen::MatrixXd mass;
  articulate(chain, sweeps);
  forward_dynamics(chain, sweeps, T, by_articulated);
  composite_forward_dynamics(chain, sweeps, T, mass, by_composite);
  EXPECT_LT((by_articulated - by_composite).norm(), 1e-9 * by_composite.norm());  // round-off times the condition
}

}  // namespace
}  // namespace tenon::assembly
