#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>

/// Spatial algebra, linear part first throughout: twist [v; ω], wrench [F; T], dofs [ux uy uz rx ry rz].
/// (The spatial-operator paper is angular first; the permutation that maps its 6-vectors to ours swaps the two halves.)
namespace tenon::fem {

using Vec3 = Eigen::Vector3d;
using Mat3 = Eigen::Matrix3d;
using Vec6 = Eigen::Matrix<double, 6, 1>;
using Mat6 = Eigen::Matrix<double, 6, 6>;
using Mat6X = Eigen::Matrix<double, 6, Eigen::Dynamic>;

/// The cross-product matrix: skew(a) b = a × b.
inline Mat3 skew(const Vec3& a) {
  Mat3 s;
  s << 0.0, -a.z(), a.y(),  //
      a.z(), 0.0, -a.x(),   //
      -a.y(), a.x(), 0.0;
  return s;
}

/// τ_CP = [1 skew(P − C); 0 1]: the twist at C of a rigid body from its twist at P; r = C − P [m]. TITOP paper, eq (1).
/// Its transpose carries a wrench from C to P.
Mat6 tau(const Vec3& r);

/// P^a = blkdiag(R, R): a direction cosine matrix for twists and wrenches.
Mat6 rotation6(const Mat3& R);

/// Rigid mass matrix (6×6, linear first) about a reference point: mass m [kg], c = centre of mass − reference [m],
/// J_c = inertia about the centre of mass [kg m²].
Mat6 rigid_mass(double m, const Vec3& c, const Mat3& J_c);

}  // namespace tenon::fem
