#pragma once

#include "assembly/recursion/multibody.hpp"

/// How far bodies deform in a motion: what taking them as undeformed would leave out.
namespace tenon::assembly {

/// Largest motion of a port of body k by deformation, displacement over the distance of the farthest port from the
/// reference, or rotation [rad]. 0 for bodies without modes.
double deflection(const Multibody& system, std::size_t k, const Eigen::VectorXd& q);

}  // namespace tenon::assembly
