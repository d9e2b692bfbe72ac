#pragma once

#include <string>

#include "fem/model.hpp"

namespace tenon::assembly {

/// Powers of length, mass and time.
struct Dimension {
  int length = 0, mass = 0, time = 0;
};

namespace dimension {
inline constexpr Dimension none{}, length{1, 0, 0}, area{2, 0, 0}, second_moment{4, 0, 0}, mass{0, 1, 0},
    inertia{2, 1, 0}, density{-3, 1, 0}, pressure{-1, 1, -2}, mass_per_length{-1, 1, 0}, mass_per_area{-2, 1, 0},
    acceleration{1, 0, -2}, torque{2, 1, -2}, rotary_damping{2, 1, -1}, time{0, 0, 1};
}

/// A consistent system of units: how much of the SI unit one of its units is.
struct Units {
  double length = 1.0;  ///< [m]
  double mass = 1.0;    ///< [kg]
  double time = 1.0;    ///< [s]
  std::string name = "SI";

  /// Factor that takes a quantity of these units to SI.
  double to_si(const Dimension& dimension) const;
};

/// The model in SI, given that every number of it stands in `units` (decks of Nastran and the like).
fem::Model to_si(fem::Model model, const Units& units);

}  // namespace tenon::assembly
