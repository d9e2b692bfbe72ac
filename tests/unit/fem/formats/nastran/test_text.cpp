#include <cmath>

#include "fem/formats/nastran/cards.hpp"
#include "tests/unit/fem/formats/nastran/deck_file.hpp"

using namespace tenon;
using namespace tenon::fem;
using nastran::parse_integer;
using nastran::parse_real;
using tenon::fem::testing::Scratch;
using ::testing::ElementsAre;
using ::testing::HasSubstr;

TEST(NastranNumbers, RealsInAllTheirForms) {
  EXPECT_EQ(parse_real("1.92+8"), 1.92e8);
  EXPECT_EQ(parse_real("-2.74-6"), -2.74e-6);
  EXPECT_EQ(parse_real("1.5E+3"), 1500.0);
  EXPECT_EQ(parse_real("1.5d3"), 1500.0);
  EXPECT_EQ(parse_real("+7."), 7.0);
  EXPECT_EQ(parse_real(".25"), 0.25);
  EXPECT_EQ(parse_real("12"), 12.0);
  EXPECT_EQ(parse_real("0.100000000E+01"), 1.0);
}

TEST(NastranNumbers, WhatIsNoRealIsNone) {
  for (const char* text :
       {"", "+", ".", "1.0.0", "1.+", "1.E", "nan", "inf", "0x10", "1 2", "--1.", "1.e5x", "1.+999", "E5"})
    EXPECT_FALSE(parse_real(text)) << text;
}

TEST(NastranNumbers, IntegersAreWholeAndInRange) {
  EXPECT_EQ(parse_integer("+12"), 12);
  EXPECT_EQ(parse_integer("-3"), -3);
  for (const char* text : {"", "1.", "1e3", "12a", "99999999999999999999", "+-1", "+"})
    EXPECT_FALSE(parse_integer(text)) << text;
}

namespace {

std::vector<long> ids(const std::string& content) { return read_deck(content).mesh.point_ids; }

Vec3 first_point(const std::string& content) { return read_deck(content).mesh.points.at(0); }

const Vec3 expected_point(1.5, -25.0, 0.125);

}  // namespace

TEST(NastranText, SmallLargeAndFreeFieldSayTheSame) {
  EXPECT_EQ(first_point("GRID           7       0     1.5  -2.5+1    .125\n"), expected_point);
  EXPECT_EQ(first_point(
                "GRID*                  7               0             1.5          -2.5+1\n*                   .125\n"),
            expected_point);
  EXPECT_EQ(
      first_point(
          "grid*                  7               0             1.5          -2.5+1*A1\n*A1                 .125\n"),
      expected_point);
  EXPECT_EQ(first_point("GRID,7,0,1.5,-2.5+1,.125\n"), expected_point);
  EXPECT_EQ(first_point("  grid , 7,, 1.5 , -25. ,.125\n"), expected_point);
  EXPECT_EQ(first_point("GRID*,7,,1.5,-25.\n*,.125\n"), expected_point);
  EXPECT_EQ(first_point("GRID\t7\t0\t1.5\t-25.\t.125\n"), expected_point);
}

TEST(NastranText, CarriageReturnsCommentsAndBlankLinesDoNotMatter) {
  EXPECT_EQ(first_point("$ a deck\r\n\r\nGRID           7       0     1.5    -25.    .125$ behind\r\n   \r\n$\r\n"),
            expected_point);
}

TEST(NastranText, ColumnsBehindTheEightiethAreNotRead) {
  EXPECT_EQ(
      first_point("GRID           7       0     1.5    -25.    .125" + std::string(24, ' ') + "+MARK   and more 99.\n"),
      expected_point);
}

