// SDLS106: a simply supported plate cut in two parts, each reduced by Craig-Bampton on the cut, rejoined, against the
// uncut plate.
#include <gtest/gtest.h>
#include <unistd.h>

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <numbers>

#include "assembly/build.hpp"
#include "assembly/scene.hpp"
#include "fem/structure.hpp"
#include "reduction/modes.hpp"
#include "reduction/subspace.hpp"
#include "tests/reference/values.hpp"

using namespace tenon;

namespace {

const std::filesystem::path data = std::filesystem::path(TENON_SOURCE_DIR) / "data" / "reference";
constexpr double cut_at = 0.75;

/// The committed scene of the whole plate, with another mesh and without the edge that the part does not have.
fem::Structure structure_of(const std::string& mesh, const std::string& missing_edge) {
  std::ifstream file(data / "sdls106.yaml");
  std::string text((std::istreambuf_iterator<char>(file)), {});
  const auto replace = [&text](const std::string& from, const std::string& to) {
    text.replace(text.find(from), from.size(), to);
  };
  replace("sdls106.msh", (data / mesh).string());
  if (!missing_edge.empty()) replace(missing_edge + ": [z, rx], ", "");
  const std::filesystem::path path =
      std::filesystem::temp_directory_path() / ("tenon_cut_" + std::to_string(::getpid()) + ".yaml");
  std::ofstream(path) << text;
  const assembly::Scene scene = assembly::read_scene(path);
  std::filesystem::remove(path);
  fem::Model model = assembly::build_model(scene.bodies.front());
  model.ports.clear();
  return fem::assemble(model);
}

/// One part by classical Craig-Bampton: its mass and stiffness over (cut dofs from y = 0 to y = 1.5, fixed-interface
/// modes).
struct Part {
  Eigen::MatrixXd M, K;
  Eigen::Index cut = 0;
};

Part reduced(const std::string& mesh, const std::string& missing_edge, int modes) {
  const fem::Structure s = structure_of(mesh, missing_edge);
  reduction::Partition parts;
  for (int i = 0; i < s.n(); ++i) {
    const fem::Dof& dof = s.dofs.free[static_cast<std::size_t>(i)];
    const bool on_cut = std::abs(s.nodes[static_cast<std::size_t>(dof.node)].x() - cut_at) < 1e-9;
    (on_cut ? parts.children : parts.interior).push_back(i);
  }
  std::ranges::sort(parts.children, {}, [&](int row) {
    const fem::Dof& dof = s.dofs.free[static_cast<std::size_t>(row)];
    return std::pair(s.nodes[static_cast<std::size_t>(dof.node)].y(), dof.direction);
  });
  const reduction::Subspace space =
      reduction::component_modes(s, parts, {Eigen::MatrixXd(s.n(), 0), {}}, {.count = modes});
  return {space.T.transpose() * (s.M.selfadjointView<Eigen::Lower>() * space.T),
          space.T.transpose() * (s.K.selfadjointView<Eigen::Lower>() * space.T),
          static_cast<Eigen::Index>(parts.children.size())};
}

Eigen::VectorXd rejoined(int modes, int count) {
  const Part a = reduced("sdls106_1.msh", "x1", modes), b = reduced("sdls106_2.msh", "x0", modes);
  EXPECT_EQ(a.cut, b.cut);
  const Eigen::Index na = a.M.rows() - a.cut, nb = b.M.rows() - b.cut, n = a.cut + na + nb;
  Eigen::MatrixXd M = Eigen::MatrixXd::Zero(n, n), K = M;
  const auto add = [&](const Part& part, Eigen::Index modal_at, Eigen::Index modal) {
    Eigen::MatrixXd J = Eigen::MatrixXd::Zero(part.M.rows(), n);
    J.topLeftCorner(part.cut, part.cut).setIdentity();
    J.block(part.cut, modal_at, modal, modal).setIdentity();
    M += J.transpose() * part.M * J;
    K += J.transpose() * part.K * J;
  };
  add(a, a.cut, na);
  add(b, a.cut + na, nb);
  // M x = μ K x: massless rotations do no harm, the lowest modes have the largest μ
  const Eigen::GeneralizedSelfAdjointEigenSolver<Eigen::MatrixXd> eigen(M, K);
  return eigen.eigenvalues().reverse().head(count).cwiseInverse();
}

}  // namespace

TEST(CutPlate, RejoinedPartsEqualTheUncutPlate) {
  const reduction::Modes whole = reduction::solve_modes(structure_of("sdls106.msh", ""), {.count = 5});
  const Eigen::VectorXd joined = rejoined(250, 5);
  for (int i = 0; i < 5; ++i) {
    EXPECT_NEAR(std::sqrt(joined(i) / whole.lambda(i)), 1.0, 1e-6) << "mode " << i + 1;
    const double hertz = std::sqrt(whole.lambda(i)) / (2.0 * std::numbers::pi);
    EXPECT_NEAR(hertz, reference::sdls106[static_cast<std::size_t>(i)],
                5e-3 * reference::sdls106[static_cast<std::size_t>(i)]);
  }
}

/// A Ritz method: fewer modes can only raise the frequencies.
TEST(CutPlate, FewerModesAreNeverBelow) {
  const Eigen::VectorXd few = rejoined(5, 5), many = rejoined(250, 5);
  for (int i = 0; i < 5; ++i) EXPECT_GE(few(i), many(i) * (1.0 - 1e-9));
  EXPECT_GT(few(4), many(4) * (1.0 + 1e-7));
}
