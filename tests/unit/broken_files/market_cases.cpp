#include "fem/formats/matrices/labels.hpp"
#include "fem/formats/matrices/matrix_market.hpp"
#include "tests/unit/broken_files/broken.hpp"

namespace tenon::broken {
namespace {

const std::string market_text = R"(%%MatrixMarket matrix coordinate real symmetric
% K of three dofs
3 3 5
1 1 4.0
2 1 -1.5
2 2 3.0
3 2 -1.0
3 3 2.0
)";

const std::string label_text = R"(# rows
7 ux 0 0 0
7 uy
9 3 1 0 0
scalar 100
scalar
set root 7
set both 7 9
)";

struct PlacedChange {
  const char *from, *to, *says;  ///< says "": reads
  long line, column;
};

constexpr PlacedChange of_market[] = {
    {"%%MatrixMarket", "%MatrixMarket", "does not begin with %%MatrixMarket", 1, 1},
    {"%%MatrixMarket", "\xEF\xBB\xBF%%MatrixMarket", "does not begin with %%MatrixMarket", 1, 1},
    {"matrix c", "vector c", "the object is 'vector'", 1, 16},
    {"coordinate", "array", "the format is 'array'", 1, 23},
    {"real", "complex", "the field is 'complex'", 1, 34},
    {"real", "pattern", "the field is 'pattern'", 1, 34},
    {"symmetric", "skew-symmetric", "the symmetry is 'skew-symmetric'", 1, 39},
    {"symmetric", "hermitian", "the symmetry is 'hermitian'", 1, 39},
    {" symmetric", "", "found the end of the line, expected the symmetry", 1, 38},
    {"symmetric", "symmetric lower", "found 'lower', expected the end of the line", 1, 49},
    {"symmetric", "general", "is not symmetric: -1.5 and 0 couple node 7 uy and node 7 ux", 5, 1},
    {"real", "integer", "expected a whole number", 5, 5},
    {"3 3 5", "3 4 5", "3×4 is not square", 3, 3},
    {"3 3 5", "4 4 5", "the matrix has 4 rows and the label file 3", 3, 3},
    {"3 3 5", "2 2 5", "the matrix has 2 rows and the label file 3", 3, 3},
    {"3 3 5", "0 0 5", "found '0', expected the number of rows", 3, 1},
    {"3 3 5", "-3 -3 5", "found '-3', expected the number of rows", 3, 1},
    {"3 3 5", "99999999999 3 5", "found '99999999999', expected the number of rows", 3, 1},
    {"3 3 5", "3 3", "found the end of the line, expected the number of entries", 3, 4},
    {"3 3 5", "3 3 5 1", "found '1', expected the end of the line", 3, 7},
    {"3 3 5", "3 3 -5", "found '-5', expected the number of entries", 3, 5},
    {"3 3 5", "3 3 4", "there is more after the 4 entries", 8, 1},
    {"3 3 5", "3 3 0", "there is more after the 0 entries", 4, 1},
    {"3 3 5", "3 3 6", "the file ends after 5 of 6 entries", 9, 1},
    {"3 3 5", "3 3 9223372036854775807", "the file ends after 5 of 9223372036854775807 entries", 9, 1},
    {"3 3 5", "3 3 99999999999999999999", "expected the number of entries", 3, 5},
    {"3 3 5\n", "", "the matrix has 1 rows and the label file 3", 3, 3},
    {"2 1 -1.5", "4 1 -1.5", "found '4', expected a row (a whole number, 1 to 3)", 5, 1},
    {"2 1 -1.5", "0 1 -1.5", "found '0', expected a row (a whole number, 1 to 3)", 5, 1},
    {"2 1 -1.5", "2 -1 -1.5", "found '-1', expected a column", 5, 3},
    {"2 1 -1.5", "2 1", "found the end of the line, expected a value", 5, 4},
    {"2 1 -1.5", "2 1 -1.5 0.0", "found '0.0', expected the end of the line", 5, 10},
    {"2 1 -1.5", "2 1 nan", "found 'nan', expected a value (a finite number)", 5, 5},
    {"2 1 -1.5", "2 1 -inf", "found '-inf', expected a value (a finite number)", 5, 5},
    {"2 1 -1.5", "2 1 1e999", "found '1e999', expected a value (a finite number)", 5, 5},
    {"2 1 -1.5", "2 1 +-1.5", "found '+-1.5', expected a value", 5, 5},
    {"2 1 -1.5", "2 1 -1,5", "found '-1,5', expected a value", 5, 5},
    {"2 1 -1.5", "2 1 -1.5i", "found '-1.5i', expected a value", 5, 5},
    {"2 1 -1.5", "2, 1, -1.5", "found '2,', expected a row", 5, 1},
    {"2 1 -1.5", "2 2 -1.5", "the entry (2, 2) is given twice", 6, 1},
    {"3 2 -1.0", "1 2 -1.5", "(2, 1) is given twice", 7, 1},
    {"3 2 -1.0", "1 2 -1.5", "A symmetric file holds one triangle", 7, 1},
    {"2 1 -1.5", "1 2 -1.5", "", 0, 0},
    {"2 1 -1.5", "2 1 +1.5", "", 0, 0},
    {"2 1 -1.5", "2 1 -1e-400", "", 0, 0},
    {"2 1 -1.5", "  2\t1\t-1.5  ", "", 0, 0},
    {"2 1 -1.5", "\n% another\n2 1 -1.5", "", 0, 0},
    {"real symmetric", "REAL Symmetric", "", 0, 0},
    {"%%MatrixMarket matrix", "%%MatrixMarket\tmatrix", "", 0, 0},
    {"% K of three dofs", "% K f\xFCr drei", "", 0, 0},
};

