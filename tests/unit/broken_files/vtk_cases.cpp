#include <algorithm>
#include <bit>
#include <cstdint>
#include <cstring>
#include <initializer_list>

#include "fem/formats/read_vtk.hpp"
#include "tests/unit/broken_files/broken.hpp"

namespace tenon::broken {
namespace {

const std::string old_text = R"(# vtk DataFile Version 4.2
two lines
ASCII
DATASET UNSTRUCTURED_GRID
POINTS 3 double
0 0 0
1 0 0
2 0 0
CELLS 2 6
2 0 1
2 1 2
CELL_TYPES 2
3
3
CELL_DATA 2
SCALARS part int 1
LOOKUP_TABLE default
5
6
POINT_DATA 3
VECTORS u double
0 0 1
0 0 2
0 0 3
)";

const std::string new_text = R"(# vtk DataFile Version 5.1
two lines
ASCII
DATASET UNSTRUCTURED_GRID
POINTS 3 double
0 0 0
1 0 0
2 0 0
CELLS 3 4
OFFSETS vtktypeint64
0 2 4
CONNECTIVITY vtktypeint64
0 1 1 2
CELL_TYPES 2
3
3
POINT_DATA 3
FIELD FieldData 1
T 1 3 double
7 8 9
)";

struct Change {
  const char *from, *to, *says;
  long line;  ///< of the section at fault
};

constexpr Change both[] = {
    {"# vtk DataFile", "# vtu DataFile", "does not begin with '# vtk DataFile Version x.y'", 1},
    {"ASCII", "TEXT", "found 'TEXT', expected ASCII or BINARY", 3},
    {"UNSTRUCTURED_GRID", "POLYDATA", "found the dataset POLYDATA, expected UNSTRUCTURED_GRID", 4},
    {"DATASET UNSTRUCTURED_GRID\n", "", "found 'POINTS', expected DATASET", 4},
    {"POINTS 3 double", "POINTS 4 double", "in place of value 10", 5},
    {"POINTS 3 double", "POINTS 2 double", "found '2', expected a section of an unstructured grid", 8},
    {"POINTS 3 double", "POINTS -3 double", "found '-3' in 'POINTS', expected a number of points", 5},
    {"POINTS 3 double", "POINTS 999999999999 double", "declares 999999999999: more than the", 5},
    {"POINTS 3 double", "POINTS 99999999999999999999 double", "expected a number of points", 5},
    {"POINTS 3 double", "POINTS 3 quad", "found type 'quad' in 'POINTS'", 5},
    {"POINTS 3 double", "POINTS 3 bit", "found type 'bit' in 'POINTS'", 5},
    {"POINTS 3 double", "POINTS", "found '' in 'POINTS', expected a number of points", 5},
    {"1 0 0\n", "nan 0 0\n", "point 1 is not finite", 5},
    {"1 0 0\n", "inf 0 0\n", "point 1 is not finite", 5},
    {"1 0 0\n", "1e999 0 0\n", "found '1e999' in place of value 4", 5},
    {"POINT_DATA 3", "POINT_DATA 2", "POINT_DATA declares 2 rows, the dataset has 3 points", 0},
    {"POINT_DATA 3", "SPOT_DATA 3", "found 'SPOT_DATA', expected a section", 0},
};

