#pragma once

#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <string>

namespace tenon::fem {

/// A file of the reference truss with two booms (NX Nastran runs), which is no part of a clone of the project: it is
/// read from data/nastran-cb of the folder that TENON_SHARED names.
inline std::filesystem::path shared_deck(const std::string& name) {
  const char* variable = std::getenv("TENON_SHARED");
  const std::filesystem::path shared =
      variable ? std::filesystem::path(variable) : std::filesystem::path(TENON_SOURCE_DIR) / ".." / "shared";
  return shared / "data" / "nastran-cb" / name;
}

/// Tests on those decks, which the project cannot ship: they skip without them.
class NastranDecks : public ::testing::Test {
 protected:
  void SetUp() override {
    if (!std::filesystem::exists(shared_deck("full.dat")))
      GTEST_SKIP() << "Set TENON_SHARED: see above.";  // another program's decks may not be copied here
  }
};

}  // namespace tenon::fem
