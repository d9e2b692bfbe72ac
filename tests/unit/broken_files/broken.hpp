#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <utility>
#include <vector>

/// Broken files by the hundred, each with what its reader must say. A format adds a source with a function that returns
/// its Family, and that function to the table of test_broken_files.cpp.
namespace tenon::broken {

/// One file and its outcome.
struct Case {
  std::string name;  ///< what is wrong with it
  std::string bytes;
  std::vector<std::string> says{};               ///< parts of the error's message; ignored where it is read well
  std::optional<std::pair<long, long>> place{};  ///< line and column of the error, where the rule gives them
  bool reads = false;                            ///< read without an error: odd, not wrong
  std::vector<std::pair<std::string, std::string>> beside{};  ///< other files of its folder: name, bytes
};

/// The cases of one format.
struct Family {
  std::string file;  ///< its name while it is read
  void (*read)(const std::filesystem::path&) = nullptr;
  std::vector<Case> cases;
};

Family abaqus_cases();
Family gmsh_cases();
Family nastran_cases();
Family scene_cases();
Family body_cases();
Family vtk_cases();
Family vtu_cases();
Family xdmf_cases();
Family market_cases();
Family label_cases();
Family calculix_cases();
Family abaqus_matrix_cases();
Family op4_cases();
Family superelement_cases();
Family punch_cases();

/// A word of a text and where it stands.
struct Word {
  std::string text;
  long line = 0, column = 0;  ///< from 1
  std::size_t offset = 0;
};
/// Words that are numbers, separated by blanks and the characters of `separators`; nothing inside double quotes.
std::vector<Word> numbers_of(const std::string& text, const std::string& separators = "");

/// Every number replaced by a word, one at a time: the error must stand at that place.
void add_words_for_numbers(std::vector<Case>& cases, const std::string& format, const std::string& text,
                           const std::vector<Word>& numbers);
/// The text cut after each of its lines but the last `complete`: refused, the file named.
void add_cuts(std::vector<Case>& cases, const std::string& format, const std::string& text, int complete);

/// The text with its first `from` replaced; fails loudly when there is none.
std::string replaced(std::string text, const std::string& from, const std::string& to);

/// The text with Windows line ends.
std::string with_windows_ends(const std::string& text);

}  // namespace tenon::broken
