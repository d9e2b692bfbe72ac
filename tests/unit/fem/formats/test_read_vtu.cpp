#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdlib>

#include "fem/error.hpp"
#include "fem/formats/read_mesh.hpp"
#include "fem/formats/read_vtu.hpp"
#include "fem/formats/vtu.hpp"
#include "tests/support/oracle.hpp"
#include "tests/unit/fem/formats/scratch.hpp"

using namespace tenon;
using namespace tenon::fem;
using namespace tenon::fem::testing;
using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::HasSubstr;

namespace {

/// One piece of a line from (0, 0, 0) to (x, 0, 0) in part `part`, with the temperatures 1 and 2 at its ends.
std::string piece(double x, int part) {
  return fmt::format(
      "<Piece NumberOfPoints=\"2\" NumberOfCells=\"1\">\n"
      "<PointData><DataArray type=\"Float64\" Name=\"T\" format=\"ascii\">1 2</DataArray></PointData>\n"
      "<CellData><DataArray type=\"Int32\" Name=\"part\" format=\"ascii\">{}</DataArray></CellData>\n"
      "<Points><DataArray type=\"Float32\" NumberOfComponents=\"3\">0 0 0 {} 0 0</DataArray></Points>\n"
      "<Cells><DataArray type=\"Int64\" Name=\"connectivity\">0 1</DataArray>\n"
      "<DataArray type=\"Int64\" Name=\"offsets\">2</DataArray>\n"
      "<DataArray type=\"UInt8\" Name=\"types\">3</DataArray></Cells></Piece>\n",
      part, x);
}

std::string file(const std::string& pieces, const std::string& attributes = "") {
  return fmt::format(
      "<?xml version=\"1.0\"?>\n<VTKFile type=\"UnstructuredGrid\" version=\"1.0\"{}>\n<UnstructuredGrid>\n{}"
      "</UnstructuredGrid>\n</VTKFile>\n",
      attributes, pieces);
}

std::string replaced(std::string text, const std::string& old, const std::string& fresh) {
  const auto at = text.find(old);
  EXPECT_NE(at, text.npos) << old;
  return at == text.npos ? text : text.replace(at, old.size(), fresh);
}

std::string message(const std::string& bytes) {
  try {
    parse_vtu(bytes, "a.vtu");
  } catch (const InputError& error) {
    return error.what();
  }
  return "read";
}

}  // namespace

TEST(ReadVtu, KeepsAllPiecesWithDataAndSets) {
  const Mesh mesh = parse_vtu(file(piece(2.0, 7) + piece(3.5, 8)), "a.vtu");
  ASSERT_EQ(mesh.points.size(), 4U);
  EXPECT_EQ(mesh.points[3], Vec3(3.5, 0, 0));
  ASSERT_EQ(mesh.cells.size(), 1U);
  EXPECT_THAT(mesh.cells[0].nodes, ElementsAre(0, 1, 2, 3));
  EXPECT_EQ(mesh.point_data.at("T"), Eigen::MatrixXd(Eigen::Vector4d(1, 2, 1, 2)));
  EXPECT_THAT(mesh.cell_sets.at("part_8"), ElementsAre(ElementsAre(1)));
  ASSERT_EQ(mesh.losses.size(), 1U);
  EXPECT_EQ(mesh.losses[0].name, "Piece");
  EXPECT_EQ(mesh.losses[0].count, 2);
}

TEST(ReadVtu, ReadsWhatIsWritten) {
  const Scratch scratch;
  Mesh mesh;
  for (int i = 0; i < 6; ++i) mesh.points.emplace_back(i, 0.5 * i * i, -i);
  mesh.cells = {{CellType::wedge, {0, 1, 2, 3, 4, 5}, {1}}, {CellType::quad, {3, 2, 1, 0}, {2}}};
  write_vtu(scratch.file("a.vtu"), mesh);
  const Mesh found = read_mesh(scratch.file("a.vtu"));
  EXPECT_EQ(found.points, mesh.points);
  ASSERT_EQ(found.cells.size(), 2U);
  EXPECT_EQ(found.cells[0].nodes, mesh.cells[0].nodes);
  EXPECT_EQ(found.cells[1].nodes, mesh.cells[1].nodes);
}

/// The points 1, 2, 3 as big-endian Float32 behind header words of 4 and 8 bytes, as raw bytes, and in base64 whose
/// header is encoded alone and together with the data.
TEST(ReadVtu, ReadsAppendedAndEncodedArraysOfEitherOrder) {
  const std::string data("\x3f\x80\0\0\x40\0\0\0\x40\x40\0\0", 12), four("\0\0\0\x0c", 4),
      eight("\0\0\0\0\0\0\0\x0c", 8);
  const std::string vertex =
      replaced(replaced(replaced(piece(0, 1), "<PointData>", "<PointData/><!--"), "</PointData>", "-->"),
               "NumberOfPoints=\"2\"", "NumberOfPoints=\"1\"");
  const std::string cell = replaced(replaced(replaced(vertex, ">0 1<", ">0<"), ">2<", ">1<"), ">3<", ">1<");
  const std::string points = "<DataArray type=\"Float32\" NumberOfComponents=\"3\">0 0 0 0 0 0</DataArray>";
  const auto read = [&](const std::string& array, const std::string& word, const std::string& tail) {
    const std::string text =
        file(replaced(cell, points, array), fmt::format(" byte_order=\"BigEndian\" header_type=\"{}\"", word));
    const Mesh mesh = parse_vtu(tail.empty() ? text : replaced(text, "</VTKFile>", tail + "</VTKFile>"), "a.vtu");
    EXPECT_EQ(mesh.points.at(0), Vec3(1, 2, 3)) << array << word;
  };
  const std::string appended = "<DataArray type=\"Float32\" format=\"appended\" offset=\"3\"/>";
  read(appended, "UInt32", "<AppendedData encoding=\"raw\">\n_<&>" + four + data + "</AppendedData>");
  read(appended, "UInt64", std::string("<AppendedData encoding=\"raw\">_\0<>", 33) + eight + data + "</AppendedData>");
  const auto binary = [](const std::string& text) {
    return "<DataArray type=\"Float32\" format=\"binary\">" + text + "</DataArray>";
  };
  read(binary("\n AAAADA== P4AAAEAAAABAQAAA\n"), "UInt32", "");
  read(binary("AAAADD+AAABAAAAAQEAAAA=="), "UInt32", "");
}

