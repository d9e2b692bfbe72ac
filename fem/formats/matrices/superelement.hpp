#pragma once

#include <string>

#include "fem/formats/matrices/matrix_data.hpp"

namespace tenon::fem {

/// A Nastran external superelement as EXTSEOUT writes it: the interface description (.asm for the main bulk data or
/// .pch for the part behind BEGIN SUPER) and the .op4 of the same name beside it, whose KXX and MXX (MSC: KAAX, MAAX)
/// are K and M. Without an .op4, the DMIG cards of a .pch.
///
/// Rows: EXTRN of the file, or of the .pch beside an .asm, names them with their components; without one each boundary
/// GRID has six. SECONCT tells which numbers of the assembly they have there; these are the numbers returned. Rows are
/// turned from the displacement frames CD to the basic frame. The set "boundary" holds the grids.
///
/// Throws InputError when the rows described are not those of the matrices, when EXTRN is not in rising order (the
/// matrices are, so rows and numbers could not be matched), and for cards that would add stiffness or mass. Damping,
/// loads and output matrices become losses.
/// Source: EXTSEOUT, EXTRN, SECONCT, SEBULK in the Quick Reference Guides of MSC and NX Nastran.
MatrixData read_nastran_superelement(const std::string& asm_file);

}  // namespace tenon::fem
