#pragma once

#include <string>

#include "fem/model.hpp"

namespace tenon::assembly {

/// Powers of length, mass, time and force. Force stands by itself: where pounds count both masses and forces, stiffness
/// is lbf/in while density is lbm/in³.
struct Dimension {
  int length = 0, mass = 0, time = 0, force = 0;
};

namespace dimension {
inline constexpr Dimension none{}, length{1, 0, 0}, area{2, 0, 0}, second_moment{4, 0, 0}, mass{0, 1, 0},
    inertia{2, 1, 0}, density{-3, 1, 0}, mass_per_length{-1, 1, 0}, mass_per_area{-2, 1, 0}, acceleration{1, 0, -2},
    time{0, 0, 1}, force{0, 0, 0, 1}, pressure{-2, 0, 0, 1}, torque{1, 0, 0, 1}, rotary_damping{1, 0, 1, 1};
}

/// Takes numbers to SI, rounding once. What is a whole number of units to the SI unit divides by it: 1e-3 is no number
/// of the machine, 1000 is, so that 2 in mm is what 0.002 in m is read as.
struct Factor {
  double times = 1.0, over = 1.0;  ///< one of them 1
  double operator*(double x) const { return x * times / over; }
  fem::Vec3 operator*(const fem::Vec3& x) const { return x * times / over; }
  fem::Mat3 operator*(const fem::Mat3& x) const { return x * times / over; }
};

/// A system of units: how much of the SI unit one of its units is. Consistent unless it has a unit of force of its own.
struct Units {
  double length = 1.0;  ///< [m]
  double mass = 1.0;    ///< [kg]
  double time = 1.0;    ///< [s]
  double force = 0.0;   ///< [N]; 0: mass · length / time²
  std::string name = "SI";

  /// What takes a quantity of these units to SI.
  Factor to_si(const Dimension& dimension) const;
};

/// The model in SI, given that every number of it stands in `units` (decks of Nastran and the like).
fem::Model to_si(fem::Model model, const Units& units);

}  // namespace tenon::assembly
