#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>

#include "fem/formats/gmsh.hpp"
#include "tests/unit/fem/formats/scratch.hpp"

using namespace tenon::fem;
using namespace tenon::fem::testing;
using ::testing::ElementsAre;

namespace {

/// Points of cell c of a block.
std::vector<Vec3> corners(const Mesh& mesh, const CellBlock& block, int c) {
  std::vector<Vec3> points;
  const int width = node_count(block.type);
  for (int i = 0; i < width; ++i)
    points.push_back(mesh.points[static_cast<std::size_t>(block.nodes[static_cast<std::size_t>(c * width + i)])]);
  return points;
}

/// Signed length or area (towards +z) of a linear cell: shoelace formula.
double measure(const std::vector<Vec3>& p) {
  if (p.size() == 2) return (p[1] - p[0]).norm();
  double twice = 0.0;
  for (std::size_t i = 0; i < p.size(); ++i) twice += p[i].cross(p[(i + 1) % p.size()]).z();
  return 0.5 * twice;
}

struct SetSize {
  int cells = 0;
  double measure = 0.0;
};

SetSize size_of(const Mesh& mesh, const std::string& set) {
  SetSize size;
  const auto& blocks = mesh.cell_sets.at(set);
  for (std::size_t b = 0; b < blocks.size(); ++b)
    for (const int c : blocks[b]) {
      ++size.cells;
      size.measure += measure(corners(mesh, mesh.cells[b], c));
    }
  return size;
}

const CellBlock* block_of(const Mesh& mesh, CellType type) {
  const auto found = std::ranges::find_if(mesh.cells, [=](const CellBlock& b) { return b.type == type; });
  return found == mesh.cells.end() ? nullptr : &*found;
}

int cells_of(const Mesh& mesh, CellType type) {
  const CellBlock* const block = block_of(mesh, type);
  return block ? block->size() : 0;
}

long lost(const Mesh& mesh, const std::string& name) {
  for (const Loss& loss : mesh.losses)
    if (loss.name == name) return loss.count;
  return 0;
}

/// What mixed.geo says, whatever the file's variant: the yoke's two lines are √1.25 long, the patches 2 × 1.
void expect_mixed(const Mesh& mesh) {
  EXPECT_EQ(mesh.points.size(), 32U);
  EXPECT_EQ(mesh.point_ids.size(), 32U);
  EXPECT_EQ(mesh.cells.size(), 4U);
  EXPECT_EQ(cells_of(mesh, CellType::vertex), 2);
  EXPECT_EQ(cells_of(mesh, CellType::line), 6 + 2);
  EXPECT_EQ(cells_of(mesh, CellType::triangle), 16);
  EXPECT_EQ(cells_of(mesh, CellType::quad), 8);
  for (const CellBlock& block : mesh.cells) EXPECT_EQ(block.ids.size(), static_cast<std::size_t>(block.size()));

  constexpr double gmsh_tolerance = 1e-10;  // Gmsh places transfinite points to about 1e-12
  const std::map<std::string, SetSize> expected{
      {"yoke", {6, 2.0 * std::sqrt(1.25)}}, {"hinge", {2, 1.0}}, {"skin", {24, 4.0}}, {"outer part", {16, 2.0}}};
  for (const auto& [set, size] : expected) {
    const SetSize found = size_of(mesh, set);
    EXPECT_EQ(found.cells, size.cells) << set;
    EXPECT_NEAR(found.measure, size.measure, gmsh_tolerance) << set;
  }
  ASSERT_EQ(mesh.point_sets.at("root").size(), 1U);
  ASSERT_EQ(mesh.point_sets.at("tip").size(), 1U);
  EXPECT_LT((mesh.points[static_cast<std::size_t>(mesh.point_sets.at("root")[0])] - Vec3(-1.0, 0.5, 0.0)).norm(),
            1e-15);
  EXPECT_LT((mesh.points[static_cast<std::size_t>(mesh.point_sets.at("tip")[0])] - Vec3(4.0, 1.0, 0.0)).norm(), 1e-15);
  EXPECT_EQ(mesh.cell_sets.size(), 6U);
  EXPECT_EQ(mesh.field_data.at("skin"), std::make_pair(5, 2));
  EXPECT_EQ(points_of_set(mesh, "hinge").size(), 3U);
}

/// A .msh file written number by number, in either byte order.
struct BinaryWriter {
  bool swapped = false;
  std::string bytes;
  template <class T>
  void put(T value) {
    char raw[sizeof(T)];
    std::memcpy(raw, &value, sizeof(T));
    if (swapped) std::reverse(raw, raw + sizeof(T));
    bytes.append(raw, sizeof(T));
  }
  void text(const std::string& line) { bytes += line; }
};

/// One triangle (0,0) (2,0) (0,3) with nodes 10, 7, 3 in two physical groups.
std::string triangle_22(bool swapped) {
  BinaryWriter w{swapped, {}};
  w.text("$MeshFormat\n2.2 1 8\n");
  w.put(1);
  w.text("\n$EndMeshFormat\n$Nodes\n3\n");
  const double xy[3][2] = {{0, 0}, {2, 0}, {0, 3}};
  const int numbers[3] = {10, 7, 3};
  for (int i = 0; i < 3; ++i) {
    w.put(numbers[i]);
    w.put(xy[i][0]), w.put(xy[i][1]), w.put(0.0);
  }
  w.text("\n$EndNodes\n$Elements\n2\n");
  for (const int physical : {4, 9})  // two runs: the same triangle in each group, its nodes turned in the second
    for (const int value :
         {2, 1, 2, physical, physical, 1, physical == 4 ? 10 : 7, physical == 4 ? 7 : 3, physical == 4 ? 3 : 10})
      w.put(value);
  w.text("\n$EndElements\n");
  return w.bytes;
}

/// The same mesh as version 4.1.
std::string triangle_41(bool swapped, int size_width) {
  BinaryWriter w{swapped, {}};
  const auto size = [&](std::int64_t n) { size_width == 8 ? w.put(n) : w.put(static_cast<std::int32_t>(n)); };
  w.text("$MeshFormat\n4.1 1 " + std::to_string(size_width) + "\n");
  w.put(1);
  w.text("\n$EndMeshFormat\n$Entities\n");
  for (const int n : {0, 0, 1, 0}) size(n);
  w.put(1);
  for (const double box : {0.0, 0.0, 0.0, 2.0, 3.0, 0.0}) w.put(box);
  size(2), w.put(4), w.put(-9), size(0);
  w.text("\n$EndEntities\n$Nodes\n");
  for (const int n : {1, 3, 3, 10}) size(n);
  w.put(2), w.put(1), w.put(0), size(3);
  for (const int n : {10, 7, 3}) size(n);
  for (const double x : {0.0, 0.0, 0.0, 2.0, 0.0, 0.0, 0.0, 3.0, 0.0}) w.put(x);
  w.text("\n$EndNodes\n$Elements\n");
  for (const int n : {1, 1, 1, 1}) size(n);
  w.put(2), w.put(1), w.put(2), size(1);
  for (const int n : {1, 10, 7, 3}) size(n);
  w.text("\n$EndElements\n");
  return w.bytes;
}

void expect_triangle(const Mesh& mesh) {
  ASSERT_EQ(mesh.cells.size(), 1U);
  ASSERT_EQ(mesh.cells[0].size(), 1);
  EXPECT_THAT(mesh.point_ids, ElementsAre(10, 7, 3));
  EXPECT_THAT(mesh.cells[0].nodes, ElementsAre(0, 1, 2));
  EXPECT_DOUBLE_EQ(measure(corners(mesh, mesh.cells[0], 0)), 3.0);
  EXPECT_EQ(mesh.cell_sets.at("surface_4")[0], std::vector<int>{0});
  EXPECT_EQ(mesh.cell_sets.at("surface_9")[0], std::vector<int>{0});
}

}  // namespace

