#pragma once

#include <array>
#include <cstdint>
#include <string_view>

namespace tenon::fem::med {

/// A kind of cells by MED's name, as VTK numbers it: VTK's node i is MED's node order[i], its own where they are alike.
/// MED turns its solids the other way round.
struct Kind {
  std::string_view name;
  std::int64_t vtk;
  std::size_t nodes;
  std::array<std::uint8_t, 27> order{};

  std::size_t from(std::size_t i) const { return order[1] + order[2] == 0 ? i : order[i]; }
};

constexpr std::array<Kind, 18> kinds{
    {{"PO1", 1, 1},
     {"SE2", 3, 2},
     {"SE3", 21, 3},
     {"TR3", 5, 3},
     {"TR6", 22, 6},
     {"QU4", 9, 4},
     {"QU8", 23, 8},
     {"QU9", 28, 9},
     {"TE4", 10, 4, {0, 2, 1, 3}},
     {"T10", 24, 10, {0, 2, 1, 3, 6, 5, 4, 7, 9, 8}},
     {"PY5", 14, 5, {0, 3, 2, 1, 4}},
     {"P13", 27, 13, {0, 3, 2, 1, 4, 8, 7, 6, 5, 9, 12, 11, 10}},
     {"PE6", 13, 6},  // VTK turns its linear wedge too
     {"P15", 26, 15, {0, 2, 1, 3, 5, 4, 8, 7, 6, 11, 10, 9, 12, 14, 13}},
     {"P18", 32, 18, {0, 2, 1, 3, 5, 4, 8, 7, 6, 11, 10, 9, 12, 14, 13, 17, 16, 15}},
     {"HE8", 12, 8, {0, 3, 2, 1, 4, 7, 6, 5}},
     {"H20", 25, 20, {0, 3, 2, 1, 4, 7, 6, 5, 11, 10, 9, 8, 15, 14, 13, 12, 16, 19, 18, 17}},
     {"H27", 29, 27, {0,  3,  2,  1,  4,  7,  6,  5,  11, 10, 9,  8,  15, 14,
                      13, 12, 16, 19, 18, 17, 21, 23, 24, 22, 20, 25, 26}}}};

}  // namespace tenon::fem::med
