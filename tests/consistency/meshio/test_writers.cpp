// What we write is read by meshio (Debian's python3-meshio), by Gmsh and by our own readers, which meshio's files hold.
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <limits>
#include <map>
#include <random>
#include <set>

#include "fem/error.hpp"
#include "fem/formats/gmsh.hpp"
#include "fem/formats/vtu.hpp"
#include "fem/formats/write_gmsh.hpp"
#include "tests/support/oracle.hpp"
#include "tests/support/temporary_folder.hpp"

using namespace tenon;
using fem::CellType;
using fem::Mesh;
namespace fs = std::filesystem;

namespace {

constexpr std::array all_types{
    CellType::vertex,     CellType::line,         CellType::line3,        CellType::triangle, CellType::triangle6,
    CellType::quad,       CellType::quad8,        CellType::quad9,        CellType::tetra,    CellType::tetra10,
    CellType::hexahedron, CellType::hexahedron20, CellType::hexahedron27, CellType::wedge,    CellType::wedge15,
    CellType::wedge18,    CellType::pyramid,      CellType::pyramid13,    CellType::pyramid14};

/// Points and cells anywhere; each cell in one group of its dimension, numbers of points and cells with gaps.
Mesh random_mesh(std::mt19937& random, const std::vector<CellType>& types) {
  const auto whole = [&](int from, int to) { return std::uniform_int_distribution(from, to)(random); };
  std::normal_distribution<double> normal;
  Mesh mesh;
  const int n = whole(27, 60);
  const double size = std::pow(10.0, whole(-3, 4));
  for (int i = 0; i < n; ++i) {
    mesh.points.emplace_back(size * normal(random), size * normal(random), size * normal(random));
    mesh.point_ids.push_back(3 * i + 7);
  }
  mesh.point_data["T"] = Eigen::MatrixXd::NullaryExpr(n, 1, [&] { return normal(random); });
  mesh.point_data["u"] = Eigen::MatrixXd::NullaryExpr(n, 3, [&] { return normal(random); });
  std::vector<int> order(static_cast<std::size_t>(n));
  for (int i = 0; i < n; ++i) order[static_cast<std::size_t>(i)] = i;
  for (const CellType type : types) {
    if (whole(0, 1) == 0) continue;
    const auto b = mesh.cells.size();
    fem::CellBlock block{.type = type, .nodes = {}, .ids = {}};
    std::set<std::vector<int>> taken;
    for (int c = whole(1, 5); c > 0; --c) {
      std::ranges::shuffle(order, random);
      std::vector<int> nodes(order.begin(), order.begin() + fem::node_count(type)), sorted = nodes;
      std::ranges::sort(sorted);
      if (!taken.insert(sorted).second) continue;  // no two cells on the same nodes
      const std::string group = fmt::format("part {} of dimension {}", whole(1, 3), fem::dimension(type));
      auto& blocks = mesh.cell_sets[group];
      blocks.resize(std::max(blocks.size(), b + 1));
      blocks[b].push_back(static_cast<int>(block.ids.size()));
      block.nodes.insert(block.nodes.end(), nodes.begin(), nodes.end());
      block.ids.push_back(static_cast<long>(1000 * (b + 1) + 2 * block.ids.size()));
    }
    mesh.cells.push_back(std::move(block));
  }
  for (auto& [name, blocks] : mesh.cell_sets) blocks.resize(mesh.cells.size());
  for (const fem::CellBlock& block : mesh.cells)
    mesh.cell_data["level"].push_back(Eigen::MatrixXd::NullaryExpr(block.size(), 1, [&] { return normal(random); }));
  return mesh;
}

std::string nodes_text(const fem::CellBlock& block, int cell) {
  const int n = fem::node_count(block.type);
  return fmt::format("{}", fmt::join(block.nodes.begin() + cell * n, block.nodes.begin() + (cell + 1) * n, " "));
}

/// The mesh in words that read_files.py knows; blanks of names become underscores on both sides.
void write_truth(const fs::path& path, const Mesh& mesh) {
  std::ofstream out(path);
  out << fmt::format("points {}\n", mesh.points.size());
  for (const fem::Vec3& x : mesh.points) out << fmt::format("{} {} {}\n", x.x(), x.y(), x.z());
  for (std::size_t b = 0; b < mesh.cells.size(); ++b) {
    const fem::CellBlock& block = mesh.cells[b];
    out << fmt::format("cells {} {}\n", fem::name(block.type), block.size());
    for (int c = 0; c < block.size(); ++c) out << nodes_text(block, c) << '\n';
    for (const auto& [name, blocks] : mesh.cell_sets) {
      if (blocks[b].empty()) continue;
      out << fmt::format("set {} {} {}\n", name, fem::name(block.type), blocks[b].size());
      for (const int c : blocks[b]) out << nodes_text(block, c) << '\n';
    }
    for (const auto& [name, blocks] : mesh.cell_data) {
      out << fmt::format("cell_data {} {} {}\n", name, fem::name(block.type), block.size());
      for (int c = 0; c < block.size(); ++c) out << fmt::format("{} {}\n", blocks[b](c, 0), nodes_text(block, c));
    }
  }
  for (const auto& [name, values] : mesh.point_data) {
    out << "point_data " << name << '\n';
    for (Eigen::Index i = 0; i < values.rows(); ++i)
      out << fmt::format("{}\n", fmt::join(std::vector<double>(values.row(i).begin(), values.row(i).end()), " "));
  }
}

/// Cells by type and where their nodes lie, with their numbers and sets, whatever their order.
using Contents = std::map<std::pair<CellType, std::vector<double>>, std::pair<long, std::set<std::string>>>;

Contents contents(const Mesh& mesh) {
  Contents all;
  for (std::size_t b = 0; b < mesh.cells.size(); ++b) {
    const fem::CellBlock& block = mesh.cells[b];
    const int n = fem::node_count(block.type);
    for (int c = 0; c < block.size(); ++c) {
      std::vector<double> nodes;
      for (int i = 0; i < n; ++i)
        for (const double x : mesh.points[static_cast<std::size_t>(block.nodes[static_cast<std::size_t>(c * n + i)])])
          nodes.push_back(x);
      auto& [id, sets] = all[{block.type, nodes}];
      id = block.ids[static_cast<std::size_t>(c)];
      for (const auto& [name, blocks] : mesh.cell_sets)
        if (std::ranges::find(blocks[b], c) != blocks[b].end()) sets.insert(name);
    }
  }
  return all;
}

bool has(const char* command) { return std::system(fmt::format("{} > /dev/null 2>&1", command).c_str()) == 0; }

}  // namespace

