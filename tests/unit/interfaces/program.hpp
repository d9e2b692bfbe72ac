#pragma once

#include <gtest/gtest.h>
#include <sys/wait.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>

#include "tests/support/temporary_folder.hpp"

// The program from outside, in a folder of its own.

using nlohmann::json;
namespace fs = std::filesystem;

struct Ended {
  int status = -1;
  std::string out, err;
};

class Program : public testing::Test {
 protected:
  Ended tenon(const std::string& arguments) const {
    const fs::path out = folder_.path() / "stdout", err = folder_.path() / "stderr";
    const std::string line = "cd " + folder_.path().string() + " && " + std::string(TENON_PROGRAM) + " " + arguments +
                             " >" + out.string() + " 2>" + err.string() + " </dev/null";
    const int ended = std::system(line.c_str());
    Ended run{WIFEXITED(ended) ? WEXITSTATUS(ended) : -1, text(out), text(err)};
    fs::remove(out);
    fs::remove(err);
    return run;
  }
  json object(const std::string& arguments, int status = 0) const {
    const Ended run = tenon(arguments + " --json");
    EXPECT_EQ(run.status, status) << run.err;
    return json::parse(run.out);
  }
  static std::string text(const fs::path& file) {
    std::ifstream stream(file);
    return {std::istreambuf_iterator<char>(stream), {}};
  }
  std::vector<std::string> files() const {
    std::vector<std::string> names;
    for (const auto& entry : fs::directory_iterator(folder_.path())) names.push_back(entry.path().filename().string());
    std::sort(names.begin(), names.end());
    return names;
  }

  TemporaryFolder folder_;
};