TEST(NastranText, ContinuationsOfEveryForm) {
  const std::string start =
      "GRID,1\nGRID,2,,1.\nGRID,3,,2.\nGRID,4,,3.\nGRID,5,,4.\nGRID,6,,5.\nGRID,7,,6.\nGRID,8,,7.\n";
  for (const std::string card : {
           "RBE2    9       1       123     2       3       4       5       6\n        7       8\n",
           "RBE2    9       1       123     2       3       4       5       6\n+       7       8\n",
           "RBE2    9       1       123     2       3       4       5       6       +R1\n+R1     7       8\n",
           "RBE2    9       1       123     2       3       4       5       6\n$ between\n\n+       7       8\n",
           "RBE2,9,1,123,2,3,4,5,6\n,7,8\n",
           "RBE2,9,1,123,2,3,4,5,6,+\n+,7,8\n",
           "RBE2,9,1,123,2,3,4,5,6,+A\n+A      7       8\n",
           "RBE2*                  9               1             123               2\n"
           "*                      3               4               5               6\n"
           "*                      7               8\n",
           // four large fields, then small ones: the rest of the large pair is blank
           "RBE2*                  9               1             123               2\n"
           "+       3       4       5       6       7       8\n",
           // a continuation that is blank throughout stands for eight blank fields
           "RBE2    9       1       123     2       3       4       5       6\n+\n+       7       8\n",
       }) {
    const auto links = read_deck(start + card).model.rigid_links;
    ASSERT_EQ(links.size(), 1U) << card;
    EXPECT_THAT(links[0].dependents, ElementsAre(1, 2, 3, 4, 5, 6, 7)) << card;
  }
}

TEST(NastranText, ContinuationsWithoutTheirCardAreRefused) {
  EXPECT_THAT(refusal("+       1       2\nGRID,1\n"),
              HasSubstr("deck.bdf:1:1: found a continuation line without a card"));
  EXPECT_THAT(refusal("GRID,1,,0.,0.,0.,,,,+A\nGRID,2\n+A,1\n"),
              HasSubstr("deck.bdf:3:1: found the continuation '+A'"));
  EXPECT_THAT(refusal("GRID,1,0,0.,0.,0.,0,,,0,5\n"), HasSubstr("deck.bdf:1:23: found '0' after the 8 data fields"));
  EXPECT_THAT(refusal("GRID,1\n=,*(1),==\n"), HasSubstr("Replication"));
}

TEST(NastranText, SectionsBeforeTheBulkDataAreOptional) {
  EXPECT_THAT(ids("GRID,1\nGRID,2\n"), ElementsAre(1, 2));
  EXPECT_THAT(ids("GRID,1\nENDDATA\nGRID,2\n"), ElementsAre(1));
  EXPECT_THAT(ids("BEGIN BULK\nGRID,1\nENDDATA\n"), ElementsAre(1));
  const NastranDeck deck = read_deck(
      "ASSIGN OUTPUT4='x.op4',UNIT=1\nSOL 103\ninclude '/nowhere/dmap.v9'\nCEND\nTITLE = A boom\nMETHOD=1\nbegin   "
      "bulk\nGRID,4\nENDDATA\n");
  EXPECT_THAT(deck.mesh.point_ids, ElementsAre(4));
  EXPECT_EQ(deck.title, "A boom");
  EXPECT_EQ(deck.mesh.format, "nastran bulk data");
}

TEST(NastranText, ADeckThatEndsEarlyIsRefused) {
  EXPECT_THAT(refusal("SOL 103\nCEND\nMETHOD = 1\n"), HasSubstr("deck.bdf:3: the file ends before BEGIN BULK"));
  EXPECT_THAT(refusal("SOL 103\nCEND\nBEGIN BULK\nGRID,1\n"), HasSubstr("ENDDATA"));
  const NastranDeck deck =
      read_deck("CEND\nBEGIN BULK\nGRID,1\n", {.allow_losses = true, .spc_set = {}, .mpc_set = {}});
  EXPECT_EQ(lost(deck.mesh, "ENDDATA"), 1);
}

TEST(NastranText, IncludesAreFoundBesideTheirFileOrBesideTheDeck) {
  const Scratch folder;
  for (const char* name : {"parts", "a folder/with a long name"})
    std::filesystem::create_directories(folder.file(name));
  folder.write("parts/a.blk", "GRID,2\nINCLUDE 'b.blk'\ninclude \"common.blk\"\n");
  folder.write("parts/b.blk", "$ nothing but a grid\nGRID,3\n");
  folder.write("common.blk", "GRID,4\n");
  folder.write("plain.blk", "GRID,5\n");
  folder.write("a folder/with a long name/split.blk", "GRID,6\n");
  const auto deck = folder.write("deck.dat",
                                 "CEND\nBEGIN BULK\nGRID,1\nINCLUDE 'parts/a.blk' $ the first\ninclude plain.blk\n"
                                 "INCLUDE 'a folder/\n   with a long name/\nsplit.blk'\nGRID,7\nENDDATA\n");
  EXPECT_THAT(read_nastran(deck).mesh.point_ids, ElementsAre(1, 2, 3, 4, 5, 6, 7));
}

