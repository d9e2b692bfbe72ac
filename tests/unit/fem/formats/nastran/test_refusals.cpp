#include <chrono>

#include "tests/unit/fem/formats/nastran/deck_file.hpp"

using namespace tenon;
using namespace tenon::fem;
using ::testing::HasSubstr;

TEST(NastranRefusals, CardsThatWouldAddStiffnessOrMassAreNamed) {
  const std::string message = refusal("GRID,1\nGRID,2\nCGAP,1,1,1,2\nCGAP,2,1,1,2\nCSHEAR,3,100,1,1\n");
  EXPECT_THAT(message, HasSubstr("CGAP (2 found, first at "));
  EXPECT_THAT(message, HasSubstr("deck.bdf:3"));
  EXPECT_THAT(message, HasSubstr("CSHEAR (1 found"));
  EXPECT_THAT(message, HasSubstr("allow losses"));
}

TEST(NastranRefusals, UnknownCardsAreRefusedToo) {
  EXPECT_THAT(refusal("GRID,1\nGIRD,2\n"), HasSubstr("GIRD (1 found, first at "));
  EXPECT_THAT(refusal("GRID,1\nGIRD,2\n"), HasSubstr("no card that is known"));
}

TEST(NastranRefusals, AllowedLossesAreReportedNotRefused) {
  const Mesh mesh = read_deck("GRID,1\nGRID,2\nCGAP,1,1,1,2\nCGAP,2,1,1,2\nGIRD,4\n",
                              {.allow_losses = true, .spc_set = {}, .mpc_set = {}})
                        .mesh;
  ASSERT_EQ(mesh.losses.size(), 2U);
  for (const Loss& loss : mesh.losses) EXPECT_TRUE(loss.changes_physics) << loss.name;
  EXPECT_EQ(lost(mesh, "CGAP"), 2);
}

TEST(NastranRefusals, HarmlessCardsAreCountedByName) {
  const NastranDeck deck = read_deck(
      "GRID,1\nEIGRL,1,,50.\nFORCE,1,1,0,1.,1.,0.,0.\nFORCE,2,1,0,1.,1.,0.,0.\nPLOTEL,7,1,1\nTABLED1,3\n"
      "PARAM,AUTOSPC,YES\nPARAM,GRDPNT,0\nPARAM,POST,-1\n");
  EXPECT_EQ(lost(deck.mesh, "FORCE"), 2);
  EXPECT_EQ(lost(deck.mesh, "EIGRL"), 1);
  EXPECT_EQ(lost(deck.mesh, "PLOTEL"), 1);
  EXPECT_EQ(lost(deck.mesh, "TABLED1"), 1);
  EXPECT_EQ(lost(deck.mesh, "PARAM AUTOSPC"), 1);
  for (const Loss& loss : deck.mesh.losses) EXPECT_FALSE(loss.changes_physics) << loss.name;
  EXPECT_EQ(deck.model.losses.size(), deck.mesh.losses.size());
}

TEST(NastranRefusals, SuperelementsInOneFile) {
  EXPECT_THAT(refusal("CEND\nBEGIN BULK\nGRID,1\nBEGIN SUPER=5\nGRID,2\nENDDATA\n"),
              HasSubstr("deck.bdf:4: found BEGIN SUPER=5"));
  EXPECT_THAT(refusal("CEND\nBEGIN BULK SUPER=5\nGRID,2\nENDDATA\n"), HasSubstr("superelements"));
  EXPECT_THAT(refusal("GRID,1\nSEBULK,101,EXTOP4\n"), HasSubstr("SEBULK"));
}

TEST(NastranRefusals, Parameters) {
  EXPECT_THAT(refusal("GRID,1\nPARAM,WTMASS,0.\n"),
              HasSubstr("deck.bdf:2:14: PARAM WTMASS is '0.', expected a number above zero"));
  EXPECT_THAT(refusal("GRID,1\nPARAM,COUPMASS,YES\n"), HasSubstr("PARAM COUPMASS is 'YES'"));
  EXPECT_THAT(refusal("GRID,1\nPARAM,WTMASS,2.\nPARAM,WTMASS,3.\n"), HasSubstr("but 2. at "));
  const NastranDeck deck = read_deck("CEND\nPARAM,COUPMASS,1\nBEGIN BULK\nPARAM   WTMASS  .00259\nGRID,1\nENDDATA\n");
  EXPECT_TRUE(deck.coupled_mass);
  EXPECT_EQ(deck.mass_factor, 0.00259);
  EXPECT_FALSE(read_deck("GRID,1\nPARAM,COUPMASS,-1\n").coupled_mass);
}

