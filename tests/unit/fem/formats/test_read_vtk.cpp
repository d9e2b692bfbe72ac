#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <cstring>

#include "fem/error.hpp"
#include "fem/formats/read_mesh.hpp"
#include "fem/formats/read_vtk.hpp"
#include "tests/unit/fem/formats/scratch.hpp"

using namespace tenon;
using namespace tenon::fem;
using namespace tenon::fem::testing;
using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::HasSubstr;

namespace {

/// A unit square of pixel order and a line, with data of every kind.
const std::string old_text = R"(# vtk DataFile Version 4.2
a title
ASCII
DATASET UNSTRUCTURED_GRID
FIELD FieldData 1
TIME 1 1 double
0.5
POINTS 5 float
0 0 0 1 0 0 0 1 0
1 1 0 2 1 0
METADATA
INFORMATION 0

CELLS 2 8
4 0 1 2 3
2 3 4
CELL_TYPES 2
8
3
CELL_DATA 2
SCALARS part int 1
LOOKUP_TABLE default
7
9
FIELD FieldData 2
my%20stress 3 2 double
1 2 3
4 5 6
label 1 2 string
first
second
POINT_DATA 5
VECTORS u float
0 0 0 0 0 1 0 0 2 0 0 3 0 0 4
SCALARS T double
LOOKUP_TABLE heat
1 2 3 4 5
LOOKUP_TABLE heat 1
0 0 0 1
)";

const std::string new_text = R"(# vtk DataFile Version 5.1
vtk output
ASCII
DATASET UNSTRUCTURED_GRID
POINTS 4 double
0 0 0 1 0 0 1 1 0 0 1 0
CELLS 3 5
OFFSETS vtktypeint64
0 3 5
CONNECTIVITY vtktypeint64
0 1 2 2 3
CELL_TYPES 2
5
3

)";

void add_line(std::string& bytes, const std::string& line) { bytes += line + "\n"; }

template <class T>
void add_big_endian(std::string& bytes, std::initializer_list<T> values) {
  for (const T value : values) {
    char raw[sizeof(T)];
    std::memcpy(raw, &value, sizeof raw);
    if (std::endian::native == std::endian::little) std::reverse(raw, raw + sizeof raw);
    bytes.append(raw, sizeof raw);
  }
  bytes += '\n';
}

std::string message(const std::string& bytes) {
  try {
    parse_vtk(bytes, "a.vtk");
  } catch (const InputError& error) {
    return error.what();
  }
  return "read";
}

std::string changed(std::string text, const std::string& old, const std::string& fresh) {
  const auto at = text.find(old);
  EXPECT_NE(at, text.npos) << old;
  return at == text.npos ? text : text.replace(at, old.size(), fresh);
}

}  // namespace

TEST(ReadVtk, KeepsCellsDataAndSetsOfTheOldLayout) {
  const Mesh mesh = parse_vtk(old_text, "a.vtk");
  EXPECT_EQ(mesh.format, "vtk 4.2 ascii");
  ASSERT_EQ(mesh.points.size(), 5U);
  EXPECT_EQ(mesh.points[4], Vec3(2, 1, 0));
  ASSERT_EQ(mesh.cells.size(), 2U);
  EXPECT_EQ(mesh.cells[0].type, CellType::quad);
  EXPECT_THAT(mesh.cells[0].nodes, ElementsAre(0, 1, 3, 2)) << "a pixel counts along the axes";
  EXPECT_THAT(mesh.cells[1].nodes, ElementsAre(3, 4));
  EXPECT_THAT(mesh.cell_sets.at("part_9"), ElementsAre(ElementsAre(), ElementsAre(0)));
  const Mesh bytes = parse_vtk(changed(old_text, "part int", "part signed_char"), "a.vtk");
  EXPECT_THAT(bytes.cell_sets.at("part_9"), ElementsAre(ElementsAre(), ElementsAre(0)));
  EXPECT_EQ(mesh.cell_data.at("my stress")[1], Eigen::MatrixXd(Eigen::RowVector3d(4, 5, 6)));
  EXPECT_EQ(mesh.point_data.at("u").row(4), Eigen::RowVector3d(0, 0, 4));
  EXPECT_EQ(mesh.point_data.at("T")(4, 0), 5.0);
  std::vector<std::string> losses;
  for (const Loss& loss : mesh.losses) losses.push_back(loss.name);
  EXPECT_THAT(losses, ElementsAre("field 'TIME'", "array 'label'", "LOOKUP_TABLE"));
}

