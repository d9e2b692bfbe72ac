#include "titop/constrain.hpp"

#include <Eigen/SVD>
#include <cmath>

namespace tenon::titop {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;
using reduction::ReducedBody;

namespace {

// The directions of a boundary, port by port, and the names of what goes in and out there.
struct Directions {
  std::vector<int> free, fixed;  // 6 port + direction
  std::vector<double> sign;      // of a wrench, per port: applied to the body +1, by it −1
  std::vector<Channel> wrenches, positions, accelerations, reactions;
};

Directions directions(const ReducedBody& body, const Boundary& boundary) {
  Directions d;
  for (int p = 0; p < static_cast<int>(body.ports.size()); ++p) {
    const std::string name = body.name + "." + body.ports[static_cast<std::size_t>(p)].name;
    const auto wrench = wrench_channels(name), acceleration = acceleration_channels(name),
               position = position_channels(name);
    d.sign.push_back(p == body.parent ? -1.0 : 1.0);
    for (std::size_t i = 0; i < 6; ++i) {
      const int row = 6 * p + static_cast<int>(i);
      if (boundary.ports[static_cast<std::size_t>(p)].fixed[i]) {
        d.fixed.push_back(row);
        d.reactions.push_back(wrench[i]);
      } else {
        d.free.push_back(row);
        d.wrenches.push_back(wrench[i]);
        d.positions.push_back(position[i]);
        d.accelerations.push_back(acceleration[i]);
      }
    }
  }
  return d;
}

std::vector<Channel> outputs_of(const Directions& d) {
  std::vector<Channel> all = d.positions;
  all.insert(all.end(), d.accelerations.begin(), d.accelerations.end());
  all.insert(all.end(), d.reactions.begin(), d.reactions.end());
  return all;
}

// Columns [τᵀ; Φᵀ] of the wrenches at the given directions, the right side of eq (1).
MatrixXd wrench_columns(const ReducedBody& body, const Directions& d, const std::vector<int>& rows) {
  MatrixXd B(6 + body.n(), static_cast<Index>(rows.size()));
  for (std::size_t k = 0; k < rows.size(); ++k) {
    const int p = rows[k] / 6, i = rows[k] % 6;
    const auto port = static_cast<std::size_t>(p);
    const auto column = static_cast<Index>(k);
    B.col(column).head<6>() = d.sign[port] * reduction::tau(body, p).row(i).transpose();
    B.col(column).tail(body.n()) = d.sign[port] * body.ports[port].Phi.row(i).transpose();
  }
  return B;
}

// λ of least norm with Gᵀλ = f: rows and columns in comparable units first.
MatrixXd reactions(const ReducedBody& body, const std::vector<int>& fixed, MatrixXd Gt, MatrixXd f) {
  const double a = size_of(body), m = body.D(0, 0) > 0.0 ? body.D(0, 0) : 1.0;
  VectorXd rows = VectorXd::Constant(Gt.rows(), std::sqrt(m) * a), columns(Gt.cols());
  rows.head<6>() << a, a, a, 1.0, 1.0, 1.0;
  for (Index k = 0; k < Gt.cols(); ++k) columns[k] = fixed[static_cast<std::size_t>(k)] % 6 < 3 ? 1.0 / a : 1.0;
  Gt = rows.asDiagonal() * Gt * columns.asDiagonal();
  Eigen::JacobiSVD<MatrixXd> svd(Gt, Eigen::ComputeThinU | Eigen::ComputeThinV);
  svd.setThreshold(1e-10);
  return columns.asDiagonal() * svd.solve(rows.asDiagonal() * f);
}

}  // namespace

std::vector<Channel> position_channels(const std::string& port) {
  return {{port + ".ux", "m"},   {port + ".uy", "m"},   {port + ".uz", "m"},
          {port + ".rx", "rad"}, {port + ".ry", "rad"}, {port + ".rz", "rad"}};
}

ConstrainedModel constrain(const ReducedBody& body, const Boundary& boundary) {
  const ConstrainedModes modes = constrained_modes(body, boundary);
  const Directions d = directions(body, boundary);
  const Index k = modes.omega.size(), g = modes.rigid.cols(), z = k + g, n = body.n();
  const auto in = static_cast<Index>(d.free.size()), held = static_cast<Index>(d.fixed.size());
  MatrixXd T(6 + n, z);  // (x_ref, η) of the coordinates (ζ, ρ)
  T << modes.reference, modes.rigid, modes.eta, MatrixXd::Zero(n, g);
  const MatrixXd B_free = wrench_columns(body, d, d.free), damping = reduction::damping(body);

  ConstrainedModel model{{}, static_cast<int>(g), 2 * modes.removed, 1.0};
  StateSpace& ss = model.ss;
  ss.A = MatrixXd::Zero(2 * z, 2 * z);
  ss.A.topRightCorner(z, z).setIdentity();
  ss.A.block(z, 0, k, k).diagonal() = -modes.omega.cwiseAbs2();
  ss.A.block(z, z, k, k) = -modes.eta.transpose() * damping * modes.eta;
  ss.B = MatrixXd::Zero(2 * z, in);
  ss.B.bottomRows(z) = T.transpose() * B_free;

  const MatrixXd motion = port_motions(body, T.topRows(6), T.bottomRows(n))(d.free, Eigen::all);
  const MatrixXd A_z = ss.A.bottomRows(z), B_z = ss.B.bottomRows(z);  // z̈ = A_z x + B_z u
  ss.C = MatrixXd::Zero(2 * in + held, 2 * z);
  ss.D = MatrixXd::Zero(2 * in + held, in);
  ss.C.topLeftCorner(in, z) = motion;
  ss.C.middleRows(in, in) = motion * A_z;
  ss.D.middleRows(in, in) = motion * B_z;
  if (held > 0) {  // Gᵀλ = M q̈ + C q̇ + K q − B u, eq (1)
    MatrixXd M(6 + n, 6 + n);
    M << body.D, body.L.transpose(), body.L, MatrixXd::Identity(n, n);
    const MatrixXd MT = M * T;
    MatrixXd f(6 + n, 2 * z + in);
    f << MT * A_z, MT * B_z - B_free;
    f.block(6, 0, n, k) += body.omega.cwiseAbs2().asDiagonal() * modes.eta;
    f.block(6, z, n, k) += damping * modes.eta;
    const MatrixXd lambda = reactions(body, d.fixed, wrench_columns(body, d, d.fixed), f);
    ss.C.bottomRows(held) = lambda.leftCols(2 * z);
    ss.D.bottomRows(held) = lambda.rightCols(in);
  }
  ss.inputs = d.wrenches;
  ss.outputs = outputs_of(d);
  check(ss);
  return model;
}

namespace {

// Channel of a direction 6 port + i in a port model of all ports.
int channel_of(const PortModel& model, int row) {
  if (row / 6 == model.parent) return model.parent_channels()[static_cast<std::size_t>(row % 6)];
  for (std::size_t k = 0; k < model.children.size(); ++k)
    if (model.children[k] == row / 6) return 6 * static_cast<int>(k) + row % 6;
  return -1;
}

std::vector<int> channels_of(const PortModel& model, const std::vector<int>& rows) {
  std::vector<int> channels;
  for (const int row : rows) channels.push_back(channel_of(model, row));
  return channels;
}

// Without the fixed child channels that move with fixed directions of the parent port only: nothing to invert there,
// their wrench stays zero.
std::vector<int> without_rigid(const PortModel& model, const Boundary& boundary, std::vector<int> I) {
  const std::vector<int> parent = model.parent_channels();
  const auto& fixed = boundary.ports[static_cast<std::size_t>(model.parent)].fixed;
  const auto idle = [&](int channel) {
    if (channel >= parent.front() || !model.ss.B.col(channel).isZero(0.0)) return false;
    for (std::size_t i = 0; i < 6; ++i)
      if (!fixed[i] && model.ss.D(channel, parent[i]) != 0.0) return false;
    return true;
  };
  I.erase(std::remove_if(I.begin(), I.end(), idle), I.end());
  return I;
}

}  // namespace

// After inversion Zᵀ Φ_F η̈ is prescribed, so with zero inputs the states [N ξ; N ξ̇] are invariant: A_ξ = NᵀAN block by
// block. The coordinates ρ of the rigid motions carry all momentum, so ρ̈ = Rᵀ Σ τᵀ W: exact double integrators.
ConstrainedModel constrain_by_inversion(const ReducedBody& body, const Boundary& boundary, double limit) {
  const PortModel port = port_model(body);
  const ConstraintBasis basis = constraint_basis(body, boundary);
  const Directions d = directions(body, boundary);
  const Inversion inverse =
      invert_channels(port.ss, without_rigid(port, boundary, inverted_channels(port, boundary)), limit);
  const Index n = body.n(), k = basis.N.cols(), g = basis.R.cols();
  const auto in = static_cast<Index>(d.free.size()), held = static_cast<Index>(d.fixed.size());
  const std::vector<int> free = channels_of(port, d.free), fixed = channels_of(port, d.fixed);

  MatrixXd N2 = MatrixXd::Zero(2 * n, 2 * k);
  N2.topLeftCorner(n, k) = basis.N;
  N2.bottomRightCorner(n, k) = basis.N;
  const MatrixXd C_xi = inverse.ss.C * N2;
  ConstrainedModel model{{}, static_cast<int>(g), 2 * basis.removed, inverse.condition};
  StateSpace& ss = model.ss;
  ss.A = MatrixXd::Zero(2 * (k + g), 2 * (k + g));
  ss.A.topLeftCorner(2 * k, 2 * k) = N2.transpose() * inverse.ss.A * N2;
  ss.A.block(2 * k, 2 * k + g, g, g).setIdentity();
  ss.B = MatrixXd::Zero(2 * (k + g), in);
  ss.B.topRows(2 * k) = N2.transpose() * inverse.ss.B(Eigen::all, free);
  ss.B.bottomRows(g) = basis.R.transpose() * wrench_columns(body, d, d.free).topRows(6);
  ss.C = MatrixXd::Zero(2 * in + held, 2 * (k + g));
  ss.D = MatrixXd::Zero(2 * in + held, in);
  ss.C.topLeftCorner(in, k) = port_motions(body, basis.X, basis.N)(d.free, Eigen::all);
  ss.C.block(0, 2 * k, in, g) = port_motions(body, basis.R, MatrixXd::Zero(n, g))(d.free, Eigen::all);
  ss.C.block(in, 0, in, 2 * k) = C_xi(free, Eigen::all);
  ss.C.block(2 * in, 0, held, 2 * k) = C_xi(fixed, Eigen::all);
  ss.D.middleRows(in, in) = inverse.ss.D(free, free);
  ss.D.bottomRows(held) = inverse.ss.D(fixed, free);
  ss.inputs = d.wrenches;
  ss.outputs = outputs_of(d);
  check(ss);
  return model;
}

}  // namespace tenon::titop
