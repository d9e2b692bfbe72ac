#include "assembly/scene/split_cells.hpp"

namespace tenon::assembly {

using fem::CellType;

std::span<const Piece> pieces_of(CellType type) {
  static constexpr std::array<Piece, 1> line{{{CellType::line, {0, 1}}}}, triangle{{{CellType::triangle, {0, 1, 2}}}},
      quad{{{CellType::quad, {0, 1, 2, 3}}}};
  static constexpr std::array<Piece, 2> line3{{{CellType::line, {0, 2}}, {CellType::line, {2, 1}}}};
  // mid-sides 3, 4, 5 of 0-1, 1-2, 2-0
  static constexpr std::array<Piece, 4> triangle6{{{CellType::triangle, {0, 3, 5}},
                                                   {CellType::triangle, {3, 1, 4}},
                                                   {CellType::triangle, {5, 4, 2}},
                                                   {CellType::triangle, {3, 4, 5}}}};
  // mid-sides 4 .. 7 of 0-1, 1-2, 2-3, 3-0, centre 8
  static constexpr std::array<Piece, 4> quad9{{{CellType::quad, {0, 4, 8, 7}},
                                               {CellType::quad, {4, 1, 5, 8}},
                                               {CellType::quad, {8, 5, 2, 6}},
                                               {CellType::quad, {7, 8, 6, 3}}}};
  switch (type) {
    case CellType::line:
      return line;
    case CellType::triangle:
      return triangle;
    case CellType::quad:
      return quad;
    case CellType::line3:
      return line3;
    case CellType::triangle6:
      return triangle6;
    case CellType::quad8:
    case CellType::quad9:
      return quad9;
    default:
      return {};
  }
}

}  // namespace tenon::assembly
