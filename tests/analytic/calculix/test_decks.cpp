// The decks of CalculiX's own tests (Debian's calculix-ccx-test, read in place): nothing of them is read past unsaid.
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <map>
#include <set>

#include "fem/error.hpp"
#include "fem/formats/abaqus.hpp"
#include "tests/support/oracle.hpp"

using namespace tenon;
namespace fs = std::filesystem;

namespace {

const fs::path decks = "/usr/share/doc/calculix-ccx-test/examples/test";

/// CalculiX reads keywords with their blanks and without.
std::string without_blanks(std::string name) {
  std::erase(name, ' ');
  return name;
}

/// How often each keyword begins a line: upper case, no blanks, up to the first comma. Independent of the reader.
std::map<std::string, long> keywords(const fs::path& deck) {
  std::ifstream file(deck);
  std::map<std::string, long> counts;
  bool goes_on = false;  // the keyword line before ended with a comma
  for (std::string line; std::getline(file, line);) {
    const std::size_t end = line.find_last_not_of(" \t\r");
    if (end == std::string::npos) continue;
    const bool before = goes_on;
    const bool keyword = line[0] == '*' && line.compare(0, 2, "**") != 0 && !before;
    if (line.compare(0, 2, "**") != 0) goes_on = (keyword || before) && line[end] == ',';
    if (!keyword) continue;
    std::string name;
    for (const char c : line.substr(1, line.find(',') - 1))
      if (std::isspace(static_cast<unsigned char>(c)) == 0)
        name += static_cast<char>(std::toupper(static_cast<unsigned char>(c)));
    ++counts[name];
  }
  return counts;
}

/// What a model or a mesh is made of: these leave no loss of their own name.
const std::set<std::string> taken{"NODE",
                                  "ELEMENT",
                                  "NSET",
                                  "ELSET",
                                  "TRANSFORM",
                                  "MATERIAL",
                                  "ELASTIC",
                                  "DENSITY",
                                  "BEAMSECTION",
                                  "SHELLSECTION",
                                  "MASS",
                                  "SPRING",
                                  "RIGIDBODY",
                                  "COUPLING",
                                  "KINEMATIC",
                                  "DISTRIBUTING",
                                  "MPC",
                                  "EQUATION",
                                  "BOUNDARY",
                                  "HEADING",
                                  "SURFACE",
                                  "SOLIDSECTION",
                                  "FLUIDSECTION",
                                  "MEMBRANESECTION",
                                  "INCLUDE",
                                  "ROTARYINERTIA",
                                  "GASKETSECTION",
                                  "SURFACESECTION",
                                  "BEAMGENERALSECTION"};

}  // namespace

TEST(CalculixDecks, EveryKeywordIsReadOrNamedAndCounted) {
  TENON_SKIP_WITHOUT(fs::is_directory(decks), "calculix-ccx-test");
  int read = 0, refused = 0;
  for (const auto& entry : fs::directory_iterator(decks)) {
    if (entry.path().extension() != ".inp") continue;
    fem::AbaqusDeck deck;
    try {
      deck = fem::read_abaqus(entry.path(), {.allow_losses = true});
    } catch (const Error& error) {  // a sentence with a place, never anything else
      EXPECT_NE(std::string(error.what()).find(entry.path().filename().string()), std::string::npos) << error.what();
      RecordProperty(entry.path().stem().string(), error.what());
      ++refused;
      continue;
    }
    ++read;
    std::map<std::string, long> losses;
    for (const fem::Loss& loss : deck.model.losses) losses[without_blanks(loss.name)] += loss.count;
    for (const auto& [keyword, count] : keywords(entry.path()))
      if (!taken.contains(keyword)) {
        EXPECT_EQ(losses["*" + keyword], count) << entry.path() << ": *" << keyword;
      }
  }
  RecordProperty("read", read);
  RecordProperty("refused", refused);
  EXPECT_GE(read, 20);
}
