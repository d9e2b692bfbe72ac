#include <gtest/gtest.h>

#include <numbers>

#include "fem/error.hpp"
#include "fem/section_shapes.hpp"

namespace tenon::fem {
namespace {

constexpr double pi = std::numbers::pi;

TEST(SectionShapes, CircleAndTubeHaveTheirClosedForms) {
  const BeamSection solid = circle(0.3, 0.3);
  EXPECT_NEAR(solid.A, pi * 0.09, 1e-15);
  EXPECT_NEAR(solid.Iy, pi * 0.0081 / 4.0, 1e-16);
  EXPECT_NEAR(solid.J, pi * 0.0081 / 2.0, 1e-16);
  EXPECT_NEAR(solid.kappa_y, 7.8 / 8.8, 1e-15);  // Cowper 1966, table 1: 0.886 for ν = 0.3
  const BeamSection hollow = tube(0.3, 0.2, 0.3);
  EXPECT_NEAR(hollow.Iz, pi / 4.0 * (0.0081 - 0.0016), 1e-16);
}

TEST(SectionShapes, TubeIsACircleWithoutAHoleAndAThinRingInTheLimit) {
  EXPECT_NEAR(tube(0.3, 0.0, 0.25).kappa_y, circle(0.3, 0.25).kappa_y, 1e-15);
  EXPECT_NEAR(tube(1.0, 1.0 - 1e-9, 0.3).kappa_y, 2.0 * 1.3 / (4.0 + 3.0 * 0.3), 1e-8);  // Cowper: thin round tube
}

// Timoshenko & Goodier, Theory of Elasticity, art. 109: J = k₁ a b³ for sides a ≥ b.
TEST(SectionShapes, RectangleHasSaintVenantsTorsionConstant) {
  for (const auto& [ratio, k1] : {std::pair(1.0, 0.1406),
                                  {1.2, 0.166},
                                  {1.5, 0.196},
                                  {2.0, 0.229},
                                  {2.5, 0.249},
                                  {3.0, 0.263},
                                  {4.0, 0.281},
                                  {5.0, 0.291},
                                  {10.0, 0.312}})
    EXPECT_NEAR(rectangle(ratio, 1.0, 0.3).J / ratio, k1, 6e-4) << ratio;  // the table's last digit
  EXPECT_NEAR(rectangle(1e6, 1.0, 0.3).J / 1e6, 1.0 / 3.0, 1e-6);
  EXPECT_NEAR(rectangle(2.0, 3.0, 0.3).J, rectangle(3.0, 2.0, 0.3).J, 1e-14);
}

TEST(SectionShapes, RectangleBendsStifferInItsLongDirection) {
  const BeamSection section = rectangle(0.1, 0.2, 0.3);  // b along y, h along z
  EXPECT_NEAR(section.Iy, 0.1 * 0.008 / 12.0, 1e-19);
  EXPECT_NEAR(section.Iz, 0.2 * 0.001 / 12.0, 1e-19);
  EXPECT_NEAR(section.kappa_y, 13.0 / 15.3, 1e-15);  // Cowper: 10(1+ν)/(12+11ν)
}

TEST(SectionShapes, BoxHasTheDifferenceOfTwoRectangles) {
  const BeamSection section = box(0.2, 0.3, 0.01, 0.3);
  EXPECT_NEAR(section.A, 0.06 - 0.18 * 0.28, 1e-16);
  EXPECT_NEAR(section.Iy, (0.2 * 0.027 - 0.18 * 0.28 * 0.28 * 0.28) / 12.0, 1e-17);
  EXPECT_NEAR(section.J, 4.0 * std::pow(0.19 * 0.29, 2) * 0.01 / (2.0 * (0.19 + 0.29)), 1e-16);  // Bredt: 4A²t/s
  EXPECT_NEAR(box(0.1, 0.1, 0.001, 0.3).kappa_y, box(0.1, 0.1, 0.001, 0.3).kappa_z, 1e-15);
  EXPECT_NEAR(box(2e-5, 1.0, 9e-6, 0.3).kappa_z, 13.0 / 15.3, 1e-3);  // no flanges left: two thin webs
}

TEST(SectionShapes, SizesThatMakeNoSectionAreRefused) {
  EXPECT_THROW(circle(0.0, 0.3), ModelError);
  EXPECT_THROW(tube(0.1, 0.2, 0.3), ModelError);
  EXPECT_THROW(rectangle(0.1, -0.2, 0.3), ModelError);
  EXPECT_THROW(box(0.1, 0.2, 0.05, 0.3), ModelError);
}

}  // namespace
}  // namespace tenon::fem
