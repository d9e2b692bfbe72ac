#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <hdf5.h>

#include <cmath>

#include "fem/error.hpp"
#include "fem/formats/read_mesh.hpp"
#include "fem/formats/read_xdmf.hpp"
#include "tests/unit/fem/formats/scratch.hpp"

using namespace tenon;
using namespace tenon::fem;
using ::testing::HasSubstr;

namespace {

const std::string square_points =
    "<Geometry GeometryType=\"XY\"><DataItem Dimensions=\"4 2\" Precision=\"8\">0 0 2 0 2 1 0 1</DataItem></Geometry>";
const std::string square_cells =
    "<Topology TopologyType=\"Quadrilateral\" NumberOfElements=\"1\">"
    "<DataItem NumberType=\"Int\" Dimensions=\"1 4\">0 1 2 3</DataItem></Topology>";

std::string square_grid(const std::string& rest = {}) {
  return "<Grid Name=\"g\">" + square_points + square_cells + rest + "</Grid>";
}

std::string xdmf(const std::string& grids) {
  return "<?xml version=\"1.0\"?>\n<Xdmf Version=\"3.0\"><Domain>\n" + grids + "\n</Domain></Xdmf>\n";
}

Mesh parse(const std::string& grids) { return parse_xdmf(xdmf(grids), "part.xdmf", "."); }

std::string xdmf_refusal(const std::string& bytes, const std::filesystem::path& folder = ".") {
  try {
    parse_xdmf(bytes, "part.xdmf", folder);
  } catch (const InputError& error) {
    return error.what();
  }
  ADD_FAILURE() << "read without an InputError:\n" << bytes;
  return {};
}

std::string with(std::string text, const std::string& from, const std::string& to) {
  const auto at = text.find(from);
  EXPECT_NE(at, std::string::npos) << from;
  return text.replace(at, from.size(), to);
}

/// A file with one dataset /x of n doubles: written, or chunked and never filled; compressed where `packed`.
void write_hdf5(const std::filesystem::path& path, hsize_t n, const std::vector<double>& values, bool packed = false) {
  const hid_t file = H5Fcreate(path.c_str(), H5F_ACC_TRUNC, H5P_DEFAULT, H5P_DEFAULT),
              space = H5Screate_simple(1, &n, nullptr), how = H5Pcreate(H5P_DATASET_CREATE);
  const hsize_t chunk = 1 << 16;
  if (values.empty() || packed) H5Pset_chunk(how, 1, &chunk);
  if (packed) H5Pset_deflate(how, 9);
  const hid_t data = H5Dcreate2(file, "x", H5T_IEEE_F64LE, space, H5P_DEFAULT, how, H5P_DEFAULT);
  if (!values.empty()) H5Dwrite(data, H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, values.data());
  H5Dclose(data), H5Pclose(how), H5Sclose(space), H5Fclose(file);
}

}  // namespace

TEST(ReadXdmf, PointsInAPlaneAndSets) {
  const Mesh mesh = parse(square_grid(
      "<Set Name=\"edge\" SetType=\"Node\"><DataItem NumberType=\"Int\" Dimensions=\"2\">0 3</DataItem></Set>"
      "<Set Name=\"skin\" SetType=\"Cell\"><DataItem NumberType=\"Int\" Dimensions=\"1\">0</DataItem></Set>"
      "<Attribute Name=\"part\" Center=\"Cell\"><DataItem NumberType=\"Int\" Dimensions=\"1\">7</DataItem></Attribute>"
      "<Attribute Name=\"at faces\" Center=\"Face\"/><Information Name=\"by\" Value=\"hand\"/>"));
  EXPECT_EQ(mesh.format, "xdmf 3.0");
  EXPECT_EQ(mesh.points, (std::vector<Vec3>{{0, 0, 0}, {2, 0, 0}, {2, 1, 0}, {0, 1, 0}}));
  EXPECT_EQ(mesh.point_sets.at("edge"), (std::vector{0, 3}));
  EXPECT_EQ(mesh.cell_sets.at("skin"), (std::vector<std::vector<int>>{{0}}));
  EXPECT_EQ(mesh.cell_sets.at("part_7"), (std::vector<std::vector<int>>{{0}}));
  ASSERT_EQ(mesh.losses.size(), 2U);
  EXPECT_EQ(mesh.losses[0].name, "Attribute 'at faces'");
  EXPECT_EQ(mesh.losses[1].name, "Information");
}

