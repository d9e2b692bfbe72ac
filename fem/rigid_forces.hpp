#pragma once

#include <Eigen/Core>

#include "fem/structure.hpp"

namespace tenon::fem {

/// What motions that should cost nothing meet in a stiffness matrix, row by row. The ratio of both tells rounding from
/// a tie to the ground.
struct RigidForces {
  Eigen::MatrixXd force;  ///< K R
  Eigen::MatrixXd terms;  ///< Σ_j √(K_ii K_jj) |R_j|: bounds what cancels in a row of a positive matrix

  /// |force| / terms; zero where there is no force.
  double ratio(Eigen::Index row, Eigen::Index motion) const;
  /// The largest ratio of a row, or of all rows, and the row.
  struct Worst {
    double ratio = 0.0;
    Eigen::Index row = -1;
  };
  double ratio(Eigen::Index row) const;
  Worst worst() const;
};

/// @param K  n×n, lower triangle  @param R  n×r, columns in the units of the rows
RigidForces rigid_forces(const SparseMatrix& K, const Eigen::Ref<const Eigen::MatrixXd>& R);

/// How far from zero rounding may leave the ratios of a structure's rigid motions (Structure::rounding).
namespace rigid_limit {
inline constexpr double unsaid = 1e-13;        ///< forces on motions taken as rigid that need no word
inline constexpr double of_elements = 1e-12;   ///< our elements leave 1e-13; a tie to the ground above this is one
inline constexpr double of_tied_nodes = 1e-9;  ///< nothing reaches the ground: springs of nodes that nearly coincide
inline constexpr double of_matrices = 1e-9;    ///< other programs' elements and their condensation
}  // namespace rigid_limit

/// That of a model: whether anything of it reaches the ground, and its matrices' own.
double rigid_rounding(const Model& model);

}  // namespace tenon::fem
