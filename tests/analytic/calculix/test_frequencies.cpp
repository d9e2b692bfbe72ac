// The same decks read here and run by CalculiX, which turns beams and shells into solids of second order.
#include <gtest/gtest.h>

#include <numbers>

#include "fem/formats/abaqus.hpp"
#include "fem/structure.hpp"
#include "reduction/modes.hpp"
#include "tests/analytic/calculix/ccx.hpp"
#include "tests/support/oracle.hpp"
#include "tests/support/temporary_folder.hpp"

using namespace tenon;

namespace {

constexpr const char* steel_and_step =
    "*MATERIAL, NAME=STEEL\n*ELASTIC\n2.1E11, .3\n*DENSITY\n7800.\n{}*BOUNDARY\n{}*STEP\n*FREQUENCY\n10\n*END STEP\n";

/// A portal of three members of 1 m (the beam of 1.2 m), n elements of three nodes each, .03 wide along z and .02
/// thick, its feet held.
std::string portal(int n) {
  std::string nodes = "*NODE, NSET=ALL\n", elements = "*ELEMENT, TYPE=B32, ELSET=FRAME\n";
  const int last = 6 * n;  // nodes along the portal
  for (int i = 0; i <= last; ++i) {
    const double s = static_cast<double>(i) / (2 * n);
    const double x = s <= 1.0 ? 0.0 : s <= 2.0 ? 1.2 * (s - 1.0) : 1.2, y = s <= 1.0 ? s : s <= 2.0 ? 1.0 : 3.0 - s;
    nodes += fmt::format("{},{:.15g},{:.15g},0.\n", i + 1, x, y);
  }
  for (int e = 0; e < 3 * n; ++e) elements += fmt::format("{},{},{},{}\n", e + 1, 2 * e + 1, 2 * e + 2, 2 * e + 3);
  return "*HEADING\nportal\n" + nodes + elements +
         fmt::format(fmt::runtime(steel_and_step),
                     "*BEAM SECTION, ELSET=FRAME, MATERIAL=STEEL, SECTION=CIRC\n.02, .02\n0., 0., 1.\n",
                     fmt::format("1,1,6\n{},1,6\n", last + 1));
}

/// A plate of 1 × .8 m, n×n elements of eight nodes, one edge held.
std::string plate(int n, const std::string& section) {
  std::string nodes = "*NODE, NSET=ALL\n", elements = "*ELEMENT, TYPE=S8R, ELSET=PLATE\n", held;
  const auto id = [n](int i, int j) { return j * (2 * n + 1) + i + 1; };
  for (int j = 0; j <= 2 * n; ++j)
    for (int i = 0; i <= 2 * n; ++i) {
      if (i % 2 == 1 && j % 2 == 1) continue;
      nodes += fmt::format("{},{:.15g},{:.15g},0.\n", id(i, j), i / (2.0 * n), 0.8 * j / (2.0 * n));
      if (i == 0) held += fmt::format("{},1,6\n", id(i, j));
    }
  for (int j = 0; j < n; ++j)
    for (int i = 0; i < n; ++i) {
      const int x = 2 * i, y = 2 * j;
      elements += fmt::format("{},{},{},{},{},{},{},{},{}\n", j * n + i + 1, id(x, y), id(x + 2, y), id(x + 2, y + 2),
                              id(x, y + 2), id(x + 1, y), id(x + 2, y + 1), id(x + 1, y + 2), id(x, y + 1));
    }
  return "*HEADING\nplate\n" + nodes + elements +
         fmt::format(fmt::runtime(steel_and_step), "*SHELL SECTION, ELSET=PLATE, " + section + "\n", held);
}

void compare(const TemporaryFolder& folder, const std::string& deck, double tolerance) {
  const auto file = folder.write("job.inp", deck);
  ASSERT_TRUE(calculix::run(folder.path(), "job"));
  const std::vector<double> theirs = calculix::frequencies(folder.path() / "job.dat");
  ASSERT_EQ(theirs.size(), 10U);
  const fem::Structure structure = fem::assemble(fem::read_abaqus(file).model);
  const reduction::Modes modes = reduction::solve_modes(structure, {.count = 10});
  for (int k = 0; k < 10; ++k) {
    const double ours = std::sqrt(modes.lambda[k]) / (2.0 * std::numbers::pi),
                 ccx = theirs[static_cast<std::size_t>(k)];
    ::testing::Test::RecordProperty(fmt::format("mode_{}", k + 1), fmt::format("{:.6g} {:.6g}", ours, ccx));
    EXPECT_NEAR(ours / ccx, 1.0, tolerance) << "mode " << k + 1 << ": " << ours << " against " << ccx << " Hz";
  }
}

}  // namespace

