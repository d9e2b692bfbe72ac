#pragma once

#include <Eigen/Dense>

#include "assembly/recursion/sweeps.hpp"

/// The spatial operators of the paper as dense matrices, base to tip (parent index < child index), linear first.
namespace tenon::assembly::testing {

using Eigen::Index;
using Eigen::MatrixXd;

struct DenseOperators {
  std::vector<Index> row;       ///< of each body in the stacked (n+6)
  MatrixXd H, E_phi, Phi, M_m;  ///< 𝓗, 𝓔_Φ (18), Φ (19), blkdiag M_m
  MatrixXd rotors;              ///< hinge inertias on the diagonal: on β, not on V_m
  MatrixXd mass() const;        ///< (43)
};

/// V_F = twist_matrix V_T.
Mat6 twist_matrix(const RigidMotion& X);

DenseOperators dense_operators(const Multibody& mb, const Sweeps& sweeps);

}  // namespace tenon::assembly::testing
