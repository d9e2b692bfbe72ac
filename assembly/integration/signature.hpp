#pragma once

#include <string>
#include <vector>

#include "assembly/recursion/multibody.hpp"

/// What a motion state belongs to: enough of a system to tell whether another one is the same.
namespace tenon::assembly {

/// Numbers of one kind: their sum with fixed weights, and the same over their sizes. Round-off leaves it within 1e-7 of
/// the size; other mode shapes of a repeated frequency do not, and modal coordinates mean something else then.
struct Trait {
  std::string of;    ///< "body 'blade'"
  std::string what;  ///< "mass matrix"
  double sum = 0.0, size = 0.0;
};

bool same(const Trait& a, const Trait& b);

struct Signature {
  std::vector<std::string> structure;  ///< names, joints, parents, counts of modes
  std::vector<Trait> traits;           ///< bodies' data, joints, gravity
};

Signature signature(const Multibody& system);

}  // namespace tenon::assembly
