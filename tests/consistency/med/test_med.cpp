// MED-fichier (Debian's python3-med) as an oracle: what the format's own library writes is what we read.
#include "fem/formats/read_med.hpp"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <hdf5.h>

#include <Eigen/Geometry>
#include <cmath>
#include <fstream>
#include <functional>

#include "fem/error.hpp"
#include "tests/support/oracle.hpp"
#include "tests/support/temporary_folder.hpp"

using namespace tenon;
using fem::CellBlock;
using fem::CellType;
using fem::Vec3;
using ::testing::HasSubstr;
namespace fs = std::filesystem;

// HDF5 loses some of its own memory in damaged files.
extern "C" const char* __lsan_default_suppressions() { return "leak:libhdf5\n"; }

namespace {

class Med : public ::testing::Test {
 protected:
  void SetUp() override {
    TENON_SKIP_WITHOUT(std::system("/usr/bin/python3 -c 'import med.medfile' 2> /dev/null") == 0, "python3-med");
    const std::string log = (folder_.path() / "log").string();
    const std::string command =
        fmt::format("/usr/bin/python3 {} {} > {} 2>&1", TENON_SOURCE_DIR "/tests/consistency/med/make_files.py",
                    folder_.path().string(), log);
    ASSERT_EQ(std::system(command.c_str()), 0) << std::ifstream(log).rdbuf();
  }

  fs::path file(const std::string& name) const { return folder_.path() / name; }

  std::string refusal(const std::string& name) const {
    try {
      fem::read_med(file(name));
    } catch (const InputError& error) {
      return error.what();
    }
    ADD_FAILURE() << name << " is read";
    return {};
  }

  /// A copy of plate.med, changed.
  std::string refusal_of_plate(const std::function<void(hid_t)>& change) const {
    fs::copy_file(file("plate.med"), file("changed.med"), fs::copy_options::overwrite_existing);
    const hid_t id = H5Fopen(file("changed.med").c_str(), H5F_ACC_RDWR, H5P_DEFAULT);
    change(id);
    H5Fclose(id);
    return refusal("changed.med");
  }

  TemporaryFolder folder_;
};

const std::string step = "/ENS_MAA/part/-0000000000000000001-0000000000000000001";

/// Puts n whole numbers in a dataset's place.
void replace(hid_t file, const std::string& dataset, const std::vector<int>& numbers) {
  H5Ldelete(file, dataset.c_str(), H5P_DEFAULT);
  const hsize_t n = numbers.size();
  const hid_t space = H5Screate_simple(1, &n, nullptr);
  const hid_t data = H5Dcreate2(file, dataset.c_str(), H5T_STD_I32LE, space, H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT);
  H5Dwrite(data, H5T_NATIVE_INT, H5S_ALL, H5S_ALL, H5P_DEFAULT, numbers.data());
  H5Dclose(data), H5Sclose(space);
}

/// A cell's corners, and those in whose middle each further node lies: vtkTriQuadraticHexahedron, vtkBiQuadraticWedge…
struct Middles {
  int corners;
  std::vector<std::vector<int>> of{};
};

Middles middles_of(CellType type) {
  const std::string_view kind = fem::name(type);
  const bool prism = kind.starts_with("hexa") || kind.starts_with("wedge"), flat = kind.starts_with("quad");
  const int n = kind.starts_with("wedge") || kind.starts_with("tetra") ? 3 : 4;
  Middles m{prism ? 2 * n : flat ? n : n + 1};
  if (fem::node_count(type) == m.corners) return m;
  for (int low = 0; low < (prism ? 2 * n : n); low += n)
    for (int i = 0; i < n; ++i) m.of.push_back({low + i, low + (i + 1) % n});
  for (int i = 0; i < (flat ? 0 : n); ++i) m.of.push_back({i, prism ? i + n : n});
  if (type == CellType::wedge18)
    for (int i = 0; i < 3; ++i) m.of.push_back({i, (i + 1) % 3, 3 + (i + 1) % 3, 3 + i});
  if (type == CellType::hexahedron27)
    for (const auto& face : {std::vector{0, 3, 7, 4},
                             {1, 2, 6, 5},
                             {0, 1, 5, 4},
                             {2, 3, 7, 6},
                             {0, 1, 2, 3},
                             {4, 5, 6, 7},
                             {0, 1, 2, 3, 4, 5, 6, 7}})
      m.of.push_back(face);
  if (type == CellType::quad9) m.of.push_back({0, 1, 2, 3});
  return m;
}

}  // namespace

