#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <iterator>
#include <numbers>
#include <sstream>
#include <tuple>

#include "fem/error.hpp"
#include "fem/formats/vtu.hpp"
#include "tests/unit/fem/formats/scratch.hpp"

using namespace tenon;
using namespace tenon::fem;
using namespace tenon::fem::testing;
using ::testing::ElementsAre;
using ::testing::HasSubstr;

namespace {

/// The numbers of a named data array of a .vtu file written as text.
std::vector<double> values(const std::string& vtu, const std::string& name) {
  const auto heading = vtu.find("Name=\"" + name + "\"");
  if (heading == std::string::npos) return {};
  const auto first = vtu.find('>', heading) + 1;
  std::istringstream stream(vtu.substr(first, vtu.find("</DataArray>", first) - first));
  return {std::istream_iterator<double>(stream), {}};
}

double number(const std::string& vtu, const std::string& attribute) {
  const auto at = vtu.find(attribute + "=\"");
  return at == std::string::npos ? -1.0 : std::stod(vtu.substr(at + attribute.size() + 2));
}

/// A wedge beside a line, far from the origin.
Mesh wedge_and_line() {
  Mesh mesh;
  for (const auto& p : {Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(0, 1, 0), Vec3(0, 0, 2), Vec3(1, 0, 2), Vec3(0, 1, 2)})
    mesh.points.push_back(Vec3(1000.0 / 3.0, 0.0, 0.0) + p);
  mesh.cells = {{CellType::wedge, {0, 1, 2, 3, 4, 5}, {1}}, {CellType::line, {0, 5}, {2}}};
  return mesh;
}

}  // namespace

TEST(Vtu, HoldsPointsCellsAndArrays) {
  const Scratch scratch;
  const Mesh mesh = wedge_and_line();
  Eigen::MatrixXd u(6, 3);
  for (Eigen::Index i = 0; i < u.size(); ++i) u(i) = std::sin(1.0 + static_cast<double>(i)) * 1e-7;
  const Eigen::MatrixXd scalar = Eigen::VectorXd::LinSpaced(6, -1.0, 4.0);
  write_vtu(scratch.file("a.vtu"), mesh, {{"mode_1", u}, {"a < b & \"c\"", scalar}});
  const std::string vtu = contents(scratch.file("a.vtu"));

  EXPECT_EQ(number(vtu, "NumberOfPoints"), 6.0);
  EXPECT_EQ(number(vtu, "NumberOfCells"), 2.0);
  const std::vector<double> points = values(vtu, "Points"), found = values(vtu, "mode_1");
  ASSERT_EQ(points.size(), 18U);
  ASSERT_EQ(found.size(), 18U);
  for (std::size_t i = 0; i < 18; ++i) {  // nine digits
    EXPECT_NEAR(points[i], mesh.points[i / 3][static_cast<Eigen::Index>(i % 3)], 1e-8 * 334.0);
    const double expected = u(static_cast<Eigen::Index>(i / 3), static_cast<Eigen::Index>(i % 3));
    EXPECT_NEAR(found[i], expected, 1e-8 * std::abs(expected));
  }
  EXPECT_THAT(values(vtu, "connectivity"), ElementsAre(0, 2, 1, 3, 5, 4, 0, 5));  // VTK's wedge: normal outward
  EXPECT_THAT(values(vtu, "offsets"), ElementsAre(6, 8));
  EXPECT_THAT(values(vtu, "types"), ElementsAre(13, 3));
  EXPECT_THAT(values(vtu, "a &lt; b &amp; &quot;c&quot;"), ElementsAre(-1, 0, 1, 2, 3, 4));
}

TEST(Vtu, EveryCellKindKeepsItsNodesAndGetsVtksNumber) {
  // vtkCellType.h; nodes of a cell as VTK counts them
  const std::vector<std::tuple<CellType, int, int>> kinds{
      {CellType::vertex, 1, 1},         {CellType::line, 3, 2},        {CellType::line3, 21, 3},
      {CellType::triangle, 5, 3},       {CellType::triangle6, 22, 6},  {CellType::quad, 9, 4},
      {CellType::quad8, 23, 8},         {CellType::quad9, 28, 9},      {CellType::tetra, 10, 4},
      {CellType::tetra10, 24, 10},      {CellType::hexahedron, 12, 8}, {CellType::hexahedron20, 25, 20},
      {CellType::hexahedron27, 29, 27}, {CellType::wedge15, 26, 15},   {CellType::wedge18, 32, 18},
      {CellType::pyramid, 14, 5},       {CellType::pyramid13, 27, 13}, {CellType::pyramid14, 27, 13}};
  const Scratch scratch;
  Mesh mesh;
  mesh.points.assign(27, Vec3::Zero());
  for (const auto& [type, number, nodes] : kinds) {
    std::vector<int> all(static_cast<std::size_t>(node_count(type)));
    for (std::size_t i = 0; i < all.size(); ++i) all[i] = static_cast<int>(i);
    mesh.cells = {{type, all, {1}}};
    write_vtu(scratch.file("a.vtu"), mesh);
    const std::string vtu = contents(scratch.file("a.vtu"));
    EXPECT_THAT(values(vtu, "types"), ElementsAre(number)) << name(type);
    EXPECT_THAT(values(vtu, "offsets"), ElementsAre(nodes)) << name(type);
    const std::vector<double> connectivity = values(vtu, "connectivity");
    ASSERT_EQ(connectivity.size(), static_cast<std::size_t>(nodes));
    for (std::size_t i = 0; i < connectivity.size(); ++i)
      EXPECT_EQ(connectivity[i], static_cast<double>(i)) << name(type);
  }
}

