#pragma once

#include <Eigen/Eigenvalues>

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
  int turned_over = -1;   ///< first closure whose hinge stands half a turn off, where its rows vanish too; −1: none
  std::vector<Mat6X> shapes;  ///< scratch: shapes at the ports
  int rows() const { return static_cast<int>(gap.size()); }
};

/// Throws what check_closures() throws.
ClosureRows make_closure_rows(const Multibody& system);

/// After set_state() for the same q and v.
void closure_rows(const Multibody& system, const Sweeps& sweeps, const Eigen::VectorXd& q, const Eigen::VectorXd& v,
                  ClosureRows& rows);

/// After closure_rows(): throws NumericalError naming the closure that is turned over. Axes that must be parallel are
/// so, to the rows a·b = 0, pointing either way.
void check_sides(const Multibody& system, const ClosureRows& rows);

/// Λ⁻¹ = J 𝓜⁻¹ Jᵀ in rows scaled to a unit diagonal, by its eigenvalues w: redundant directions have none.
struct ClosureInertia {
  Eigen::MatrixXd X;           ///< nv×m: 𝓜⁻¹ Jᵀ
  Eigen::VectorXd scale;       ///< m: of the rows
  Eigen::MatrixXd directions;  ///< m×m: eigenvectors, w ascending
  Eigen::VectorXd inverse;     ///< m: 1/w; 0 for the redundant
  Eigen::Index redundant = 0;  ///< how many: the first directions, in which multipliers are indeterminate

  // scratch: an eigen-solver in two halves, for as one it takes from the heap
  Eigen::Tridiagonalization<Eigen::MatrixXd> tridiagonal{1};
  Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> eigen;
  Eigen::MatrixXd compliance;
  Eigen::VectorXd diagonal, beside, work, f, x, missing;
};

/// After articulate() and closure_rows(). Sizes `inertia` when it is first given; after that nothing is allocated, up
/// to 48 rows. Throws NumericalError when no gap tells redundant rows from others.
void closure_inertia(const Multibody& system, Sweeps& sweeps, const ClosureRows& rows, ClosureInertia& inertia);
ClosureInertia closure_inertia(const Multibody& system, Sweeps& sweeps, const ClosureRows& rows);

/// λ of least norm such that J (χ̇_f + X λ) + γ = 0, and χ̇ ← χ̇_f + X λ. No allocation.
void close(const ClosureRows& rows, ClosureInertia& inertia, Eigen::VectorXd& v_dot, Eigen::VectorXd& lambda);

/// Moves q, then v onto the constraints by the smallest step in the metric of 𝓜 (Gauss-Newton; redundant rows
/// included). Returns the gap that was there before [m]. Throws NumericalError when the loop cannot close, or closes
/// only with a hinge turned over.
double project(const Multibody& system, Sweeps& sweeps, ClosureRows& rows, MotionState& state);

}  // namespace tenon::assembly