TEST(NastranRefusals, HugeRangesCostNothing) {
  const auto start = std::chrono::steady_clock::now();
  const NastranDeck deck =
      read_deck("GRID,1\nSPOINT,1001,THRU,99999999\nQSET1,,1001,THRU,99999999\nASET1,123456,1,THRU,999\n");
  EXPECT_EQ(deck.model.nodes.size(), 1U);  // no node for a scalar that nothing names
  EXPECT_EQ(deck.boundary_nodes.size(), 1U);
  EXPECT_LT(std::chrono::steady_clock::now() - start, std::chrono::seconds(2));  // 10⁸ ids would take longer
}

TEST(NastranRefusals, EveryPrefixOfADeckIsReadOrRefusedButNeverCrashes) {
  const std::string deck =
      "SOL 103\nCEND\nSPC = 1\nMPC=2\nBEGIN BULK\nMAT1    1       6.894+7 2.62+7          "
      "2.74-6\nPBAR,1,1,1.,2.,3.,4.\n"
      "GRID,1\nGRID*,2,,1.,0.\n*,0.\nGRID           3       0      0.      "
      "1.\nCBAR,1,1,1,2,3\nRBE3,5,,3,123,1.,123,1,2\n"
      "SPC1,1,123456,1\nSPOINT,11,THRU,12\nMPC,2,3,4,1.,11,0,1.\nCONM2,9,2,,1.\n,1.,0.,1.,0.,0.,1.\nENDDATA\n";
  EXPECT_EQ(read_deck(deck).mesh.points.size(), 3U);
  const std::size_t complete = deck.find("ENDDATA") + 7;
  const tenon::fem::testing::Scratch folder;
  for (std::size_t n = 0; n < complete; ++n)
    EXPECT_THROW(read_nastran(folder.write("deck.bdf", deck.substr(0, n))), InputError) << deck.substr(0, n);
}

// The tables of MATT1 replace E at the temperature that case control selects for materials.
TEST(NastranRefusals, MaterialsAtATemperature) {
  const std::string bulk =
      "BEGIN BULK\nGRID,1\nMAT1,1,7.+10,,.3\nMATT1,1,8\nTABLEM1,8\n,0.,1.,ENDT\nTEMPD,5,400.\nENDDATA\n";
  EXPECT_EQ(lost(read_deck("CEND\nTEMP(LOAD)=5\n" + bulk).mesh, "MATT1"), 1);
  for (const char* selection : {"TEMPERATURE(MATERIAL) = 5", "TEMP (INIT)=5", "temp(both)=5"})
    EXPECT_THAT(refusal(std::string("CEND\n") + selection + "\n" + bulk),
                HasSubstr("deck.bdf:6: reading on would change stiffness or mass: MATT1"))
        << selection;
}

TEST(NastranRefusals, ParametersOfCaseControl) {
  const std::string bulk = "BEGIN BULK\nGRID,1\nENDDATA\n";
  EXPECT_EQ(read_deck("CEND\nPARAM,WTMASS,.5\n" + bulk).mass_factor, 0.5);
  EXPECT_THAT(refusal("CEND\nPARAM WTMASS .5\n" + bulk), HasSubstr("deck.bdf:2: found 'PARAM WTMASS .5'"));
  EXPECT_FALSE(read_deck("CEND\nPARAM,AUTOSPC,NO\n" + bulk).auto_spc);
  EXPECT_TRUE(read_deck("CEND\n" + bulk).auto_spc);
}

// What nothing uses takes nothing away: properties of elements that are not there, heat, aerodynamics, DMIG that case
// control leaves alone.
TEST(NastranRefusals, WhatHasNoEffectIsNone) {
  const std::string bulk = "BEGIN BULK\nGRID,1\n", unused = "PSOLID,3,9\nMAT9,9,1.+9\nMAT4,1,200.\nCAERO1,7,1,,4,4\n";
  const NastranDeck deck = read_deck("CEND\n" + bulk + unused + "ENDDATA\n");
  for (const char* card : {"PSOLID", "MAT9", "MAT4", "CAERO1"}) EXPECT_EQ(lost(deck.mesh, card), 1) << card;
  for (const Loss& loss : deck.mesh.losses) EXPECT_FALSE(loss.changes_physics) << loss.name;
  EXPECT_THAT(refusal("CEND\n" + bulk + unused + "CHEXA,1,3,1,1,1,1,1,1\n,1,1\nENDDATA\n"),
              HasSubstr("reading on would change stiffness or mass: CHEXA"));
  const std::string matrix = "DMIG,STIF,0,6,1,0,,,1\nDMIG,STIF,1,1,,1,1,5.\nENDDATA\n";
  EXPECT_EQ(lost(read_deck("CEND\n" + bulk + matrix).mesh, "DMIG"), 2);
  EXPECT_THAT(refusal("CEND\nK2GG=STIF\n" + bulk + matrix), HasSubstr("K2GG"));
  EXPECT_THAT(refusal(bulk.substr(11) + matrix), HasSubstr("DMIG"));
}