TEST_F(Med, PlateOfBothVersions) {
  for (const auto& [name, format] : {std::pair{"plate.med", "med 4.1"}, {"plate3.med", "med 3.3"}}) {
    SCOPED_TRACE(name);
    const fem::Mesh mesh = fem::read_med(file(name));
    EXPECT_EQ(mesh.format, format);
    EXPECT_EQ(mesh.points, (std::vector<Vec3>{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0.25}, {2, 0.5, 0}}));
    EXPECT_EQ(mesh.point_ids, (std::vector<long>{10, 20, 30, 40, 50}));
    ASSERT_EQ(mesh.cells.size(), 3U);
    EXPECT_EQ(mesh.cells[0].type, CellType::quad);
    EXPECT_EQ(mesh.cells[0].nodes, (std::vector{0, 1, 2, 3}));
    EXPECT_EQ(mesh.cells[1].type, CellType::line);
    EXPECT_EQ(mesh.cells[1].nodes, (std::vector{0, 1, 1, 4}));
    EXPECT_EQ(mesh.cells[1].ids, (std::vector<long>{3, 4}));
    EXPECT_EQ(mesh.cells[2].type, CellType::triangle);
    EXPECT_EQ(mesh.cells[2].nodes, (std::vector{1, 4, 2}));
    EXPECT_EQ(mesh.cells[2].ids, (std::vector<long>{11}));
    EXPECT_EQ(mesh.cell_sets.size(), 3U);
    EXPECT_EQ(mesh.cell_sets.at("skin"), (std::vector<std::vector<int>>{{0}, {}, {}}));
    EXPECT_EQ(mesh.cell_sets.at("all of it"), (std::vector<std::vector<int>>{{0}, {}, {0}}));
    EXPECT_EQ(mesh.cell_sets.at("edge"), (std::vector<std::vector<int>>{{}, {1}, {}}));
    EXPECT_EQ(mesh.point_sets, (std::map<std::string, std::vector<int>>{{"tip", {4}}}));
    for (int i = 0; i < 5; ++i) EXPECT_EQ(mesh.point_data.at("u").row(i), Eigen::RowVector2d(i, 10.0 * i));
    EXPECT_EQ(mesh.point_data.at("moving")(3, 0), 3.0);
    EXPECT_EQ(mesh.cell_data.at("s")[0].row(0), Eigen::RowVector2d(7.5, 8.5));
    EXPECT_TRUE(mesh.cell_data.at("s")[2].array().isNaN().all());
    std::vector<std::string> losses;
    for (const fem::Loss& loss : mesh.losses) losses.push_back(loss.name);
    EXPECT_THAT(losses, ::testing::UnorderedElementsAre("UNI", "field 'moving'", "field 'at corners', NOE.TR3"));
  }
}

// VTK turns solids the other way round: their volume must not be negative, and nodes lie in VTK's middles.
TEST_F(Med, SolidsAreTurned) {
  const fem::Mesh mesh = fem::read_med(file("brick.med"));
  ASSERT_EQ(mesh.cells.size(), 11U);
  for (const CellBlock& block : mesh.cells) {
    SCOPED_TRACE(fem::name(block.type));
    const auto x = [&](int i) {
      return mesh.points[static_cast<std::size_t>(block.nodes[static_cast<std::size_t>(i)])];
    };
    const Middles middles = middles_of(block.type);
    ASSERT_EQ(middles.corners + std::ssize(middles.of), fem::node_count(block.type));
    EXPECT_GT((x(1) - x(0)).cross(x(2) - x(0)).z(), 0.0);  // seen from within, from above
    if (block.type != CellType::quad9) {
      EXPECT_GT(x(middles.corners - 1).z(), 0.5);
    }
    for (std::size_t m = 0; m < middles.of.size(); ++m) {
      Vec3 mean = Vec3::Zero();
      for (const int corner : middles.of[m]) mean += x(corner) / static_cast<double>(middles.of[m].size());
      EXPECT_EQ(x(middles.corners + static_cast<int>(m)), mean) << "middle " << m;
    }
  }
}

TEST_F(Med, NumbersAtCellsDoNotJoinGroupsNamedAlike) {
  const fem::Mesh mesh = fem::read_med(file("alike.med"));
  EXPECT_EQ(mesh.cell_sets.at("mat_1"), (std::vector<std::vector<int>>{{0}}));
  EXPECT_EQ(mesh.cell_sets.at("mat_2"), (std::vector<std::vector<int>>{{1}}));
  EXPECT_EQ(mesh.cell_sets.at("part_5"), (std::vector<std::vector<int>>{{0, 1}}));
  ASSERT_EQ(mesh.losses.size(), 1U);
  EXPECT_EQ(mesh.losses[0].name, "sets of 'mat'");
  EXPECT_EQ(mesh.losses[0].note, "'mat_1' is another set; it is cell data alone");
}

// 320 MB of it, from a file of a third of one
TEST_F(Med, WhatIsKeptStaysBelowAHundredTimesTheFile) {
  EXPECT_THAT(refusal("wide.med"), HasSubstr("it takes more than a hundred times the file"));
}

TEST_F(Med, TwoCoordinatesANode) {
  const fem::Mesh mesh = fem::read_med(file("flat.med"));
  EXPECT_EQ(mesh.points, (std::vector<Vec3>{{0, 0, 0}, {3, 0, 0}, {0, 4, 0}}));
  EXPECT_EQ(mesh.point_ids, (std::vector<long>{1, 2, 3}));
  ASSERT_EQ(mesh.losses.size(), 1U);
  EXPECT_EQ(mesh.losses[0].note, "later steps of the mesh");
}