constexpr Change old_ones[] = {
    {"4.2", "9.2", "found version 9.2, expected 1.0 to 5.1", 1},
    {"4.2", "four", "does not begin with", 1},
    {"CELLS 2 6", "CELLS 2 5", "cell 1 of 2 does not fit into the 5 values of CELLS", 9},
    {"CELLS 2 6", "CELLS 1 6", "the 1 cells take 3 values, CELLS declares 6", 9},
    {"CELLS 2 6", "CELLS 3 6", "cell 2 of 3 does not fit", 9},
    {"CELLS 2 6", "CELLS 2 777777", "declares 777777: more than the", 9},
    {"2 0 1\n", "3 0 1\n", "cell 0 ends at 3 after 0, expected 2 nodes of a line", 9},
    {"2 0 1\n", "-2 0 1\n", "cell 0 of 2 does not fit", 9},
    {"2 0 1\n", "2 0 3\n", "cell 0 names point 3 of 3", 9},
    {"2 0 1\n", "2 0 -1\n", "cell 0 names point -1 of 3", 9},
    {"2 0 1\n", "2 0 1.5\n", "found '1.5' in place of value 3", 9},
    {"CELL_TYPES 2\n3\n3\n", "", "the dataset has no CELL_TYPES", 0},
    {"CELL_TYPES 2\n3\n3\n", "CELL_TYPES 1\n3\n", "found 2 offsets and 1 types for 1 cells", 9},
    {"CELL_TYPES 2\n3\n", "CELL_TYPES 2\n5\n", "cell 0 ends at 2 after 0, expected 3 nodes of a triangle", 9},
    {"CELL_TYPES 2\n3\n", "CELL_TYPES 2\n7\n", "cell 0 has VTK's type 7, which is not read", 9},
    {"CELL_TYPES 2\n", "CELLS 2 6\n", "found a second section CELLS", 12},
    {"CELL_DATA 2\n", "", "the array 'part' stands before POINT_DATA or CELL_DATA", 15},
    {"CELL_DATA 2\n", "CELL_DATA 3\n", "CELL_DATA declares 3 rows, the dataset has 2 cells", 15},
    {"LOOKUP_TABLE default\n", "", "SCALARS has no line LOOKUP_TABLE", 0},
    {"part int 1", "part int 0", "the array 'part' declares 0 components", 16},
    {"part int 1", "part int 150", "the array 'part' declares 150 components for 2 cells", 16},
    {"part int 1", "part", "'SCALARS' has no name and type", 16},
    {"VECTORS u double", "VECTORS u", "'VECTORS' has no name and type", 21},
    {"VECTORS u double", "TENSORS u double", "holds 9 values, expected 27", 21},
    {"POINT_DATA 3\n", "POINT_DATA 3\nCOLOR_SCALARS c 5\n", "found 'VECTORS' in place of value 1", 21},
};

constexpr Change new_ones[] = {
    {"OFFSETS vtktypeint64\n0 2 4\n", "", "CELLS has no OFFSETS", 10},
    {"CONNECTIVITY", "NODES", "CELLS has no CONNECTIVITY", 12},
    {"0 2 4", "1 2 4", "OFFSETS begin with 1, expected 0", 12},
    {"0 2 4", "0 3 4", "cell 0 ends at 3 after 0, expected 2 nodes of a line", 9},
    {"0 2 4", "0 2 9", "cell 1 ends at 9 after 2", 9},
    {"0 2 4", "0 4 2", "cell 0 ends at 4 after 0", 9},
    {"CELLS 3 4", "CELLS 2 4", ":11:5: CELLS has no CONNECTIVITY", 0},
    {"CELLS 3 4", "CELLS 3 5", "found 'CELL_TYPES' in place of value 5", 12},
    {"0 1 1 2", "0 1 1 8", "cell 1 names point 8 of 3", 9},
    {"OFFSETS vtktypeint64", "OFFSETS double", "found cells made of reals", 9},
    {"FieldData 1", "FieldData 2", "FIELD declares 2 arrays, found 1", 0},
    {"FieldData 1", "FieldData", "found '' in 'FIELD', expected a number of arrays", 18},
    {"T 1 3 double", "T 1 2 double", "the array 'T' has 2 rows for 3 points", 19},
    {"T 1 3 double", "T 2 3 double", "holds 3 values, expected 6", 19},
    {"T 1 3 double", "T 200 200 double", "'T' declares 200 times 200 values: more than the file holds", 19},
    {"T 1 3 double", "T 1 3 string", "the array 'T' holds 1 texts, expected 3", 19},
    {"T 1 3 double", "my%20T 1 3 double", "", -1},
};

template <std::size_t n>
void add(Family& family, const std::string& text, const std::string& format, const Change (&changes)[n]) {
  for (const Change& c : changes) {
    Case& added = family.cases.emplace_back();
    added.name = format + ": '" + c.from + "' made '" + c.to + "'";
    added.bytes = replaced(text, c.from, c.to);
    added.says = {c.says};
    if (c.line > 0) added.place = std::pair{c.line, 1L};
    added.reads = c.line < 0;
  }
}

/// Big-endian bytes, as binary legacy files have them.
template <class T>
std::string big(std::initializer_list<T> values) {
  std::string out;
  for (const T value : values) {
    std::string raw(sizeof value, '\0');
    std::memcpy(raw.data(), &value, sizeof value);
    if constexpr (std::endian::native == std::endian::little) std::ranges::reverse(raw);
    out += raw;
  }
  return out;
}

const std::string binary_head = "# vtk DataFile Version 4.2\ntwo lines\nBINARY\nDATASET UNSTRUCTURED_GRID\n";

