#pragma once

#include <Eigen/SparseCore>
#include <functional>
#include <span>
#include <vector>

#include "fem/elements/beam.hpp"
#include "fem/elements/shell.hpp"

/// The few lines of assembly and eigen-solution the element tests need, independent of the product's assembler.
namespace tenon::fem::testing {

using Sparse = Eigen::SparseMatrix<double>;

struct SmallAssembly {
  std::vector<Vec3> nodes;
  std::vector<Eigen::Triplet<double>> K, M;

  void add(std::span<const int> element_nodes, const ElementMatrices& e);
};

struct System {
  Sparse K, M;
  std::vector<int> index;  // of dof 6 node + direction, −1 where held
};

/// Keeps the dofs for which `free(position, direction)` holds.
System restrict_to(const SmallAssembly& a, const std::function<bool(const Vec3&, int)>& free);

/// Lowest eigenvalues of K x = λ M x by subspace iteration about `shift` (< 0 for free bodies); M may be singular.
Eigen::VectorXd lowest(const System& s, int count, double shift = 0.0);

/// Rigid motions of the given nodes about the origin, 6n×6: translations, rotations.
Eigen::MatrixXd rigid_motions(std::span<const Vec3> nodes);

/// Number of eigenvalues of a symmetric stiffness that are zero to `tolerance` of the largest, all lengths scaled by h
/// so that forces and moments compare.
int zero_modes(const Eigen::MatrixXd& K, double h, double tolerance);

}  // namespace tenon::fem::testing
