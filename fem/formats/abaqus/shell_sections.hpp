#pragma once

#include <span>
#include <string>

#include "fem/formats/abaqus/draft.hpp"

namespace tenon::fem::abaqus {

/// What *SHELL SECTION says of its elements.
struct DraftShellSection {
  ShellSection section;
  Material material;
  std::string unread;  ///< what of it has no counterpart here; else ""
};

/// @throws InputError at the field that makes no section
DraftShellSection shell_section(Draft& draft, const Block& block);

/// Adds a shell of 3, 4, 6, 8 or 9 nodes as triangles and quadrilaterals that are else as `like`. Returns how it was
/// split, "" where it was not.
std::string add_shell(Model& model, std::span<const int> nodes, const Quad4& like);

}  // namespace tenon::fem::abaqus