/// meshio writes one mesh in all its encodings; every cell type that it knows (5.0 knows no wedge15 and pyramid13),
/// with node numbers that tell the order.
TEST(ReadVtu, ReadsWhatMeshioWrites) {
  const Scratch scratch;
  TENON_SKIP_WITHOUT(std::system("/usr/bin/python3 -c 'import meshio' 2>/dev/null") == 0, "python3-meshio");
  const auto script = scratch.write("make.py", R"(import sys, numpy as np, meshio
types = dict(vertex=1, line=2, line3=3, triangle=3, triangle6=6, quad=4, quad8=8, quad9=9, tetra=4, tetra10=10,
    hexahedron=8, hexahedron20=20, hexahedron27=27, wedge=6, wedge18=18, pyramid=5)
i = np.arange(30)
mesh = meshio.Mesh(np.c_[i / 3, i * i, -i], [(t, np.arange(2 * n).reshape(2, n) % 30) for t, n in types.items()],
    point_data={'T': i * 0.1}, cell_data={'part': [np.array([k, k + 1]) for k in range(len(types))]})
for name, o in dict(ascii=dict(binary=False), raw=dict(compression=None), zlib={}, wide=dict(header_type='UInt64')).items():
    meshio.vtu.write(f'{sys.argv[1]}/{name}.vtu', mesh, **o)
)");
  const std::string command =
      fmt::format("/usr/bin/python3 {} {} >/dev/null 2>&1", script.string(), scratch.file("").string());
  ASSERT_EQ(std::system(command.c_str()), 0);
  for (const char* const name : {"ascii.vtu", "raw.vtu", "zlib.vtu", "wide.vtu"}) {
    const Mesh mesh = read_vtu(scratch.file(name));
    ASSERT_EQ(mesh.points.size(), 30U) << name;
    for (int i = 0; i < 30; ++i)  // text has 12 digits: 5e-12 of the value
      EXPECT_LT((mesh.points[static_cast<std::size_t>(i)] - Vec3(i / 3.0, i * i, -i)).norm(), 5e-12 * (1 + i * i));
    ASSERT_EQ(mesh.cells.size(), 16U) << name;
    for (std::size_t b = 0; b < 16; ++b) {
      constexpr auto wedge15 = static_cast<std::size_t>(CellType::wedge15);
      EXPECT_EQ(mesh.cells[b].type, static_cast<CellType>(b < wedge15 ? b : b + 1)) << name;
      ASSERT_EQ(mesh.cells[b].size(), 2) << name;
      for (std::size_t k = 0; k < mesh.cells[b].nodes.size(); ++k)
        EXPECT_EQ(mesh.cells[b].nodes[k], static_cast<int>(k) % 30) << name << " block " << b;
      EXPECT_EQ(mesh.cell_data.at("part")[b](1, 0), static_cast<double>(b) + 1.0) << name;
    }
    EXPECT_THAT(mesh.cell_sets.at("part_1")[0], ElementsAre(1)) << name;
    EXPECT_THAT(mesh.cell_sets.at("part_1")[1], ElementsAre(0)) << name;
  }
}

TEST(ReadVtu, SaysWhatIsWrong) {
  const std::string good = file(piece(1.0, 1));
  const auto with = [&](const std::string& old, const std::string& fresh) {
    return message(replaced(good, old, fresh));
  };
  EXPECT_EQ(message(good), "read");
  EXPECT_THAT(message(""), HasSubstr("empty"));
  EXPECT_THAT(message(good.substr(0, good.size() / 2)), HasSubstr("no well-formed XML"));
  EXPECT_THAT(with("UnstructuredGrid\"", "ImageData\""), AllOf(HasSubstr("a.vtu:2:"), HasSubstr("ImageData")));
  EXPECT_THAT(with(">3<", ">42<"), HasSubstr("VTK's type 42"));
  EXPECT_THAT(with(">0 1<", ">0 2<"), HasSubstr("names point 2 of 2"));
  EXPECT_THAT(with(">2<", ">9<"), HasSubstr("ends at 9"));
  EXPECT_THAT(with(">1 2<", ">1 x<"), AllOf(HasSubstr("a.vtu:5:"), HasSubstr("'T' found 'x' in place of value 2")));
  EXPECT_THAT(with("NumberOfPoints=\"2\"", "NumberOfPoints=\"2000000000\""), HasSubstr("6 coordinates for 2000000000"));
  EXPECT_THAT(with("0 0 0 1", "0 0 0 nan"), HasSubstr("not finite"));
  EXPECT_THAT(with("\"part\"", "\"vtkGhostType\""), HasSubstr("ghosts"));
  EXPECT_THAT(with("format=\"ascii\">1 2<", "format=\"binary\">____AAAA<"), HasSubstr("no base64"));
  EXPECT_THAT(with("format=\"ascii\">1 2<", "format=\"binary\">/////w==<"), HasSubstr("needs 4294967295 more bytes"));
  EXPECT_THAT(with("Grid\" version=", "Grid\" compressor=\"vtkLZ4DataCompressor\" version="),
              HasSubstr("vtkZLibDataCompressor"));
}
