#include <gtest/gtest.h>

#include "fem/spatial.hpp"

using namespace tenon::fem;

TEST(Spatial, TauCarriesATwistAsARigidBodyDoes) {
  const Vec3 v(1.0, -2.0, 0.5), w(0.3, 0.7, -1.1), r(2.0, 3.0, -4.0);
  Vec6 twist;
  twist << v, w;
  const Vec6 at_c = tau(r) * twist;
  EXPECT_LT((at_c.head<3>() - (v + w.cross(r))).norm(), 1e-15 * 20);
  EXPECT_LT((at_c.tail<3>() - w).norm(), 1e-15);
}

TEST(Spatial, TausCompose) {
  const Vec3 a(1.0, 2.0, 3.0), b(-0.5, 0.25, 4.0);
  EXPECT_LT((tau(b) * tau(a) - tau(a + b)).norm(), 1e-15 * 20);
}

TEST(Spatial, RigidMassHasTheKineticEnergyOfTwoPoints) {
  // two masses at ±e about c: inertia known in closed form
  const Vec3 c(0.2, -0.4, 1.0), e(0.0, 0.5, 0.0);
  const double m = 3.0;
  const Mat3 J_c = 2.0 * m * skew(e).transpose() * skew(e);
  Vec6 twist;
  twist << 0.3, 0.1, -0.2, 0.5, -0.6, 0.7;
  double energy = 0.0;
  for (const double s : {-1.0, 1.0}) {
    const Vec3 v = twist.head<3>() + twist.tail<3>().cross(c + s * e);
    energy += 0.5 * m * v.squaredNorm();
  }
  EXPECT_NEAR(0.5 * twist.dot(rigid_mass(2.0 * m, c, J_c) * twist), energy, 1e-14);
}
