#pragma once

#include <string>
#include <unordered_map>

#include "fem/formats/nastran/draft.hpp"

/// Materials and sections of a deck: MAT1, PBAR, PSHELL.
namespace tenon::fem::nastran {

/// What an element's property number leads to: indices into the model.
struct Property {
  int section = 0;
  int material = 0;
};

struct Properties {
  std::unordered_map<long, Property> bars, shells;  ///< PBAR, PSHELL by PID

  /// The property an element names; throws InputError at the field.
  static const Property& find(const std::unordered_map<long, Property>& properties, const char* kind, const Card& card,
                              int field);
};

/// Appends materials and sections to the draft's model.
Properties read_properties(Draft& draft);

}  // namespace tenon::fem::nastran
