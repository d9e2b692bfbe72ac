#include "assembly/recursion/lowest_modes.hpp"

#include <Spectra/SymEigsSolver.h>
#include <fmt/format.h>

#include <algorithm>

#include "fem/error.hpp"

namespace tenon::assembly {

using Eigen::Index;
using Eigen::VectorXd;

namespace {

// √K on the diagonal: modes and hinge springs
VectorXd stiffness_root(const Multibody& system) {
  VectorXd root(system.nv);
  for (std::size_t k = 0; k < system.bodies.size(); ++k) {
    const HingedBody& b = system.bodies[k];
    const Index first = system.v_offset[k], n = b.modes(), r = b.dofs();
    root.segment(first, n) = b.body->omega;
    root.segment(first + n, r) = b.stiffness.cwiseSqrt();
    if (r > 0 && !(b.stiffness.minCoeff() > 0.0))
      throw ModelError(
          fmt::format("the {} hinge of body '{}' has no spring, so that the system moves freely", name(b.kind), b.name),
          "Give every hinge a stiffness, or linearise the system as a whole");
  }
  return root;
}

// y = K^-½ 𝓜 K^-½ x
struct Operator {
  using Scalar = double;
  const Multibody& system;
  Sweeps& sweeps;
  const VectorXd& root;
  mutable VectorXd x, y;

  Index rows() const { return system.nv; }
  Index cols() const { return system.nv; }
  void perform_op(const double* in, double* out) const {
    x = Eigen::Map<const VectorXd>(in, system.nv).cwiseQuotient(root);
    inverse_dynamics(system, sweeps, x, y);
    Eigen::Map<VectorXd>(out, system.nv) = y.cwiseQuotient(root);
  }
};

}  // namespace

LowestModes lowest_modes(const Multibody& system, int count) {
  if (!system.closures.empty())
    throw ModelError("the recursion for the lowest modes needs a tree, but the system has loops",
                     "Linearise the system as a whole");
  if (count < 1 || system.nv < 2)
    throw ModelError(fmt::format("{} lowest modes are asked of {} coordinates, where Lanczos finds one to all but one",
                                 count, system.nv),
                     "Ask for one mode or more; linearise a system of one coordinate as a whole");
  Multibody still = system;
  still.gravity.setZero();
  const VectorXd root = stiffness_root(still);
  Sweeps sweeps = make_sweeps(still);
  const MotionState rest = rest_state(still);
  set_state(still, rest.q, rest.v, sweeps);
  Operator op{still, sweeps, root, {}, VectorXd(system.nv)};
  const Index wanted = std::min<Index>(count, system.nv - 1);
  Spectra::SymEigsSolver<Operator> solver(op, wanted, std::min<Index>(system.nv, 4 * wanted + 20));
  solver.init();
  constexpr int most_restarts = 1000;
  constexpr double tolerance = 1e-14;
  if (solver.compute(Spectra::SortRule::LargestAlge, most_restarts, tolerance) < wanted)
    throw NumericalError("the lowest modes did not converge after restarts", most_restarts, "Ask for fewer modes");
  LowestModes modes;
  modes.omega = solver.eigenvalues().cwiseSqrt().cwiseInverse();
  modes.shapes = root.cwiseInverse().asDiagonal() * solver.eigenvectors();
  for (Index j = 0; j < wanted; ++j) modes.shapes.col(j) *= modes.omega[j];  // xᵀ𝓜x = 1/ω² before
  return modes;
}

}  // namespace tenon::assembly
