#pragma once

#include <string>

#include "assembly/recursion/sweeps.hpp"

namespace tenon::assembly {

/// b_f += K_G η for bodies that carry geometric stiffening, under the loads of the motion as it is with χ̇ = 0: the
/// accelerations that velocities and gravity make, and what bodies farther out pull with at the ports. Exact in steady
/// spin; the loads of χ̇ itself are left out. set_state() calls it.
void add_stiffening(const Multibody& system, const Eigen::VectorXd& q, Sweeps& sweeps);

/// The body whose spin comes closest to its first frequency, of those without geometric stiffening: where spin softens
/// a model that leaves it out (relative error of the first frequency ~ ½ ratio²).
struct SpinRatio {
  int body = -1;       ///< −1: none has modes
  double ratio = 0.0;  ///< |ω| / ω_1
};
SpinRatio spin_ratio(const Multibody& system, const Sweeps& sweeps);

}  // namespace tenon::assembly