TEST(MeshWriters, MeshioReadsWhatTheyWrite) {
  constexpr const char* python = "/usr/bin/python3";
  TENON_SKIP_WITHOUT(has("/usr/bin/python3 -c 'import meshio'"), "python3-meshio");
  // meshio 5.0 knows no dimension of three types, and reads wedge18 in VTK's order, as it writes it
  const std::set unread{CellType::wedge15, CellType::wedge18, CellType::pyramid13, CellType::pyramid14};
  std::vector<CellType> types;
  for (const CellType type : all_types)
    if (!unread.contains(type)) types.push_back(type);
  const TemporaryFolder folder;
  std::mt19937 random(20170401);
  int files = 0;
  for (int k = 0; k < 40; ++k) {
    Mesh mesh = random_mesh(random, types);
    if (mesh.cells.empty()) continue;
    mesh.point_ids.clear();                                     // 1, 2, ...: others it does not find in binary data
    std::map<std::string, std::vector<std::vector<int>>> sets;  // the truth's words end at blanks
    for (auto& [name, blocks] : mesh.cell_sets) {
      std::string word = name;
      std::ranges::replace(word, ' ', '_');
      sets.emplace(word, blocks);
    }
    mesh.cell_sets = sets;
    const fs::path stem = folder.path() / std::to_string(k);
    write_truth(stem.string() + ".truth", mesh);
    fem::write_gmsh(stem.string() + ".msh", mesh);
    Mesh without = mesh;  // binary cell data it reads where cells are numbered 1, 2, ... in the order of the file
    without.cell_data.clear();
    fem::write_gmsh(stem.string() + ".binary.msh", without, {.binary = true});
    std::vector<fem::PointArray> arrays;
    for (const auto& [name, values] : mesh.point_data) arrays.push_back({name, values});
    Eigen::MatrixXd level(0, 1);
    for (const Eigen::MatrixXd& block : mesh.cell_data.at("level")) {
      level.conservativeResize(level.rows() + block.rows(), 1);
      level.bottomRows(block.rows()) = block;
    }
    fem::write_vtu(stem.string() + ".vtu", mesh, arrays, {.cell_arrays = {{"level", level}}, .digits = 17});
    files += 3;
  }
  const std::string log = (folder.path() / "log").string();
  const std::string command =
      fmt::format("{} {} {} > {} 2>&1", python, TENON_SOURCE_DIR "/tests/consistency/meshio/read_files.py",
                  folder.path().string(), log);
  const int status = std::system(command.c_str());
  std::stringstream said;
  said << std::ifstream(log).rdbuf();
  ASSERT_EQ(status, 0) << said.str();
  EXPECT_EQ(said.str(), fmt::format("{}\n", files));
  EXPECT_GE(files, 100);
}

