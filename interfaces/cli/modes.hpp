#pragma once

#include <cmath>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "interfaces/cli/output.hpp"

namespace tenon::cli {

struct ModesCommand {
  std::filesystem::path file, vtu;
  int count = 20;
  std::vector<double> band_hz;
  std::vector<std::string> clamp, allow;
  bool full = false, json = false;

  bool shows(double omega) const {
    return band_hz.empty() || (hertz(omega) >= band_hz[0] && hertz(omega) <= band_hz[1]);
  }
};

inline double omega_of(double lambda) { return std::sqrt(std::max(lambda, 0.0)); }

/// The lowest modes of a structural model: `count`, or all up to the band's top.
reduction::Modes solve(const fem::Structure& structure, const ModesCommand& command, int count,
                       const reduction::Progress& progress);

/// A structural model as it is: a deck, or an FE body alone. `mesh` holds the sets for --clamp.
int modes_of_model(const ModesCommand& command, fem::Model model, const fem::Mesh& mesh);

/// Reduced modes of a scene, beside those of its unreduced assembly with --full.
int modes_of_scene(const ModesCommand& command);

}  // namespace tenon::cli