TEST_F(Med, WhatIsNoMeshIsRefused) {
  EXPECT_THAT(refusal("two.med"), HasSubstr("holds 2 meshes, 'other', 'part': which one is meant?"));
  EXPECT_THAT(refusal("cylindrical.med"), HasSubstr("'part' has cylindrical or spherical coordinates"));
  EXPECT_THAT(refusal("grid.med"), HasSubstr("'part' is a structured grid"));
  EXPECT_THAT(refusal("bare.med"), HasSubstr("the mesh 'part' has no nodes"));
  EXPECT_THAT(refusal("polygon.med"), HasSubstr("cells of MED's type POG, which is not read"));
  EXPECT_THAT(refusal("plate.mde"), HasSubstr("plate.med"));
}

TEST_F(Med, DamageIsRefused) {
  const std::string quads = step + "/MAI/QU4/";
  EXPECT_THAT(refusal_of_plate([&](hid_t f) {
                replace(f, quads + "NOD", {1, 2, 3, 6});
              }),
              HasSubstr("'" + quads + "NOD' names node 6 of 5"));
  EXPECT_THAT(refusal_of_plate([&](hid_t f) {
                replace(f, quads + "NOD", {1, 2, 3, 0});
              }),
              HasSubstr("names node 0 of 5"));
  EXPECT_THAT(refusal_of_plate([&](hid_t f) {
                replace(f, quads + "NOD", {1, 2, 3});
              }),
              HasSubstr("holds 3 nodes, expected 4 of each cell"));
  EXPECT_THAT(refusal_of_plate([&](hid_t f) { replace(f, quads + "FAM", {-9}); }),
              HasSubstr("'" + step + "/MAI/QU4/FAM' names family -9, which '/FAS/part/ELEME' does not hold"));
  EXPECT_THAT(refusal_of_plate([&](hid_t f) {
                replace(f, quads + "FAM", {-1, -1});
              }),
              HasSubstr("holds 2 numbers, expected 1 whole numbers"));
  EXPECT_THAT(refusal_of_plate([&](hid_t f) {
                replace(f, step + "/NOE/COO", {0, 0, 0, 0});
              }),
              HasSubstr("holds 4 coordinates, expected 3 of each node"));
  EXPECT_THAT(refusal_of_plate([&](hid_t f) {
                replace(f, step + "/NOE/NUM", {1, 2, 3, 4, 4});
              }),
              HasSubstr("gives two nodes the same number"));
  EXPECT_THAT(refusal_of_plate([&](hid_t f) {
                replace(f, step + "/NOE/NUM", {1, 2, -3, 4, 5});
              }),
              HasSubstr("gives a node the number -3, expected 1 or more"));
  EXPECT_THAT(refusal_of_plate([&](hid_t f) {
                H5Ldelete(f, quads.c_str(), H5P_DEFAULT), H5Ldelete(f, (step + "/MAI").c_str(), H5P_DEFAULT);
              }),
              HasSubstr("no points or no cells"));
  EXPECT_THAT(refusal_of_plate([&](hid_t f) {
                H5Ldelete(f, (quads + "NOD").c_str(), H5P_DEFAULT);
                H5Lcreate_external("brick.med", "/x", f, (quads + "NOD").c_str(), H5P_DEFAULT, H5P_DEFAULT);
              }),
              HasSubstr("NOD' is a link to another place"));
  EXPECT_THAT(refusal_of_plate([&](hid_t f) { H5Ldelete(f, "/INFOS_GENERALES", H5P_DEFAULT); }),
              HasSubstr("no INFOS_GENERALES"));
  EXPECT_THAT(refusal_of_plate([&](hid_t f) { H5Ldelete(f, "/ENS_MAA", H5P_DEFAULT); }), HasSubstr("holds no mesh"));
}

// Cut short anywhere, or a byte of it another: read well or refused in a sentence.
TEST_F(Med, AnyDamageEndsInASentence) {
  std::ifstream in(file("plate.med"), std::ios::binary);
  const std::string whole((std::istreambuf_iterator<char>(in)), {});
  int refused = 0;
  const auto attempt = [&](const std::string& bytes) {
    std::ofstream(file("damaged.med"), std::ios::binary) << bytes;
    try {
      fem::read_med(file("damaged.med"));
    } catch (const InputError& error) {
      EXPECT_THAT(error.what(), HasSubstr("damaged.med"));
      ++refused;
    }
  };
  for (std::size_t n = 0; n < whole.size(); n += whole.size() / 100 + 1) attempt(whole.substr(0, n));
  EXPECT_EQ(refused, 100) << "HDF5 says how long a file is";
  for (std::size_t at = 0; at < whole.size(); at += 97) {
    std::string bytes = whole;
    bytes[at] = static_cast<char>(~bytes[at]);
    attempt(bytes);
  }
}