constexpr PlacedChange of_labels[] = {
    {"7 uy", "7 ux", "node 7 ux has a row already", 3, 1},
    {"7 uy", "7 1", "node 7 ux has a row already", 3, 1},
    {"7 uy", "7 uw", "found the direction 'uw'", 3, 3},
    {"7 uy", "7 0", "found the direction '0'", 3, 3},
    {"7 uy", "7 7", "found the direction '7'", 3, 3},
    {"7 uy", "7 2.0", "found the direction '2.0'", 3, 3},
    {"7 uy", "7", "found the end of the line, expected a direction", 3, 2},
    {"7 uy", "7.uy", "found '7.uy', expected a node number", 3, 1},
    {"7 uy", "0 uy", "found '0', expected a node number", 3, 1},
    {"7 uy", "-7 uy", "found '-7', expected a node number", 3, 1},
    {"7 uy", "7.0 uy", "found '7.0', expected a node number", 3, 1},
    {"7 uy", "99999999999 uy", "found '99999999999', expected a node number", 3, 1},
    {"7 uy", "7 uy 0 0", "found the end of the line, expected a coordinate", 3, 9},
    {"7 uy", "7 uy 0 0 0 0", "found '0', expected the end of the line", 3, 12},
    {"7 uy", "7 uy 0 0 1", "node 7 stands at (0, 0, 1) here and at (0, 0, 0) before", 3, 10},
    {"7 uy", "7 uy 0 nan 0", "found 'nan', expected a coordinate", 3, 8},
    {"7 uy", "7 uy 0 0 inf", "found 'inf', expected a coordinate", 3, 10},
    {"scalar 100", "scalr 100", "Did you mean 'scalar'?", 5, 1},
    {"scalar 100", "scalar 0", "found '0', expected a number", 5, 8},
    {"scalar 100", "scalar -1", "found '-1', expected a number", 5, 8},
    {"scalar 100", "scalar 100 ux", "found 'ux', expected the end of the line", 5, 12},
    {"scalar 100", "scalar 7", "the number 7 is taken already", 5, 1},
    {"scalar\n", "scalar 100\n", "the number 100 is taken already", 6, 1},
    {"set root 7", "sett root 7", "Did you mean 'set'?", 7, 1},
    {"set root 7", "set", "found the end of the line, expected the name of the set", 7, 4},
    {"set root 7", "set root", "found the end of the line, expected a node number", 7, 9},
    {"set root 7", "set root 8", "a set names node 8, which has no row", 7, 10},
    {"set root 7", "set root 100", "a set names node 100, which has no row", 7, 10},
    {"set root 7", "set root 0", "found '0', expected a node number", 7, 10},
    {"set root 7", "set root 7,9", "found '7,9', expected a node number", 7, 10},
    {"7 uy", "7 uy 0 0 0", "", 0, 0},
    {"7 uy", "  7\tuy  # second row", "", 0, 0},
    {"7 uy", "\n\n7 uy", "", 0, 0},
    {"# rows", "# Fl\xFCgel", "", 0, 0},
    {"set root 7", "set root 7 7", "", 0, 0},
};

