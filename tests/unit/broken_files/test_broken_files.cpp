#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <chrono>

#include "fem/error.hpp"
#include "tests/support/temporary_folder.hpp"
#include "tests/unit/broken_files/broken.hpp"

using namespace tenon;
using namespace tenon::broken;

namespace {

struct Entry {
  const char* format;
  Family (*cases)();
  std::size_t least;  ///< so that no case gets lost
};
constexpr Entry table[] = {{"gmsh", gmsh_cases, 300},        {"abaqus", abaqus_cases, 255},
                           {"nastran", nastran_cases, 100},  {"scene", scene_cases, 60},
                           {"body", body_cases, 60},         {"vtk", vtk_cases, 200},
                           {"vtu", vtu_cases, 250},          {"xdmf", xdmf_cases, 120},
                           {"market", market_cases, 105},    {"labels", label_cases, 55},
                           {"calculix", calculix_cases, 68}, {"abaqus_matrices", abaqus_matrix_cases, 48},
                           {"op4", op4_cases, 190},          {"superelement", superelement_cases, 35},
                           {"punch", punch_cases, 75}};

class BrokenFiles : public testing::TestWithParam<Entry> {};

TEST_P(BrokenFiles, AreRefusedWithTheirPlaceOrReadWell) {
  using namespace std::chrono;
  const Family family = GetParam().cases();
  EXPECT_GE(family.cases.size(), GetParam().least);
  const TemporaryFolder folder;
  for (const Case& c : family.cases) {
    for (const auto& [name, bytes] : c.beside) folder.write(name, bytes);
    const auto file = folder.write(family.file, c.bytes);
    std::string message;
    std::pair<long, long> place;
    const auto start = steady_clock::now();
    try {
      family.read(file);
    } catch (const InputError& error) {
      message = error.what();
      if (const std::size_t at = message.find(folder.path().string() + "/"); at == 0)
        message.erase(0, folder.path().string().size() + 1);
      place = {error.place().line, error.place().column};
    } catch (const std::exception& error) {
      ADD_FAILURE() << c.name << ": no InputError but: " << error.what();
      continue;
    }
    EXPECT_LT(steady_clock::now() - start, seconds(1)) << c.name;
    if (c.reads) {
      EXPECT_EQ(message, "") << c.name;
      continue;
    }
    EXPECT_NE(message, "") << c.name << ": read without complaint";
    if (message.empty()) continue;
    EXPECT_THAT(message, testing::HasSubstr(c.beside.empty() ? family.file : "")) << c.name;
    for (const std::string& part : c.says) EXPECT_THAT(message, testing::HasSubstr(part)) << c.name;
    EXPECT_EQ(place, c.place.value_or(place)) << c.name << ": " << message;
  }
  RecordProperty("files", static_cast<int>(family.cases.size()));
}

INSTANTIATE_TEST_SUITE_P(, BrokenFiles, testing::ValuesIn(table),
                         [](const auto& info) { return std::string(info.param.format); });

}  // namespace
