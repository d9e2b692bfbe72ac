#pragma once

#include <cmath>

#include "interfaces/cli/commands.hpp"
#include "interfaces/cli/output.hpp"

namespace tenon::cli {

/// Whether a mode stands in the band asked for.
inline bool shows(const ModesOptions& options, double omega) {
  return options.band_hz.empty() || (hertz(omega) >= options.band_hz[0] && hertz(omega) <= options.band_hz[1]);
}

inline double omega_of(double lambda) { return std::sqrt(std::max(lambda, 0.0)); }

/// The lowest modes of a structural model: `count`, or all up to the band's top.
reduction::Modes solve(const fem::Structure& structure, const ModesOptions& command, int count,
                       const reduction::Progress& progress);

/// An FE body alone, as it is.
int modes_of_model(const ModesOptions& command, fem::Model model);

/// Reduced modes of a scene, beside those of its unreduced assembly with --full.
int modes_of_scene(const ModesOptions& command);

}  // namespace tenon::cli
