#include "titop/state_space.hpp"

#include <fmt/format.h>

#include <Eigen/LU>
#include <limits>

#include "fem/error.hpp"
#include "titop/equilibrate.hpp"

namespace tenon::titop {

using Eigen::Index;
using Eigen::MatrixXcd;
using Eigen::MatrixXd;

void check(const StateSpace& ss) {
  const auto n = ss.A.rows(), m = ss.D.cols(), p = ss.D.rows();
  const bool fits = ss.A.cols() == n && ss.B.rows() == n && ss.B.cols() == m && ss.C.rows() == p && ss.C.cols() == n &&
                    static_cast<Index>(ss.inputs.size()) == m && static_cast<Index>(ss.outputs.size()) == p;
  if (!fits)
    throw ModelError(
        fmt::format("state space of order {} with {} inputs and {} outputs has matrices of other sizes", n, m, p),
        "Give A n×n, B n×m, C p×n, D p×m and a name for every channel");
}

MatrixXcd response(const StateSpace& ss, double omega) {
  check(ss);
  MatrixXcd G = ss.D.cast<std::complex<double>>();
  if (ss.order() == 0 || ss.D.size() == 0) return G;
  MatrixXcd Z = -ss.A.cast<std::complex<double>>();
  Z.diagonal().array() += std::complex<double>(0.0, omega);
  const Eigen::PartialPivLU<MatrixXcd> lu(Z);
  if (!(lu.matrixLU().diagonal().cwiseAbs().minCoeff() > 0.0))
    throw NumericalError(fmt::format("the response at {} rad/s does not exist, it is a pole of the system", omega), 0.0,
                         "Ask beside the pole, or give the system damping");
  G.noalias() += ss.C * lu.solve(ss.B.cast<std::complex<double>>());
  return G;
}

StateSpace subsystem(const StateSpace& ss, const std::vector<int>& outputs, const std::vector<int>& inputs) {
  StateSpace part{ss.A, ss.B(Eigen::all, inputs), ss.C(outputs, Eigen::all), ss.D(outputs, inputs), {}, {}};
  for (const int j : inputs) part.inputs.push_back(ss.inputs[static_cast<std::size_t>(j)]);
  for (const int i : outputs) part.outputs.push_back(ss.outputs[static_cast<std::size_t>(i)]);
  return part;
}

StateSpace append(const std::vector<StateSpace>& systems) {
  Index n = 0, m = 0, p = 0;
  for (const StateSpace& s : systems) n += s.A.rows(), m += s.D.cols(), p += s.D.rows();
  StateSpace all{MatrixXd::Zero(n, n), MatrixXd::Zero(n, m), MatrixXd::Zero(p, n), MatrixXd::Zero(p, m), {}, {}};
  n = m = p = 0;
  for (const StateSpace& s : systems) {
    all.A.block(n, n, s.A.rows(), s.A.cols()) = s.A;
    all.B.block(n, m, s.B.rows(), s.B.cols()) = s.B;
    all.C.block(p, n, s.C.rows(), s.C.cols()) = s.C;
    all.D.block(p, m, s.D.rows(), s.D.cols()) = s.D;
    all.inputs.insert(all.inputs.end(), s.inputs.begin(), s.inputs.end());
    all.outputs.insert(all.outputs.end(), s.outputs.begin(), s.outputs.end());
    n += s.A.rows(), m += s.D.cols(), p += s.D.rows();
  }
  return all;
}

// y = C x + D u and u = F y + E v give W y = C x + D E v with W = 1 − D F. W is solved as
// W⁻¹ = diag(cols) (diag(rows) W diag(cols))⁻¹ diag(rows), so that units do not decide the pivots.
Connection connect(const StateSpace& ss, const Wiring& wiring, double limit) {
  const auto& [F, E, H, J, inputs, outputs] = wiring;
  const Index p = ss.D.rows(), n = ss.A.rows(), v = E.cols();
  MatrixXd right(p, n + v);
  right << ss.C, ss.D * E;
  Connection connection;
  const Equilibrated W = equilibrate(MatrixXd::Identity(p, p) - ss.D * F);
  if (p > 0) {
    const Eigen::PartialPivLU<MatrixXd> lu(W.A);
    const double rcond = lu.rcond();
    connection.condition = rcond > 0.0 ? 1.0 / rcond : std::numeric_limits<double>::infinity();
    if (!(connection.condition <= limit))
      throw NumericalError("the feedback between the port models has no solution: 1 − D F is singular, condition",
                           connection.condition,
                           "Give the ports of the loop inertia or static modes, or use the second-order route");
    right = W.cols.asDiagonal() * lu.solve(W.rows.asDiagonal() * right);
  }
  const auto Yx = right.leftCols(n), Yv = right.rightCols(v);  // y = Yx x + Yv v
  connection.ss = {ss.A + ss.B * (F * Yx), ss.B * (F * Yv + E), H * Yx, H * Yv + J, inputs, outputs};
  check(connection.ss);
  return connection;
}

StateSpace feedback(const StateSpace& ss, const MatrixXd& F) {
  const Index m = ss.D.cols(), p = ss.D.rows();
  return connect(ss,
                 {F, MatrixXd::Identity(m, m), MatrixXd::Identity(p, p), MatrixXd::Zero(p, m), ss.inputs, ss.outputs})
      .ss;
}

StateSpace gains(const MatrixXd& Ly, const StateSpace& ss, const MatrixXd& Ru, std::vector<Channel> outputs,
                 std::vector<Channel> inputs) {
  StateSpace scaled{ss.A, ss.B * Ru, Ly * ss.C, Ly * ss.D * Ru, std::move(inputs), std::move(outputs)};
  check(scaled);
  return scaled;
}

}  // namespace tenon::titop
