#pragma once

#include <gtest/gtest.h>

#include <cstdlib>

/// Ends a test that compares with another program where that is missing: skipped, but failed where TENON_ORACLES is
/// set, as .ci/run sets it, for what cmake/packages.txt installs there must not go missing unseen.
#define TENON_SKIP_WITHOUT(present, package)                                               \
  if (!(present)) {                                                                        \
    if (std::getenv("TENON_ORACLES") != nullptr) FAIL() << package " is not installed";    \
    GTEST_SKIP() << package " is not installed"; /* to be had from Debian: `./dev deps` */ \
  }                                                                                        \
  static_assert(true)