TEST(Vtu, ModesAreTheTranslationsOfAllDofs) {
  Eigen::MatrixXd shapes(12, 2);
  for (Eigen::Index i = 0; i < shapes.size(); ++i) shapes(i % 12, i / 12) = static_cast<double>(i);
  const std::vector<PointArray> arrays = mode_arrays(shapes);
  ASSERT_EQ(arrays.size(), 2U);
  EXPECT_EQ(arrays[0].name, "mode_1");
  EXPECT_EQ(arrays[1].name, "mode_2");
  Eigen::MatrixXd expected(2, 3);
  expected << 12, 13, 14, 18, 19, 20;
  EXPECT_EQ(arrays[1].values, expected);
  EXPECT_THROW(mode_arrays(Eigen::MatrixXd::Zero(7, 1)), ModelError);
}

TEST(Vtu, RefusesWhatDoesNotFitAndLeavesTheOldFile) {
  const Scratch scratch;
  const auto path = scratch.write("a.vtu", "good");
  Mesh mesh = wedge_and_line();
  EXPECT_THROW(write_vtu(path, mesh, {{"u", Eigen::MatrixXd::Zero(5, 3)}}), ModelError);
  EXPECT_THROW(write_vtu(path, mesh, {}, {.cell_arrays = {{"E", Eigen::MatrixXd::Zero(6, 1)}}}), ModelError);
  EXPECT_THROW(write_vtu(path, mesh, {{"u", Eigen::MatrixXd::Constant(6, 3, std::nan(""))}}), ModelError);
  mesh.cells[1].nodes[1] = 6;
  EXPECT_THROW(write_vtu(path, mesh), ModelError);
  EXPECT_EQ(contents(path), "good");
  EXPECT_THROW(write_vtu(scratch.file("missing/a.vtu"), wedge_and_line()), InputError);
}

TEST(Vtu, AnimationIsOnePeriodOfTheMode) {
  const Scratch scratch;
  const Mesh mesh = wedge_and_line();
  Eigen::MatrixX3d mode = Eigen::MatrixX3d::Zero(6, 3);
  mode.row(4) = Vec3(0.0, 3.0, -4.0).transpose();
  write_mode_animation(scratch.file("bending.pvd"), mesh, mode, {.frames = 8, .amplitude = 0.2});
  const std::string pvd = contents(scratch.file("bending.pvd"));
  for (int k = 0; k < 8; ++k) {
    const std::string name = "bending_00" + std::to_string(k) + ".vtu";
    EXPECT_THAT(pvd, HasSubstr("file=\"" + name + "\""));
    const std::string vtu = contents(scratch.file(name));
    const double a = 0.2 * std::sqrt(1.0 + 1.0 + 4.0) * std::sin(2.0 * std::numbers::pi * k / 8.0);  // box 1 × 1 × 2
    const std::vector<double> points = values(vtu, "Points"), u = values(vtu, "displacement");
    ASSERT_EQ(points.size(), 18U);
    ASSERT_EQ(u.size(), 18U);
    EXPECT_NEAR(points[13], a * 0.6, 1e-8);
    EXPECT_NEAR(points[14], 2.0 - a * 0.8, 1e-8);
    EXPECT_NEAR(u[14], -a * 0.8, 1e-8);
    EXPECT_NEAR(points[0], 1000.0 / 3.0, 1e-6);
  }
  EXPECT_THAT(pvd, HasSubstr("timestep=\"0.875\""));
  EXPECT_FALSE(std::filesystem::exists(scratch.file("bending_008.vtu")));
  write_mode_animation(scratch.file("still.pvd"), mesh, Eigen::MatrixX3d::Zero(6, 3), {.frames = 1});
  EXPECT_NEAR(values(contents(scratch.file("still_000.vtu")), "Points")[14], 2.0, 1e-12);
}
