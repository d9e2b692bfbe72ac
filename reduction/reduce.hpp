#pragma once

#include <optional>
#include <string>
#include <vector>

#include "fem/structure.hpp"
#include "reduction/modes.hpp"
#include "reduction/reduced_body.hpp"

namespace tenon::reduction {

/// What a body keeps; NUMERICS 3 compares. The number of modes never includes the static shapes.
enum class Basis {
  craig_bampton,                 ///< constraint modes of all ports, fixed-interface modes
  craig_bampton_inertia_relief,  ///< and the static responses to the inertia of rigid motions, up to 6: best from 6
                                 ///< shapes on, exactly quintic for a uniform beam, never worse than the paper's G_pol
  clamped_free,                  ///< modes clamped at the parent port only, children free: no static shapes
  clamped_free_static,           ///< and the residual static responses to wrenches at the children
  rubin  ///< free-free modes, residual inertia-relief attachment modes of all ports: for ports that are mostly free
};

struct ReduceOptions {
  Basis basis = Basis::craig_bampton_inertia_relief;
  int modes = 20;  ///< kept fixed-interface (clamped, free-free) modes, unless `band` is given
  std::optional<double> band = std::nullopt;  ///< keep every mode below this frequency [rad/s] instead
  bool all_modes = false;                     ///< keep every finite mode: inertia relief has nothing to add then
  double zeta = 0.0;                          ///< modal damping ratio
  bool keep_shapes = true;                    ///< node shapes for pictures
  bool nonlinear = false;                     ///< shape integrals, for large motion
  Progress progress = {};
};

/// Reduces a structure with ports to the form of eq (1). `parent` names the port the body hangs by; every port of the
/// structure becomes a port of the body. Throws ModelError when a part has no stiffness path to the parent port (nodes
/// named).
ReducedBody reduce(const fem::Structure& structure, const std::string& parent, const ReduceOptions& options = {});

}  // namespace tenon::reduction