TEST(NastranText, ErrorsStandAtTheLineOfTheIncludedFile) {
  const Scratch folder;
  folder.write("part.blk", "GRID,1\n$\nGRID           2       0     1.x\n");
  const auto deck = folder.write("deck.dat", "\n\nINCLUDE 'part.blk'\n");
  try {
    read_nastran(deck);
    FAIL();
  } catch (const InputError& error) {
    EXPECT_TRUE(error.place().file.ends_with("part.blk"));
    EXPECT_EQ(error.place().line, 3);
    EXPECT_EQ(error.place().column, 25);
    EXPECT_THAT(error.what(), HasSubstr("GRID field X1 is '1.x', expected a real number"));
  }
}

TEST(NastranText, IncludesThatFailAreNamedWhereTheyStand) {
  const Scratch folder;
  folder.write("a.blk", "GRID,1\nINCLUDE 'deck.dat'\n");
  folder.write("b.blk", "GRID,9\n");
  const auto message = [&](const std::string& content) {
    try {
      read_nastran(folder.write("deck.dat", content));
    } catch (const InputError& error) {
      return std::string(error.what());
    }
    return std::string("read");
  };
  EXPECT_THAT(message("GRID,2\nINCLUDE 'a.blk'\n"), HasSubstr("a.blk:2: "));
  EXPECT_THAT(message("GRID,2\nINCLUDE 'a.blk'\n"), HasSubstr("includes itself"));
  EXPECT_THAT(message("INCLUDE 'b.blk'\nINCLUDE 'b.blk'\n"), HasSubstr("deck.dat:2: "));
  EXPECT_THAT(message("INCLUDE 'b.blk'\nINCLUDE './b.blk'\n"), HasSubstr("a second time"));
  EXPECT_THAT(message("\nINCLUDE 'missing.blk'\n"), HasSubstr("deck.dat:2: the included file"));
  EXPECT_THAT(message("INCLUDE 'never closed\nGRID,1\n"), HasSubstr("deck.dat:1: INCLUDE opens a quote"));
  EXPECT_THAT(message("INCLUDE\nGRID,1\n"), HasSubstr("INCLUDE names no file"));
  EXPECT_THAT(message("INCLUDE '.'\nGRID,1\n"), HasSubstr("deck.dat:1: "));
}

TEST(NastranText, FilesThatAreNoDeckAreRefused) {
  EXPECT_THROW(read_nastran("/nowhere/missing.bdf"), InputError);
  EXPECT_THAT(refusal(""), HasSubstr("holds no bulk data"));
  EXPECT_THAT(refusal("$ only a comment\n"), HasSubstr("holds no bulk data"));
  EXPECT_THAT(refusal(std::string("GRID,1\nGR\0ID", 12)), HasSubstr("deck.bdf:2: found the byte 0x00, expected text"));
  EXPECT_THAT(refusal("\x7f"
                      "ELF\x02\x01\x01"),
              HasSubstr("expected text"));
  EXPECT_THAT(refusal("$MeshFormat\n2.2 0 8\n"), HasSubstr("found '2.2 0 8' where a card's name was expected"));
  EXPECT_THAT(refusal("MAT1,1,2.+11,,.3\n"), HasSubstr("defines no GRID"));
}

TEST(NastranText, AByteOrderMarkIsNoPartOfTheText) {
  EXPECT_EQ(read_deck("\xEF\xBB\xBFGRID,1,,2.\nGRID\t2\n").mesh.points.size(), 2U);
  EXPECT_EQ(read_deck("\xEF\xBB\xBFGRID,1,,2.\n").mesh.points.at(0).x(), 2.0);
}
