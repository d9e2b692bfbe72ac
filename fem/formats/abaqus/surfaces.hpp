#pragma once

#include <map>
#include <string>

#include "fem/formats/abaqus/draft.hpp"

namespace tenon::fem::abaqus {

/// The nodes of a *SURFACE, a list or sides of shells, and their weights in *DISTRIBUTING: as listed, or ∫ N dA [m²].
struct Surface {
  std::map<int, double> weights;
  bool weighed = true;  ///< whether all weights are known: of elements of first order
};

/// @param asker  the block that names it, for messages and the scope of the name
/// Throws InputError for surfaces that are missing or stand twice, sides other than SPOS and SNEG, and weights ≤ 0.
/// Source: *SURFACE and *COUPLING in the keywords manuals of Abaqus.
Surface read_surface(const Draft& draft, const Block& asker, const std::string& name);

}  // namespace tenon::fem::abaqus