TEST(MeshWriters, OurReaderReadsWhatTheyWrite) {
  const TemporaryFolder folder;
  std::mt19937 random(7);
  const std::vector<CellType> types(all_types.begin(), all_types.end());
  for (int k = 0; k < 40; ++k) {
    const Mesh mesh = random_mesh(random, types);
    for (const bool binary : {false, true}) {
      const fs::path path = folder.path() / "mesh.msh";
      fem::write_gmsh(path, mesh, {.binary = binary});
      const Mesh read = fem::read_gmsh(path);
      EXPECT_EQ(read.format, binary ? "gmsh 4.1 binary" : "gmsh 4.1 ascii");
      EXPECT_EQ(read.points, mesh.points);
      EXPECT_EQ(read.point_ids, mesh.point_ids);
      EXPECT_EQ(contents(read), contents(mesh));
      EXPECT_EQ(read.point_data.at("u"), mesh.point_data.at("u"));
      for (const fem::Loss& loss : read.losses) ADD_FAILURE() << loss.name << ' ' << loss.note;
    }
  }
}

// A cell in two groups, a set of points, values that are not known, a name that dimensions share.
TEST(MeshWriters, OverlappingSetsAndSetsOfPoints) {
  const TemporaryFolder folder;
  const fs::path path = folder.path() / "mesh.msh";
  Mesh mesh;
  mesh.points = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}};
  mesh.cells = {{.type = CellType::quad, .nodes = {0, 1, 2, 3}, .ids = {5}},
                {.type = CellType::line, .nodes = {0, 1, 1, 2}, .ids = {1, 2}}};
  mesh.cell_sets = {{"skin", {{0}, {}}}, {"all", {{0}, {0, 1}}}, {"edge", {{}, {1}}}};
  mesh.point_sets = {{"corner", {2, 3}}, {"tip", {3}}};
  mesh.field_data = {{"edge", {42, 1}}};
  const double unknown = std::numeric_limits<double>::quiet_NaN();
  mesh.point_data["T"] = Eigen::Vector4d(1.0, unknown, 3.0, 4.0);
  fem::write_gmsh(path, mesh);
  const Mesh read = fem::read_gmsh(path);
  EXPECT_EQ(fem::points_of_set(read, "corner"), (std::vector{2, 3}));
  EXPECT_EQ(fem::points_of_set(read, "tip"), (std::vector{3}));
  EXPECT_EQ(fem::points_of_set(read, "edge"), (std::vector{1, 2}));
  EXPECT_EQ(fem::points_of_set(read, "all"), (std::vector{0, 1, 2, 3}));
  EXPECT_EQ(read.field_data.at("edge"), (std::pair{42, 1}));
  EXPECT_EQ(read.point_ids, (std::vector<long>{1, 2, 3, 4}));
  EXPECT_TRUE(std::isnan(read.point_data.at("T")(1, 0)));
  EXPECT_EQ(read.point_data.at("T")(3, 0), 4.0);
  mesh.cell_sets["skin"] = {{1}};
  EXPECT_THROW(fem::write_gmsh(path, mesh), ModelError);
  mesh.cell_sets["skin"] = {{0}};
  for (const char* name : {"a \"b\"", "", "two\nlines"}) {
    Mesh named = mesh;
    named.cell_sets[name] = {{0}};
    EXPECT_THROW(fem::write_gmsh(path, named), ModelError) << name;
    named = mesh;
    named.point_data[name] = Eigen::Vector4d::Zero();
    EXPECT_THROW(fem::write_gmsh(path, named), ModelError) << name;
  }
  mesh.cells[0].nodes[2] = 4;
  EXPECT_THROW(fem::write_gmsh(path, mesh), ModelError);
}