/// The two lines, without data: whole only to its last byte.
std::string binary_text(const std::string& points, const std::string& cells, const std::string& kinds) {
  return binary_head + "POINTS 3 double\n" + points + "\nCELLS 2 6\n" + cells + "\nCELL_TYPES 2\n" + kinds;
}

void add_binary(std::vector<Case>& cases) {
  const std::string x = big<double>({0, 0, 0, 1, 0, 0, 2, 0, 0}), lines = big<std::int32_t>({2, 0, 1, 2, 1, 2}),
                    kinds = big<std::int32_t>({3, 3}), sound = binary_text(x, lines, kinds);
  const auto at = [&](const char* name, const std::string& bytes, const char* says, long line) {
    Case& added = cases.emplace_back();
    added.name = std::string("binary: ") + name;
    added.bytes = bytes;
    added.says = {says};
    if (line > 0) added.place = std::pair{line, 1L};
  };
  cases.push_back({.name = "binary", .bytes = sound, .reads = true});
  cases.push_back({.name = "binary with a line end behind it", .bytes = sound + "\n", .reads = true});
  for (std::size_t size = 1; size < sound.size(); size += 3)
    cases.push_back({"binary: cut after byte " + std::to_string(size), sound.substr(0, size), {"bad.vtk"}});
  // lines are counted by their ends, and none of these numbers holds the byte of one
  at("nan", binary_text(replaced(x, big<double>({1}), "\x7f\xf8" + std::string(6, '\0')), lines, kinds),
     "point 1 is not finite", 5);
  at("reals of half the width", replaced(sound, "3 double", "3 float"), "expected a section of an unstructured grid",
     0);
  at("a point too many", replaced(sound, "POINTS 3", "POINTS 4"), "expected a section of an unstructured grid", 0);
  at("points beyond the file", replaced(sound, "POINTS 3", "POINTS 200"), "needs 600 values of 8 bytes", 5);
  at("a cell of a point that is not there", binary_text(x, big<std::int32_t>({2, 0, 3, 2, 1, 2}), kinds),
     "cell 0 names point 3 of 3", 7);
  at("a negative point", binary_text(x, big<std::int32_t>({2, 0, -1, 2, 1, 2}), kinds), "cell 0 names point -1 of 3",
     7);
  at("a cell of -1 nodes", binary_text(x, big<std::int32_t>({-1, 0, 1, 2, 1, 2}), kinds), "cell 0 of 2 does not fit",
     7);
  at("a cell of 2147483647 nodes", binary_text(x, big<std::int32_t>({2147483647, 0, 1, 2, 1, 2}), kinds),
     "cell 0 of 2 does not fit", 7);
  at("the other byte order of the cells", binary_text(x, big<std::int32_t>({1 << 25, 0, 1 << 24, 2, 1, 2}), kinds),
     "cell 0 of 2 does not fit", 7);
  at("an unknown type", binary_text(x, lines, big<std::int32_t>({3, 99})), "cell 1 has VTK's type 99", 7);
  at("text", replaced(old_text, "ASCII", "BINARY"), "expected a section of an unstructured grid", 0);
}

}  // namespace

Family vtk_cases() {
  Family family{"bad.vtk", [](const std::filesystem::path& file) { fem::read_vtk(file); }, {}};
  family.cases.push_back({.name = "empty", .bytes = "", .says = {"the file is empty"}});
  family.cases.push_back({.name = "blank", .bytes = "\n\n\n", .says = {"does not begin with"}});
  family.cases.push_back(
      {.name = "UTF-16", .bytes = std::string("\xff\xfe#\0 \0", 6), .says = {"does not begin with"}});
  for (const auto& [format, text] : {std::pair{"4.2", old_text}, {"5.1", new_text}}) {
    add(family, text, format, both);
    // A section may end with the file; the dataset is whole from its cell types on.
    std::vector<Case> cuts;
    add_cuts(cuts, format, text, 0);
    const std::size_t whole = text.find("3\n3\n") + 4;
    for (Case& cut : cuts) {
      const std::string last = cut.bytes.substr(cut.bytes.rfind('\n', cut.bytes.size() - 2) + 1);
      cut.reads = cut.bytes.size() == whole || cut.bytes == text || last.starts_with("CELL_DATA") ||
                  last.starts_with("POINT_DATA") || last == "6\n";
      family.cases.push_back(cut);
    }
    family.cases.push_back({.name = "Windows line ends", .bytes = with_windows_ends(text), .reads = true});
  }
  add(family, old_text, "4.2", old_ones);
  add(family, new_text, "5.1", new_ones);
  add_binary(family.cases);
  return family;
}

}  // namespace tenon::broken