template <std::size_t n>
void add_placed(std::vector<Case>& cases, const std::string& text, const PlacedChange (&changes)[n]) {
  for (const PlacedChange& c : changes) {
    Case& added = cases.emplace_back();
    added.name = std::string("'") + c.from + "' made '" + c.to + "'";
    added.bytes = replaced(text, c.from, c.to);
    added.says = {c.says};
    added.reads = *c.says == '\0';
    if (!added.reads) added.place = std::pair{c.line, c.column};
  }
}

void add_common(std::vector<Case>& cases, const std::string& text, const char* of_nothing) {
  std::string wide;
  for (const char c : text) wide += {c, '\0'};
  cases.push_back({.name = "sound", .bytes = text, .reads = true});
  cases.push_back({.name = "Windows line ends", .bytes = with_windows_ends(text), .reads = true});
  cases.push_back({"no line end", text.substr(0, text.size() - 1), {"the last line has no line end"}});
  cases.push_back({"empty", "", {"the file is empty"}});
  cases.push_back({"blank", "\n \n", {of_nothing}});
  cases.push_back({"UTF-16", "\xFF\xFE" + wide, {"bad."}});
  add_words_for_numbers(cases, "text", text, numbers_of(text));
}

}  // namespace

Family market_cases() {
  Family family{"bad.mtx",
                [](const std::filesystem::path& file) {
                  fem::read_matrix_market(file, {{7, 0, false}, {7, 1, false}, {9, 2, false}});
                },
                {}};
  add_common(family.cases, market_text, "found the end of the line, expected %%MatrixMarket");
  add_cuts(family.cases, "text", market_text, 1);
  for (std::size_t size = 1; size < market_text.size(); size += 5)
    family.cases.push_back({"cut after byte " + std::to_string(size), market_text.substr(0, size), {"bad.mtx"}});
  add_placed(family.cases, market_text, of_market);
  const std::string general = replaced(replaced(market_text, "symmetric", "general"), "3 3 5", "3 3 7") + "1 2 ";
  family.cases.push_back({.name = "both triangles", .bytes = general + "-1.5\n2 3 -1.0\n", .reads = true});
  family.cases.push_back({"triangles that differ", general + "-1.6\n2 3 -1.0\n", {"-1.5", "-1.6", "node 7 uy"}});
  family.cases.push_back({"triangles that differ in the tenth digit", general + "-1.5000000001\n2 3 -1.0\n", {"-1.5"}});
  family.cases.push_back(
      {"an entry of both triangles twice", general + "-1.5\n1 2 -1.5\n", {"(1, 2) is given twice"}, {{10, 1}}});
  return family;
}

Family label_cases() {
  Family family{"bad.labels", [](const std::filesystem::path& file) { fem::read_matrix_labels(file); }, {}};
  add_common(family.cases, label_text, "the file labels no row");
  family.cases.push_back({"comments alone", "# nothing\n# here\n", {"the file labels no row"}});
  family.cases.push_back({"sets alone", "set root 7\n", {"the file labels no row"}});
  add_placed(family.cases, label_text, of_labels);
  return family;
}

}  // namespace tenon::broken