// $NodeData and $ElementData have 4 bytes for a number: one beyond them must not come back as another.
TEST(MeshWriters, NumbersBeyondFourBytes) {
  const TemporaryFolder folder;
  const fs::path path = folder.path() / "mesh.msh";
  Mesh mesh;
  mesh.points = {{0, 0, 0}, {1, 0, 0}};
  mesh.point_ids = {1, (1L << 32) + 5};
  mesh.cells = {{.type = CellType::line, .nodes = {0, 1}, .ids = {1L << 31}}};
  mesh.point_data["T"] = Eigen::Vector2d(1.0, 2.0);
  mesh.point_data["nothing"] = Eigen::MatrixXd(2, 0);
  mesh.cell_data["E"] = {Eigen::MatrixXd::Constant(1, 1, 3.0)};
  for (const bool binary : {false, true}) {
    fem::write_gmsh(path, mesh, {.binary = binary});
    const Mesh read = fem::read_gmsh(path);
    EXPECT_EQ(read.point_ids, (std::vector<long>{1, 2}));
    EXPECT_EQ(read.point_data.at("T"), Eigen::Vector2d(1.0, 2.0));
    EXPECT_FALSE(read.point_data.contains("nothing"));
    EXPECT_EQ(read.cell_data.at("E")[0](0, 0), 3.0);
  }
}

// Gmsh itself opens the files and writes them in its older format, which has other nodes' and groups' rules.
TEST(MeshWriters, GmshReadsWhatTheyWrite) {
  TENON_SKIP_WITHOUT(has("gmsh --version"), "gmsh");
  const TemporaryFolder folder;
  std::mt19937 random(11);
  const std::vector<CellType> types(all_types.begin(), all_types.end());
  for (int k = 0; k < 4; ++k) {
    const Mesh mesh = random_mesh(random, types);
    const std::string ours = (folder.path() / "ours.msh").string(), theirs = (folder.path() / "theirs.msh").string();
    fem::write_gmsh(ours, mesh, {.binary = k % 2 == 1});
    ASSERT_TRUE(has(fmt::format("gmsh {} -save -format msh22 -o {}", ours, theirs).c_str()));
    Mesh read = fem::read_gmsh(theirs);
    for (fem::Vec3& x : read.points) {  // it writes 16 digits
      const fem::Vec3 nearest =
          *std::ranges::min_element(mesh.points, {}, [&](const fem::Vec3& y) { return (x - y).norm(); });
      EXPECT_LT((x - nearest).norm(), 1e-15 * nearest.norm());
      x = nearest;
    }
    Contents a = contents(read), b = contents(mesh);
    for (Contents* c : {&a, &b})  // format 2.2 numbers groups anew
      for (auto& [cell, id_sets] : *c) id_sets.first = 0;
    EXPECT_EQ(a, b);
  }
}
