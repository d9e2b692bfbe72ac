#pragma once

#include <vector>

#include "fem/formats/nastran/cards.hpp"
#include "fem/model.hpp"

namespace tenon::fem::nastran {

/// How many DIMi the TYPE of a PBARL or PBEAML card has (field 4). @throws InputError for types that are not read
int dimensions_of(const Card& card);

/// A section of that TYPE in the element's axes: y up in the manuals' figures, z to the right. Constants are those of
/// our own shapes (fem/section_shapes.hpp), whose J and κ differ a little from Nastran's closed formulas.
/// @param dim  DIM1, DIM2, …  @throws InputError at the card's field `at` for sizes that make no section
BeamSection named_shape(const Card& card, const std::vector<double>& dim, int at, double nu);

}  // namespace tenon::fem::nastran
