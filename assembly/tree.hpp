#pragma once

#include <vector>

#include "assembly/network.hpp"

/// Recursive dynamics on trees by spatial operators (Jain, Rodriguez), linear first.
/// Numbering: parent index < child index (the paper counts tip to base).
///
/// The paper's 6-vectors are angular first; with the permutation that swaps the halves its operators become, here,
///   φ(x, y) = τ(l(x, y))ᵀ: a wrench from y to x;   φ*(x, y) = τ(l(x, y)): a twist from x to y,
/// with fem::tau and l(x, y) the vector from x to y.
namespace tenon::assembly {

/// What a tree is: per body its modal mass matrix and how it hangs on its parent. Hinge coordinates β are those of the
/// joint; a free root has six, about its reference; a weld and a fixed root have none.
struct TreeBody {
  std::string name;
  int body = 0;                     ///< index in the network
  int parent = -1;                  ///< index of the parent body in the tree, −1: the inertial frame
  Eigen::MatrixXd M;                ///< M_m(k), (n+6)×(n+6) over (η, x_ref), world axes, lumped masses in, eq (23)
  Eigen::MatrixXd K;                ///< n modal stiffnesses on the diagonal, n×n
  fem::Mat6X H_star;                ///< 6×n_r hinge map at the hinge O_k, world axes, eq (8)
  Eigen::VectorXd hinge_stiffness;  ///< n_r [N m/rad]
  Eigen::VectorXd hinge_inertia;    ///< n_r [kg m²], acts on β
  Vec3 parent_to_hinge = Vec3::Zero();     ///< l(parent reference, t): world axes [m]
  Vec3 reference_to_hinge = Vec3::Zero();  ///< l(k, O_k); zero for cantilever bodies hung by their parent port
  fem::Mat6X Pi_t;  ///< shapes of the *parent* at the port this body hangs on, 6×n_parent, world axes
  fem::Mat6X Pi_d;  ///< shapes of this body at its own hinge node, 6×n, world axes (zero for cantilever)

  int modes() const { return static_cast<int>(K.rows()); }
  int hinge_dofs() const { return static_cast<int>(H_star.cols()); }
};

struct Tree {
  std::vector<TreeBody> bodies;
  std::vector<int> offset;  ///< first generalised coordinate of each body: η then β
  int n = 0;                ///< generalised coordinates
};

/// From the values a network holds; any body may hang by any port, cantilever or free-free. A joint read against its
/// own direction keeps its sign: β is the rotation of the joint's child relative to its parent. Throws ModelError
/// naming the joint when the network has a loop or a grounded port that closes one.
Tree make_tree(const Network& network);

/// Mass matrix at rest by the composite-body recursion, eq (50).
Eigen::MatrixXd composite_mass_matrix(const Tree& tree);

/// Block-diagonal stiffness over (η, β).
Eigen::MatrixXd stiffness(const Tree& tree);

/// Kinematic map q = J χ from tree coordinates to the coordinates of the second-order assembly (for comparison of the
/// routes).
Eigen::MatrixXd kinematic_map(const Tree& tree, const Network& network);

}  // namespace tenon::assembly
