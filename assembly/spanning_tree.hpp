#pragma once

#include <string>
#include <vector>

#include "assembly/network.hpp"

namespace tenon::assembly {

/// A body of a tree and how it hangs. A network's pieces with a grounded port are rooted there, the others at the body
/// that place() starts from.
struct Branch {
  int body = 0;
  int parent = -1;      ///< index of the parent branch, −1: the inertial frame
  int joint = -1;       ///< −1 for roots
  int inner_port = -1;  ///< of the parent body
  int outer_port = -1;  ///< of this body, by which it hangs; the grounded port of a fixed root; −1 for a free root
  bool outward = true;  ///< this body is the joint's child (else its parent)
};

/// Branches, parents before children. Throws ModelError naming the joint that closes a loop, or the second grounded
/// port of a piece, and points to the second-order route; `route` is the name of what needs a tree.
std::vector<Branch> spanning_tree(const Network& network, const Placement& placement, const std::string& route);

}  // namespace tenon::assembly
