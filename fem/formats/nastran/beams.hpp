#pragma once

#include "fem/formats/nastran/element_cells.hpp"
#include "fem/formats/nastran/properties.hpp"

namespace tenon::fem::nastran {

/// BAROR, CBAR, BEAMOR, CBEAM.
void read_beams(Draft& draft, const Properties& properties, Register& known, ElementCells& cells);

}  // namespace tenon::fem::nastran
