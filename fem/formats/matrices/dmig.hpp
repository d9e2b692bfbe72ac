#pragma once

#include <string>

#include "fem/formats/matrices/matrix_data.hpp"

namespace tenon::fem {

/// K and M from the DMIG cards (small, large or free field) of a bulk data file that holds their GRIDs, coordinate
/// systems and SPOINTs too: rows in rising order of grid and component, turned from the displacement frames to the
/// basic one. Terms of a symmetric matrix (form 6) stand in either triangle; a square one (form 1) holds both.
/// @param stiffness, mass  the DMIG names; "" takes the only one that begins with K (but not K4) or M
/// Throws InputError at the card or field for complex or rectangular matrices, for terms at grids that are not in the
/// file, whose frames are therefore unknown, and for cards that would add stiffness or mass.
/// Source: DMIG in the Quick Reference Guides of MSC and NX Nastran.
MatrixData read_nastran_dmig(const std::string& file, const std::string& stiffness = "", const std::string& mass = "");

}  // namespace tenon::fem
