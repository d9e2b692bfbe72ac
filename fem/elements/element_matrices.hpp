#pragma once

#include <Eigen/Core>

/// What every element gives to assembly.
namespace tenon::fem {

/// Element matrices in the basic frame over six dofs per node, [ux uy uz rx ry rz] node by node. Fixed capacity, no
/// heap.
struct ElementMatrices {
  static constexpr int max_dofs = 24;
  using Matrix = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::ColMajor, max_dofs, max_dofs>;
  Matrix K;  ///< stiffness, n×n, symmetric, both triangles filled [N/m, N, N m]
  Matrix M;  ///< mass, n×n, symmetric, both triangles filled [kg, kg m, kg m²]
};

}  // namespace tenon::fem
