#pragma once

#include <string>

#include "assembly/recursion/sweeps.hpp"

namespace tenon::assembly {

/// b_f += K_G η for bodies that carry geometric stiffening, under the loads of the motion as far as it is known: what
/// velocities and gravity accelerate, and what bodies farther out pull with at the ports. χ̇ is taken as 0, but a tree
/// that floats (free root without springs, not closed to the ground) is accelerated as a whole with its hinges and
/// modes held. Exact in free fall and in steady spin, fixed or afloat; the loads of the χ̇ of hinges and modes are left
/// out. set_state() calls it.
void add_stiffening(const Multibody& system, const Eigen::VectorXd& q, Sweeps& sweeps);

/// After apply_wrench(): K_G η under the wrenches at ports as well, in place of what set_state() added.
void restiffen(const Multibody& system, const Eigen::VectorXd& q, Sweeps& sweeps);

/// The same under the accelerations `v_dot` in place of those that add_stiffening() takes.
void restiffen(const Multibody& system, const Eigen::VectorXd& q, const Eigen::VectorXd& v_dot, Sweeps& sweeps);

/// The body whose spin comes closest to its first frequency, of those without geometric stiffening: where spin softens
/// a model that leaves it out (relative error of the first frequency ~ ½ ratio²).
struct SpinRatio {
  int body = -1;       ///< −1: none has modes
  double ratio = 0.0;  ///< |ω| / ω_1
};
SpinRatio spin_ratio(const Multibody& system, const Sweeps& sweeps);

}  // namespace tenon::assembly
