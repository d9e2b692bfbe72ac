// A body given as its own matrices is the body: K and M written to files and read back by `matrices:`.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "assembly/build.hpp"
#include "assembly/second_order.hpp"
#include "fem/formats/read_mesh.hpp"
#include "fem/mesh.hpp"
#include "fem/structure.hpp"
#include "reduction/modes.hpp"
#include "tests/refusal.hpp"
#include "tests/support/matrix_files.hpp"
#include "tests/support/temporary_folder.hpp"

using namespace tenon;
using namespace tenon::assembly;
using testing::HasSubstr;

namespace {

/// A mesh of data/reference with its sections, and ports that are laid on afterwards.
struct Case {
  std::string mesh, sections, ports;
  std::vector<std::string> sets;
};

const Case beam{"beam_16.msh",
                "material: {E: 200e9, nu: 0.3, rho: 8000}, sections: {beam: {rectangle: [0.125, 0.25], orientation: "
                "[0, 1, 0]}}",
                "{root: {set: left}, tip: {set: right}}",
                {"left", "right"}};
const Case plate{"sdls106_1.msh",
                 "material: {E: 2.1e11, nu: 0.3, rho: 7800}, sections: {plate: {shell: 0.01}}, "
                 "ignore: [cut, x0, y0, y1]",
                 "{cut: {set: cut, kind: rigid}}",
                 {"cut"}};

std::string scene_text(const std::string& units, const std::string& source, const std::string& ports) {
  return fmt::format("units: {}\nbodies:\n  b: {{{}{}, reduction: {{modes: 8}}}}\n{}", units, source,
                     ports.empty() ? "" : ", ports: " + ports, "requires: {band: [0, 200 Hz]}\n");
}

class Matrices : public testing::TestWithParam<Case> {
 protected:
  Matrices() {
    const Case& c = GetParam();
    mesh_ = std::filesystem::path(TENON_SOURCE_DIR) / "data/reference" / c.mesh;
    fe_ = fmt::format("fe: {}, {}", mesh_.string(), c.sections);
    const fem::Structure s = fem::assemble(build_model(scene(fe_, "").bodies.front()));
    const fem::Mesh mesh = fem::read_mesh(mesh_);
    std::map<std::string, std::vector<long>> sets;
    for (const std::string& set : c.sets)
      for (const int point : fem::points_of_set(mesh, set))
        sets[set].push_back(mesh.point_ids[static_cast<std::size_t>(point)]);
    folder_.write("k.mtx", tests::market_text(s.K));
    folder_.write("m.mtx", tests::market_text(s.M));
    folder_.write("rows.txt", tests::label_text(s, sets));
  }
  Scene scene(const std::string& source, const std::string& ports, const std::string& units = "SI") const {
    return read_scene(folder_.write("scene.yaml", scene_text(units, source, ports)));
  }

  TemporaryFolder folder_;
  std::filesystem::path mesh_;
  std::string fe_;
  const std::string matrices_ = "matrices: {K: k.mtx, M: m.mtx, labels: rows.txt}";
};

}  // namespace

TEST_P(Matrices, AloneHaveTheSameFrequencies) {
  const auto modes = [&](const std::string& source) {
    return reduction::solve_modes(fem::assemble(build_model(scene(source, "").bodies.front())), {.count = 14});
  };
  const reduction::Modes a = modes(fe_), b = modes(matrices_);
  ASSERT_EQ(a.rigid, 6);
  ASSERT_EQ(b.rigid, 6);
  // rows in another order: other round-off in the factor of K, whose largest eigenvalue is 1e8 times these
  for (int k = 6; k < 14; ++k) EXPECT_NEAR(std::sqrt(b.lambda[k] / a.lambda[k]), 1.0, 1e-11) << k;
}

