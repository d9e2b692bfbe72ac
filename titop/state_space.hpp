#pragma once

#include <Eigen/Core>
#include <complex>
#include <string>
#include <vector>

namespace tenon::titop {

/// A named scalar input or output with its SI unit, e.g. {"panel.root.Tz", "N m"}.
struct Channel {
  std::string name;
  std::string unit;
};

/// ẋ = A x + B u, y = C x + D u.
struct StateSpace {
  Eigen::MatrixXd A, B, C, D;
  std::vector<Channel> inputs, outputs;

  int order() const { return static_cast<int>(A.rows()); }
};

/// Sizes of A, B, C, D and names agree; throws ModelError.
void check(const StateSpace& ss);

/// G(jω) = D + C (jω − A)⁻¹ B.
Eigen::MatrixXcd response(const StateSpace& ss, double omega);

/// The rows `outputs` and columns `inputs` of a system.
StateSpace subsystem(const StateSpace& ss, const std::vector<int>& outputs, const std::vector<int>& inputs);

/// Block-diagonal union of systems.
StateSpace append(const std::vector<StateSpace>& systems);

/// Closes u = F y + v: inputs stay (v), outputs stay (y). Throws NumericalError when 1 − F D is singular to working
/// precision (after equilibration).
StateSpace feedback(const StateSpace& ss, const Eigen::MatrixXd& F);

/// Applies constant gains: y' = Ly y, u = Ru u'.
StateSpace gains(const Eigen::MatrixXd& Ly, const StateSpace& ss, const Eigen::MatrixXd& Ru,
                 std::vector<Channel> outputs, std::vector<Channel> inputs);

/// Channel inversion, eqs (27)–(28) of the TITOP paper as one block: the inputs and outputs of the channels in `I` swap
/// roles.
struct Inversion {
  StateSpace ss;
  double condition = 1.0;  ///< of the equilibrated D(I, I)
};

/// Throws NumericalError (naming the channels and what to do) when the equilibrated D(I, I) has a condition above
/// `limit`.
Inversion invert_channels(const StateSpace& ss, const std::vector<int>& I, double limit = 1e14);

}  // namespace tenon::titop
