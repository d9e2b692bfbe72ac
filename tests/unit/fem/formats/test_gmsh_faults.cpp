#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <random>

#include "fem/error.hpp"
#include "fem/formats/gmsh.hpp"
#include "tests/unit/fem/formats/allocations.hpp"
#include "tests/unit/fem/formats/scratch.hpp"

using namespace tenon;
using namespace tenon::fem;
using namespace tenon::fem::testing;
using ::testing::AllOf;
using ::testing::HasSubstr;

namespace {

const std::vector<std::string> variants{"mixed_22.msh",
                                        "mixed_22_binary.msh",
                                        "mixed_40.msh",
                                        "mixed_41.msh",
                                        "mixed_41_binary.msh",
                                        "mixed_41_partitioned_binary.msh",
                                        "mixed_22_parametric_binary.msh"};

/// The message of the InputError that an action throws; "" when it throws none.
std::string message_of(const auto& action) {
  try {
    action();
  } catch (const InputError& error) {
    return error.what();
  }
  return {};
}

std::string message(const std::filesystem::path& path) {
  return message_of([&] { read_gmsh(path); });
}

std::string message_for(const std::string& bytes) {
  return message_of([&] { parse_gmsh(bytes, "bad.msh"); });
}

std::string replaced(std::string text, const std::string& from, const std::string& to) {
  const auto at = text.find(from);
  EXPECT_NE(at, std::string::npos) << from;
  return text.replace(at, from.size(), to);
}

std::string text_22() { return contents(fixture("mixed_22.msh")); }
std::string text_41() { return contents(fixture("mixed_41.msh")); }

int cell_count(const Mesh& mesh) {
  int n = 0;
  for (const CellBlock& block : mesh.cells) n += block.size();
  return n;
}

/// Two nodes and a line, version 2.2 text; what stands behind the counts can be varied.
std::string line_22(const std::string& nodes, const std::string& elements) {
  return "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes\n" + nodes + "$EndNodes\n$Elements\n" + elements +
         "$EndElements\n";
}

}  // namespace

TEST(GmshFaults, CutAnywhereIsAnErrorOrTheWholeMesh) {
  for (const std::string& variant : variants) {
    const std::string whole = contents(fixture(variant));
    int errors = 0;
    for (std::size_t n = 0; n < whole.size(); ++n) {
      try {
        EXPECT_EQ(cell_count(parse_gmsh(whole.substr(0, n), "cut.msh")), 2 + 8 + 16 + 8)
            << variant << " cut to " << n << " bytes";
      } catch (const InputError& error) {
        ++errors;
        EXPECT_THAT(error.what(), HasSubstr("cut.msh"));
      }
    }
    EXPECT_GE(errors, static_cast<int>(whole.size()) - 2) << variant;  // the last line end is not needed
  }
}

TEST(GmshFaults, AnyChangedByteIsAnErrorOrAMesh) {
  std::mt19937 random(20240607);
  for (const std::string& variant : variants) {
    const std::string whole = contents(fixture(variant));
    for (int trial = 0; trial < 1500; ++trial) {
      std::string changed = whole;
      for (int k = trial % 3; k >= 0; --k) changed[random() % changed.size()] = static_cast<char>(random());
      largest_request = 0;
      try {
        const Mesh mesh = parse_gmsh(changed, "changed.msh");
        for (const CellBlock& block : mesh.cells)
          for (const int node : block.nodes) ASSERT_LT(static_cast<std::size_t>(node), mesh.points.size());
      } catch (const InputError&) {
      }
      EXPECT_LT(largest_request.load(), 16 * whole.size() + 65536) << variant << " trial " << trial;
    }
  }
}

