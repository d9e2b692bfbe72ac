#include "fem/formats/nastran.hpp"
#include "tests/unit/broken_files/broken.hpp"

namespace tenon::broken {
namespace {

const std::string head = "SOL 103\nCEND\nSPC = 1\nBEGIN BULK\n";
const std::string bulk = R"(PARAM,COUPMASS,1
PARAM,WTMASS,1.
CORD2R,7,0,0.,0.,0.,0.,0.,1.
,1.,0.,0.
GRID,1,0,0.,0.,0.
GRID,2,7,1.,0.,0.
GRID,3,0,1.,1.,0.
GRID,4,0,0.,1.,0.
GRID,5,0,0.,1.,1.
MAT1,1,7e10,,.33,2700.
PBAR,1,1,1e-4,1e-8,1e-8,2e-8
CBAR,1,1,1,2,0.,0.,1.
PSHELL,2,1,.01,1,,1
CQUAD4,2,2,1,2,3,4
CTRIA3,5,2,1,2,3
CONM2,3,3,0,1.5
RBE2,4,4,123456,5
SPC1,1,123456,1
)";
const std::string deck = head + bulk + "ENDDATA\n";

/// A card at line 9 below two grids, a material and a section.
Case card(const std::string& name, const std::string& lines, std::vector<std::string> says) {
  return {name,
          "CEND\nSPC=1\nMPC=2\nBEGIN BULK\nGRID,1\nGRID,2,,1.\nMAT1,1,7e10,,.3,2700.\nPBAR,1,1,1e-4,1e-8,1e-8,2e-8\n" +
              lines + "\nSPC1,1,4,1\nMPC,2,2,3,1.,1,3,-1.\nENDDATA\n",
          std::move(says)};
}

void add_cards(std::vector<Case>& cases) {
  for (Case& c : std::vector<Case>{
           card("unknown card", "GIRD,3", {"GIRD", "bad.bdf:9"}),
           card("unknown card with blanks", "CFROG   1       2", {"CFROG", "bad.bdf:9"}),
           card("grid twice", "GRID,1,,5.", {"bad.bdf:9", "1"}),
           card("grid without number", "GRID,,,1.", {"bad.bdf:9"}),
           card("grid number negative", "GRID,-3,,1.", {"bad.bdf:9", "-3"}),
           card("grid number too large", "GRID,99999999999999999999", {"bad.bdf:9"}),
           card("grid coordinate nan", "GRID,3,,nan", {"bad.bdf:9:9"}),
           card("grid coordinate infinite", "GRID,3,,inf", {"bad.bdf:9:9"}),
           card("grid coordinate overflows", "GRID,3,,1.+999", {"bad.bdf:9:9"}),
           card("grid in an unknown system", "GRID,3,77,1.", {"bad.bdf:9", "77"}),
           card("grid displaced in an unknown system", "GRID,3,,1.,0.,0.,78", {"bad.bdf:9", "78"}),
           card("system refers to itself", "CORD2R,5,5,0.,0.,0.,0.,0.,1.\n,1.,0.,0.\nGRID,3,5,1.", {"bad.bdf:9", "5"}),
           card("two systems refer to each other",
                "CORD2R,5,6,0.,0.,0.,0.,0.,1.\n,1.,0.,0.\nCORD2R,6,5,0.,0.,0.,0.,0.,1.\n,1.,0.,0.\nGRID,3,5,1.",
                {"bad.bdf:9:10", "circle"}),
           card("system of three grids refers to itself", "CORD1R,5,1,2,3\nGRID,3,5,0.,1.", {"bad.bdf:", "5"}),
           card("system on one line", "CORD2R,5,0,0.,0.,0.,0.,0.,1.\n,0.,0.,2.\nGRID,3,5,1.",
                {"bad.bdf:9", "one line"}),
           card("system with coincident points", "CORD2R,5,0,0.,0.,0.,0.,0.,0.\n,1.,0.,0.\nGRID,3,5,1.",
                {"bad.bdf:9", "CORD2R"}),
           card("system twice",
                "CORD2R,5,0,0.,0.,0.,0.,0.,1.\n,1.,0.,0.\nCORD2R,5,0,0.,0.,0.,0.,0.,2.\n,2.,0.,0.\nGRID,3,5,1.",
                {"bad.bdf:", "5"}),
           card("bar on an unknown grid", "CBAR,1,1,1,9,0.,1.,0.", {"bad.bdf:9", "9"}),
           card("bar with an unknown section", "CBAR,1,8,1,2,0.,1.,0.", {"bad.bdf:9", "8"}),
           card("bar without orientation", "CBAR,1,1,1,2", {"bad.bdf:9"}),
           card("bar along its orientation", "CBAR,1,1,1,2,1.,0.,0.", {"bad.bdf:9"}),
           card("bar with zero orientation", "CBAR,1,1,1,2,0.,0.,0.", {"bad.bdf:9"}),
           card("bar between one grid", "CBAR,1,1,1,1,0.,1.,0.", {"bad.bdf:9"}),
           card("bar of a word", "CBAR,one,1,1,2,0.,1.,0.", {"bad.bdf:9:6"}),
           card("element twice", "CBAR,1,1,1,2,0.,1.,0.\nCBAR,1,1,1,2,0.,0.,1.", {"bad.bdf:10", "1"}),
           card("material twice", "MAT1,1,2e11,,.3", {"bad.bdf:9", "1"}),
           card("section twice", "PBAR,1,1,5e-4", {"bad.bdf:9", "1"}),
           card("section of an unknown material", "PBAR,2,7,1e-4\nCBAR,1,2,1,2,0.,1.,0.", {"bad.bdf:", "7"}),
           card("negative area", "PBAR,2,1,-1e-4,1e-8,1e-8,2e-8\nCBAR,1,2,1,2,0.,1.,0.", {"bad.bdf:9"}),
           card("negative modulus", "MAT1,2,-7e10,,.3\nPBAR,2,2,1e-4\nCBAR,1,2,1,2,0.,1.,0.", {"bad.bdf:9"}),
           card("quad with three grids", "PSHELL,2,1,.01,1\nCQUAD4,2,2,1,2,1", {"bad.bdf:10"}),
           card("quad with a grid twice", "GRID,3,,1.,1.\nPSHELL,2,1,.01,1\nCQUAD4,2,2,1,2,3,3", {"bad.bdf:11"}),
           card("shell without thickness", "GRID,3,,1.,1.\nPSHELL,2,1\nCTRIA3,2,2,1,2,3", {"bad.bdf:"}),
           card("shell of negative thickness", "GRID,3,,1.,1.\nPSHELL,2,1,-.1,1\nCTRIA3,2,2,1,2,3", {"bad.bdf:10"}),
           card("mass on an unknown grid", "CONM2,1,9,,1.", {"bad.bdf:9", "9"}),
           card("rigid link to an unknown grid", "RBE2,1,1,123456,9", {"bad.bdf:9", "9"}),
           card("rigid link to itself", "RBE2,1,1,123456,1", {"bad.bdf:9", "1"}),
           card("rigid link in direction 7", "RBE2,1,1,127,2", {"bad.bdf:9", "127"}),
           card("rigid link without dependents", "RBE2,1,1,123456", {"bad.bdf:9"}),
           card("average without nodes", "RBE3,1,,1,123456", {"bad.bdf:9"}),
           card("average with weight zero", "RBE3,1,,1,123,0.,123,2", {"bad.bdf:9"}),
           card("average of an unknown grid", "RBE3,1,,1,123,1.,123,9", {"bad.bdf:9", "9"}),
           card("support of an unknown grid", "SPC1,1,123,9", {"bad.bdf:9", "9"}),
           card("support in direction 8", "SPC1,1,8,1", {"bad.bdf:9", "8"}),
           card("support of a word", "SPC1,1,123,one", {"bad.bdf:9:12"}),
           card("range turned around", "SPC1,1,123,2,THRU,1", {"bad.bdf:9"}),
           card("range without end", "SPC1,1,123,1,THRU", {"bad.bdf:9"}),
           card("equation with zero", "MPC,2,1,1,0.,2,1,1.", {"bad.bdf:9"}),
           card("equation on an unknown grid", "MPC,2,9,1,1.,2,1,1.", {"bad.bdf:9", "9"}),
           card("equation in direction 9", "MPC,2,1,9,1.,2,1,1.", {"bad.bdf:9"}),
           card("equation cut", "MPC,2,1,1", {"bad.bdf:9"}),
           card("gap read past", "CGAP,7,1,1,2", {"bad.bdf:9", "CGAP"}),
           card("solid read past", "CHEXA,7,1,1,2,1,2,1,2", {"bad.bdf:9", "CHEXA"}),
           card("field of seventeen characters", "GRID*   3                               1.5.7", {"bad.bdf:9"}),
           card("number with two points", "GRID,3,,1.5.7", {"bad.bdf:9:9"}),
           card("number with two exponents", "GRID,3,,1.e5+3", {"bad.bdf:9:9"}),
           card("integer with a point", "CBAR,1.5,1,1,2,0.,1.,0.", {"bad.bdf:9:6"}),
           card("real in place of a direction", "RBE2,1,1,12.,2", {"bad.bdf:9"}),
           card("include without a name", "INCLUDE", {"bad.bdf:9"}),
           card("include of no file", "INCLUDE 'none.bdf'", {"bad.bdf:9", "none.bdf"}),
           card("include of a folder", "INCLUDE '.'", {"bad.bdf"}),
           card("include of itself", "INCLUDE 'bad.bdf'", {"bad.bdf:9"})})
    cases.push_back(std::move(c));
  Case ring = card("two files include each other", "INCLUDE 'other.bdf'", {"other.bdf:1", "bad.bdf"});
  ring.beside = {{"other.bdf", "INCLUDE 'bad.bdf'\n"}};
  cases.push_back(ring);
  Case inside = card("fault in an included file", "INCLUDE 'part.bdf'", {"part.bdf:2:9"});
  inside.beside = {{"part.bdf", "$ one grid\nGRID,3,,oops\n"}};
  cases.push_back(inside);
}

void add_text_oddities(std::vector<Case>& cases) {
  std::string tabs = deck, wide, latin = deck;
  tabs = replaced(tabs, "GRID,3,0,1.,1.,0.", "GRID\t3\t0\t1.\t1.\t0.");
  for (const char c : deck) wide += {c, '\0'};
  cases.push_back({.name = "Windows line ends", .bytes = with_windows_ends(deck), .reads = true});
  cases.push_back({.name = "tabs", .bytes = tabs, .reads = true});
  cases.push_back({.name = "lower case", .bytes = replaced(deck, "GRID,3", "grid,3"), .reads = true});
  cases.push_back({.name = "Latin-1 in a comment", .bytes = "$ Fl\xFCgel\n" + deck, .reads = true});
  cases.push_back({.name = "empty lines", .bytes = replaced(deck, "GRID,3", "\n\n  \nGRID,3"), .reads = true});
  cases.push_back({"UTF-16", "\xFF\xFE" + wide, {"expected text"}});
  cases.push_back({"zero byte", replaced(deck, "GRID,3", std::string("GRID,\0", 6)), {"bad.bdf:11"}});
  cases.push_back({"empty", "", {"bad.bdf"}});
  cases.push_back({"comments alone", "$ nothing\n$ here\n", {"bad.bdf"}});
  cases.push_back({"bulk section empty", "CEND\nBEGIN BULK\nENDDATA\n", {"bad.bdf"}});
  cases.push_back({"no bulk section", "SOL 103\nCEND\nTITLE = X\n", {"bad.bdf"}});
}

}  // namespace

Family nastran_cases() {
  Family family{"bad.bdf", [](const std::filesystem::path& file) { fem::read_nastran(file); }, {}};
  family.cases.push_back({.name = "sound", .bytes = deck, .reads = true});
  std::vector<Word> numbers;
  for (const Word& word : numbers_of(deck, ","))
    if (word.line > 4) numbers.push_back(word);
  add_words_for_numbers(family.cases, "free field", deck, numbers);
  add_cuts(family.cases, "deck", deck, 1);
  add_cards(family.cases);
  add_text_oddities(family.cases);
  return family;
}

}  // namespace tenon::broken
