#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "assembly/network.hpp"

namespace tenon::assembly {

/// All bodies of a network side by side, before any joint holds them: q = (x_ref in world axes, η) of every body,
/// M q̈ + C q̇ + K q = B u, and the rows G q = 0 that joints and ground demand (NUMERICS 4a). Every matrix also as a
/// root, one row per mass, spring or damper, so that extreme ratios never meet in one sum.
struct DisjointSystem {
  Placement placement;
  std::vector<int> offset;  ///< first coordinate of each body in q: 6 reference coordinates, then η
  Eigen::MatrixXd M, C, K;  ///< q×q: bodies, lumped masses, joint springs, dampers and drive inertias
  Eigen::MatrixXd mass_root, damping_root, stiffness_root;  ///< W, E, F: M = WᵀW, C = EᵀE, K = FᵀF
  Eigen::MatrixXd B;                                        ///< q×inputs
  Eigen::MatrixXd position_rows;  ///< outputs×q: the displacement whose position, velocity or acceleration is asked
  Eigen::MatrixXd G;              ///< rows×q, unscaled: translations [m], rotations [rad]
  std::vector<std::string> row_names;  ///< of G: "joint 'tip', translation y"
  std::vector<std::string> row_units;  ///< of what each row transmits: "N" or "N m"
  Eigen::VectorXd scale;  ///< q: natural size of each coordinate (1 m, 1/length rad, η that moves a port by 1 m)
};

DisjointSystem disjoint(const Network& network);

}  // namespace tenon::assembly
