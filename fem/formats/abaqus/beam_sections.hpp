#pragma once

#include <optional>

#include "fem/formats/abaqus/draft.hpp"

namespace tenon::fem::abaqus {

/// What *BEAM SECTION or *BEAM GENERAL SECTION says of its elements.
struct DraftBeamSection {
  BeamSection section;
  Vec3 n1{0.0, 0.0, -1.0};           ///< first direction of the section
  bool one_number = false;           ///< a circle given by one number
  double offset_2 = 0.0;             ///< of the centroid from the nodes, along n2 = t × n1
  std::optional<Material> material;  ///< of a general section, which names none
  std::string unread;                ///< why the shape has no constants here; else ""
};

/// @param nu  of the material, for Cowper's shear coefficients  @throws InputError at the field that makes no section
DraftBeamSection beam_section(const Block& block, double nu);

}  // namespace tenon::fem::abaqus
