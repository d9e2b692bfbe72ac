#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>

#include "fem/formats/read_mesh.hpp"

using namespace tenon::fem;

namespace {

/// Cells of a set and their lengths or areas added up; area vectors towards +z count positive.
struct Extent {
  int cells = 0;
  double measure = 0.0;
};

Extent extent(const Mesh& mesh, const std::string& set) {
  Extent e;
  const auto& blocks = mesh.cell_sets.at(set);
  for (std::size_t b = 0; b < blocks.size(); ++b)
    for (const int cell : blocks[b]) {
      const auto width = static_cast<std::size_t>(node_count(mesh.cells[b].type));
      const auto p = [&](std::size_t i) {
        return mesh.points[static_cast<std::size_t>(mesh.cells[b].nodes[static_cast<std::size_t>(cell) * width + i])];
      };
      ++e.cells;
      if (width == 2) e.measure += (p(1) - p(0)).norm();
      if (width == 4) e.measure += 0.5 * (p(2) - p(0)).cross(p(3) - p(1)).z();
    }
  return e;
}

struct Shipped {
  std::string file;
  std::size_t points = 0;
  std::map<std::string, Extent> sets;
};

void PrintTo(const Shipped& shipped, std::ostream* out) { *out << shipped.file; }

Mesh read(const std::string& file) { return read_mesh(std::string(TENON_SOURCE_DIR) + "/data/" + file); }

/// Nodes as sorted coordinates.
std::vector<std::array<double, 3>> positions(const Mesh& mesh, const std::vector<int>& nodes) {
  std::vector<std::array<double, 3>> found;
  for (const int n : nodes) {
    const Vec3& p = mesh.points[static_cast<std::size_t>(n)];
    found.push_back({p.x(), p.y(), p.z()});
  }
  std::ranges::sort(found);
  return found;
}

}  // namespace

class ShippedMeshes : public ::testing::TestWithParam<Shipped> {};

/// Counts and sizes follow from the numbers in the .geo files.
TEST_P(ShippedMeshes, HoldWhatTheirGeometrySays) {
  const Mesh mesh = read(GetParam().file);
  EXPECT_EQ(mesh.points.size(), GetParam().points);
  EXPECT_TRUE(mesh.losses.empty());
  EXPECT_EQ(mesh.cell_sets.size(), GetParam().sets.size());
  for (const auto& [set, expected] : GetParam().sets) {
    const Extent found = extent(mesh, set);
    EXPECT_EQ(found.cells, expected.cells) << set;
    EXPECT_NEAR(found.measure, expected.measure, 1e-9 * std::max(1.0, expected.measure)) << set;
  }
}

INSTANTIATE_TEST_SUITE_P(
    Data, ShippedMeshes,
    ::testing::Values(
        // three panels' nodes, and 34 of the yoke's 34 cells, which close one ring
        Shipped{"spacecraft/panel.msh",
                3 * 21 * 26 + 34,
                {{"skin", {3 * 20 * 25, 3 * 1.6 * 2.0}},
                 {"frame", {3 * 2 * (20 + 25), 3 * 2 * (1.6 + 2.0)}},
                 {"hinge", {2 + 3 + 3, 8 * 0.05}},
                 {"yoke", {4 + 4 * 6 + 6, 0.4 + 2.0 * std::hypot(0.64, 1.0) + 0.64}},
                 {"root", {1, 0.0}},
                 {"tip", {1, 0.0}}}},
        Shipped{"reference/beam_16.msh", 17, {{"beam", {16, 1.0}}, {"left", {1, 0.0}}, {"right", {1, 0.0}}}},
        Shipped{
            "reference/double_cross.msh", 8 * 8 + 1, {{"arms", {64, 40.0}}, {"ends", {8, 0.0}}, {"centre", {1, 0.0}}}},
        Shipped{"reference/fv4.msh",
                17 + 2,
                {{"beam", {16, 10.0}},
                 {"root", {1, 0.0}},
                 {"tip", {1, 0.0}},
                 {"tip_plus", {1, 0.0}},
                 {"tip_minus", {1, 0.0}}}},
        Shipped{
            "reference/sdls03.msh",
            37 * 25,
            {{"plate", {36 * 24, 1.5}}, {"x0", {24, 1.0}}, {"x1", {24, 1.0}}, {"y0", {36, 1.5}}, {"y1", {36, 1.5}}}},
        Shipped{"reference/fv12.msh",
                25 * 25,
                {{"plate", {24 * 24, 100.0}},
                 {"x0", {24, 10.0}},
                 {"x1", {24, 10.0}},
                 {"y0", {24, 10.0}},
                 {"y1", {24, 10.0}}}},
        Shipped{"reference/sdls106.msh",
                33 * 25,
                {{"plate", {32 * 24, 3.0}},
                 {"cut", {24, 1.5}},
                 {"x0", {24, 1.5}},
                 {"x1", {24, 1.5}},
                 {"y0", {32, 2.0}},
                 {"y1", {32, 2.0}}}},
        Shipped{"reference/sdls106_1.msh",
                13 * 25,
                {{"plate", {12 * 24, 0.75 * 1.5}},
                 {"cut", {24, 1.5}},
                 {"x0", {24, 1.5}},
                 {"y0", {12, 0.75}},
                 {"y1", {12, 0.75}}}},
        Shipped{"reference/sdls106_2.msh",
                21 * 25,
                {{"plate", {20 * 24, 1.25 * 1.5}},
                 {"cut", {24, 1.5}},
                 {"x1", {24, 1.5}},
                 {"y0", {20, 1.25}},
                 {"y1", {20, 1.25}}}}),
    [](const auto& shipped) {
      std::string name = shipped.param.file;
      std::ranges::replace_if(
          name, [](char c) { return c == '/' || c == '.'; }, '_');
      return name;
    });

TEST(ShippedMeshes, WingRunsAlongYFromItsRootAtTheOrigin) {
  const Mesh mesh = read("spacecraft/panel.msh");
  EXPECT_EQ(mesh.points[static_cast<std::size_t>(mesh.point_sets.at("root").at(0))], Vec3::Zero());
  const Vec3 tip = mesh.points[static_cast<std::size_t>(mesh.point_sets.at("tip").at(0))];
  EXPECT_LT((tip - Vec3(0.0, 1.45 + 3 * 2.0 + 2 * 0.05, 0.0)).norm(), 1e-12);
  for (const Vec3& p : mesh.points) EXPECT_EQ(p.z(), 0.0);
}

TEST(ShippedMeshes, PartsOfThePlateMeetNodeByNode) {
  const Mesh whole = read("reference/sdls106.msh"), one = read("reference/sdls106_1.msh"),
             two = read("reference/sdls106_2.msh");
  const auto cut = positions(whole, points_of_set(whole, "cut"));
  EXPECT_EQ(positions(one, points_of_set(one, "cut")), cut);
  EXPECT_EQ(positions(two, points_of_set(two, "cut")), cut);
  const auto all = positions(whole, points_of_set(whole, "plate"));
  for (const Mesh* const part : {&one, &two})
    EXPECT_TRUE(std::ranges::includes(all, positions(*part, points_of_set(*part, "plate"))));
}