TEST(GmshFaults, HugeDeclaredCountsAllocateNothing) {
  const std::string huge = "9000000000000000000";
  const std::vector<std::string> files{
      replaced(text_22(), "$Nodes\n32\n", "$Nodes\n" + huge + "\n"),
      replaced(text_22(), "$Elements\n50\n", "$Elements\n" + huge + "\n"),
      replaced(text_22(), "$PhysicalNames\n6\n", "$PhysicalNames\n" + huge + "\n"),
      replaced(text_22(), "\n3 1 2 4", "\n3 1 2000000000 4"),
      replaced(text_41(), "$Entities\n7 9 2 0", "$Entities\n7 9 " + huge + " 0"),
      replaced(text_41(), "$Nodes\n18 32", "$Nodes\n" + huge + " " + huge),
      replaced(text_41(), "1 1 0 3\n", "1 1 0 " + huge + "\n"),
      replaced(text_41(), "$Nodes\n18 32", "$Nodes\n18 " + huge),
      replaced(text_41(), "\n7 -1 0.5 0 1 1", "\n7 -1 0.5 0 " + huge + " 1"),
      text_41() + "$NodeData\n0\n0\n3\n0\n1\n" + huge + "\n$EndNodeData\n",
      text_41() + "$NodeData\n" + huge + "\n",
      line_22("1\n9223372036854775807 0 0 0\n", "1\n1 15 0 1\n"),
  };
  for (const std::string& file : files) {
    largest_request = 0;
    EXPECT_THROW(parse_gmsh(file, "bad.msh"), InputError) << file.substr(0, 300);
    EXPECT_LT(largest_request.load(), 16 * file.size() + 65536);
  }
  std::string binary = contents(fixture("mixed_41_binary.msh"));
  for (const char* const heading : {"$Entities\n", "$Nodes\n", "$Elements\n"})
    for (std::size_t word = 0; word < 2; ++word) {
      std::string file = binary;
      file.replace(file.find(heading) + std::string(heading).size() + 8 * word, 8, "\xff\xff\xff\xff\xff\xff\xff\x7f");
      largest_request = 0;
      EXPECT_THROW(parse_gmsh(file, "bad.msh"), InputError);
      EXPECT_LT(largest_request.load(), 16 * file.size() + 65536);
    }
}

TEST(GmshFaults, MissingEmptyAndForeignFiles) {
  const Scratch scratch;
  scratch.write("panel.msh", text_22());
  EXPECT_THAT(message(scratch.file("pannel.msh")),
              AllOf(HasSubstr("no such file"), HasSubstr("Did you mean"), HasSubstr("panel.msh")));
  EXPECT_THAT(message(scratch.file("no/such/folder/a.msh")), HasSubstr("readable folder"));
  EXPECT_THAT(message(scratch.file(".")), HasSubstr("folder"));
  EXPECT_THAT(message("/dev/null"), HasSubstr("not a regular file"));
  EXPECT_THAT(message_for(""), HasSubstr("empty"));
  EXPECT_THAT(message_for(" \n\n"), HasSubstr("$Nodes"));
  EXPECT_THAT(message_for(std::string("\x7f"
                                      "ELF\x02\x01\x00",
                                      7)),
              AllOf(HasSubstr("bad.msh:1:1"), HasSubstr("'\\x7fELF\\x02\\x01\\x00'"), HasSubstr("$MeshFormat")));
  EXPECT_THAT(message_for("$NOD\n1\n"), HasSubstr("$MeshFormat"));
  EXPECT_THAT(message_for("$MeshFormat\n3.0 0 8\n$EndMeshFormat\n"),
              AllOf(HasSubstr("bad.msh:2:1"), HasSubstr("found version 3, expected 2.0 to 2.2, 4.0 or 4.1")));
  EXPECT_THAT(message_for("$MeshFormat\n4.1 7 8\n$EndMeshFormat\n"), HasSubstr("found file type 7, expected 0"));
  EXPECT_THAT(message_for("$MeshFormat\n4.1 0 16\n$EndMeshFormat\n"), HasSubstr("found data size 16"));
  EXPECT_THAT(message_for("$MeshFormat\n4 1 8\n"), HasSubstr("binary files of version 4.0 are not read"));
  EXPECT_THAT(message_for("$MeshFormat\n4.1 1 8\nabcd\n$EndMeshFormat\n"),
              AllOf(HasSubstr("byte offset 20"), HasSubstr("expected the number 1")));
}

