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
Mat6 shift_inertia(const Mat6& P, const Vec3& l);

/// s of an inertia about a reference, D = [m, −s̃; s̃, J]: mass times the place of its centre [kg m].
inline Vec3 first_moment(const Mat6& D) { return {D(5, 1), D(3, 2), D(4, 0)}; }

/// R P Rᵀ of a symmetric P, block by block.
Mat6 rotate_inertia(const Mat6& P, const Mat3& R);

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