class GmshVariants : public ::testing::TestWithParam<const char*> {};

TEST_P(GmshVariants, HoldWhatTheGeometrySays) { expect_mixed(read_gmsh(fixture(GetParam()))); }

INSTANTIATE_TEST_SUITE_P(Mixed, GmshVariants,
                         ::testing::Values("mixed_22.msh", "mixed_22_binary.msh", "mixed_22_parametric.msh",
                                           "mixed_22_parametric_binary.msh", "mixed_40.msh", "mixed_41.msh",
                                           "mixed_41_binary.msh", "mixed_41_parametric.msh", "mixed_41_partitioned.msh",
                                           "mixed_41_partitioned_binary.msh"),
                         [](const auto& variant) {
                           const std::string file = variant.param;
                           return file.substr(0, file.find('.'));
                         });

TEST(Gmsh, FormatIsNamed) {
  EXPECT_EQ(read_gmsh(fixture("mixed_22_binary.msh")).format, "gmsh 2.2 binary");
  EXPECT_EQ(read_gmsh(fixture("mixed_41.msh")).format, "gmsh 4.1 ascii");
}

TEST(Gmsh, LossReportNamesWhatHadNoEffect) {
  EXPECT_EQ(lost(read_gmsh(fixture("mixed_22.msh")), "repeated cells"), 16);  // triangles in "skin" and "outer part"
  EXPECT_EQ(lost(read_gmsh(fixture("mixed_41_parametric.msh")), "parametric coordinates"),
            32 - 7);  // all but 7 corners
  const Mesh partitioned = read_gmsh(fixture("mixed_41_partitioned.msh"));
  EXPECT_EQ(lost(partitioned, "$PartitionedEntities"), 1);
  EXPECT_EQ(lost(partitioned, "cells between partitions"), 2);
  EXPECT_TRUE(read_gmsh(fixture("mixed_41.msh")).losses.empty());
}