// cells of several kinds: XDMF's number of the kind, of points and lines the number of nodes, then the nodes
TEST(ReadXdmf, MixedCells) {
  const auto mixed = [](const std::string& numbers, int n) {
    return "<Grid>" + square_points +
           fmt::format(
               "<Topology Type=\"Mixed\" BaseOffset=\"1\"><DataItem NumberType=\"Int\" Dimensions=\"{}\">{}"
               "</DataItem></Topology></Grid>",
               n, numbers);
  };
  const Mesh mesh = parse(mixed("1 1 2  2 2 3 4  4 1 2 3", 11));
  ASSERT_EQ(mesh.cells.size(), 3U);
  EXPECT_EQ(mesh.cells[0].nodes, (std::vector{1}));
  EXPECT_EQ(mesh.cells[1].nodes, (std::vector{2, 3}));
  EXPECT_EQ(mesh.cells[2].nodes, (std::vector{0, 1, 2}));
  EXPECT_THAT(xdmf_refusal(xdmf(mixed("2 3 1 2 3", 5))), HasSubstr("a Polyline of 3 nodes, expected 2"));
  EXPECT_THAT(xdmf_refusal(xdmf(mixed("4 1 2", 3))), HasSubstr("a Triangle, lacks nodes"));
  EXPECT_THAT(xdmf_refusal(xdmf(mixed("3 1 2", 3))), HasSubstr("XDMF's type 3, which is not read"));
}

TEST(ReadXdmf, FirstTimeAndGridsSideBySide) {
  const Mesh first = parse("<Grid GridType=\"Collection\" CollectionType=\"Temporal\">" +
                           square_grid("<Time Value=\"0\"/>") + "<Grid><Time Value=\"1\"/></Grid></Grid>");
  EXPECT_EQ(first.points.size(), 4U);
  EXPECT_EQ(first.losses.at(0).note, "later times of a temporal collection");
  const Mesh both = parse("<Grid GridType=\"Collection\">" + square_grid() + square_grid() + "</Grid>");
  EXPECT_EQ(both.points.size(), 8U);
  EXPECT_EQ(both.cells.at(0).nodes, (std::vector{0, 1, 2, 3, 4, 5, 6, 7}));
  EXPECT_EQ(both.losses.at(0).name, "Grid, side by side");
}

TEST(ReadXdmf, NumbersBesideTheFile) {
  const fem::testing::Scratch folder;
  const std::filesystem::path here = folder.write("note.txt", "no numbers").parent_path();
  write_hdf5(here / "data.h5", 8, {0, 0, 2, 0, 2, 1, 0, 1});
  const auto points = [](const std::string& text) {
    return with(xdmf(square_grid()), ">0 0 2 0 2 1 0 1<", " Format=\"HDF\">" + text + "<");
  };
  EXPECT_EQ(parse_xdmf(points(" data.h5:/x "), "part.xdmf", here).points[2], Vec3(2, 1, 0));
  EXPECT_THAT(xdmf_refusal(points("data.h5:/y"), here), HasSubstr("'/y' is not in 'data.h5'"));
  EXPECT_THAT(xdmf_refusal(points("note.txt:/x"), here), HasSubstr("'note.txt' is no HDF5 file"));
  EXPECT_THAT(xdmf_refusal(points("absent.h5:/x"), here), HasSubstr("which is not there"));
  EXPECT_THAT(xdmf_refusal(points("/etc/passwd:/x"), here), HasSubstr("does not lie in the folder"));
  EXPECT_THAT(xdmf_refusal(points("../data.h5:/x"), here), HasSubstr("does not lie in the folder"));
  EXPECT_THAT(xdmf_refusal(points("data.h5"), here), HasSubstr("expected FILE.h5:/DATASET"));
  write_hdf5(here / "data.h5", hsize_t{1} << 40, {});
  EXPECT_THAT(xdmf_refusal(points("data.h5:/x"), here), HasSubstr("declares 1099511627776 values and stores 0 bytes"));
}

