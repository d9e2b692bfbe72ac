#pragma once

#include <Eigen/SparseCore>
#include <span>
#include <string>
#include <vector>

#include "fem/model.hpp"

namespace tenon::fem {

using SparseMatrix = Eigen::SparseMatrix<double>;

/// What the elimination of constraints met beside its work; nothing here is an error by itself.
struct ConstraintNote {
  enum class Kind {
    redundant,        ///< the row says nothing that rows before it have not said
    dependent_twice,  ///< its dependent dof had been given up before, so another one was
    forced_zero,      ///< rows together leave a dof no motion although no support holds it
    ill_determined    ///< what it adds to the rows before is at round-off of the coefficients: `figure` of the row
  };
  Kind kind = Kind::redundant;
  std::string link;  ///< "rigid link 7"
  Dof dof;           ///< that the row would give up, or that it forces to zero
  double figure = 0.0;
};

/// Where each of the 6 dofs a node went: free (its own row of K and M), held, unused (no stiffness, no mass), or a
/// linear combination of free ones: u_full = T u_free, T kept row by row.
struct DofMap {
  struct Term {
    int free = 0;  ///< index of a free dof
    double coefficient = 1.0;
  };
  std::vector<int> start;  ///< size 6·nodes + 1: terms of full dof i are terms[start[i] .. start[i+1])
  std::vector<Term> terms;
  std::vector<Dof> free;           ///< the dof behind each row of K and M
  std::vector<std::string> names;  ///< "node 45 rz", one a free dof
  std::vector<Dof> unused;         ///< dofs dropped since nothing gives them stiffness or mass
  int redundant_constraints = 0;
  std::vector<ConstraintNote> notes;  ///< on constraints, in their order

  int n_free() const { return static_cast<int>(free.size()); }
  int n_nodes() const { return static_cast<int>(start.size() / 6); }
  /// The row of a dof that is itself free, or −1.
  int row(const Dof& dof) const;
  /// T u: all 6·nodes displacements from the free ones (columns are shapes).
  Eigen::MatrixXd expand(const Eigen::Ref<const Eigen::MatrixXd>& u_free) const;
  /// Displacements of one node (6×columns) from the free ones.
  Mat6X expand_node(int node, const Eigen::Ref<const Eigen::MatrixXd>& u_free) const;
};

/// K and M of a model: sparse, symmetric, **lower triangle stored**, constraints eliminated exactly.
struct Structure {
  SparseMatrix K;  ///< [N/m], n×n
  SparseMatrix M;  ///< [kg], n×n; may be singular
  DofMap dofs;
  std::vector<Vec3> nodes;  ///< positions [m]
  std::vector<long> node_ids;
  std::vector<int> scalar_points;  ///< nodes that are one scalar dof: they do not move with a rigid body
  std::vector<Port> ports;
  double rounding = 1e-9;  ///< what stays below it counts as no force on a rigid motion (fem/rigid_forces.hpp)

  int n() const { return static_cast<int>(K.rows()); }
};

/// Assembles K and M: Σ TᵀK_eT, TᵀM_eT; no heap allocation per element. Port nodes are never eliminated.
/// Throws ModelError for bad elements (named), dependency cycles, over-constraint.
Structure assemble(const Model& model);

/// Geometric stiffness K_σ of the stress that the displacement u causes (n×n, lower triangle, rows of K): second-order
/// work of axial forces in beams and of membrane forces in shells. Stress in rigid links and springs is left out, and
/// what the elements say of theirs. Parts given as matrices do not tell their stress: ModelError.
/// The tangent of a loaded structure is K + K_σ, its buckling K + λ K_σ singular.
/// @param model  the one that `structure` was assembled from  @param u  n [m, rad]  @throws ModelError otherwise
SparseMatrix geometric_stiffness(const Model& model, const Structure& structure,
                                 const Eigen::Ref<const Eigen::VectorXd>& u);

/// Rigid-body motions about `point` restricted to the free dofs: n×6, columns = unit twist components. Throws
/// ModelError for a node whose place is not known.
Eigen::MatrixXd rigid_motions(const Structure& structure, const Vec3& point);

/// Mass, centre of mass and inertia.
struct MassProperties {
  double mass = 0.0;            ///< [kg]
  Vec3 centre = Vec3::Zero();   ///< [m]
  Mat3 inertia = Mat3::Zero();  ///< about the centre [kg m²]
};

/// From RᵀMR.
MassProperties mass_properties(const Structure& structure);
/// From volumes, areas, lengths and densities alone, warped quads in their mean planes: an independent check of the
/// former. Parts given as matrices have none of these: ModelError.
MassProperties geometric_mass_properties(const Model& model);

}  // namespace tenon::fem