TEST(Gmsh, WindowsLineEndsAndTabsReadTheSame) {
  const Scratch scratch;
  for (const char* const file : {"mixed_22.msh", "mixed_40.msh", "mixed_41.msh"}) {
    std::string other;
    bool in_name = false;
    for (const char c : contents(fixture(file))) {
      if (c == '"') in_name = !in_name;
      if (c == '\n') other += "\t\r";
      other += c == ' ' && !in_name ? '\t' : c;
    }
    expect_mixed(read_gmsh(scratch.write("windows.msh", other)));
  }
}

TEST(Gmsh, BothByteOrdersAndSizeWidths) {
  const Scratch scratch;
  for (const bool swapped : {false, true}) {
    expect_triangle(read_gmsh(scratch.write("a.msh", triangle_22(swapped))));
    for (const int width : {4, 8}) expect_triangle(read_gmsh(scratch.write("b.msh", triangle_41(swapped, width))));
  }
}

TEST(Gmsh, TaggedAndUntaggedCellsOfOneTypeShareABlock) {
  const Scratch scratch;
  const Mesh mesh =
      read_gmsh(scratch.write("a.msh",
                              "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n"
                              "$PhysicalNames\n2\n1 3 \"left half\"\n1 8 \"nowhere\"\n$EndPhysicalNames\n"
                              "$Nodes\n4\n1 0 0 0\n2 1 0 0\n3 2 0 0\n4000000000 3 0 0\n$EndNodes\n"
                              "$Elements\n3\n1 1 2 0 1 1 2\n2 1 0 2 3\n3 1 2 3 1 3 4000000000\n$EndElements\n"));
  ASSERT_EQ(mesh.cells.size(), 1U);
  EXPECT_THAT(mesh.cells[0].nodes, ElementsAre(0, 1, 1, 2, 2, 3));
  EXPECT_THAT(mesh.cell_sets.at("left half")[0], ElementsAre(2));
  EXPECT_EQ(mesh.point_ids[3], 4000000000L);
  EXPECT_EQ(lost(mesh, "physical group 'nowhere'"), 1);
}

