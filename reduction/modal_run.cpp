#include "reduction/modal_run.hpp"

#include <fmt/format.h>

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

#include "fem/error.hpp"
#include "reduction/partition.hpp"

namespace tenon::reduction {
namespace {

constexpr double worst = 1e-2;  // of orthonormality, links and parent: beyond it the shapes are of another model

/// Printed shapes on the rows of K and M, zero at the clamped nodes.
Eigen::MatrixXd on_rows(const fem::Structure& s, const std::vector<int>& clamped, const fem::ModalRun& run) {
  Eigen::MatrixXd Phi = Eigen::MatrixXd::Zero(s.n(), static_cast<Eigen::Index>(run.shapes.size()));
  const Eigen::VectorXd weight = s.M.diagonal();
  for (int row = 0; row < s.n(); ++row) {
    const fem::Dof dof = s.dofs.free[static_cast<std::size_t>(row)];
    if (std::ranges::find(clamped, dof.node) != clamped.end()) continue;
    const long id = s.node_ids[static_cast<std::size_t>(dof.node)];
    for (const auto& [mode, shape] : run.shapes) {
      const auto found = shape.find(id);
      if (found != shape.end())
        Phi(row, mode - 1) = found->second[dof.direction];
      else if (weight[row] > 0.0)
        throw ModelError(fmt::format("node {} has mass, but eigenvector {} does not show it", id, mode),
                         "Print all grids: VECTOR = ALL in the case control");
    }
  }
  return Phi;
}

/// Printed motion of every node against T Φ: the clamp is where the run had it, and links are the deck's.
void check_motion(const fem::Structure& s, const std::vector<int>& clamped, const fem::ModalRun& run,
                  const Eigen::MatrixXd& Phi) {
  const Eigen::MatrixXd full = s.dofs.expand(Phi);
  for (const auto& [mode, shape] : run.shapes) {
    Eigen::Vector2d largest = Eigen::Vector2d::Zero();  // translation, rotation
    for (const auto& [id, u] : shape)
      largest = largest.cwiseMax(Eigen::Vector2d(u.head<3>().cwiseAbs().maxCoeff(), u.tail<3>().cwiseAbs().maxCoeff()));
    for (std::size_t node = 0; node < s.nodes.size(); ++node) {
      const auto found = shape.find(s.node_ids[node]);
      const bool clamp = std::ranges::find(clamped, static_cast<int>(node)) != clamped.end();
      if (clamp && found == shape.end())
        throw ModelError(fmt::format("eigenvector {} does not show node {}, which is clamped", mode, s.node_ids[node]),
                         "Print all grids: VECTOR = ALL in the case control");
      if (found == shape.end()) continue;
      for (int k = 0; k < 6; ++k) {
        const std::size_t dof = 6 * node + static_cast<std::size_t>(k);
        if (!clamp && s.dofs.start[dof] == s.dofs.start[dof + 1]) continue;  // nothing holds it, or nothing moves it
        const double gap = found->second[k] - full(static_cast<Eigen::Index>(dof), mode - 1);
        if (std::abs(gap) > worst * largest[k / 3])
          throw ModelError(
              fmt::format("mode {} moves node {} {} by {:.3g}, where {} says {:.3g}", mode, s.node_ids[node],
                          directions[static_cast<std::size_t>(k)], found->second[k],
                          clamp ? "the clamp" : "the deck's links", full(static_cast<Eigen::Index>(dof), mode - 1)),
              "Deck and .f06 must be of one run, clamped where the deck says");
      }
    }
  }
}

/// Φ (ΦᵀMΦ)^-½; `gap` becomes the largest entry of m^-½ ΦᵀMΦ m^-½ − 1.
Eigen::MatrixXd orthonormal(const fem::Structure& s, const fem::ModalRun& run, const Eigen::MatrixXd& Phi,
                            double& gap) {
  Eigen::MatrixXd unit = Phi;
  for (Eigen::Index j = 0; j < Phi.cols(); ++j) unit.col(j) /= std::sqrt(run.modes.at(j + 1).generalized_mass);
  const Eigen::MatrixXd gram = unit.transpose() * (s.M.selfadjointView<Eigen::Lower>() * unit);
  gap = (gram - Eigen::MatrixXd::Identity(gram.rows(), gram.cols())).cwiseAbs().maxCoeff();
  if (!(gap <= worst))
    throw NumericalError("the printed modes are not orthonormal in the deck's mass matrix", gap,
                         "Deck and .f06 must be of one run, in one system of units, with all their digits");
  return unit * Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(gram).operatorInverseSqrt();
}

}  // namespace

ReducedBody modal_body(const fem::Structure& s, const std::string& parent, const fem::ModalRun& run,
                       const std::vector<int>& beside) {
  const Partition parts = partition(s, parent, true);
  const int clamp = s.ports[static_cast<std::size_t>(parts.parent)].node;
  std::vector<int> clamped{clamp};
  clamped.insert(clamped.end(), beside.begin(), beside.end());
  const Eigen::MatrixXd printed = on_rows(s, clamped, run);
  check_motion(s, clamped, run, printed);

  ReducedBody body;
  Certificate& c = body.certificate;
  const Eigen::MatrixXd Phi = orthonormal(s, run, printed, c.max_orthogonality);
  const Eigen::Index n = Phi.cols();
  body.reference = s.nodes[static_cast<std::size_t>(clamp)];
  body.omega.resize(n);
  for (Eigen::Index j = 0; j < n; ++j) body.omega[j] = std::sqrt(run.modes.at(j + 1).lambda);
  for (Eigen::Index j = 1; j < n; ++j)
    if (body.omega[j] < body.omega[j - 1])
      throw ModelError(fmt::format("eigenvalue {} of the run is below the one before", j + 1), "Print modes ascending");
  body.zeta = Eigen::VectorXd::Zero(n);

  const Eigen::MatrixXd R = fem::rigid_motions(s, body.reference);
  const Eigen::MatrixXd MR = s.M.selfadjointView<Eigen::Lower>() * R;
  body.L = Phi.transpose() * MR;  // eq (1)
  body.D = R.transpose() * MR;
  body.D = (0.5 * (body.D + body.D.transpose())).eval();
  const auto add_port = [&](const fem::Port& port) {
    body.ports.push_back(
        {port.name, s.nodes[static_cast<std::size_t>(port.node)], port.axes, s.dofs.expand_node(port.node, Phi)});
  };
  add_port(s.ports[static_cast<std::size_t>(parts.parent)]);
  for (std::size_t p = 0; p < s.ports.size(); ++p)
    if (static_cast<int>(p) != parts.parent) add_port(s.ports[p]);
  body.node_positions = s.nodes;
  body.node_shapes = s.dofs.expand(Phi);

  c.basis = fmt::format("clamped-free, {} modes of another program", n);
  c.modes_found = static_cast<int>(n);
  if (const auto next = run.modes.find(n + 1); next != run.modes.end()) c.valid_below = std::sqrt(next->second.lambda);
  c.left_out.push_back(fmt::format(
      "digits beyond the {} that the .f06 prints: a shape's numbers are known to {:.0e} of the largest digit's place, "
      "frequencies to {:.0e}; the printed modes are orthonormal in the deck's mass to {:.1e}",
      run.digits, 0.5 * std::pow(10.0, 1 - run.digits), 0.25 * std::pow(10.0, 1 - run.digits), c.max_orthogonality));
  if (!beside.empty())
    c.left_out.push_back(
        fmt::format("how the {} clamped nodes move against each other: they are one rigid piece", clamped.size()));
  c.left_out.emplace_back("modes that the run did not print, and static shapes of the ports");
  c.left_out.emplace_back("residuals and count of the modes: no K of the other program is at hand");
  check(body);
  return body;
}

}  // namespace tenon::reduction
