#include "titop/port_model.hpp"

#include <fmt/format.h>

#include <cmath>
#include <numeric>

#include "fem/error.hpp"

namespace tenon::titop {

using Eigen::Index;
using Eigen::MatrixXd;
using fem::Mat6;

namespace {

constexpr double unresolved = 1e-10;  // of D(i, i): a residual mass with fewer than six digits

std::vector<int> six_from(int first) {
  std::vector<int> channels(6);
  std::iota(channels.begin(), channels.end(), first);
  return channels;
}

void extend(std::vector<Channel>& channels, const std::vector<Channel>& more) {
  channels.insert(channels.end(), more.begin(), more.end());
}

// Phi of the child ports stacked; rows of round-off are set to exact zero (translations and rotations apart).
MatrixXd stacked_shapes(const reduction::ReducedBody& body, const std::vector<int>& children) {
  MatrixXd Phi(6 * static_cast<Index>(children.size()), body.n());
  double largest[2] = {0.0, 0.0};
  for (const reduction::BodyPort& port : body.ports)
    for (int half = 0; half < 2; ++half)
      if (body.n() > 0) largest[half] = std::max(largest[half], port.Phi.middleRows<3>(3 * half).cwiseAbs().maxCoeff());
  for (std::size_t k = 0; k < children.size(); ++k)
    for (int i = 0; i < 6; ++i) {
      const auto row = body.ports[static_cast<std::size_t>(children[k])].Phi.row(i);
      const bool content = body.n() > 0 && row.cwiseAbs().maxCoeff() > 1e-14 * largest[i / 3];
      if (content)
        Phi.row(6 * static_cast<Index>(k) + i) = row;
      else
        Phi.row(6 * static_cast<Index>(k) + i).setZero();
    }
  return Phi;
}

// −D + LᵀL, the residual mass that the kept modes leave at P (negative). A diagonal entry with fewer than six digits
// left of the difference is an exact zero with its row and column, so that nobody inverts it; other entries when
// round-off.
Mat6 residual_mass(const reduction::ReducedBody& body) {
  Mat6 residual = -body.D + body.L.transpose() * body.L;
  for (int i = 0; i < 6; ++i)
    for (int j = 0; j < 6; ++j)
      if (std::abs(residual(i, j)) <= 1e-14 * std::sqrt(std::abs(body.D(i, i) * body.D(j, j)))) residual(i, j) = 0.0;
  for (int i = 0; i < 6; ++i)
    if (std::abs(residual(i, i)) <= unresolved * body.D(i, i)) {
      residual.row(i).setZero();
      residual.col(i).setZero();
    }
  return residual;
}

}  // namespace

std::vector<int> PortModel::child_channels(int k) const { return six_from(6 * k); }

std::vector<int> PortModel::parent_channels() const { return six_from(6 * static_cast<int>(children.size())); }

std::vector<Channel> wrench_channels(const std::string& port) {
  return {{port + ".Fx", "N"},   {port + ".Fy", "N"},   {port + ".Fz", "N"},
          {port + ".Tx", "N m"}, {port + ".Ty", "N m"}, {port + ".Tz", "N m"}};
}

std::vector<Channel> acceleration_channels(const std::string& port) {
  return {{port + ".ax", "m/s²"},        {port + ".ay", "m/s²"},        {port + ".az", "m/s²"},
          {port + ".alpha_x", "rad/s²"}, {port + ".alpha_y", "rad/s²"}, {port + ".alpha_z", "rad/s²"}};
}

PortModel port_model(const reduction::ReducedBody& body) {
  std::vector<int> children;
  for (int p = 0; p < static_cast<int>(body.ports.size()); ++p)
    if (p != body.parent) children.push_back(p);
  return port_model(body, children);
}

PortModel port_model(const reduction::ReducedBody& body, const std::vector<int>& children) {
  if (body.kind != reduction::ReducedBody::Kind::cantilever)
    throw ModelError(fmt::format("body '{}' is free-free and has no port model of its own", body.name),
                     "Rebase it to the port it hangs by");
  const Index n = body.n(), c = 6 * static_cast<Index>(children.size());
  const MatrixXd Phi = stacked_shapes(body, children);
  MatrixXd tau(c, 6);
  PortModel model{{}, children, body.parent};
  StateSpace& ss = model.ss;
  for (std::size_t k = 0; k < children.size(); ++k) {
    tau.middleRows<6>(6 * static_cast<Index>(k)) = reduction::tau(body, children[k]);
    const std::string name = body.name + "." + body.ports[static_cast<std::size_t>(children[k])].name;
    extend(ss.inputs, wrench_channels(name));
    extend(ss.outputs, acceleration_channels(name));
  }
  const std::string name =
      body.name + "." + (body.ports.empty() ? "reference" : body.ports[static_cast<std::size_t>(body.parent)].name);
  extend(ss.inputs, acceleration_channels(name));
  extend(ss.outputs, wrench_channels(name));

  const Eigen::VectorXd k = body.omega.cwiseAbs2();
  const MatrixXd damping = reduction::damping(body);
  const MatrixXd coupling = tau - Phi * body.L;
  // η̈ = −diag(ω²) η − C η̇ + Phiᵀ W_C − L ẍ_P, eq (1)
  ss.A = MatrixXd::Zero(2 * n, 2 * n);
  ss.A.topRightCorner(n, n).setIdentity();
  ss.A.bottomLeftCorner(n, n).diagonal() = -k;
  ss.A.bottomRightCorner(n, n) = -damping;
  ss.B = MatrixXd::Zero(2 * n, c + 6);
  ss.B.bottomLeftCorner(n, c) = Phi.transpose();
  ss.B.bottomRightCorner(n, 6) = -body.L;
  // ẍ_C = τ ẍ_P + Phi η̈, eq (2);  W_P = τᵀ W_C − D ẍ_P − Lᵀ η̈, first row of (1)
  ss.C.resize(c + 6, 2 * n);
  ss.C << -Phi * k.asDiagonal(), -Phi * damping,  //
      body.L.transpose() * k.asDiagonal(), body.L.transpose() * damping;
  ss.D.resize(c + 6, c + 6);
  ss.D << Phi * Phi.transpose(), coupling,  //
      coupling.transpose(), residual_mass(body);
  check(ss);
  return model;
}

}  // namespace tenon::titop