TEST(ReadXdmf, BytesBesideTheFile) {
  const fem::testing::Scratch folder;
  const float place[] = {9, 0, 0, 2, 0, 2, 1, 0, 1};
  const std::filesystem::path here =
      folder.write("x.bin", std::string(reinterpret_cast<const char*>(place), sizeof place)).parent_path();
  const auto points = [](const std::string& attributes) {
    return with(xdmf(square_grid()), "Precision=\"8\">0 0 2 0 2 1 0 1<",
                "Precision=\"4\" Format=\"Binary\" " + attributes + ">x.bin<");
  };
  EXPECT_EQ(parse_xdmf(points("Seek=\"4\""), "part.xdmf", here).points[2], Vec3(2, 1, 0));
  EXPECT_THAT(xdmf_refusal(points("Seek=\"8\""), here), HasSubstr("needs 32 bytes from 8 on, 'x.bin' has 36"));
  EXPECT_THAT(xdmf_refusal(points("Endian=\"Middle\""), here), HasSubstr("expected Native, Little or Big"));
  EXPECT_THAT(xdmf_refusal(points("Compression=\"Zlib\""), here), HasSubstr("Compression=\"Zlib\""));
}

TEST(ReadXdmf, FaultsAreNamedWithTheirPlace) {
  const std::string good = xdmf(square_grid());
  for (const auto& [from, to, message] : std::vector<std::array<std::string, 3>>{
           {"</Xdmf>", "", "no well-formed XML"},
           {"Dimensions=\"4 2\"", "", "has no Dimensions"},
           {"Dimensions=\"4 2\"", "Dimensions=\"4 x\"", "expected whole numbers"},
           {"Dimensions=\"4 2\"", "Dimensions=\"-4 2\"", "expected whole numbers"},
           {"Dimensions=\"4 2\"", "Dimensions=\"5 2\"", "holds 8 numbers, its Dimensions say 10"},
           {"Dimensions=\"4 2\"", "Dimensions=\"99999999999 99999999999\"", "expected whole numbers"},
           {"Dimensions=\"4 2\"", "Dimensions=\"9999999999999999999999\"", "expected whole numbers"},
           {"Precision=\"8\"", "Precision=\"3\"", "Precision 3"},
           {"Precision=\"8\"", "Format=\"ZIP\"", "expected XML, HDF or Binary"},
           {"Precision=\"8\"", "ItemType=\"Function\"", "ItemType Function"},
           {"Precision=\"8\"", "Reference=\"/a\"", "refers to '/a', which is no path to a DataItem"},
           {">0 0 2 0 2 1 0 1<", ">0 0 2 nan 2 1 0 1<", "point 1 is not finite"},
           {">0 0 2 0 2 1 0 1<", ">0 0 2 zero 2 1 0 1<", "'zero'"},
           {"GeometryType=\"XY\"", "GeometryType=\"X_Y_Z\"", "expected XYZ or XY"},
           {"\"Quadrilateral\"", "\"Polygon\"", "the topology 'Polygon'"},
           {"\"Quadrilateral\"", "\"Hexahedron\"", "expected 8 for each Hexahedron"},
           {"NumberOfElements=\"1\"", "NumberOfElements=\"2\"", "NumberOfElements says 2"},
           {">0 1 2 3<", ">0 1 2 4<", "names point 4 of 4"},
           {">0 1 2 3<", ">0 1 2 -1<", "names point -1 of 4"},
           {"NumberType=\"Int\"", "NumberType=\"Float\"", "found cells made of reals"},
           {"NumberType=\"Int\"", "NumberType=\"Bool\"", "numbers of type Bool"},
           {"<Grid Name=\"g\">", "<Grid GridType=\"Subset\">", "found a grid of type Subset"},
           {"<Grid Name=\"g\">", "<xi:include href=\"x\"/><Grid>", "xi:include"},
           {"</Grid>", "<Set Name=\"s\"><DataItem NumberType=\"Int\" Dimensions=\"1\">9</DataItem></Set></Grid>",
            "the set 's' names 9 of 4 points"},
           {"</Grid>", "<Attribute Name=\"T\"><DataItem Dimensions=\"3\">1 2 3</DataItem></Attribute></Grid>",
            "holds 3 values for 4 points"},
           {"</Grid>", "<Attribute Name=\"T\"/></Grid>", "Attribute has no DataItem"},
           {square_cells, "", "has no Topology"},
           {square_points, "", "has no Geometry"},
           {square_grid(), "", "has no points or no cells"},
       }) {
    const std::string said = xdmf_refusal(with(good, from, to));
    EXPECT_THAT(said, HasSubstr(message)) << to;
    EXPECT_THAT(said, HasSubstr("part.xdmf")) << to;
  }
  EXPECT_THAT(xdmf_refusal(with(good, ">0 1 2 3<", ">0 1 2 4<")), ::testing::StartsWith("part.xdmf:3:"));
  EXPECT_THAT(xdmf_refusal(""), HasSubstr("the file is empty"));
  EXPECT_THAT(xdmf_refusal("<a/>"), HasSubstr("has no element Xdmf"));
  for (std::size_t n = 0; n + 2 < good.size(); ++n)
    EXPECT_THROW(parse_xdmf(good.substr(0, n), "part.xdmf", "."), InputError) << n;
}

