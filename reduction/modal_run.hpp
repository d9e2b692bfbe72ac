#pragma once

#include <string>
#include <vector>

#include "fem/formats/f06.hpp"
#include "fem/structure.hpp"
#include "reduction/reduced_body.hpp"

namespace tenon::reduction {

/// A body in the form of eq (1) from the modes that another program printed of it, clamped at `parent`:
///   L = ΦᵀMR, D = RᵀMR, M and the rigid motions R of `structure` (parent free, no other support with mass).
/// The printed Φ are made orthonormal, Φ (ΦᵀMΦ)^-½, since digits are missing and D − LᵀL must stay positive; how far
/// they were from it is `certificate.max_orthogonality`. No static shapes of the other ports: as `clamped_free`.
/// @param beside  nodes that the run clamped beside the parent: they follow it as one rigid piece
/// Throws ModelError for shapes that move what is clamped or that lack nodes with mass, links or supports that the
/// shapes do not obey, and NumericalError where |ΦᵀMΦ − m| of the generalized masses m passes 1 %: M of the deck is not
/// that of the run, or too few digits are printed.
ReducedBody modal_body(const fem::Structure& structure, const std::string& parent, const fem::ModalRun& run,
                       const std::vector<int>& beside = {});

}  // namespace tenon::reduction
