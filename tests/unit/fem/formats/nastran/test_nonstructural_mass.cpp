#include "tests/unit/fem/formats/nastran/deck_file.hpp"

using namespace tenon;
using namespace tenon::fem;
using ::testing::AllOf;
using ::testing::HasSubstr;

namespace {

// one square metre of shell, two metres of bar, of a rod, of a tapered beam
const std::string structure =
    "BEGIN BULK\nMAT1,1,7.+10,,.25,0.\nGRID,1\nGRID,2,,1.\nGRID,3,,1.,1.\nGRID,4,,0.,1.\nGRID,5,,3.\n"
    "PSHELL,7,1,.01,1,,1,,4.\nCQUAD4,1,7,1,2,3,4\nPBAR,8,1,1.-4,1.-8,1.-8,1.-8,.5\nCBAR,2,8,2,5,0.,0.,1.\n"
    "PROD,9,1,1.-4\nCROD,3,9,2,5\nPBEAM,10,1,1.-4,1.-8,1.-8,0.,1.-8\n,,,,,,,,\n,YES,1.,4.-4,1.6-7,1.6-7,0.,1.6-7\n"
    "CBEAM,4,10,2,5,0.,0.,1.\nPCOMP,11\n,1,.01\n";

std::string selecting(const std::string& set, const std::string& cards) {
  return "CEND\n" + set + structure + cards + "ENDDATA\n";
}

double mass_of(const std::string& deck_text) {
  double mass = 0.0;
  for (const PointMass& p : elements_of<PointMass>(read_deck(deck_text).model)) mass += p.mass;
  return mass;
}

constexpr double own = 4.0 * 1.0 + 0.5 * 2.0;  // of PSHELL and PBAR

}  // namespace

TEST(NastranNonstructuralMass, JoinsThatOfProperties) {
  EXPECT_NEAR(mass_of(selecting("", "")), own, 1e-14);
  EXPECT_NEAR(mass_of(selecting("NSM = 5\n", "NSM1,5,PSHELL,3.,7\n")), own + 3.0, 1e-14);
  EXPECT_NEAR(mass_of(selecting("NSM = 5\n", "NSM1,5,PBAR,3.,7,THRU,9\nNSM1,5,PROD,.25,ALL\n")), own + 6.0 + 0.5,
              1e-14);
  EXPECT_NEAR(mass_of(selecting("NSM = 5\n", "NSM,5,PSHELL,7,1.5\nNSM,5,PBAR,8,-.5\n")), own + 1.5 - 1.0, 1e-14);
  EXPECT_NEAR(mass_of(selecting("NSM = 5\n", "NSM1,5,PBEAM,2.,10\n")), own + 4.0, 1e-13) << "at both stations";
  EXPECT_NEAR(mass_of(selecting("NSM = 6\n", "NSMADD,6,1,2\nNSM1,1,PROD,1.,9\nNSM1,2,PROD,2.,9\nNSM1,3,PROD,4.,9\n")),
              own + 6.0, 1e-14);
  EXPECT_NEAR(mass_of(selecting("NSM = 5\nPARAM,WTMASS,.5\n", "NSM1,5,PSHELL,3.,7\n")), 0.5 * (own + 3.0), 1e-14);
}

TEST(NastranNonstructuralMass, CountsOnlyWhereItIsSelected) {
  const std::string card = "NSM1,5,PSHELL,3.,7\n";
  const NastranDeck unselected = read_deck(selecting("", card));
  EXPECT_EQ(lost(unselected.mesh, "NSM set 5"), 1);
  EXPECT_NEAR(mass_of(selecting("", card)), own, 1e-14);
  EXPECT_THAT(refusal(structure.substr(11) + card), HasSubstr("NSM = 5"));
}

TEST(NastranNonstructuralMass, IsRefusedWhereItCannotBeTold) {
  const auto said = [](const std::string& card) { return refusal(selecting("NSM = 5\n", card)); };
  EXPECT_THAT(said("NSM1,5,PSHELL,3.,77\n"), AllOf(HasSubstr("PSHELL 77"), HasSubstr("not defined")));
  EXPECT_THAT(said("NSM1,5,ELEMENT,3.,1\n"), HasSubstr("NSM1 ELEMENT"));
  EXPECT_THAT(said("NSML1,5,PSHELL,3.,7\n"), HasSubstr("whole mass"));
  EXPECT_THAT(said("NSM,5,PSHELL,7,-5.\n"), HasSubstr("negative"));
  EXPECT_THAT(said("NSM,5,PSHELL,7\n"), HasSubstr("VALUE"));
  EXPECT_THAT(refusal(selecting("NSM = 9\n", "NSM1,5,PSHELL,3.,7\n")), HasSubstr("NSM set 9 is selected"));
}

TEST(NastranNonstructuralMass, PliesWithNumbersAreThoseWithout) {
  const std::string head =
      "MAT1,1,7.+10,,.25,2700.\nMAT8,2,1.4+11,1.+10,.3,5.+9,4.+9,3.+9,1600.\nGRID,1\nGRID,2,,1.\n"
      "GRID,3,,1.,1.\nCTRIA3,1,5,1,2,3\n";
  const auto section = [&](const std::string& cards) { return read_deck(head + cards).model.shell_sections.at(0); };
  const ShellSection plain = section("PCOMP,5,-.002,7.\n,2,.001,45.,,2,.003,-30.\n,1,.001\n");
  const ShellSection numbered = section("PCOMPG,5,-.002,7.\n,101,2,.001,45.,YES\n,102,2,.003,-30.\n,103,1,.001\n");
  ASSERT_EQ(numbered.plies.size(), 3U);
  EXPECT_EQ(numbered.nsm, 7.0);
  for (std::size_t k = 0; k < 3; ++k) {
    EXPECT_EQ(numbered.plies[k].thickness, plain.plies[k].thickness);
    EXPECT_EQ(numbered.plies[k].angle, plain.plies[k].angle);
    EXPECT_EQ(numbered.plies[k].E1, plain.plies[k].E1);
  }
  EXPECT_THAT(refusal(head + "PCOMPG,5\n,101,2,.001\n,101,2,.001\n"), HasSubstr("two plies the number 101"));
  EXPECT_THAT(refusal(head + "PCOMPG,5,,,,,,,SYM\n,101,2,.001\n"), HasSubstr("LAM is 'SYM'"));
  EXPECT_THAT(refusal(head + "PCOMPG,5\n"), HasSubstr("the material of the first ply"));
}
