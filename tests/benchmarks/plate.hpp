#pragma once

#include "fem/model.hpp"

namespace tenon::benchmarks {

/// A square plate of n×n four-node shells, 6 dofs a node, turned out of every coordinate plane so that no entry of K
/// vanishes; clamped along x = 0 when asked, with ports "root" (middle of that edge) and "tip" (middle of the opposite
/// one) on rigid edges otherwise.
struct Plate {
  int n = 200;
  bool clamped = true;
  bool tilted = true;
};
fem::Model plate_model(const Plate& plate);

}  // namespace tenon::benchmarks
