#pragma once

#include <Eigen/Core>
#include <vector>

#include "reduction/reduced_body.hpp"
#include "reduction/shape_integrals.hpp"

/// A body of lumped nodes with random shapes, and its sums over the nodes as the spatial-operator paper writes them.
namespace tenon::tests {

using fem::Mat3;
using fem::Mat6X;
using fem::Vec3;
using fem::Vec6;
using reduction::LumpedNode;

struct LumpedBody {
  std::vector<LumpedNode> nodes;
  Eigen::MatrixXd shapes;  ///< 6N×n, mass-normalised
  Vec3 reference;
  reduction::ReducedBody body;

  Eigen::Matrix3Xd psi(std::size_t j) const;
  Eigen::Matrix3Xd theta(std::size_t j) const { return shapes.middleRows<3>(6 * static_cast<Eigen::Index>(j) + 3); }
  Vec3 position(std::size_t j) const { return nodes[j].position + nodes[j].offset - reference; }

  /// [Π_j, B_jᵀ]: velocity of the centre of mass of node j from (η̇, V), eq (21).
  Eigen::MatrixXd motion(std::size_t j, const Eigen::VectorXd& eta) const;
  fem::Mat6 spatial_inertia(std::size_t j) const;
};

/// Eq (1) of nodes and shapes about a reference, by sums.
void fill(LumpedBody& lumped);

LumpedBody random_lumped(unsigned seed, int nodes, int modes, bool inertia, bool offsets);

/// M_m of (23) and b_m of (28), (31), (37), node by node.
struct NodeSums {
  Eigen::MatrixXd M;
  Eigen::VectorXd b;
};
NodeSums node_sums(const LumpedBody& lumped, const Eigen::VectorXd& eta, const Eigen::VectorXd& eta_dot, const Vec3& w);

}  // namespace tenon::tests
