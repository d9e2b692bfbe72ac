#pragma once

#include <filesystem>

#include "assembly/scene/units.hpp"
#include "reduction/reduced_body.hpp"

namespace tenon::assembly {

/// A body in SI from Nastran's modes of it (.f06) and its deck, which lies beside it (.bdf, .dat or .nas of the same
/// name), both in `units`. The grid that SPCs hold in all six directions is the parent port, the ASET and BSET grids
/// are the others; a port is named after its grid, "g12". Where several grids are held so, they are one rigid piece
/// and the one of the lowest number is the parent.
/// Throws InputError, ModelError or NumericalError for what cannot be trusted: see fem::read_f06 and
/// reduction::modal_body; displacement frames (CD), in which shapes are printed; a mass that is not the weight
/// generator's.
reduction::ReducedBody read_modal_run(const std::filesystem::path& f06, const Units& units = {});

}  // namespace tenon::assembly
