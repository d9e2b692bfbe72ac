#pragma once

#include "fem/spatial.hpp"

/// Spatial operators kept as their 3-vector and direction cosines, never as 6×6 matrices.
namespace tenon::fem {

/// φ*(x, y) V: the twist at y of a rigid body from its twist at x; l = y − x [m].
inline Vec6 shift_twist(const Vec6& V, const Vec3& l) {
  Vec6 W = V;
  W.head<3>() += V.tail<3>().cross(l);
  return W;
}

/// φ(x, y) f: the wrench at x of one at y; l = y − x [m].
inline Vec6 shift_wrench(const Vec6& f, const Vec3& l) {
  Vec6 W = f;
  W.tail<3>() += l.cross(f.head<3>());
  return W;
}

/// φ(x, y) P φ*(x, y): a symmetric spatial inertia about x from that about y; l = y − x [m].
inline Mat6 shift_inertia(const Mat6& P, const Vec3& l) {
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

/// s of an inertia about a reference, D = [m, −s̃; s̃, J]: mass times the place of its centre [kg m].
inline Vec3 first_moment(const Mat6& D) { return {D(5, 1), D(3, 2), D(4, 0)}; }

/// R P Rᵀ of a symmetric P, block by block.
inline Mat6 rotate_inertia(const Mat6& P, const Mat3& R) {
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

/// Frame F seen from frame T: columns of R are F's axes in T's, r is F's origin in T's axes [m].
struct RigidMotion {
  Mat3 R = Mat3::Identity();
  Vec3 r = Vec3::Zero();

  /// The twist at F, in F's axes, of a rigid body from its twist at T in T's.
  Vec6 twist(const Vec6& V) const {
    Vec6 W;
    W.head<3>().noalias() = R.transpose() * (V.head<3>() + V.tail<3>().cross(r));
    W.tail<3>().noalias() = R.transpose() * V.tail<3>();
    return W;
  }
  /// The wrench at T, in T's axes, of one at F in F's.
  Vec6 wrench(const Vec6& f) const {
    Vec6 W;
    W.head<3>().noalias() = R * f.head<3>();
    W.tail<3>().noalias() = R * f.tail<3>();
    W.tail<3>() += r.cross(W.head<3>());
    return W;
  }
  /// The spatial inertia about T, in T's axes, of one about F in F's.
  Mat6 inertia(const Mat6& P) const { return shift_inertia(rotate_inertia(P, R), r); }
};

}  // namespace tenon::fem
