#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "fem/error.hpp"
#include "fem/formats/read_mesh.hpp"
#include "tests/unit/fem/formats/scratch.hpp"

using namespace tenon;
using namespace tenon::fem;
using namespace tenon::fem::testing;
using ::testing::AllOf;
using ::testing::HasSubstr;

namespace {

std::string message(const std::filesystem::path& path) {
  try {
    read_mesh(path);
  } catch (const InputError& error) {
    return error.what();
  }
  return {};
}

}  // namespace

TEST(ReadMesh, ChoosesByContentAndByExtension) {
  const Scratch scratch;
  EXPECT_EQ(read_mesh(fixture("mixed_41_binary.msh")).points.size(), 32U);
  const std::string bytes = contents(fixture("mixed_22.msh"));
  EXPECT_EQ(read_mesh(scratch.write("panel.txt", bytes)).points.size(), 32U);
  EXPECT_EQ(read_mesh(scratch.write("PANEL.MSH", bytes)).points.size(), 32U);
}

TEST(ReadMesh, RefusesOtherFormatsAndSaysWhatItReads) {
  const Scratch scratch;
  EXPECT_THAT(message(scratch.write("a.unv", "    -1\n")), AllOf(HasSubstr("'.unv'"), HasSubstr(".msh")));
  EXPECT_THAT(message(scratch.write("a.BDF", "GRID,1\n")), AllOf(HasSubstr("'.bdf'"), HasSubstr("Nastran")));
  EXPECT_THAT(message(scratch.write("a.msh", "(0 \"Fluent\")\n")), HasSubstr("$MeshFormat"));
  EXPECT_THAT(message(scratch.write("mesh", "x")), HasSubstr(".msh"));
}

TEST(ReadMesh, NamesNearMissesOfAMissingFile) {
  const Scratch scratch;
  scratch.write("wing.msh", "");
  EXPECT_THAT(message(scratch.file("wimg.msh")), AllOf(HasSubstr("no such file"), HasSubstr("wing.msh")));
  EXPECT_THAT(message(scratch.file("something_else.msh")),
              AllOf(HasSubstr("no such file"), ::testing::Not(HasSubstr("mean"))));
}
