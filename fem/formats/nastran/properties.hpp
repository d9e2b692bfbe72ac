#pragma once

#include <string>
#include <unordered_map>

#include "fem/formats/nastran/draft.hpp"

/// Materials and sections of a deck: MAT1, MAT8, PBAR, PSHELL, PCOMP.
namespace tenon::fem::nastran {

/// What an element's property number leads to: indices into the model.
struct Property {
  int section = 0;
  int material = 0;
  double offset = 0.0;  ///< of PCOMP: from the reference plane to the middle surface
};

using MaterialIndex = std::unordered_map<long, int>;  ///< MAT1 by MID

struct Properties {
  std::unordered_map<long, Property> bars, shells;  ///< PBAR, PSHELL and PCOMP by PID

  /// The property an element names; throws InputError at the field.
  static const Property& find(const std::unordered_map<long, Property>& properties, const char* kind, const Card& card,
                              int field);
};

/// MAT8 and PCOMP: plies from bottom to top, each in the axes that THETA of the element and of the ply give.
void read_composites(Draft& draft, const MaterialIndex& materials, Properties& properties);

/// Appends materials and sections to the draft's model.
Properties read_properties(Draft& draft);

}  // namespace tenon::fem::nastran
