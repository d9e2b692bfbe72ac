#pragma once

#include "assembly/recursion/sweeps.hpp"

/// Closed loops: rows J χ̇ + γ = 0 on the tree, their multipliers by Λ⁻¹ = J 𝓜⁻¹ Jᵀ, and projection on the constraints.
/// NUMERICS 4e; section 9 of the spatial-operator paper.
namespace tenon::assembly {

/// Rows of all closures at a state, translations in m, rotations times the system's size in m. Sized once by
/// make_closure_rows(); closure_rows() allocates nothing.
struct ClosureRows {
  Eigen::VectorXd gap;    ///< m: what is missing in position
  Eigen::VectorXd rate;   ///< m: J χ
  Eigen::VectorXd gamma;  ///< m: J̇ χ
  Eigen::MatrixXd J_t;    ///< nv×m: Jᵀ
  Mat6X on_outer;         ///< 6×m: wrench of a unit multiplier on the outer port, world axes; the inner feels −it
  double length = 1.0;    ///< that weighs rotations [m]
  std::vector<Mat6X> shapes;  ///< scratch: shapes at the ports
  int rows() const { return static_cast<int>(gap.size()); }
};

ClosureRows make_closure_rows(const Multibody& system);

/// After set_state() for the same q and v.
void closure_rows(const Multibody& system, const Sweeps& sweeps, const Eigen::VectorXd& q, const Eigen::VectorXd& v,
                  ClosureRows& rows);

/// Λ⁻¹ = J 𝓜⁻¹ Jᵀ with its redundant directions set apart.
struct ClosureInertia {
  Eigen::MatrixXd X;          ///< nv×m: 𝓜⁻¹ Jᵀ
  Eigen::VectorXd scale;      ///< m: of the rows, so that Λ⁻¹ has a unit diagonal
  Eigen::MatrixXd Q;          ///< m×rank: eigenvectors of the scaled Λ⁻¹ that count
  Eigen::VectorXd inverse;    ///< rank: 1/eigenvalue
  Eigen::MatrixXd redundant;  ///< m×(m − rank): directions in which multipliers are indeterminate
};

/// After articulate() and closure_rows(). Throws NumericalError when no gap tells redundant rows from others.
ClosureInertia closure_inertia(const Multibody& system, Sweeps& sweeps, const ClosureRows& rows);

/// λ of least norm such that J (χ̇_f + X λ) + γ = 0, and χ̇ ← χ̇_f + X λ.
void close(const ClosureRows& rows, const ClosureInertia& inertia, Eigen::VectorXd& v_dot, Eigen::VectorXd& lambda);

/// Moves q, then v onto the constraints by the smallest step in the metric of 𝓜 (Gauss-Newton; redundant rows
/// included). Returns the gap that was there before [m]. Throws NumericalError when the loop cannot close.
double project(const Multibody& system, Sweeps& sweeps, ClosureRows& rows, MotionState& state);

}  // namespace tenon::assembly