TEST(GmshFaults, EachIsNamedWithItsPlace) {
  const std::string nodes = "2\n1 0 0 0\n2 1 0 0\n", element = "1\n1 1 0 1 2\n";
  EXPECT_EQ(message_for(line_22(nodes, element)), "");
  // lines: 1-3 format, 4 $Nodes, 5 count, 6-7 nodes, 8 $EndNodes, 9 $Elements, 10 count, 11 element
  const std::vector<std::array<std::string, 3>> cases{
      {line_22("2\n1 0 0 0\n2 nan 0 0\n", element), "bad.msh:7:3: in $Nodes: found 'nan', expected the x coordinate",
       ""},
      {line_22("2\n1 0 0 0\n2 1 -inf 0\n", element), "bad.msh:7:5: in $Nodes: found '-inf', expected the y coordinate",
       ""},
      {line_22("2\n1 0 0 0\n2 1 0 1e999\n", element),
       "bad.msh:7:7: in $Nodes: found '1e999', expected the z coordinate", ""},
      {line_22("2\n1 0 0 0\n2 1 0 0x\n", element), "bad.msh:7:7: in $Nodes: found '0x', expected the z coordinate", ""},
      {line_22("2\n1 0 0 0\n2 1 0\n", element),
       "bad.msh:7:6: in $Nodes: found the end of the line, expected the z coordinate", ""},
      {line_22("2\n1 0 0 0\n2 1 0 0 0\n", element), "bad.msh:7:9: in $Nodes: found '0', expected the end of the line",
       ""},
      {line_22("2\n1 0 0 0\n1 1 0 0\n", element), "bad.msh:7:1: in $Nodes: node 1 is defined a second time",
       "Renumber"},
      {line_22("2\n1 0 0 0\n0 1 0 0\n", element),
       "bad.msh:7:1: in $Nodes: found node number 0, expected numbers from 1", ""},
      {line_22("2\n1 0 0 0\n-2 1 0 0\n", element),
       "bad.msh:7:1: in $Nodes: found -2, expected the node's number (not negative)", ""},
      {line_22("3\n1 0 0 0\n2 1 0 0\n", element), "bad.msh:8:1: in $Nodes: found '$EndNodes', expected node 3 of 3",
       ""},
      {line_22("1\n1 0 0 0\n2 1 0 0\n", element), "bad.msh:7:1: in $Nodes: found '2', expected $EndNodes", ""},
      {line_22("-1\n", element), "bad.msh:5:1: in $Nodes: found -1, expected the number of nodes", ""},
      {line_22("0\n", element), "elements come before any node", ""},
      {line_22(nodes, "1\n1 1 0 1 5\n"),
       "bad.msh:11:9: in $Elements: element 1 names node 5, which $Nodes does not define", ""},
      {line_22(nodes, "1\n1 1 0 1 -2\n"), "bad.msh:11:9: in $Elements: found -2, expected a node of the element", ""},
      {line_22(nodes, "1\n1 21 0 1 2\n"), "bad.msh:11:3: in $Elements: found element type 21, expected one of 1 to 19",
       "order 1 or 2"},
      {line_22(nodes, "1\n1 0 0 1 2\n"), "found element type 0", ""},
      {line_22(nodes, "1\n1 1 -1 1 2\n"), "bad.msh:11:5: in $Elements: found -1 as the number of tags", ""},
      {line_22(nodes, "1\n1 1 0 1\n"), "found the end of the line, expected a node of the element", ""},
      {line_22(nodes, "1\n1 1 99999999999 1 2\n"),
       "bad.msh:11:5: in $Elements: found 99999999999, expected the number of tags (a 4-byte whole number)", ""},
      {line_22(nodes, "0\n"), "the file ends without any element, expected $Elements", ""},
      {line_22(nodes, element) + "$Nodes\n1\n1 0 0 0\n$EndNodes\n", "node 1 is defined a second time", ""},
      {line_22(nodes, element) + line_22(nodes, element), "bad.msh:13:1: found a second $MeshFormat",
       "file of its own"},
      {line_22(nodes, element) + "words\n", "bad.msh:13:1: found 'words', expected a section such as $Nodes", ""},
      {line_22(nodes, element) + "$Periodic\n1\n",
       "bad.msh:13:1: in $Periodic: the section $Periodic has no $EndPeriodic", ""},
      {line_22(nodes, element) + "$NodeData\n0\n0\n3\n0\n0\n1\n1 1\n$EndNodeData\n", "found 0 components, expected 1",
       ""},
      {line_22(nodes, element) + "$NodeData\n0\n0\n2\n0\n1\n", "found 2 integer tags, expected at least 3", ""},
      {line_22(nodes, element) + "$NodeData\n1\n\"u\"\n0\n3\n0\n1\n1\n7 1.5\n$EndNodeData\n",
       "$NodeData 'u' (at byte offset", "node 7"},
      {line_22(nodes, element) + "$ElementData\n1\n\"u\"\n0\n3\n0\n1\n1\n7 1.5\n$EndElementData\n",
       "$ElementData 'u' (at byte offset", "element 7"},
      {replaced(text_22(), "0 1 \"root\"", "4 1 \"root\""),
       "bad.msh:6:1: in $PhysicalNames: found the dimension 4, expected 0 to 3", ""},
      {replaced(text_22(), "\"root\"", "root"),
       "bad.msh:6:5: in $PhysicalNames: found 'root', expected a name in double quotes", ""},
      {replaced(text_41(), "$Nodes\n18 32", "$Nodes\n18 31"),
       "in $Nodes: the blocks hold 32 nodes, expected the 31 declared", ""},
      {replaced(text_41(), "\n7 -1 0.5 0 1 1", "\n17 -1 0.5 0 1 1"),
       "in $Elements: the block is on entity 7 of dimension 0, which $Entities does not list", ""},
  };
  for (const auto& [file, what, also] : cases) EXPECT_THAT(message_for(file), AllOf(HasSubstr(what), HasSubstr(also)));
}

