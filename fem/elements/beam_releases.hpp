#pragma once

#include <Eigen/Core>

#include "fem/model.hpp"

namespace tenon::fem {

using Mat12 = Eigen::Matrix<double, 12, 12>;

/// A beam with force-free directions at its ends, in the element's axes.
struct Release {
  Mat12 T;  ///< u = T q: what the beam's ends do when its nodes' arms move by q; columns of released directions are 0
  Mat12 K;  ///< T'K T, exact zeros where the releases leave no stiffness
};

/// Condenses the released directions r out of a 12×12 stiffness, one after the other: the force there is zero, so
///   u_r = −K_rr⁻¹ K_rj u_j  and  K ← K − K_·r K_rr⁻¹ K_r· .
/// T leaves rigid motions alone, hence rigid masses too. A direction without stiffness (J = 0) has nothing to release.
/// T'M T is consistent: the kinetic energy of the static shapes of the released beam.
/// @throws ModelError naming element, end and direction when the releases make a mechanism: K_rr fallen below 1e-11 of
///         what it was, where rounding (1e-16 of it) would be read as stiffness in the fifth digit.
/// Source: Guyan, AIAA J. 3 (1965) 380; Przemieniecki, Theory of Matrix Structural Analysis, 1968, §6.6 (releases).
Release release_ends(const Beam& beam, const Mat12& K);

/// T'A T, symmetric for a symmetric A.
Mat12 congruent(const Mat12& A, const Mat12& T);

}  // namespace tenon::fem
