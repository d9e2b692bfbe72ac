#pragma once

#include <vector>

#include "assembly/port_algebra.hpp"
#include "assembly/port_tree.hpp"

namespace tenon::assembly {

/// A cut of a loop: the joint that closes it, or a grounded port beyond the first of its piece.
struct Cut {
  int joint = -1;
  PortRef ground;  ///< with joint < 0
};

/// A network cut open to a tree. Its last inputs and outputs are six forces and six accelerations, world axes, at every
/// port of a cut: two ports of a joint (child, then parent), one of a grounded port.
struct OpenLoops {
  Network network;
  std::vector<Cut> cuts;
  std::vector<int> inputs, outputs;  ///< of the closed network, that the open one has: their numbers, in its order
};
OpenLoops open_loops(const Network& network);

/// Closes the loops of a tree's port model as section 2.2 of the TITOP paper does: the wrench that a cut passes is the
/// input, the relative acceleration of its two sides the output; the held channels are inverted, and what is prescribed
/// then is zero. States are confined to the motions that the loops allow, by an orthonormal basis of the null space of
/// the closure rows, so that no integrators of prescribed motion remain.
///
/// A row of zeros on both sides, where neither side of the cut can move (across the plane of a grounded planar
/// mechanism), has no content: the exact zero-padding of a planar model. It is no equation, and left out. A row in
/// which the sides move but never apart (two rigid bars welded at both ends; a planar mechanism that floats in space)
/// is redundant, its reaction indeterminate. Throws NumericalError, naming the channels, for those and for rows that
/// follow from the others.
PortAlgebra close_loops(const Network& network, const OpenLoops& open, const PortTree& tree);

}  // namespace tenon::assembly
