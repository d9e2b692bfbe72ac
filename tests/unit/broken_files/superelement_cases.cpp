#include <fmt/format.h>

#include <cstdint>
#include <limits>

#include "fem/formats/matrices/op4.hpp"
#include "fem/formats/matrices/superelement.hpp"
#include "tests/unit/broken_files/broken.hpp"
#include "tests/unit/fem/formats/matrices/op4_files.hpp"

/// Nastran's matrices: OP4 files, the .asm beside them, and punched DMIG.
namespace tenon::broken {
namespace {

using fem::testing::Layout;
using fem::testing::op4_ascii;
using fem::testing::op4_binary;
using fem::testing::Op4Kind;

Eigen::MatrixXd two_by_two() { return (Eigen::Matrix2d() << 4.0, -1.5, -1.5, 3.0).finished(); }

struct Op4Change {
  const char *from, *to, *says;  ///< says "": reads
  long line, column;
};

// header; column 1 and its numbers; column 2 and its numbers; the end and its number
constexpr Op4Change of_dense[] = {
    {"       2       2       2       2KXX", "     two       2       2       2KXX", "'two' for the number of columns", 1,
     1},
    {"       2       2       2       2KXX", "       2     2.0       2       2KXX", "'2.0' for the number of rows", 1,
     9},
    {"       2       2       2       2KXX", "       2       2               2KXX", "'' for the form", 1, 17},
    {"       2       2       2       2KXX", "       2       2       2       xKXX", "'x' for the type", 1, 25},
    {"       2       2       2       2KXX", "       2       2       2       3KXX", "matrix 'KXX' is complex", 1, 0},
    {"       2       2       2       2KXX", "       2       2       2       4KXX", "matrix 'KXX' is complex", 1, 0},
    {"       2       2       2       2KXX", "       2       2       2       0KXX", "found the type 0", 1, 0},
    {"       2       2       2       2KXX", "       0       2       2       2KXX", "found the size 2×0", 1, 0},
    {"       2       2       2       2KXX", "      -2       2       2       2KXX", "found the size 2×-2", 1, 0},
    {"       2       2       2       2KXX", "       2       0       2       2KXX", "found the size 0×2", 1, 0},
    {"       2       2       2       2KXX", "       2       1       2       2KXX", "which has 1 rows", 2, 0},
    {"       2       2       2       2KXX", "       1       2       2       2KXX", "found '' for the type", 6, 25},
    {"       2       2       2       2KXX", "       3       2       2       2KXX", "where a column of KXX", 7, 0},
    {"       2       2       2       2KXX", "99999999       2       2       2KXX", "where a column of KXX", 7, 0},
    {"3E23.15", "0E23.15", "found '1P,0E23.15', expected a format", 1, 41},
    {"3E23.15", "3E0.15", "found '1P,3E0.15', expected a format", 1, 41},
    {"3E23.15", "3F23.15", "found '1P,3F23.15', expected a format", 1, 41},
    {"3E23.15", "9999E23.15", "found '1P,9999E23.15', expected a format", 1, 41},
    {"3E23.15", "3E99999999999", "found '1P,3E99999999999', expected a format", 1, 41},
    {"3E23.15", "3E16.9", "a number 16 columns wide", 3, 17},
    {"1P,3E23.15", "", "a number 16 columns wide", 3, 17},
    {"3E23.15", "1E23.15", "behind the last number expected here", 3, 24},
    {"\n       1       1       2\n", "\n       x       1       2\n", "found 'x' for a column", 2, 1},
    {"\n       1       1       2\n", "\n       1       y       2\n", "found 'y' for the first row", 2, 9},
    {"\n       1       1       2\n", "\n       1       1       z\n", "found 'z' for the length of a column", 2, 17},
    {"\n       1       1       2\n", "\n       1       1\n", "found '' for the length of a column", 2, 17},
    {"\n       1       1       2\n", "\n       0       1       2\n", "found column 0 of KXX", 2, 0},
    {"\n       1       1       2\n", "\n      -1       1       2\n", "found column -1 of KXX", 2, 0},
    {"\n       1       1       2\n", "\n       2       1       2\n", "found column 2 of KXX behind column 2", 4, 0},
    {"\n       1       1       2\n", "\n       1       2       2\n", "found 2 numbers from row 2 on in column 1", 2, 0},
    {"\n       1       1       2\n", "\n       1       3       2\n", "found 2 numbers from row 3 on in column 1", 2, 0},
    {"\n       1       1       2\n", "\n       1       1       3\n", "found 3 numbers from row 1 on in column 1", 2, 0},
    {"\n       1       1       2\n", "\n       1       1       0\n", "found 0 numbers from row 1 on in column 1", 2, 0},
    {"\n       1       1       2\n", "\n       1       1      -2\n", "found -2 numbers from row 1 on in column 1", 2,
     0},
    {"\n       1       1       2\n", "\n       1       199999999\n", "found 99999999 numbers from row 1", 2, 0},
    {"\n       1       1       2\n", "\n       1       1       1\n", "behind the last number expected here", 3, 24},
    {"\n       1       1       2\n", "\n       1       0       2\n", "expected the header of a string", 3, 1},
    {"\n       1       1       2\n", "\n       1      -1       2\n", "found numbers from row -1 on", 2, 0},
    {"  4.000000000000000E+00", "                    nan", "found 'nan', expected a number 23 columns wide", 3, 1},
    {"  4.000000000000000E+00", "               Infinity", "found 'Infinity', expected a number", 3, 1},
    {"  4.000000000000000E+00", " 4.000000000000000E+999", "expected a number", 3, 1},
    {"  4.000000000000000E+00", "***********************", "expected a number", 3, 1},
    {"  4.000000000000000E+00", "                       ", "found '', expected a number", 3, 1},
    {"  4.000000000000000E+00", "  4.000000000000000D+00", "", 0, 0},
    {"  4.000000000000000E+00", "  4.000000000000000+000", "", 0, 0},
    {"\n       3       1       1\n", "\n", "for a column", 6, 1},
    {"\n       1       1       2\n", "\n\t1\t1\t2\n", "for a column", 2, 1},
};

void add_op4_text(std::vector<Case>& cases) {
  const std::string text = op4_ascii("KXX", two_by_two());
  cases.push_back({.name = "ascii", .bytes = text, .reads = true});
  cases.push_back({.name = "ascii with Windows line ends", .bytes = with_windows_ends(text), .reads = true});
  cases.push_back({.name = "two matrices", .bytes = text + op4_ascii("MXX", two_by_two()), .reads = true});
  cases.push_back({"text behind the matrix", text + "done\n", {"found 'done' for the number of columns"}, {{8, 1}}});
  cases.push_back({"second matrix cut", text + "       2       2       2       2MXX\n", {"a column of MXX"}, {{8, 0}}});
  cases.push_back({"empty", "", {"the file is empty"}});
  cases.push_back({"blank", "\n\n", {"the file holds no matrix"}});
  cases.push_back({"a deck", "GRID,1,,0.,0.,0.\n", {"found 'GRID,1,,' for the number of columns"}, {{1, 1}}});
  cases.push_back({"zero bytes", std::string(100, '\0'), {"\\x00\\x00", "for the number of columns"}});
  add_cuts(cases, "ascii", text, 1);
  for (const Op4Change& c : of_dense) {
    Case& added = cases.emplace_back();
    added.name = fmt::format("'{}' made '{}'", c.from, c.to);
    added.bytes = replaced(text, c.from, c.to);
    added.says = {c.says};
    added.reads = *c.says == '\0';
    if (!added.reads) added.place = std::pair{c.line, c.column};
  }

  const std::string strings = op4_ascii("KXX", two_by_two(), {.layout = Layout::sparse});  // 5 · 65536 + 1 = 327681
  const auto sparse = [&](const char* fresh, const char* says, long line) {
    cases.push_back(
        {std::string("string '") + fresh + "'", replaced(strings, "      327681", fresh), {says}, {{line, 1}}});
  };
  sparse("      -65535", "found '-65535', expected the header of a string", 3);
  sparse("     327681x", "found '327681x', expected the header of a string", 3);
  sparse("           1", "found a string of 0 words", 3);
  sparse("      393217", "found a string of 6 words where 5 words are left", 3);
  sparse("      262145", "found a string of 4 words where 5 words are left", 3);
  sparse("999999999999", "found a string of", 3);
  cases.push_back(
      {"string from row 0", replaced(strings, "327681", "327680"), {"found numbers from row 0 on"}, {{3, 0}}});
  cases.push_back({"string beyond the rows", replaced(strings, "327681", "327682"), {"which has 2 rows"}, {{3, 0}}});
}

void add_op4_binary(std::vector<Case>& cases) {
  const auto add = [&](const std::string& kind, const std::string& bytes) {
    cases.push_back({.name = kind, .bytes = bytes, .reads = true});
    for (std::size_t size = 1; size < bytes.size(); size += 7)
      cases.push_back({fmt::format("{}: cut after byte {}", kind, size), bytes.substr(0, size), {"bad.op4"}});
  };
  const Eigen::MatrixXd A = two_by_two();
  add("binary", op4_binary("KXX", A));
  add("binary, other byte order", op4_binary("KXX", A, {.foreign = true}));
  add("binary, sparse", op4_binary("KXX", A, {.layout = Layout::sparse}));
  add("binary, big", op4_binary("KXX", A, {.layout = Layout::big}));
  add("binary, words of eight bytes", op4_binary("KXX", A, {.word = 8}));

  const std::string sound = op4_binary("KXX", A);
  const auto word = [&](const std::string& name, std::size_t at, std::int32_t value, const std::string& says) {
    std::string bytes = sound;
    bytes.replace(at, 4, fem::testing::Bytes(false).put(value).text);
    cases.push_back({"binary: " + name, bytes, {says}});
  };
  // record of 24 bytes: [24 | columns, rows, form, type, name | 24], then [28 | 1, 1, 4, two numbers | 28]
  word("negative columns", 4, -2, "found the size 2×-2");
  word("most negative rows", 8, std::numeric_limits<std::int32_t>::min(), "found the size");
  word("complex", 16, 4, "matrix 'KXX' is complex");
  word("another end of the header", 28, 25, "begins with length 24 and ends with 25");
  word("record beyond the file", 32, 1 << 30, "found a record of 1073741824 bytes");
  word("record of negative length", 32, -28, "found a record of -28 bytes");
  word("column 0", 36, 0, "found column 0 of KXX");
  word("row 3", 40, 3, "found 2 numbers from row 3 on");
  word("negative row", 40, -1, "found numbers from row -1 on");
  word("words beyond the record", 44, 1 << 30, "found 1073741824 words announced and 16 bytes present");
  word("negative words", 44, -4, "found -4 words announced");
  word("infinite number", 52, 0x7ff00000, "row 1 of column 1 of KXX is no finite number");
  word("nan", 52, 0x7ff80000, "row 1 of column 1 of KXX is no finite number");
}

const std::string assembly_text =
    "SEBULK,7,EXTOP4,,MANUAL,,,7\nSECONCT        7       0              NO\n"
    "               4    1004     101    2101\nGRID,1004,,1.,2.,3.\nSPOINT,2101\n";

/// Six rows of a grid and one of a scalar point.
std::string seven(const char* name, int rows = 7) {
  return op4_ascii(name, Eigen::VectorXd::LinSpaced(rows, 1.0, 2.0).asDiagonal().toDenseMatrix());
}

Case described(const std::string& name, const std::string& text, std::vector<std::string> says,
               const std::string& matrices = seven("KXX") + seven("MXX")) {
  Case made{.name = name, .bytes = text, .says = std::move(says)};
  made.reads = made.says.empty();
  made.beside = {{"part.op4", matrices}};
  return made;
}

Case changed(const std::string& from, const std::string& to, std::vector<std::string> says) {
  return described("'" + from + "' made '" + to + "'", replaced(assembly_text, from, to), std::move(says));
}

const std::string punch_text =
    "GRID,2,,1.,0.,0.\nGRID,3,,2.,0.,0.\nSPOINT,20\nDMIG,KAAX,0,6,2,0\nDMIG,KAAX,2,1,,2,1,4.\n"
    ",3,3,-4.\nDMIG,KAAX,3,3,,3,3,4.\nDMIG,KAAX,20,0,,20,0,9.\nDMIG,MAAX,0,6,2,0\nDMIG,MAAX,2,1,,2,1,1.5\n"
    "DMIG,MAAX,20,0,,20,0,1.\n";

/// A line of punch_text changed; the error stands in the line and column, where it has one.
Case punched(const std::string& from, const std::string& to, std::vector<std::string> says,
             std::optional<std::pair<long, long>> place = {}) {
  Case made{
      .name = "'" + from + "' made '" + to + "'", .bytes = replaced(punch_text, from, to), .says = std::move(says)};
  made.reads = made.says.empty();
  made.place = place;
  return made;
}

}  // namespace

Family op4_cases() {
  Family family{"bad.op4", [](const std::filesystem::path& file) { fem::read_op4(file); }, {}};
  add_op4_text(family.cases);
  add_op4_binary(family.cases);
  return family;
}

Family superelement_cases() {
  std::string wide;
  for (const char c : assembly_text) wide += {c, '\0'};
  Eigen::MatrixXd skew = Eigen::MatrixXd::Identity(7, 7);
  skew(0, 1) = 0.5;
  const std::string K = seven("KXX"), M = seven("MXX");
  const auto huge = [](const char* name) {
    return replaced(replaced(seven(name), "       7       7", " 9999998 9999998"), "\n       8", "\n 9999999");
  };
  return {
      "part.asm",
      [](const std::filesystem::path& file) { fem::read_nastran_superelement(file.string()); },
      {described("sound", assembly_text, {}),
       described("Windows line ends", with_windows_ends(assembly_text), {}),
       changed("GRID,1004,,1.,2.,3.", "GRID\t1004\t\t1.\t2.\t3.", {}),
       described("empty", "", {"part.asm"}),
       described("comments alone", "$ nothing\n", {"part.asm"}),
       described("UTF-16", "\xFF\xFE" + wide, {"part.asm", "expected text"}),
       changed("4    1004", "4    1005", {"point 1005 of the interface is neither a GRID nor an SPOINT"}),
       changed("     101    2101", "       5    1004", {"point 1004 stands twice in the interface"}),
       changed("     101    2101", "", {"the description gives 6 rows, but KXX of", "has 7"}),
       changed("GRID,1004,,1.,2.,3.", "GRID,1004,,1.,2.,nan", {"part.asm:4", "nan"}),
       changed("GRID,1004,,1.,2.,3.\n", "", {"part.asm"}),
       changed("SPOINT,2101\n", "", {"point 2101 of the interface is neither a GRID nor an SPOINT"}),
       changed("SPOINT,2101", "SPOINT,1,THRU,999999999", {}),
       changed("SPOINT,2101", "SPOINT,2101\nGRID,1004,,5.", {"part.asm:6", "1004"}),
       changed("SECONCT        7       0", "SECONCT        7       8", {"part.asm:2", "connects two superelements"}),
       changed("SEBULK,7,EXTOP4", "SEBULK,7,MIRROR",
               {"part.asm:1", "TYPE MIRROR makes the superelement from another one"}),
       changed("4    1004", "4    THRU", {"part.asm:"}),
       changed("4    1004     101    2101", "4    THRU       5    1004    THRU    1006",
               {"part.asm:3", "two ranges of different length"}),
       changed("4    1004     101    2101", "1    THRU99999999       1    THRU99999999",
               {"names more points than the 7 rows"}),
       changed("4    1004", "x    1004", {"part.asm:", "x"}),
       changed("SPOINT", "EXTRN,4,123456,5,0\nSPOINT", {"SECONCT and EXTRN name different points"}),
       changed("SPOINT", "EXTRN,101,0,4,123456\nSPOINT", {"part.asm:5", "names 4 behind 101"}),
       changed("SPOINT", "EXTRN,4,1289,101,0\nSPOINT", {"part.asm:5", "1289"}),
       changed("SPOINT", "EXTRN,4,12,101,0\nSPOINT", {"the description gives 3 rows, but KXX of"}),
       changed("SPOINT", "CBAR,1,1,1004,1004\nSPOINT", {"CBAR (1 found"}),
       changed("SPOINT", "CONM2,1,1004,,5.\nSPOINT", {"CONM2 (1 found"}),
       changed("SPOINT", "PARAM,CK2,2.\nSPOINT", {"PARAM CK2 (1 found"}),
       changed("SPOINT", "FANCY,1\nSPOINT", {"FANCY"}),
       changed("SPOINT", "INCLUDE 'part.asm'\nSPOINT", {"part.asm:5"}),
       changed("SPOINT", "INCLUDE 'none.asm'\nSPOINT", {"none.asm"}),
       described("matrices empty", assembly_text, {"part.op4: the file is empty"}, ""),
       described("no mass", assembly_text, {"found no matrix MXX; the file has KXX"}, K),
       described("no stiffness", assembly_text, {"found no matrix KXX; the file has MXX"}, M),
       described("two stiffness matrices", assembly_text, {"part.op4: has KXX and KAAX, and which one is meant"},
                 K + seven("KAAX") + M),
       described("a mass matrix twice", assembly_text, {"part.op4: has MXX and MXX, and which one is meant"},
                 K + M + M),
       described("matrices of two sizes", assembly_text, {"KXX is 7×7 and MXX is 6×6"}, K + seven("MXX", 6)),
       described("matrices too small", assembly_text, {"more points than the 1 rows"},
                 seven("KXX", 1) + seven("MXX", 1)),
       described("matrices too large", assembly_text, {"the description gives 7 rows, but KXX of", "has 8"},
                 seven("KXX", 8) + seven("MXX", 8)),
       described("matrices of a size that nothing explains", assembly_text,
                 {"part.op4: KXX has 9999998 rows, more than the grids and entries found account for"},
                 huge("KXX") + huge("MXX")),
       described("stiffness that is not symmetric", assembly_text,
                 {"KXX is not symmetric: node 1004 uy and node 1004 ux have 0 on one side", "0.5"},
                 op4_ascii("KXX", skew) + M),
       described("matrices cut", assembly_text, {"part.op4"}, (K + M).substr(0, K.size() + M.size() / 2))}};
}

Family punch_cases() {
  Family family{
      "bad.pch",
      [](const std::filesystem::path& file) { fem::read_nastran_superelement(file.string()); },
      {{.name = "sound", .bytes = punch_text, .reads = true},
       {.name = "Windows line ends", .bytes = with_windows_ends(punch_text), .reads = true},
       punched("KAAX,0,6", "KAAX,0,2", {"KAAX has the form 2"}, {{4, 13}}),
       punched("KAAX,0,6,2", "KAAX,0,6,4", {"KAAX is complex"}, {{4, 15}}),
       punched("KAAX,0,6,2,0", "KAAX,0,6,2,0,1", {"KAAX is complex"}, {{4, 15}}),
       punched("KAAX,0,6,2", "KAAX,0,x,2", {"'x'"}, {{4, 13}}),
       punched("DMIG,KAAX,0,6,2,0\n", "", {"KAAX has no header ahead of this column"}, {{4, 6}}),
       punched("DMIG,KAAX,0,6,2,0\n", "DMIG,KAAX,0,6,2,0\nDMIG,KAAX,0,6,2,0\n", {"KAAX stands twice"}, {{5, 6}}),
       punched("DMIG,KAAX,0", "DMIG,,0", {"field NAME"}, {}),
       punched("DMIG,MAAX,0,6,2,0\nDMIG,MAAX,2,1,,2,1,1.5\nDMIG,MAAX,20,0,,20,0,1.\n", "",
               {"found no DMIG M... for the mass matrix; the file has KAAX"}),
       punched("DMIG,MAAX,0", "DMIG,K2,0,6,2,0\nDMIG,MAAX,0", {"could be KAAX or K2"}),
       punched("KAAX,3,3,,3,3", "KAAX,4,3,,3,3", {"names 4, which is neither a GRID nor an SPOINT"}, {{7, 11}}),
       punched("KAAX,3,3,,3,3", "KAAX,3,3,,4,3", {"names 4, which is neither a GRID nor an SPOINT"}, {{7, 16}}),
       punched("KAAX,3,3,,3,3", "KAAX,3,0,,3,3", {"field C is '0'"}, {{7, 13}}),
       punched("KAAX,3,3,,3,3", "KAAX,3,3,,3,7", {"field C is '7'"}, {{7, 18}}),
       punched("KAAX,20,0,,20,0", "KAAX,20,2,,20,0", {"field C is '2'"}, {{8, 14}}),
       punched("KAAX,3,3,,3,3,4.", "KAAX,3,3,,3,3", {"field A is blank"}, {}),
       punched("KAAX,3,3,,3,3,4.", "KAAX,3,3,,3,3,nan", {"field A is 'nan'"}, {{7, 20}}),
       punched("KAAX,3,3,,3,3,4.", "KAAX,3,3,,3,3,1.+999", {"field A is '1.+999'"}, {{7, 20}}),
       punched("KAAX,3,3,,3,3,4.", "KAAX,3,3,,3,3,4.,1.", {"KAAX has an imaginary part"}, {{7, 23}}),
       punched("KAAX,3,3,,3,3,4.", "KAAX,3,3,,3,3,4.,0.", {}),
       punched("KAAX,3,3,,3,3,4.", "KAAX,3,3,,3,3,4.\nDMIG,KAAX,3,3,,3,3,4.",
               {"(node 3 uz, node 3 uz) of KAAX stands twice"}),
       punched("KAAX,3,3,,3,3,4.", "KAAX,3,3,,3,3,4.\n,2,1,-3.", {"KAAX is not symmetric", "-3", "-4"}),
       punched("KAAX,3,3,,3,3,4.", "KAAX,3,3,,3,3,4.\n,2,1,-4.", {}),
       punched("KAAX,3,3,,3,3,4.", "KAAX,3,3,,3,3,4.\n,2,1,-4.\nDMIG,KAAX,3,3,,2,1,-4.", {"stands twice"}),
       punched("KAAX,0,6", "KAAX,0,1", {"KAAX is not symmetric", "-4"}),
       punched("GRID,3,,2.", "GRID,2,,2.", {"bad.pch:2"}),
       punched("GRID,3,,2.", "GRID,3,77,2.", {"bad.pch:2", "77"}),
       punched("GRID,3,,2.,0.,0.", "GRID,3,,2.,0.,0.,77", {"bad.pch:2", "77"}),
       punched("SPOINT,20", "SPOINT,20\nCELAS2,1,5.,2,1", {"CELAS2 (1 found"}),
       punched("SPOINT,20", "SPOINT,20\nPARAM,CM2,2.", {"PARAM CM2 (1 found"}),
       {"empty", "", {"bad.pch"}},
       {"grids alone", "GRID,2\n", {"bad.pch: holds no DMIG, and there is no bad.op4 beside it"}}}};
  for (const Word& number : numbers_of(punch_text, ",")) {
    std::string bytes = punch_text;
    bytes.replace(number.offset, number.text.size(), "oops");
    Case& added = family.cases.emplace_back();
    added.name = fmt::format("a word for the number at {}:{}", number.line, number.column);
    added.bytes = bytes;
    added.says = {"oops"};
    added.reads = (number.line == 4 || number.line == 9) && number.column == 17;  // TOUT, the type in Nastran's memory
  }
  return family;
}

}  // namespace tenon::broken