// XDMF's way of giving numbers once; ParaView writes it for grids that share their points.
TEST(ReadXdmf, ItemsThatReferToOthers) {
  const auto referring = [](const std::string& path) {
    return xdmf(
        "<DataItem Name=\"a\"/><DataItem Name=\"x\" Dimensions=\"4 2\" Precision=\"8\">0 0 2 0 2 1 0 1</DataItem>" +
        with(square_grid(), "<DataItem Dimensions=\"4 2\" Precision=\"8\">0 0 2 0 2 1 0 1</DataItem>",
             "<DataItem Reference=\"XML\"> " + path + " </DataItem>"));
  };
  for (const char* path : {"/Xdmf/Domain/DataItem[@Name=\"x\"]", "/Xdmf/Domain[1]/DataItem[2]"})
    EXPECT_EQ(parse_xdmf(referring(path), "part.xdmf", ".").points.at(2), Vec3(2, 1, 0)) << path;
  for (const char* path : {"/Xdmf/Domain/DataItem[3]", "/Xdmf/Domain/DataItem[0]", "/Xdmf/Domain/Grid", "//DataItem",
                           "/Xdmf/Domain/DataItem[@Name=]", "/Xdmf/Domain/DataItem[x]", "DataItem", "/", ""})
    EXPECT_THAT(xdmf_refusal(referring(path)), HasSubstr("which is no path to a DataItem")) << path;
  EXPECT_THAT(xdmf_refusal(referring("/Xdmf/Domain/Grid/Geometry/DataItem")), HasSubstr("refers on and on"));
}

// What meshio's TimeSeriesWriter makes: the series stands before the mesh that its steps refer to.
TEST(ReadXdmf, SeriesOfAMeshElsewhere) {
  const Mesh mesh = parse(
      "<Grid GridType=\"Collection\" CollectionType=\"Temporal\"><Grid><xi:include "
      "xpointer=\"p\"/></Grid><Grid/></Grid>" +
      square_grid());
  EXPECT_EQ(mesh.points.size(), 4U);
  ASSERT_EQ(mesh.losses.size(), 1U);
  EXPECT_EQ(mesh.losses[0].count, 2);
  EXPECT_EQ(mesh.losses[0].note, "times of a mesh elsewhere");
}

TEST(ReadXdmf, MembersNamedTwiceAreOne) {
  const auto set = [](const char* type, const char* members) {
    return fmt::format("<Set Name=\"s\" SetType=\"{}\"><DataItem Dimensions=\"3\">{}</DataItem></Set>", type, members);
  };
  const Mesh mesh = parse(square_grid(set("Node", "3 1 3") + set("Cell", "0 0 0")));
  EXPECT_EQ(mesh.point_sets.at("s"), (std::vector{1, 3}));
  EXPECT_EQ(mesh.cell_sets.at("s"), (std::vector<std::vector<int>>{{0}}));
}

// A dataset of 8 kB that is named again and again would take any amount of memory.
TEST(ReadXdmf, NumbersTakeAHundredTimesTheFiles) {
  const fem::testing::Scratch folder;
  const std::filesystem::path here = folder.write("note.txt", "no numbers").parent_path();
  write_hdf5(here / "x.h5", 1 << 20, std::vector<double>(1 << 20, 0.0), true);
  ASSERT_LT(std::filesystem::file_size(here / "x.h5"), 40000U);  // 8 MiB of zeros: gzip gains 1030 times
  const std::string named = with(xdmf(square_grid()), "Dimensions=\"4 2\" Precision=\"8\">0 0 2 0 2 1 0 1<",
                                 "Dimensions=\"1048576\" Format=\"HDF\">x.h5:/x<");
  EXPECT_THAT(xdmf_refusal(named, here), HasSubstr("more than a hundred times the files"));
}

