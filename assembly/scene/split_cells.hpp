#pragma once

#include <array>
#include <span>

#include "fem/mesh.hpp"

namespace tenon::assembly {

/// A first-order cell cut out of a larger one, by the places of its nodes in that one's list.
struct Piece {
  fem::CellType type = fem::CellType::line;
  std::array<int, 4> at{};
};

/// The place after the last node of a quad8: a node to be made in its middle, where its serendipity functions put it,
/// ½ Σ mid-sides − ¼ Σ corners.
inline constexpr int quad8_centre = 8;

/// The first-order lines, triangles and quadrilaterals that a cell becomes: itself when it is one, two of a line3, four
/// of a triangle6, a quad8 or a quad9, in the cell's own sense of rotation. Nothing for others.
std::span<const Piece> pieces_of(fem::CellType type);

}  // namespace tenon::assembly
