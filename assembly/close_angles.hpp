#pragma once

#include "assembly/network.hpp"

namespace tenon::assembly {

/// Finds the angles that follow from the loops (Joint::follows), from those given: gaps and misalignments of the
/// closing joints to round-off, by Gauss-Newton with steps of least norm, so that planar and otherwise overconstrained
/// loops close too. Throws ModelError naming the joint with the widest gap when no configuration near the given one
/// closes it.
Network close_angles(Network network);

}  // namespace tenon::assembly
