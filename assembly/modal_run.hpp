#pragma once

#include <filesystem>

#include "reduction/reduced_body.hpp"

namespace tenon::assembly {

/// A body from Nastran's modes of it (.f06) and its deck, which lies beside it (.bdf, .dat or .nas of the same name).
/// Both in SI. The grid that SPCs hold in all six directions is the parent port, the ASET and BSET grids are the
/// others; a port is named after its grid, "g12".
/// Throws InputError, ModelError or NumericalError for what cannot be trusted: see fem::read_f06 and
/// reduction::modal_body; displacement frames (CD), in which shapes are printed; a mass that is not the weight
/// generator's.
reduction::ReducedBody read_modal_run(const std::filesystem::path& f06);

}  // namespace tenon::assembly