TEST(GmshFaults, CellsOfAnotherDimensionThanTheirEntity) {
  EXPECT_THAT(
      message_for("$MeshFormat\n4.1 0 8\n$EndMeshFormat\n$Nodes\n1 2 1 2\n1 1 0 2\n1\n2\n0 0 0\n1 0 0\n$EndNodes\n"
                  "$Elements\n1 1 1 1\n2 1 1 1\n1 1 2\n$EndElements\n"),
      AllOf(HasSubstr("bad.msh:14:3"),
            HasSubstr("found cells of type line on an entity of dimension 2, expected dimension 1")));
}

TEST(GmshFaults, BinaryFilesNameTheByte) {
  const std::string whole = contents(fixture("mixed_22_binary.msh"));
  const std::size_t first_node = whole.find("$Nodes\n32\n") + 10;
  std::string bad = whole;
  const double nan = std::nan("");
  std::memcpy(bad.data() + first_node + 4, &nan, sizeof nan);
  EXPECT_THAT(message_for(bad), HasSubstr("byte offset " + std::to_string(first_node + 4) +
                                          ": in $Nodes: found nan, expected the x coordinate"));
  bad = whole;
  bad.replace(first_node + 28, 4, bad.substr(first_node, 4));
  EXPECT_THAT(message_for(bad), HasSubstr("byte offset " + std::to_string(first_node + 28) +
                                          ": in $Nodes: node 1 is defined a second time"));
  EXPECT_THAT(message_for(whole.substr(0, first_node + 30)),
              HasSubstr("byte offset " + std::to_string(first_node + 30) +
                        ": in $Nodes: the file ends, expected the node's number (4 bytes, 2 left)"));
  const std::size_t first_run = whole.find("$Elements\n50\n") + 13;
  bad = whole;
  bad[first_run + 4] = 0;
  EXPECT_THAT(message_for(bad), HasSubstr("found a run of 0 elements, expected 1 to 50"));
}