TEST(ReadVtk, ReadsTheLayoutOfVersion5) {
  const Mesh mesh = parse_vtk(new_text, "a.vtk");
  ASSERT_EQ(mesh.cells.size(), 2U);
  EXPECT_THAT(mesh.cells[0].nodes, ElementsAre(0, 1, 2));
  EXPECT_THAT(mesh.cells[1].nodes, ElementsAre(2, 3));
  EXPECT_EQ(mesh.points[2], Vec3(1, 1, 0));
}

TEST(ReadVtk, TakesCaseAndLineEndsAsVtkDoes) {
  std::string text = changed(changed(new_text, "ASCII", "ascii"), "POINTS 4 double", "points 4 Double");
  for (std::size_t at = 0; (at = text.find('\n', at)) != text.npos; at += 2) text.replace(at, 1, "\r\n");
  EXPECT_EQ(parse_vtk(text, "a.vtk").points.size(), 4U);
}

TEST(ReadVtk, BinaryIsBigEndianAndMayHoldAnyByte) {
  std::string bytes = "# vtk DataFile Version 3.0\n\nBINARY\nDATASET UNSTRUCTURED_GRID\nPOINTS 2 double\n";
  add_big_endian<double>(bytes, {0, 0, 0, 1.0 / 3, 0, 0});
  add_line(bytes, "CELLS 1 3");
  add_big_endian<std::int32_t>(bytes, {2, 0, 1});
  add_line(bytes, "CELL_TYPES 1");
  add_big_endian<std::int32_t>(bytes, {3});
  add_line(bytes, "POINT_DATA 2\nGLOBAL_IDS id vtkIdType");
  add_big_endian<std::int32_t>(bytes, {10, 0x0a0a0a0a});
  add_line(bytes, "COLOR_SCALARS paint 3");
  add_big_endian<std::uint8_t>(bytes, {1, 2, 3, 4, 5, 255});
  const Mesh mesh = parse_vtk(bytes, "a.vtk");
  EXPECT_EQ(mesh.points[1], Vec3(1.0 / 3, 0, 0));
  EXPECT_EQ(mesh.point_data.at("id")(1, 0), 0x0a0a0a0a);
  ASSERT_EQ(mesh.losses.size(), 1U);
  EXPECT_EQ(mesh.losses[0].name, "COLOR_SCALARS");
  EXPECT_THAT(message(bytes.substr(0, bytes.find("CELLS") - 5)),
              AllOf(HasSubstr("a.vtk:5:1"), HasSubstr("needs 6 values of 8 bytes, 44 bytes are left")));
}

TEST(ReadVtk, IsChosenByTheEnding) {
  const Scratch scratch;
  EXPECT_EQ(read_mesh(scratch.write("a.VTK", new_text)).cells.size(), 2U);
}

TEST(ReadVtk, RefusesOtherDatasetsByName) {
  for (const std::string kind : {"POLYDATA", "STRUCTURED_GRID", "STRUCTURED_POINTS", "RECTILINEAR_GRID"})
    EXPECT_THAT(message(changed(new_text, "UNSTRUCTURED_GRID", kind)),
                AllOf(HasSubstr("a.vtk:4:1"), HasSubstr("found the dataset " + kind + ", expected UNSTRUCTURED_GRID")));
}