// Links add the entries in another order: round-off of K over its lowest eigenvalue, 1e-9.
TEST_P(Matrices, ReduceToTheSameBody) {
  const auto body = [&](const std::string& source) {
    const Scene s = scene(source, GetParam().ports);
    return build_network(s, plan(s)).bodies.front();
  };
  const ReducedBody a = body(fe_), b = body(matrices_);
  ASSERT_EQ(a.n(), b.n());
  for (Eigen::Index k = 0; k < a.omega.size(); ++k) EXPECT_NEAR(b.omega[k] / a.omega[k], 1.0, 1e-9) << k;
  EXPECT_LT((a.D - b.D).norm(), 1e-12 * a.D.norm());
  EXPECT_LT((a.L.transpose() * a.L - b.L.transpose() * b.L).norm(), 1e-9 * a.D.norm());  // free of signs
  EXPECT_EQ(a.certificate.dofs, b.certificate.dofs);
}

TEST_P(Matrices, InMillimetresAndTonnesAreTheSameBody) {
  // in mm and t: K [t/s²] and M [t] ×1e-3, lengths ×1e3, a rotation's row and column ×1e3 each
  const auto modes = [&](const std::string& units) {
    const Scene s = scene(matrices_, "", units);
    return reduction::solve_modes(fem::assemble(build_model(s.bodies.front())), {.count = 9});
  };
  const fem::Structure s = fem::assemble(build_model(scene(matrices_, "").bodies.front()));
  const reduction::Modes si = modes("SI");
  fem::SparseMatrix K = s.K, M = s.M;
  for (fem::SparseMatrix* A : {&K, &M})
    for (int j = 0; j < A->outerSize(); ++j)
      for (fem::SparseMatrix::InnerIterator it(*A, j); it; ++it) {
        const auto turns = [&](Eigen::Index i) { return s.dofs.free[static_cast<std::size_t>(i)].direction > 2; };
        it.valueRef() *= 1e-3 * (turns(it.row()) ? 1e3 : 1.0) * (turns(j) ? 1e3 : 1.0);
      }
  fem::Structure millimetres = s;
  for (fem::Vec3& x : millimetres.nodes) x *= 1e3;
  folder_.write("k.mtx", tests::market_text(K));
  folder_.write("m.mtx", tests::market_text(M));
  folder_.write("rows.txt", tests::label_text(millimetres, {}));
  const fem::Structure back =
      fem::assemble(build_model(scene(matrices_, "", "{length: mm, mass: t, time: s}").bodies.front()));
  EXPECT_LT((back.K - s.K).norm(), 1e-14 * s.K.norm());
  EXPECT_LT((back.M - s.M).norm(), 1e-14 * s.M.norm());
  EXPECT_LT((back.nodes.back() - s.nodes.back()).norm(), 1e-14);
  EXPECT_NEAR(fem::mass_properties(back).mass, fem::mass_properties(s).mass, 1e-13 * fem::mass_properties(s).mass);
  EXPECT_EQ(modes("{length: mm, mass: t, time: s}").rigid, si.rigid);
}

TEST_P(Matrices, StandInTheFullModelTurned) {
  const auto frequencies = [&](const std::string& source) {
    const std::string text = fmt::format(
        "units: SI\nbodies:\n  hub: {{rigid: {{mass: 50, inertia: [9, 9, 9]}}, ports: {{p: {{at: [0, 0, 0], "
        "rotate: {{axis: [1, 2, 3], angle: 40 deg}}}}}}}}\n  b: {{{}, ports: {}, reduction: {{modes: 8}}}}\n"
        "joints: {{j: {{parent: hub.p, child: b.{}, weld: true}}}}\n",
        source, GetParam().ports, GetParam().mesh == "beam_16.msh" ? "root" : "cut");
    const Scene s = read_scene(folder_.write("turned.yaml", text));
    const Network network = build_network(s, plan(s));
    return reduction::solve_modes(fem::assemble(full_model(s, network).model), {.count = 10});
  };
  const reduction::Modes a = frequencies(fe_), b = frequencies(matrices_);
  ASSERT_EQ(a.rigid, 6);
  ASSERT_EQ(b.rigid, 6);
  for (int k = 6; k < 10; ++k) EXPECT_NEAR(std::sqrt(b.lambda[k] / a.lambda[k]), 1.0, 1e-9) << k;
}

INSTANTIATE_TEST_SUITE_P(Bodies, Matrices, testing::Values(beam, plate),
                         [](const auto& info) { return info.index == 0 ? "Beam" : "Plate"; });
