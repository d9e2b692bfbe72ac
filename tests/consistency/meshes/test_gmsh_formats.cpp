// One part that Gmsh meshes, in every format that it writes: the same frequencies to the digits that the format
// carries.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <fstream>

#include "assembly/build.hpp"
#include "assembly/scene.hpp"
#include "fem/structure.hpp"
#include "reduction/modes.hpp"
#include "tests/support/oracle.hpp"
#include "tests/support/temporary_folder.hpp"

using namespace tenon;

namespace {

// A folded panel: a floor of quads and a slanting wall of triangles, its points off all axes.
constexpr const char* part = R"(h = 0.21;
Point(1) = {0, 0, 0, h}; Point(2) = {1.3, 0, 0, h}; Point(3) = {1.1, 0.7, 0.05, h}; Point(4) = {0, 0.8, 0.02, h};
Point(5) = {0, 1.1, 0.5, h}; Point(6) = {1.15, 1.0, 0.6, h};
Line(1) = {1, 2}; Line(2) = {2, 3}; Line(3) = {3, 4}; Line(4) = {4, 1}; Line(5) = {3, 6}; Line(6) = {6, 5}; Line(7) = {5, 4};
Curve Loop(1) = {1, 2, 3, 4}; Surface(1) = {1};
Curve Loop(2) = {-3, 5, 6, 7}; Surface(2) = {2};
Transfinite Curve {1, 3} = 8; Transfinite Curve {2, 4} = 5; Transfinite Surface {1}; Recombine Surface {1};
Physical Surface("floor") = {1};
Physical Surface("wall") = {2};
)";

bool gmsh_is_missing() { return std::system("command -v gmsh > /dev/null") != 0; }

class GmshFormats : public ::testing::Test {
 protected:
  /// What Gmsh writes of a .geo.
  std::string mesh(const std::string& file, const std::string& geo, const std::string& options) const {
    const std::string from = folder_.write("part.geo", geo).string(), to = (folder_.path() / file).string();
    EXPECT_EQ(std::system(fmt::format("gmsh -2 {} {} -o {} -v 0 > /dev/null", from, options, to).c_str()), 0)
        << options;
    return to;
  }
  /// Frequencies [Hz] of the first ten elastic modes of the free part.
  Eigen::VectorXd frequencies(const std::string& file, const std::string& rest) const {
    const std::string scene = fmt::format("units: SI\nbodies:\n  part: {{fe: {}{}}}\n", file, rest);
    const fem::Structure s =
        fem::assemble(assembly::build_model(assembly::read_scene(folder_.write("scene.yaml", scene)).bodies.front()));
    const reduction::Modes modes = reduction::solve_modes(s, {.count = 16});
    EXPECT_EQ(modes.rigid, 6) << file;
    return (modes.lambda.segment(6, 10).array().sqrt() / (2.0 * std::numbers::pi)).matrix();
  }
  TemporaryFolder folder_;
};

constexpr const char* steel = ", material: {E: 2.1e11, nu: 0.3, rho: 7800}";

}  // namespace

TEST_F(GmshFormats, GiveTheSameFrequencies) {
  TENON_SKIP_WITHOUT(!gmsh_is_missing(), "gmsh");
  const std::string sections = fmt::format("{}, sections: {{everywhere: {{shell: 0.004}}}}", steel);
  const Eigen::VectorXd reference = frequencies(mesh("a.msh", part, "-format msh41 -bin"), sections);
  struct Format {
    const char *file, *options;
    double digits;  ///< of coordinates of size 1 that the format carries
  };
  // Coordinates off by δ strain a side of length h by at most 2√3 δ/h; h is .14 at least here, and frequencies follow.
  // Gmsh writes MSH 4.0 in text alone.
  for (const Format& format : {Format{"b.msh", "-format msh22", 1e-15}, Format{"c.msh", "-format msh22 -bin", 1e-15},
                               Format{"d.msh", "-format msh40", 1e-15}, Format{"f.msh", "-format msh41", 1e-15},
                               Format{"g.vtk", "-format vtk", 1e-15}, Format{"h.vtk", "-format vtk -bin", 1e-15},
                               Format{"i.inp", "-format inp", 1e-13}}) {
    const Eigen::VectorXd f = frequencies(mesh(format.file, part, format.options), sections);
    const double worst = (f.cwiseQuotient(reference).array() - 1.0).abs().maxCoeff();
    RecordProperty(format.file, fmt::format("{:.1e}", worst));
    EXPECT_LT(worst, 25.0 * format.digits + 1e-11) << format.options;  // and the round-off of the modes
  }
  // Six decimals, or what sixteen columns hold. As a mesh with the scene's sections, and as a deck with its own: Gmsh
  // numbers properties by physical groups.
  for (const auto& [field, digits] : {std::pair{1, 5e-7}, std::pair{2, 5e-9}, std::pair{0, 5e-7}}) {
    const std::string file = mesh("j.bdf", part, fmt::format("-format bdf -setnumber Mesh.BdfFieldFormat {}", field));
    const double as_mesh = (frequencies(file, sections).cwiseQuotient(reference).array() - 1.0).abs().maxCoeff();
    RecordProperty(fmt::format("bdf_mesh_{}", field), fmt::format("{:.1e}", as_mesh));
    EXPECT_LT(as_mesh, 25.0 * digits) << field;
    std::string deck((std::istreambuf_iterator<char>(std::ifstream(file).rdbuf())), {});
    deck.resize(std::min(deck.size(), deck.find("ENDDATA")));
    std::ofstream(file) << deck
                        << "MAT1,1,2.1+11,,.3,7800.\nPSHELL,1,1,.004,1,,1\nPSHELL,2,1,.004,1,,1\nPARAM,COUPMASS,1\n"
                        << "ENDDATA\n";
    const double worst = (frequencies(file, "").cwiseQuotient(reference).array() - 1.0).abs().maxCoeff();
    RecordProperty(fmt::format("bdf_{}", field), fmt::format("{:.1e}", worst));
    EXPECT_LT(worst, 25.0 * digits) << field;
  }
}

// MSH 2.2 lists an element once for every physical group that it is in; it is one element all the same.
TEST_F(GmshFormats, OverlappingGroupsDoNotCountTwice) {
  TENON_SKIP_WITHOUT(!gmsh_is_missing(), "gmsh");
  const std::string groups = fmt::format("{}Physical Surface(\"all\") = {{1, 2}};\n", part);
  const std::string sections = fmt::format("{}, sections: {{floor: {{shell: 0.004}}, wall: {{shell: 0.006}}}}", steel);
  const std::string whole = fmt::format("{}, sections: {{all: {{shell: 0.004}}}}", steel);
  for (const std::string& text : {sections, whole}) {
    const Eigen::VectorXd expected = frequencies(mesh("a.msh", groups, "-format msh41"), text);
    for (const char* options : {"-format msh22", "-format msh22 -bin", "-format msh40"})
      EXPECT_LT(
          (frequencies(mesh("b.msh", groups, options), text).cwiseQuotient(expected).array() - 1.0).abs().maxCoeff(),
          1e-11)
          << options;
  }
}