// CalculiX makes one solid element of second order of the section and stiff knots of the corners: its frequencies lie
// above and come down as elements are added (10 a member: 4.0 % at worst, 20: 1.6 %). Rectangles stay 3 % apart in
// torsion: one element cannot warp as Saint-Venant's section does.
TEST(CalculixFrequencies, APortalOfBeams) {
  TENON_SKIP_WITHOUT(calculix::installed(), "CalculiX (calculix-ccx)");
  compare(TemporaryFolder(), portal(20), 2e-2);
}

TEST(CalculixFrequencies, APlateOfShells) {
  TENON_SKIP_WITHOUT(calculix::installed(), "CalculiX (calculix-ccx)");
  compare(TemporaryFolder(), plate(10, "MATERIAL=STEEL\n.01"), 2e-2);
}

// The far edge follows a node that may not turn, translations alone: the plate turns about that edge, as CalculiX's.
TEST(CalculixFrequencies, APlateWhoseEdgeIsARigidBody) {
  TENON_SKIP_WITHOUT(calculix::installed(), "CalculiX (calculix-ccx)");
  constexpr int n = 10;
  std::string edge = "*NODE\n9000,1.,.4,0.\n9001,1.,.4,0.\n*NSET, NSET=EDGE\n";
  for (int j = 0; j <= 2 * n; ++j) edge += fmt::format("{},\n", j * (2 * n + 1) + 2 * n + 1);
  edge += "*RIGID BODY, NSET=EDGE, REF NODE=9000, ROT NODE=9001\n*BOUNDARY\n9001,1,3\n";
  std::string deck = plate(n, "MATERIAL=STEEL\n.01");
  deck.insert(deck.find("*STEP"), edge);
  compare(TemporaryFolder(), deck, 2e-2);
  for (const std::string words : {"RIGID BODY", "REF NODE", "SHELL SECTION", "END STEP"}) {  // both read these so, too
    const std::string word = words.substr(0, words.find(' ')) + words.substr(words.find(' ') + 1);
    deck.replace(deck.find(words), words.size(), word);
  }
  compare(TemporaryFolder(), deck, 2e-2);
}

// Three layers of a lamina across, along and at 30°, unsymmetric, with a density of their own each.
TEST(CalculixFrequencies, APlateOfLayers) {
  TENON_SKIP_WITHOUT(calculix::installed(), "CalculiX (calculix-ccx)");
  const std::string layers =
      "COMPOSITE\n.004,,PLY,ACROSS\n.004,,HEAVY,ALONG\n.002,,PLY,OBLIQUE\n"
      "*MATERIAL, NAME=PLY\n*ELASTIC, TYPE=ENGINEERING CONSTANTS\n"
      "1.3E11, 9.E9, 9.E9, .3, .3, .4, 5.E9, 5.E9,\n3.2E9\n*DENSITY\n1600.\n"
      "*MATERIAL, NAME=HEAVY\n*ELASTIC, TYPE=ENGINEERING CONSTANTS\n"
      "4.E10, 8.E9, 8.E9, .25, .25, .4, 4.E9, 4.E9,\n2.9E9\n*DENSITY\n2400.\n"
      "*ORIENTATION, NAME=ALONG\n1., 0., 0., 0., 1., 0.\n*ORIENTATION, NAME=ACROSS\n0., 1., 0., -1., 0., 0.\n"
      "*ORIENTATION, NAME=OBLIQUE\n.8660254037844386, .5, 0., -.5, .8660254037844386, 0.";
  compare(TemporaryFolder(), plate(10, layers), 2e-2);
}
