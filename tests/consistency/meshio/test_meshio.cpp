// meshio (Debian's python3-meshio) as an oracle: what it writes is what we read, in every format both know.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <map>

#include "fem/formats/read_mesh.hpp"
#include "tests/support/oracle.hpp"
#include "tests/support/temporary_folder.hpp"

using namespace tenon;
namespace fs = std::filesystem;

namespace {

struct Truth {
  int digits = 0;
  std::vector<fem::Vec3> points;
  std::vector<std::pair<std::string, std::vector<std::vector<int>>>> cells;
  std::map<std::string, Eigen::MatrixXd> point_data;
  std::map<std::string, std::vector<std::vector<int>>> cell_data;
};

Truth read_truth(const fs::path& path) {
  Truth truth;
  std::ifstream in(path);
  for (std::string word; in >> word;) {
    std::string name;
    std::size_t n = 0;
    if (word == "digits") in >> truth.digits;
    if (word == "points") {
      in >> n;
      truth.points.resize(n);
      for (fem::Vec3& x : truth.points) in >> x[0] >> x[1] >> x[2];
    }
    if (word == "cells") {
      in >> name >> n;
      in.ignore(1);
      auto& block = truth.cells.emplace_back(name, std::vector<std::vector<int>>(n)).second;
      for (std::vector<int>& nodes : block) {
        std::string line;
        std::getline(in, line);
        std::istringstream numbers(line);
        for (int node = 0; numbers >> node;) nodes.push_back(node);
      }
    }
    if (word == "point_data") {
      in >> name >> n;
      Eigen::MatrixXd& data = truth.point_data[name];
      data.resize(static_cast<Eigen::Index>(truth.points.size()), static_cast<Eigen::Index>(n));
      for (Eigen::Index i = 0; i < data.rows(); ++i)
        for (Eigen::Index j = 0; j < data.cols(); ++j) in >> data(i, j);
    }
    if (word == "cell_data") {
      in >> name;
      for (const auto& block : truth.cells) {
        auto& values = truth.cell_data[name].emplace_back(block.second.size());
        for (int& v : values) in >> v;
      }
    }
  }
  return truth;
}

void compare(const fem::Mesh& mesh, const Truth& truth) {
  const double relative = std::pow(10.0, 1 - truth.digits);
  ASSERT_EQ(mesh.points.size(), truth.points.size());
  for (std::size_t i = 0; i < truth.points.size(); ++i)
    for (int d = 0; d < 3; ++d)
      EXPECT_NEAR(mesh.points[i][d], truth.points[i][d], relative * std::abs(truth.points[i][d])) << "point " << i;
  ASSERT_EQ(mesh.cells.size(), truth.cells.size());
  for (std::size_t b = 0; b < truth.cells.size(); ++b) {
    EXPECT_EQ(fem::name(mesh.cells[b].type), truth.cells[b].first);
    std::vector<int> nodes;
    for (const auto& cell : truth.cells[b].second) nodes.insert(nodes.end(), cell.begin(), cell.end());
    EXPECT_EQ(mesh.cells[b].nodes, nodes) << truth.cells[b].first;
  }
  for (const auto& [name, data] : truth.point_data)
    EXPECT_LE((mesh.point_data.at(name) - data).cwiseAbs().maxCoeff(), relative * data.cwiseAbs().maxCoeff()) << name;
  for (const auto& [name, blocks] : truth.cell_data)
    for (std::size_t b = 0; b < blocks.size(); ++b)
      for (std::size_t c = 0; c < blocks[b].size(); ++c) {
        const int value = blocks[b][c];
        EXPECT_EQ(mesh.cell_data.at(name)[b](static_cast<Eigen::Index>(c), 0), value);
        const auto& set = mesh.cell_sets.at(fmt::format("{}_{}", name, value))[b];
        EXPECT_NE(std::find(set.begin(), set.end(), static_cast<int>(c)), set.end()) << "whole numbers are sets";
      }
}

}  // namespace

TEST(Meshio, WhatItWritesIsWhatWeRead) {
  constexpr const char* python = "/usr/bin/python3";
  TENON_SKIP_WITHOUT(std::system(fmt::format("{} -c 'import meshio, h5py' 2> /dev/null", python).c_str()) == 0,
                     "python3-meshio or python3-h5py");
  const TemporaryFolder folder;
  const std::string script = TENON_SOURCE_DIR "/tests/consistency/meshio/make_files.py";
  const std::string command =
      fmt::format("{} {} {} 25 > {}/log 2>&1", python, script, folder.path().string(), folder.path().string());
  ASSERT_EQ(std::system(command.c_str()), 0) << std::ifstream(folder.path() / "log").rdbuf();
  int files = 0;
  for (const auto& entry : fs::directory_iterator(folder.path())) {
    const fs::path ending = entry.path().extension();
    if (ending == ".truth" || ending == ".h5" || ending == ".bin" || entry.path().filename() == "log") continue;
    SCOPED_TRACE(entry.path().filename().string());
    compare(fem::read_mesh(entry.path()), read_truth(fs::path(entry.path()).replace_extension(".truth")));
    ++files;
  }
  EXPECT_EQ(files, 450);
}
