#include "fem/spatial.hpp"

namespace tenon::fem {

Mat6 tau(const Vec3& r) {
  Mat6 t = Mat6::Identity();
  t.topRightCorner<3, 3>() = -skew(r);
  return t;
}

Mat6 rotation6(const Mat3& R) {
  Mat6 t = Mat6::Zero();
  t.topLeftCorner<3, 3>() = R;
  t.bottomRightCorner<3, 3>() = R;
  return t;
}

Mat6 rigid_mass(double m, const Vec3& c, const Mat3& J_c) {
  Mat6 D;
  const Mat3 s = skew(c);
  D << m * Mat3::Identity(), -m * s, m * s, J_c - m * s * s;
  return D;
}

}  // namespace tenon::fem
