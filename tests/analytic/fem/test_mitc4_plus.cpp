// Quads beside MITC4+ itself (mitc4_plus.py) on the same meshes: what its authors quote for skew ones depends on meshes
// that they draw but do not list. On regular ones the script must give what they quote. Of the roof it does not: .9893
// of .3024 where .9973 is quoted, which lies above the limit of any element that converges, .3006 / .3024 = .9941.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <map>
#include <numbers>
#include <sstream>

#include "tests/analytic/fem/shell_course.hpp"
#include "tests/support/oracle.hpp"
#include "tests/support/temporary_folder.hpp"

using namespace tenon::fem::testing;

namespace {

/// What the deflection should be: the thin shell's limit of the roof, the converged series of the pinched cylinder (its
/// published 1.8248e-5 is .15 % below), the round figure of the hemisphere's benchmark; the ring's by Castigliano
/// (test_shell_rates.cpp).
double exact_deflection(const std::string& problem, double t) {
  constexpr double pi = std::numbers::pi;
  if (problem == "roof") return 0.3006;
  if (problem == "cylinder") return 1.8276e-5;
  if (problem == "hemisphere") return 0.093;
  return (0.25 * pi - 2.0 / pi) * 12.0 / (t * t * t) + 0.25 * pi * (1.0 + 2.4) / t;
}

/// What its authors quote of a regular mesh, in deflection; 0 where they do not.
double quoted_deflection(const std::string& problem, const std::string& grid, double t) {
  if (grid != "regular") return 0.0;
  if (problem == "cylinder") return 0.9313 * 1.8248e-5;
  if (problem == "hemisphere") return t == 0.04 ? 1.003 * 0.093 : t == 0.004 ? 0.9834 * 0.093 : 0.0;
  return 0.0;
}

double our_deflection(const std::string& problem, Grid grid, double t) {
  if (problem == "roof") return scordelis_lo({grid});
  if (problem == "cylinder") return pinched_cylinder({grid});
  return problem == "hemisphere" ? hemisphere({grid}, t) : ring({grid}, t);
}

}  // namespace

// The hemisphere's reference is the round figure of the benchmark, of which both are within a per cent when thick; the
// margin is what it leaves open.
TEST(Mitc4Plus, OnTheSameMeshesItIsNoCloser) {
  constexpr double margin = 0.002;
  TENON_SKIP_WITHOUT(std::system("/usr/bin/python3 -c 'import numpy' 2> /dev/null") == 0, "python3-numpy");
  const TemporaryFolder folder;
  const auto table = folder.path() / "table";
  ASSERT_EQ(std::system(fmt::format("OPENBLAS_NUM_THREADS=1 /usr/bin/python3 {} > {}",
                                    TENON_SOURCE_DIR "/tests/analytic/fem/mitc4_plus.py", table.string())
                            .c_str()),
            0);
  const std::map<std::string, Grid> grids{
      {"regular", Grid::regular}, {"distorted", Grid::distorted}, {"mirrored", Grid::mirrored}};
  int rows = 0, checked = 0;
  std::ifstream in(table);
  std::string problem, grid;
  for (double t = 0.0, theirs = 0.0; in >> problem >> grid >> t >> theirs; ++rows) {
    const double exact = exact_deflection(problem, t), ours = our_deflection(problem, grids.at(grid), t);
    RecordProperty(fmt::format("{}_{}_{}", problem, grid, t),
                   fmt::format("{:.4f} {:.4f}", ours / exact, theirs / exact));
    EXPECT_LE(std::abs(ours / exact - 1.0), std::abs(theirs / exact - 1.0) + margin)
        << problem << ' ' << grid << ' ' << t << ": " << ours / exact << " against " << theirs / exact;
    EXPECT_NEAR(ours / exact, 1.0, 0.05) << problem << ' ' << grid << ' ' << t
                                         << ": the worst rows are a twentieth off";
    if (const double quoted = quoted_deflection(problem, grid, t); quoted > 0.0) {
      EXPECT_NEAR(theirs / quoted, 1.0, margin) << problem << ' ' << t;
      ++checked;
    }
  }
  EXPECT_EQ(rows, 27);
  EXPECT_EQ(checked, 3);
}
