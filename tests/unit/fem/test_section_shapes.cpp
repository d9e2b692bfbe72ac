#include <gtest/gtest.h>

#include <cmath>
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

// Rolled sections without fillets: I as the difference of rectangles, parallel-axis theorem by hand.
TEST(SectionShapes, OpenSectionsAreMadeOfRectangles) {
  const BeamSection i = i_section(0.2, 0.1, 0.01, 0.1, 0.01, 0.006);
  EXPECT_NEAR(i.A, 2.0 * 0.1 * 0.01 + 0.18 * 0.006, 1e-16);
  EXPECT_NEAR(i.Iy, (0.1 * 0.008 - 0.094 * 0.18 * 0.18 * 0.18) / 12.0, 1e-17);
  EXPECT_NEAR(i.Iz, (2.0 * 0.01 * 1e-3 + 0.18 * 0.006 * 0.006 * 0.006) / 12.0, 1e-18);
  EXPECT_NEAR(i.J, (2.0 * 0.1 * 1e-6 + 0.18 * 0.006 * 0.006 * 0.006) / 3.0, 1e-18);
  EXPECT_EQ(i.Iyz, 0.0);
  EXPECT_EQ(i.shear_y, 0.0);
  EXPECT_EQ(i.shear_z, 0.0);
  const BeamSection t = tee(0.1, 0.11, 0.01, 0.01);  // flange and web alike: the centroid midway between theirs
  EXPECT_NEAR(t.A, 0.002, 1e-17);
  EXPECT_NEAR(t.Iy, (0.1 * 1e-6 + 0.01 * 1e-3) / 12.0 + 0.002 * 0.0275 * 0.0275, 1e-17);
  EXPECT_NEAR(t.shear_z, 0.0275, 1e-16);  // in the flange
}

// An I with two flanges: its shear centre divides their distance as I₂ : I₁ (Roark, table 9.2).
TEST(SectionShapes, ShearCentreOfAnIWithTwoFlanges) {
  const BeamSection section = i_section(0.2, 0.15, 0.01, 0.05, 0.01, 0.005);
  const double of_bottom = 0.19 * 0.05 * 0.05 * 0.05 / (0.15 * 0.15 * 0.15 + 0.05 * 0.05 * 0.05);  // from its middle
  const double centroid = (0.0015 * 0.005 + 0.0005 * 0.195 + 0.0009 * 0.1) / 0.0029;
  EXPECT_NEAR(section.shear_z, 0.005 + of_bottom - centroid, 1e-15);
  EXPECT_EQ(section.shear_y, 0.0);
}

// A channel's shear centre lies e = 3b²t/(6bt + h t_w) behind the web's middle (Timoshenko, Strength of Materials I,
// §53).
TEST(SectionShapes, ShearCentreOfAChannel) {
  const double b = 0.05, h = 0.1, t = 1e-4;
  const BeamSection section = channel(b + 0.5 * t, h + t, t, t);                   // middle lines of b and h
  const double e = 3.0 * b * b / (6.0 * b + h), centroid = b * b / (2.0 * b + h);  // both from the web's middle line
  EXPECT_NEAR(section.shear_y, -e - centroid, 1e-3 * e);                           // thin wall: O(t/b)
  EXPECT_EQ(section.shear_z, 0.0);
  EXPECT_EQ(section.Iyz, 0.0);
}

// Equal legs of middle lines a: Iyz = −a³t/8, I at 45° a³t/12 and a³t/3 (Roark, table A.1); shear centre in the corner.
TEST(SectionShapes, AnglesHaveAProductOfInertia) {
  const double a = 0.1, t = 1e-5;
  const BeamSection section = angle_section(a, a, t, t);
  EXPECT_NEAR(section.Iyz / (a * a * a * t), -1.0 / 8.0, 1e-3);
  EXPECT_NEAR((section.Iy + section.Iyz) / (a * a * a * t), 5.0 / 24.0 - 1.0 / 8.0, 1e-3);
  EXPECT_NEAR(section.shear_y, -a / 4.0, 1e-4 * a);
  EXPECT_NEAR(section.shear_z, -a / 4.0, 1e-4 * a);
}

TEST(SectionShapes, SizesThatMakeNoSectionAreRefused) {
  EXPECT_THROW(circle(0.0, 0.3), ModelError);
  EXPECT_THROW(tube(0.1, 0.2, 0.3), ModelError);
  EXPECT_THROW(rectangle(0.1, -0.2, 0.3), ModelError);
  EXPECT_THROW(box(0.1, 0.2, 0.05, 0.3), ModelError);
}

}  // namespace
}  // namespace tenon::fem