TEST(Gmsh, CellTwiceInOneGroupOfVersion2IsMergedAndCountsAsAChangeOfPhysics) {
  const Mesh mesh = parse_gmsh(
      "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes\n2\n1 0 0 0\n2 1 0 0\n$EndNodes\n"
      "$Elements\n3\n1 1 2 5 1 1 2\n2 1 2 5 2 2 1\n3 1 2 6 1 1 2\n$EndElements\n",
      "a.msh");
  EXPECT_EQ(mesh.cells.at(0).size(), 1);
  EXPECT_THAT(mesh.cell_sets.at("curve_5")[0], ElementsAre(0));
  EXPECT_THAT(mesh.cell_sets.at("curve_6")[0], ElementsAre(0));
  EXPECT_EQ(lost(mesh, "repeated cells"), 1);
  ASSERT_EQ(lost(mesh, "cells given twice in one group"), 1);
  for (const Loss& loss : mesh.losses) EXPECT_EQ(loss.changes_physics, loss.name == "cells given twice in one group");
}

TEST(Gmsh, NamesOfSetsComeOnce) {
  EXPECT_THAT(set_names(read_gmsh(fixture("mixed_41.msh"))),
              ElementsAre("root", "tip", "hinge", "outer part", "skin", "yoke"));
}

TEST(Gmsh, GroupsOfOneNameInTwoDimensionsShareTheSet) {
  const Scratch scratch;
  std::string text = contents(fixture("mixed_41.msh"));
  text.replace(text.find("\"hinge\""), 7, "\"root\"");
  const Mesh mesh = read_gmsh(scratch.write("a.msh", text));
  EXPECT_EQ(points_of_set(mesh, "root").size(), 1U + 3U);
  EXPECT_EQ(mesh.point_sets.count("root"), 0U);
}

TEST(Gmsh, CoincidentCellsOfVersion4StayAndAreReported) {
  const Scratch scratch;
  const Mesh mesh = read_gmsh(
      scratch.write("a.msh",
                    "$MeshFormat\n4.1 0 8\n$EndMeshFormat\n$Nodes\n1 2 1 2\n1 1 0 2\n1\n2\n0 0 0\n1 0 0\n$EndNodes\n"
                    "$Elements\n1 2 1 2\n1 1 1 2\n1 1 2\n2 2 1\n$EndElements\n$Comments\nany words\n$EndComments\n"
                    "$Periodic\n1\n0 1 2\n0\n0\n$EndPeriodic\n"));
  EXPECT_EQ(mesh.cells.at(0).size(), 2);
  EXPECT_EQ(lost(mesh, "cells on the nodes of another cell"), 1);
  EXPECT_EQ(lost(mesh, "$Periodic"), 1);
  EXPECT_EQ(mesh.losses.size(), 2U);
}

/// Edges and faces as VTK numbers their nodes (VTK user's guide and class pages of the quadratic cells).
struct SecondOrder {
  CellType type;
  int corners;
  std::vector<std::vector<int>> between;  ///< corners whose mean is each further node, in order
};

const std::vector<std::vector<int>> hexahedron_edges{{0, 1}, {1, 2}, {2, 3}, {3, 0}, {4, 5}, {5, 6},
                                                     {6, 7}, {7, 4}, {0, 4}, {1, 5}, {2, 6}, {3, 7}};
const std::vector<std::vector<int>> wedge_edges{{0, 1}, {1, 2}, {2, 0}, {3, 4}, {4, 5}, {5, 3}, {0, 3}, {1, 4}, {2, 5}};
const std::vector<std::vector<int>> pyramid_edges{{0, 1}, {1, 2}, {2, 3}, {3, 0}, {0, 4}, {1, 4}, {2, 4}, {3, 4}};
const std::vector<std::vector<int>> tetra_edges{{0, 1}, {1, 2}, {2, 0}, {0, 3}, {1, 3}, {2, 3}};

std::vector<std::vector<int>> joined(std::vector<std::vector<int>> a, const std::vector<std::vector<int>>& b) {
  a.insert(a.end(), b.begin(), b.end());
  return a;
}

