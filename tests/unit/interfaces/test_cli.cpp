#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/wait.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <nlohmann/json.hpp>
#include <numbers>
#include <sstream>

#include "tests/support/temporary_folder.hpp"

// The program from outside: what it prints, what it writes, how it ends.
namespace {

using nlohmann::json;
using testing::ContainsRegex;
using testing::HasSubstr;
namespace fs = std::filesystem;

struct Ended {
  int status = -1;
  std::string out, err;
};

/// Cantilever of FV2's square section (0.125 m, E = 200 GPa, ρ = 8000), L = 10, Euler-Bernoulli, clamped through a
/// port.
const char* const beam_scene = R"(units: SI
bodies:
  beam:
    fe: beam_16.msh
    material: {E: 200e9, nu: 0.3, rho: 8000}
    sections: {beam: {rectangle: [0.125, 0.25], shear: euler-bernoulli, orientation: [0, 1, 0]}}
    ports: {root: {set: left}, tip: {set: right}}
    damping: 0.01
    reduction: {modes: 12}
ground: [beam.root]
inputs: {push: {at: beam.tip, force: z}}
outputs: {tip: {at: beam.tip, displacement: [y, z]}}
requires: {band: [0, 40 Hz], tolerance: 1e-4}
)";

class Cli : public testing::Test {
 protected:
  Cli() {
    fs::copy_file(fs::path(TENON_SOURCE_DIR) / "data/reference/beam_16.msh", folder_.path() / "beam_16.msh");
    scene_ = folder_.write("scene.yaml", beam_scene).string();
  }

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
  std::string scene_with(const std::string& from, const std::string& to) const {
    std::string changed = beam_scene;
    const std::size_t at = changed.find(from);
    EXPECT_NE(at, std::string::npos) << from;
    return folder_.write("changed.yaml", changed.replace(at, from.size(), to)).string();
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
  std::string scene_;
};

/// Bending frequencies of the cantilever [Hz]: (βL)² √(EI/ρA) / 2πL², L from the mesh's end points.
double cantilever_hz(double root, double depth, double length) {
  return root * root * std::sqrt(200e9 * depth * depth / 12.0 / 8000.0) / (2.0 * std::numbers::pi * length * length);
}

TEST_F(Cli, InfoPrintsWhatTheMeshHolds) {
  const json info = object("info " + (folder_.path() / "beam_16.msh").string());
  EXPECT_EQ(info["points"], 17);
  EXPECT_EQ(info["cells"]["line"], 16);
  EXPECT_EQ(info["cell_sets"]["beam"]["cells"], 16);
  EXPECT_EQ(info["point_sets"]["left"], 1);
  EXPECT_TRUE(info["read_past"].is_array());
}

TEST_F(Cli, ModesAgreeWithTheClosedFormOfTheCantilever) {
  const json info = object("info " + (folder_.path() / "beam_16.msh").string());
  const auto low = info["bounding_box_file_units"]["min"], high = info["bounding_box_file_units"]["max"];
  const double length = high[0].get<double>() - low[0].get<double>();
  const json modes = object("modes " + scene_ + " --full --count 4");
  EXPECT_EQ(modes["rigid_modes"], 0);
  // y along the orientation: b = 0.125 bends in x-y, h = 0.25 in x-z; the third mode is torsion. 16 elements: 1e-5.
  const double expected[] = {cantilever_hz(1.875104068712, 0.125, length), cantilever_hz(1.875104068712, 0.25, length),
                             cantilever_hz(4.694091132974, 0.125, length)};
  const int place[] = {0, 1, 3};
  for (int k = 0; k < 3; ++k) {
    EXPECT_NEAR(modes["full"]["frequencies_hz"][place[k]].get<double>() / expected[k], 1.0, 1e-5);
    if (k == 2) continue;  // far above the scene's band
    EXPECT_NEAR(modes["frequencies_hz"][place[k]].get<double>() / expected[k], 1.0, 1e-4);
  }
  EXPECT_TRUE(modes["full"]["within_tolerance"].get<bool>());
  EXPECT_NEAR(modes["damping_ratios"][0].get<double>(), 0.01, 1e-3);
}

TEST_F(Cli, ACheckThatFailsEndsWithStatusOne) {
  std::string coarse = beam_scene;  // static shapes alone miss the first bending modes, which the band asks for
  coarse.replace(coarse.find("{modes: 12}"), 11, "{basis: craig-bampton, modes: 0}");
  coarse.replace(coarse.find("40 Hz"), 5, "400 Hz");
  coarse = folder_.write("coarse.yaml", coarse).string();
  const json modes = object("modes " + coarse + " --full --count 4", 1);
  EXPECT_FALSE(modes["full"]["within_tolerance"].get<bool>());
}

TEST_F(Cli, StaticResponseIsTheCantileversDeflection) {
  const json info = object("info " + (folder_.path() / "beam_16.msh").string());
  const double length =
      info["bounding_box_file_units"]["max"][0].get<double>() - info["bounding_box_file_units"]["min"][0].get<double>();
  const json frf = object("frf " + scene_ + " --from push --to tip.z --band 1e-4 1e-3 --points 2");
  // F = 1 N at the tip: L³/3EI with EI of bending in x-z; static shapes are exact in Craig-Bampton.
  const double I = 0.125 * 0.25 * 0.25 * 0.25 / 12.0;
  EXPECT_NEAR(frf["responses"][0]["gain"][0].get<double>() * 3.0 * 200e9 * I / std::pow(length, 3), 1.0, 1e-6);
  EXPECT_EQ(frf["responses"][0]["unit"], "(m)/(N)");
  EXPECT_EQ(frf["frequencies_hz"].size(), 2u);
}

TEST_F(Cli, ReduceWritesABodyThatTheSceneCanUse) {
  const std::string body = (folder_.path() / "beam.body.json").string();
  const json reduced = object("reduce " + scene_ + " --body beam -o " + body);
  EXPECT_TRUE(fs::exists(body));
  EXPECT_GE(reduced["certificate"]["modes_counted"].get<int>(), 12);
  const std::string joined = folder_
                                 .write("reduced.yaml", R"(units: SI
bodies: {beam: {reduced: beam.body.json}}
ground: [beam.root]
)")
                                 .string();
  const json from_file = object("modes " + joined), direct = object("modes " + scene_);
  EXPECT_EQ(from_file["frequencies_hz"], direct["frequencies_hz"]);
}

TEST_F(Cli, AssembleWritesNamedChannelsWithUnits) {
  const std::string file = (folder_.path() / "system.json").string();
  const json summary = object("assemble " + scene_ + " -o " + file);
  const json system = json::parse(text(file));
  EXPECT_EQ(system["A"].size(), summary["states"].get<std::size_t>());
  EXPECT_EQ(system["inputs"][0]["name"], "push");
  EXPECT_EQ(system["outputs"][1]["name"], "tip.z");
  EXPECT_EQ(system["outputs"][1]["unit"], "m");
}

TEST_F(Cli, CheckLooksAtMassAndRigidMotions) {
  const json floating = object("check " + scene_with("ground: [beam.root]", "ground: []"));
  EXPECT_EQ(floating["rigid_motions"], 6);
  EXPECT_TRUE(floating["good"].get<bool>());
  EXPECT_EQ(object("check " + scene_)["rigid_motions"], 0);
  EXPECT_THAT(floating["bodies"][0]["plan"]["kept"].get<std::string>(), HasSubstr("lowest 12 fixed-interface modes"));
}

TEST_F(Cli, WritesPicturesAndTables) {
  const std::string svg = (folder_.path() / "frf.svg").string(), csv = (folder_.path() / "frf.csv").string();
  ASSERT_EQ(tenon("frf " + scene_ + " --from push --to tip --svg " + svg + " -o " + csv).status, 0);
  EXPECT_THAT(text(svg),
              testing::AllOf(testing::StartsWith("<svg"), HasSubstr("<polyline"), HasSubstr("frequency [Hz]")));
  EXPECT_THAT(text(csv), testing::StartsWith("frequency_hz,tip.y gain (m)/(N),tip.y phase_deg,tip.z gain"));
  const std::string vtu = (folder_.path() / "modes.vtu").string();
  ASSERT_EQ(tenon("modes " + scene_ + " --count 3 --vtu " + vtu).status, 0);
  EXPECT_THAT(text(vtu),
              testing::AllOf(HasSubstr("NumberOfPoints=\"17\" NumberOfCells=\"16\""), HasSubstr("mode 03, ")));
}

TEST_F(Cli, TablesFitAHundredColumns) {
  for (const char* command : {"check ", "modes ", "reduce --body beam ", "assemble "}) {
    std::istringstream lines(tenon(std::string(command) + "scene.yaml").out);
    for (std::string line; std::getline(lines, line);)
      EXPECT_LE(std::count_if(line.begin(), line.end(), [](char c) { return (c & 0xC0) != 0x80; }), 100) << line;
  }
}

TEST_F(Cli, InitWritesASceneThatOnlyLacksWhatTheUserKnows) {
  const std::string mesh = (folder_.path() / "beam_16.msh").string();
  std::string text = tenon("init " + mesh).out;
  const Ended unfilled = tenon("check " + folder_.write("new.yaml", text).string());
  EXPECT_EQ(unfilled.status, 2);
  EXPECT_THAT(unfilled.err, HasSubstr("found 'UNITS', expected one of SI"));
  for (const auto& [word, value] : {std::pair("UNITS ", "SI "), {"[OUTER, INNER]", "[0.1, 0.09]"}, {"BAND", "20"}}) {
    ASSERT_NE(text.find(word), std::string::npos);
    text.replace(text.find(word), std::string(word).size(), value);
  }
  EXPECT_EQ(tenon("check " + folder_.write("new.yaml", text).string()).status, 0);
}

TEST_F(Cli, DoctorSaysWhatIsLinkedAndUnderWhichTerms) {
  const json doctor = object("doctor");
  EXPECT_TRUE(doctor["libraries"].contains("CHOLMOD"));
  EXPECT_GE(doctor["threads"].get<int>(), 1);
  EXPECT_THAT(doctor["licence"]["binary"].get<std::string>(), HasSubstr("GPL"));
}

TEST_F(Cli, HelpEndsWithStatusZeroAndAnExample) {
  EXPECT_EQ(tenon("--help").status, 0);
  for (const char* command : {"info", "init", "check", "modes", "reduce", "assemble", "frf", "doctor"}) {
    const Ended help = tenon(std::string(command) + " --help");
    EXPECT_EQ(help.status, 0);
    EXPECT_THAT(help.out, HasSubstr("Example"));
  }
}

/// Bad input: status 2, one sentence on standard error with place and cure, no file written, nothing on standard
/// output.
struct BadInput {
  const char* name;
  std::string arguments;  ///< SCENE, FOLDER are replaced
  const char* from;       ///< edit of the scene, "" for none
  const char* to;
  const char* message;  ///< regular expression
};

class CliBadInput : public Cli, public testing::WithParamInterface<BadInput> {};

TEST_P(CliBadInput, EndsWithStatusTwoAndWritesNothing) {
  const BadInput& bad = GetParam();
  const std::string scene = *bad.from ? scene_with(bad.from, bad.to) : scene_;
  folder_.write("empty.msh", "");
  folder_.write("garbage.msh", std::string("\x7f\x01\x00\xff\x80garbage\x00\x00", 14));
  const std::string good = text(folder_.path() / "beam_16.msh");
  folder_.write("truncated.msh", good.substr(0, good.size() / 2));
  std::string arguments = bad.arguments;
  for (const auto& [word, value] : {std::pair(std::string("SCENE"), scene), {"FOLDER", folder_.path().string()}})
    for (std::size_t at = arguments.find(word); at != std::string::npos; at = arguments.find(word))
      arguments.replace(at, word.size(), value);
  const std::vector<std::string> before = files();
  const Ended run = tenon(arguments);
  EXPECT_EQ(run.status, 2) << run.out << run.err;
  EXPECT_THAT(run.err, ContainsRegex(bad.message));
  EXPECT_EQ(run.out, "");
  EXPECT_EQ(files(), before);
}

INSTANTIATE_TEST_SUITE_P(
    , CliBadInput,
    testing::Values(
        BadInput{"unknown_command", "mods SCENE", "", "", "no command 'mods'. Did you mean 'modes'"},
        BadInput{"missing_mesh", "info FOLDER/beam_17.msh", "", "", "beam_17.msh: .*Did you mean 'beam_16.msh'"},
        BadInput{"empty_mesh", "info FOLDER/empty.msh", "", "", "empty.msh"},
        BadInput{"garbage_mesh", "info FOLDER/garbage.msh", "", "", "garbage.msh"},
        BadInput{"truncated_mesh", "info FOLDER/truncated.msh", "", "", "truncated.msh:[0-9]+"},
        BadInput{"bare_mesh", "modes FOLDER/beam_16.msh", "", "",
                 "neither units nor materials nor sections.*tenon init"},
        BadInput{"missing_scene", "modes FOLDER/absent.yaml", "", "", "absent.yaml: there is no such file"},
        BadInput{"missing_set", "modes SCENE", "{set: left}", "{set: lefd}", "changed.yaml:7:.*no set 'lefd'"},
        BadInput{"missing_port", "assemble SCENE -o FOLDER/x.json", "beam.tip, force", "beam.top, force",
                 "changed.yaml:11:.*has no port 'top'. Did you mean 'tip'"},
        BadInput{"no_material", "reduce SCENE --body beam -o FOLDER/x.body.json",
                 "    material: {E: 200e9, nu: 0.3, rho: 8000}\n", "", "section 'beam' has no material. Add"},
        BadInput{"unknown_body", "reduce SCENE --body bean -o FOLDER/x.body.json", "", "", "Did you mean 'beam'"},
        BadInput{"unknown_output", "frf SCENE --from push --to top -o FOLDER/x.csv", "", "", "no output 'top'"},
        BadInput{"unknown_ending", "frf SCENE --from push --to tip -o FOLDER/x.xls", "", "",
                 "written as .csv or .json"},
        BadInput{"missing_folder", "assemble SCENE -o FOLDER/absent/x.json", "", "", "cannot be written"},
        BadInput{"no_units", "check SCENE", "units: SI\n", "", "beam_16.msh carries no units"},
        BadInput{"empty_band", "modes SCENE --band 5 5", "", "", "the band is empty"},
        BadInput{"bad_option", "modes SCENE --cuont 3", "", "", "cuont"}),
    [](const auto& info) { return std::string(info.param.name); });

TEST_F(Cli, AGoodFileSurvivesAFailedRun) {
  const std::string file = folder_.write("system.json", "good").string();
  EXPECT_EQ(tenon("assemble " + scene_with("{set: left}", "{set: lefd}") + " -o " + file).status, 2);
  EXPECT_EQ(text(file), "good");
}

}  // namespace
