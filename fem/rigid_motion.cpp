#include "fem/rigid_motion.hpp"

namespace tenon::fem {

Mat6 shift_inertia(const Mat6& P, const Vec3& l) {
  const Mat3 s = skew(l);
  const Mat3 A = P.topLeftCorner<3, 3>(), B = P.topRightCorner<3, 3>();
  const Mat3 B_x = B - A * s;  // [1 0; l̃ 1] P [1 −l̃; 0 1]
  const Mat3 lower = s * B;
  Mat6 Q;
  Q.topLeftCorner<3, 3>() = A;
  Q.topRightCorner<3, 3>() = B_x;
  Q.bottomLeftCorner<3, 3>() = B_x.transpose();
  Q.bottomRightCorner<3, 3>() = P.bottomRightCorner<3, 3>() + lower + (s * B_x).transpose();
  return Q;
}

Mat6 rotate_inertia(const Mat6& P, const Mat3& R) {
  const auto symmetric = [&](const Mat3& A) {
    const Mat3 RA = R * A;
    Mat3 Q;
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j <= i; ++j) Q(i, j) = Q(j, i) = RA(i, 0) * R(j, 0) + RA(i, 1) * R(j, 1) + RA(i, 2) * R(j, 2);
    return Q;
  };
  Mat6 Q;
  Q.topLeftCorner<3, 3>() = symmetric(P.topLeftCorner<3, 3>());
  const Mat3 RB = R * P.topRightCorner<3, 3>(), B = RB * R.transpose();
  Q.topRightCorner<3, 3>() = B;
  Q.bottomLeftCorner<3, 3>() = B.transpose();
  Q.bottomRightCorner<3, 3>() = symmetric(P.bottomRightCorner<3, 3>());
  return Q;
}

}  // namespace tenon::fem
