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

/// G(jω) = D + C (jω − A)⁻¹ B. Throws NumericalError when jω is a pole to working precision.
Eigen::MatrixXcd response(const StateSpace& ss, double omega);

/// The rows `outputs` and columns `inputs` of a system, G_{I,J}(s) of the TITOP paper, appendix 1.
StateSpace subsystem(const StateSpace& ss, const std::vector<int>& outputs, const std::vector<int>& inputs);

/// Block-diagonal union of systems.
StateSpace append(const std::vector<StateSpace>& systems);

/// A system and the worst condition number met on the way to it.
struct Connection {
  StateSpace ss;
  double condition = 1.0;  ///< of the equilibrated loop matrix 1 − D F
};

/// The wiring u = F y + E v, z = H y + J v around a system y = G u: the system from v to z.
struct Wiring {
  Eigen::MatrixXd F;  ///< inputs×outputs of the system
  Eigen::MatrixXd E;  ///< inputs×new inputs
  Eigen::MatrixXd H;  ///< new outputs×outputs
  Eigen::MatrixXd J;  ///< new outputs×new inputs
  std::vector<Channel> inputs, outputs;
};

/// Closes a wiring. Throws NumericalError when the equilibrated 1 − D F has a condition above `limit`: the loop then
/// has no residual inertia that determines its algebraic part.
Connection connect(const StateSpace& ss, const Wiring& wiring, double limit = 1e14);

/// Closes u = F y + v: inputs stay (v), outputs stay (y). Throws NumericalError when 1 − D F is singular to working
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

/// Inverts the channels `I` (0-based, each once); the system may have further inputs or outputs. D(I, I) is the
/// residual mobility or mass of the channels: where it is zero (a direction without modal content) or the equilibrated
/// block has a condition above `limit`, NumericalError names the channels and the cure: keep the static modes of the
/// port, add an inertia, or use the second-order route.
Inversion invert_channels(const StateSpace& ss, const std::vector<int>& I, double limit = 1e14);

}  // namespace tenon::titop
