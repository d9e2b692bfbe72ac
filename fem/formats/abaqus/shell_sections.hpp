#pragma once

#include <optional>
#include <span>
#include <string>

#include "fem/formats/abaqus/draft.hpp"

namespace tenon::fem::abaqus {

/// What *SHELL SECTION says of its elements.
struct DraftShellSection {
  ShellSection section;
  Material material;                  ///< without a part in laminates
  Vec3 material_axis = Vec3::Zero();  ///< direction 1 of laminates, to be projected
  std::optional<Vec3> normal;         ///< of all its elements: the axes of layers are known across it alone
  std::string unread;                 ///< what of it has no counterpart here; else ""
};

/// @throws InputError at the field that makes no section
DraftShellSection shell_section(Draft& draft, const Block& block);

/// Throws InputError, naming the shell, where its normal is not `normal`.
void check_normal(const Model& model, std::span<const int> nodes, const Vec3& normal, const Block& section, long id);

/// Adds a shell of 3, 4, 6, 8 or 9 nodes as triangles and quadrilaterals that are else as `like`. Returns how it was
/// split, "" where it was not.
std::string add_shell(Model& model, std::span<const int> nodes, const Quad4& like);

}  // namespace tenon::fem::abaqus
