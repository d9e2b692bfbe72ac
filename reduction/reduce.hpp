#pragma once

#include <optional>
#include <string>
#include <vector>

#include "fem/structure.hpp"
#include "reduction/modes.hpp"
#include "reduction/reduced_body.hpp"

namespace tenon::reduction {

enum class Basis {
  craig_bampton,  ///< constraint modes of all ports and fixed-interface modes
  clamped_free    ///< modes clamped at the parent port only, children free: eq (1) without static shapes
};

struct ReduceOptions {
  Basis basis = Basis::craig_bampton;
  int modes = 20;                             ///< kept fixed-interface (or clamped) modes, unless `band` is given
  std::optional<double> band = std::nullopt;  ///< keep every mode below this frequency [rad/s] instead
  bool all_modes = false;                     ///< keep every finite mode
  double zeta = 0.0;                          ///< modal damping ratio
  bool keep_shapes = true;                    ///< node shapes for pictures
  Progress progress = {};
};

/// Reduces a structure with ports to the form of eq (1). `parent` names the port the body hangs by; every port of the
/// structure becomes a port of the body. Throws ModelError when a part has no stiffness path to the parent port (nodes
/// named).
ReducedBody reduce(const fem::Structure& structure, const std::string& parent, const ReduceOptions& options = {});

}  // namespace tenon::reduction