// A mesh from elsewhere must not make us read what its sender could not see.
TEST(ReadXdmf, NothingLeadsOutOfTheFolder) {
  const fem::testing::Scratch folder;
  const std::filesystem::path here = folder.write("note.txt", "no numbers").parent_path();
  write_hdf5(here / "other.h5", 8, {0, 0, 2, 0, 2, 1, 0, 1});
  const auto said = [&] {
    return xdmf_refusal(with(xdmf(square_grid()), ">0 0 2 0 2 1 0 1<", " Format=\"HDF\">links.h5:/x<"), here);
  };
  const std::string file = (here / "links.h5").string();
  const auto make = [&](const auto& fill) {
    const hid_t id = H5Fcreate(file.c_str(), H5F_ACC_TRUNC, H5P_DEFAULT, H5P_DEFAULT);
    fill(id);
    H5Fclose(id);
  };
  const hsize_t n = 8;
  const auto set = [&](hid_t id, hid_t how) {
    const hid_t space = H5Screate_simple(1, &n, nullptr);
    const hid_t data = H5Dcreate2(id, "x", H5T_IEEE_F64LE, space, H5P_DEFAULT, how, H5P_DEFAULT);
    EXPECT_GE(data, 0);
    H5Dclose(data), H5Pclose(how), H5Sclose(space);
  };
  make([](hid_t id) { H5Lcreate_external("other.h5", "/x", id, "x", H5P_DEFAULT, H5P_DEFAULT); });
  EXPECT_THAT(said(), HasSubstr("'/x' is a link to another place"));
  make([&](hid_t id) {
    const hid_t how = H5Pcreate(H5P_DATASET_CREATE);
    H5Pset_external(how, "other.h5", 0, 64);
    set(id, how);
  });
  EXPECT_THAT(said(), HasSubstr("'/x' keeps its numbers in another file"));
  make([&](hid_t id) {
    const hid_t how = H5Pcreate(H5P_DATASET_CREATE), space = H5Screate_simple(1, &n, nullptr);
    H5Pset_virtual(how, space, "other.h5", "/x", space);
    H5Sclose(space);
    set(id, how);
  });
  EXPECT_THAT(said(), HasSubstr("'/x' keeps its numbers in another file"));
}

// HDF5 clips 2^64 − 1 to 2^63 − 1 when asked for signed numbers.
TEST(ReadXdmf, UnsignedNumbersOfAllBits) {
  const fem::testing::Scratch folder;
  const std::filesystem::path here = folder.write("note.txt", "no numbers").parent_path();
  const std::string text = with(xdmf(square_grid()), "NumberType=\"Int\" Dimensions=\"1 4\">0 1 2 3<",
                                "Dimensions=\"4\" Format=\"HDF\">cells.h5:/x<");
  for (const std::uint64_t last : {std::uint64_t{3}, ~std::uint64_t{0}}) {
    const std::uint64_t nodes[] = {0, 1, 2, last};
    const hsize_t n = 4;
    const hid_t file = H5Fcreate((here / "cells.h5").c_str(), H5F_ACC_TRUNC, H5P_DEFAULT, H5P_DEFAULT),
                space = H5Screate_simple(1, &n, nullptr),
                data = H5Dcreate2(file, "x", H5T_STD_U64BE, space, H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT);
    H5Dwrite(data, H5T_NATIVE_UINT64, H5S_ALL, H5S_ALL, H5P_DEFAULT, nodes);
    H5Dclose(data), H5Sclose(space), H5Fclose(file);
    if (last == 3)
      EXPECT_EQ(parse_xdmf(text, "part.xdmf", here).cells.at(0).nodes, (std::vector{0, 1, 2, 3}));
    else
      EXPECT_THAT(xdmf_refusal(text, here), HasSubstr("'/x' holds 18446744073709551615"));
  }
}
