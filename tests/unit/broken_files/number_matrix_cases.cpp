#include "fem/formats/matrices/abaqus.hpp"
#include "fem/formats/matrices/calculix.hpp"
#include "tests/unit/broken_files/broken.hpp"

/// Matrices as plain lines of numbers: CalculiX's job.sti, job.mas, job.dof and Abaqus's .mtx.
namespace tenon::broken {
namespace {

const std::string sti_text = "1 1  4.0000000000000e+00\n1 2 -1.5000000000000e+00\n2 2  3.0\n3 3  2.0\n";
const std::string mas_text = "1 1  1.0\n2 2  1.0\n3 3  0.0\n";
const std::string dof_text = "7.1\n7.3\n10.2\n";
const std::string entries_text = "** stiffness\n5,1, 5,1, 4.0\n2,6, 5,1, -1.5\n2,6, 2,6, 3.0\n";
const std::string masses_text = "5,1, 5,1, 2.0\n2,6, 2,6, 9.0\n";

using Place = std::optional<std::pair<long, long>>;

Case job(const std::string& name, const std::string& sti, const std::string& mas, const std::string& dof,
         std::vector<std::string> says, Place place = {}) {
  Case made{.name = name, .bytes = sti, .says = std::move(says), .place = place};
  made.reads = made.says.empty();
  made.beside = {{"job.mas", mas}, {"job.dof", dof}};
  return made;
}

/// The second line of the .sti made `line`.
Case stiffness(const std::string& line, std::vector<std::string> says, Place place = {}) {
  return job("sti: '" + line + "'", replaced(sti_text, "1 2 -1.5000000000000e+00", line), mas_text, dof_text,
             std::move(says), place);
}

/// The second line of the .dof made `line`.
Case label(const std::string& line, std::vector<std::string> says, Place place = {}) {
  return job("dof: '" + line + "'", sti_text, mas_text, replaced(dof_text, "7.3", line), std::move(says), place);
}

Case matrix(const std::string& name, const std::string& stiffness, const std::string& mass,
            std::vector<std::string> says, Place place = {}) {
  Case made{.name = name, .bytes = stiffness, .says = std::move(says), .place = place};
  made.reads = made.says.empty();
  made.beside = {{"m.mtx", mass}};
  return made;
}

/// The third line of the stiffness made `line`.
Case entry(const std::string& line, std::vector<std::string> says, Place place = {}) {
  return matrix("'" + line + "'", replaced(entries_text, "2,6, 5,1, -1.5", line), masses_text, std::move(says), place);
}

}  // namespace

Family calculix_cases() {
  Family family{
      "job.sti",
      [](const std::filesystem::path& file) { fem::read_calculix_matrices(file.string()); },
      {job("sound", sti_text, mas_text, dof_text, {}),
       job("Windows line ends", with_windows_ends(sti_text), with_windows_ends(mas_text), with_windows_ends(dof_text),
           {}),
       job("sti empty", "", mas_text, dof_text, {"job.sti: the file is empty"}),
       job("mas empty", sti_text, "", dof_text, {"job.mas: the file is empty"}),
       job("dof empty", sti_text, mas_text, "", {"job.dof: the file is empty"}),
       job("dof blank", sti_text, mas_text, "\n\n", {"job.dof: the file holds no dof"}),
       job("sti blank", "\n", mas_text, dof_text, {"job.sti", "diagonal entry of row 1 (node 7 ux)"}),
       job("sti without its last line end", sti_text.substr(0, sti_text.size() - 1), mas_text, dof_text,
           {"job.sti: the last line has no line end"}),
       job("mas without its last line end", sti_text, mas_text.substr(0, mas_text.size() - 1), dof_text,
           {"job.mas: the last line has no line end"}),
       job("dof without its last line end", sti_text, mas_text, dof_text.substr(0, dof_text.size() - 1),
           {"job.dof: the last line has no line end"}),
       job("a dof too few", sti_text, mas_text, "7.1\n7.3\n",
           {"job.sti:4:1: found row 3, but the .dof file labels 2 rows"}),
       job("a dof too many", sti_text, mas_text, dof_text + "11.1\n",
           {"job.sti: the diagonal entry of row 4 (node 11 ux) is missing"}),
       job("a mass too few", sti_text, "1 1 1.0\n2 2 1.0\n", dof_text,
           {"job.mas: the diagonal entry of row 3 (node 10 uy) is missing"}),
       job("matrices exchanged for labels", dof_text, mas_text, dof_text, {"found '7.1', expected row"}, {{1, 1}}),
       job("labels exchanged for a matrix", sti_text, mas_text, mas_text, {"job.dof:1:1", "found '1'"}),
       job("sti in UTF-16", std::string("\xFF\xFE\x31\0\x0A\0", 6), mas_text, dof_text, {"job.sti"}),
       stiffness("0 2 -1.5", {"found row 0, but the .dof file labels 3 rows"}, {{2, 1}}),
       stiffness("-1 2 -1.5", {"found row -1"}, {{2, 1}}),
       stiffness("1 4 -1.5", {"found column 4"}, {{2, 3}}),
       stiffness("1 99999999999999999999 -1.5", {"expected column"}, {{2, 3}}),
       stiffness("1 4294967298 -1.5", {"found column 4294967298"}, {{2, 3}}),
       stiffness("1.0 2 -1.5", {"found '1.0', expected row"}, {{2, 1}}),
       stiffness("1 2", {"found the end of the line, expected a number"}, {{2, 4}}),
       stiffness("1", {"found the end of the line, expected column"}, {{2, 2}}),
       stiffness("1 2 -1.5 0", {"found '0', expected the end of the line"}, {{2, 10}}),
       stiffness("1 2 nan", {"found 'nan', expected a number"}, {{2, 5}}),
       stiffness("1 2 -inf", {"found '-inf', expected a number"}, {{2, 5}}),
       stiffness("1 2 1e999", {"found '1e999', expected a number"}, {{2, 5}}),
       stiffness("1 2 +-1.5", {"found '+-1.5', expected a number"}, {{2, 5}}),
       stiffness("1 2 ********", {"found '********', expected a number"}, {{2, 5}}),
       stiffness("# 1 2 -1.5", {"found '#', expected row"}, {{2, 1}}),
       stiffness("1 1 -1.5", {"(node 7 ux, node 7 ux) of the stiffness matrix stands twice"}),
       stiffness("1 2 -1.5\n1 2 -1.5", {"stands twice"}),
       stiffness("1 2 -1.5\n2 1 -1.5\n1 2 -1.5", {"stands twice"}),
       stiffness("1 2 -1.5\n2 1 -1.5\n2 1 -1.5", {"stands twice"}),
       stiffness("1 2 -1.5\n2 1 -1.4", {"is not symmetric", "-1.5", "-1.4", "node 7 uz"}),
       stiffness("1 2 -1.5\n2 1 -1.5", {}),
       stiffness("2 1 -1.5", {}),
       stiffness("\t1\t2\t-1.5D+00", {}),
       stiffness("\n1 2 -1.5", {}),
       label("7.1", {"job.dof:2:1", "the label 7.1 stands twice", "beams and shells"}),
       label("7.0", {"found the label '7.0': only the directions 1 to 3"}, {{2, 1}}),
       label("7.4", {"found the label '7.4': only the directions 1 to 3"}, {{2, 1}}),
       label("7.10", {"found '7.10', expected a label"}, {{2, 1}}),
       label("7.", {"found '7.', expected a label"}, {{2, 1}}),
       label("7", {"found '7', expected a label"}, {{2, 1}}),
       label(".3", {"found '.3', expected a label"}, {{2, 1}}),
       label("0.3", {"found '0.3', expected a label"}, {{2, 1}}),
       label("-7.3", {"found '-7.3', expected a label"}, {{2, 1}}),
       label("7.3.1", {"found '7.3.1', expected a label"}, {{2, 1}}),
       label("7,3", {"found '7', expected a label"}, {{2, 1}}),
       label("7.3e0", {"found '7.3e0', expected a label"}, {{2, 1}}),
       label("99999999999999999999.3", {"expected a label"}, {{2, 1}}),
       label("7.3 8.1", {"found '8.1', expected the end of the line"}, {{2, 5}}),
       label("  7.3  ", {})}};
  std::vector<Case> words, cuts;
  add_words_for_numbers(words, "sti", sti_text, numbers_of(sti_text));
  // the last line is known by its diagonal; between diagonals no end can be told from a shorter file
  add_cuts(cuts, "sti", sti_text, 1);
  for (Case& c : cuts) c.says = {"is missing: the file is cut off"};
  for (std::vector<Case>* part : {&words, &cuts})
    for (Case& c : *part) {
      c.beside = {{"job.mas", mas_text}, {"job.dof", dof_text}};
      family.cases.push_back(std::move(c));
    }
  return family;
}

Family abaqus_matrix_cases() {
  Family family{
      "k.mtx",
      [](const std::filesystem::path& file) { fem::read_abaqus_matrices(file, file.parent_path() / "m.mtx"); },
      {matrix("sound", entries_text, masses_text, {}),
       matrix("Windows line ends", with_windows_ends(entries_text), with_windows_ends(masses_text), {}),
       matrix("stiffness empty", "", masses_text, {"k.mtx: the file is empty"}),
       matrix("mass empty", entries_text, "", {"m.mtx: the file is empty"}),
       matrix("comments alone", "** nothing\n", masses_text, {"k.mtx: the file holds no matrix entry"}),
       matrix("mass blank", entries_text, "\n", {"m.mtx: the file holds no matrix entry"}),
       matrix("no line end", entries_text.substr(0, entries_text.size() - 1), masses_text,
              {"k.mtx: the last line has no line end"}),
       matrix("every dof held", "5,1,5,1,1e36\n2,6,2,6,1e36\n", masses_text, {"k.mtx: every dof is held"}),
       matrix("Matrix Market", "%%MatrixMarket matrix coordinate real symmetric\n", masses_text,
              {"found '%%MatrixMarket', expected row node"}, {{1, 1}}),
       matrix("UTF-16", std::string("\xFF\xFE\x31\0\x0A\0", 6), masses_text, {"k.mtx"}),
       matrix("mass twice", entries_text, masses_text + "5,1, 5,1, 2.0\n", {"m.mtx", "the mass matrix stands twice"}),
       matrix("mass that is nan", entries_text, "5,1, 5,1, nan\n", {"m.mtx:1:11", "found 'nan'"}),
       entry("*MATRIX ASSEMBLE", {"found '*MATRIX ASSEMBLE' in a file of matrix entries"}, {{3, 0}}),
       entry("0,6, 5,1, -1.5", {"found row node 0", "internal nodes"}, {{3, 1}}),
       entry("2,6, -5,1, -1.5", {"found column node -5", "internal nodes"}, {{3, 6}}),
       entry("2,0, 5,1, -1.5", {"found row dof 0", "only the dofs 1 to 6"}, {{3, 3}}),
       entry("2,6, 5,7, -1.5", {"found column dof 7", "only the dofs 1 to 6"}, {{3, 8}}),
       entry("2,6, 5,11, -1.5", {"found column dof 11"}, {{3, 8}}),
       entry("2.0,6, 5,1, -1.5", {"found '2.0', expected row node"}, {{3, 1}}),
       entry("99999999999999999999,6, 5,1, -1.5", {"expected row node"}, {{3, 1}}),
       entry("2,6, 5,1", {"found the end of the line, expected a number"}, {{3, 9}}),
       entry("2,6, 5", {"found the end of the line, expected column dof"}, {{3, 7}}),
       entry("2,6, 5,1, -1.5, 3", {"found '3', expected the end of the line"}, {{3, 17}}),
       entry("2,6, 5,1, inf", {"found 'inf', expected a number"}, {{3, 11}}),
       entry("2,6, 5,1, 1e999", {"found '1e999', expected a number"}, {{3, 11}}),
       entry("2,6, 5,1, +-1.5", {"found '+-1.5', expected a number"}, {{3, 11}}),
       entry("2;6; 5;1; -1.5", {"found '2;6;', expected row node"}, {{3, 1}}),
       entry("2,6, 2,6, -1.5", {"(node 2 rz, node 2 rz) of the stiffness matrix stands twice"}),
       entry("2,6, 5,1, -1.5\n5,1, 2,6, -1.4", {"is not symmetric", "-1.5", "-1.4", "node 2 rz"}),
       entry("2,6, 5,1, -1.5\n2,6, 5,1, -1.5", {"stands twice"}),
       entry("2,6, 5,1, -1.5\n5,1, 2,6, -1.5\n2,6, 5,1, -1.5", {"stands twice"}),
       entry("2,6, 5,1, -1.5\n5,1, 2,6, -1.5", {}),
       entry("2 6\t5 1 -1.5", {}),
       entry("\n** a comment\n2,6,5,1,-1.5D0", {}),
       entry("3,1, 3,1, 1e36", {})}};
  std::vector<Case> words;
  add_words_for_numbers(words, "stiffness", entries_text, numbers_of(entries_text, ","));
  for (Case& c : words) {
    c.beside = {{"m.mtx", masses_text}};
    family.cases.push_back(std::move(c));
  }
  return family;
}

}  // namespace tenon::broken
