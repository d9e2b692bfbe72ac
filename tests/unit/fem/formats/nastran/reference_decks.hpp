#pragma once

#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <string>

namespace tenon::fem {

/// A file of the reference truss with two booms (NX Nastran runs), which is no part of a clone of the project.
inline std::filesystem::path shared_deck(const std::string& name) {
  const char* variable = std::getenv("TENON_SHARED");
  const std::filesystem::path shared =
      variable ? std::filesystem::path(variable) : std::filesystem::path(TENON_SOURCE_DIR) / ".." / "shared";
  return shared / "data" / "nastran-cb" / name;
}

/// Why the tests on those decks skip.
inline constexpr const char* decks_absent =
    "the nastran-cb decks may not be copied into the project and are not here: set TENON_SHARED to the folder that "
    "holds "
    "data/nastran-cb";

/// Tests on those decks; they are skipped where the decks are absent.
class NastranDecks : public ::testing::Test {
 protected:
  void SetUp() override {
    if (!std::filesystem::exists(shared_deck("full.dat")))
      GTEST_SKIP() << decks_absent;  // the only tests that skip: all other data stand in data/
  }
};

}  // namespace tenon::fem