void expect_vtk_order(const Mesh& mesh, const std::vector<SecondOrder>& kinds) {
  EXPECT_EQ(mesh.cells.size(), kinds.size());
  for (const SecondOrder& kind : kinds) {
    const CellBlock* const block = block_of(mesh, kind.type);
    ASSERT_NE(block, nullptr) << name(kind.type);
    ASSERT_EQ(block->size(), 1);
    const std::vector<Vec3> p = corners(mesh, *block, 0);
    ASSERT_EQ(p.size(), static_cast<std::size_t>(kind.corners) + kind.between.size());
    for (std::size_t i = 0; i < kind.between.size(); ++i) {
      Vec3 mean = Vec3::Zero();
      for (const int corner : kind.between[i]) mean += p[static_cast<std::size_t>(corner)];
      mean /= static_cast<double>(kind.between[i].size());
      EXPECT_LT((p[static_cast<std::size_t>(kind.corners) + i] - mean).norm(), 1e-9)
          << name(kind.type) << " node " << static_cast<std::size_t>(kind.corners) + i;
    }
  }
}

TEST(Gmsh, SecondOrderSolidsComeInVtkOrder) {
  expect_vtk_order(read_gmsh(fixture("solids_incomplete.msh")), {{CellType::tetra10, 4, tetra_edges},
                                                                 {CellType::hexahedron20, 8, hexahedron_edges},
                                                                 {CellType::wedge15, 6, wedge_edges},
                                                                 {CellType::pyramid13, 5, pyramid_edges}});
  expect_vtk_order(read_gmsh(fixture("solids_complete.msh")),
                   {{CellType::tetra10, 4, tetra_edges},
                    {CellType::hexahedron27, 8,
                     joined(hexahedron_edges, {{0, 4, 7, 3},
                                               {1, 2, 6, 5},
                                               {0, 1, 5, 4},
                                               {3, 7, 6, 2},
                                               {0, 1, 2, 3},
                                               {4, 5, 6, 7},
                                               {0, 1, 2, 3, 4, 5, 6, 7}})},
                    {CellType::wedge18, 6, joined(wedge_edges, {{0, 1, 4, 3}, {1, 2, 5, 4}, {2, 0, 3, 5}})},
                    {CellType::pyramid14, 5, joined(pyramid_edges, {{0, 1, 2, 3}})}});
}

TEST(Gmsh, NodeAndElementDataOfMeshio) {
  for (const char* const file : {"data_22.msh", "data_22_binary.msh"}) {
    const Mesh mesh = read_gmsh(fixture(file));
    const Eigen::MatrixXd& temperature = mesh.point_data.at("temperature");
    const Eigen::MatrixXd& displacement = mesh.point_data.at("displacement");
    ASSERT_EQ(temperature.rows(), 32);
    ASSERT_EQ(displacement.cols(), 3);
    for (std::size_t i = 0; i < mesh.points.size(); ++i) {  // the formulas of make_data.py
      const Vec3& p = mesh.points[i];
      const auto row = static_cast<Eigen::Index>(i);
      EXPECT_NEAR(temperature(row, 0), 20.0 + 3.0 * p.x() - p.y(), 1e-12);
      EXPECT_LT((displacement.row(row).transpose() - Vec3(p.x() * p.y(), -p.y(), 2.0 * p.x())).norm(), 1e-12);
    }
    const auto& load = mesh.cell_data.at("load");
    ASSERT_EQ(load.size(), mesh.cells.size());
    for (std::size_t b = 0; b < load.size(); ++b)
      for (int c = 0; c < mesh.cells[b].size(); ++c) {
        const std::vector<Vec3> p = corners(mesh, mesh.cells[b], c);
        double mean = 0.0;
        for (const Vec3& corner : p) mean += corner.x() / static_cast<double>(p.size());
        EXPECT_NEAR(load[b](c, 0), mean, 1e-12);
      }
  }
}

TEST(Gmsh, DataOfSomeNodesLeavesNanElsewhere) {
  const Scratch scratch;
  const std::string data = "$NodeData\n1\n\"u\"\n1\n0.5\n3\n0\n1\n1\n2 7.5\n$EndNodeData\n";
  const Mesh mesh = read_gmsh(scratch.write("a.msh", contents(fixture("mixed_41.msh")) + data + data));
  EXPECT_DOUBLE_EQ(mesh.point_data.at("u")(1, 0), 7.5);
  EXPECT_TRUE(std::isnan(mesh.point_data.at("u")(0, 0)));
  EXPECT_DOUBLE_EQ(mesh.point_data.at("u (step 2)")(1, 0), 7.5);
}
