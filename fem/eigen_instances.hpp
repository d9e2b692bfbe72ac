#pragma once

#include <Eigen/Dense>

/// Eigen's dense decompositions of double matrices, compiled once (in eigen_instances.cpp) for every room and test:
/// part of their precompiled headers, no source needs to include it. It shortens the build; nothing depends on it.
#define TENON_EIGEN_INSTANCES(DECLARE)                                                                             \
  DECLARE class Eigen::PartialPivLU<Eigen::MatrixXd>;                                                              \
  DECLARE class Eigen::PartialPivLU<Eigen::MatrixXcd>;                                                             \
  DECLARE class Eigen::FullPivLU<Eigen::MatrixXd>;                                                                 \
  DECLARE class Eigen::HouseholderQR<Eigen::MatrixXd>;                                                             \
  DECLARE class Eigen::ColPivHouseholderQR<Eigen::MatrixXd>;                                                       \
  DECLARE class Eigen::CompleteOrthogonalDecomposition<Eigen::MatrixXd>;                                           \
  DECLARE class Eigen::JacobiSVD<Eigen::MatrixXd>;                                                                 \
  DECLARE class Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>;                                                    \
  DECLARE class Eigen::GeneralizedSelfAdjointEigenSolver<Eigen::MatrixXd>;                                         \
  DECLARE class Eigen::EigenSolver<Eigen::MatrixXd>;                                                               \
  DECLARE class Eigen::GeneralizedEigenSolver<Eigen::MatrixXd>;                                                    \
  DECLARE class Eigen::HessenbergDecomposition<Eigen::MatrixXd>;                                                   \
  DECLARE class Eigen::RealSchur<Eigen::MatrixXd>;                                                                 \
  DECLARE class Eigen::RealQZ<Eigen::MatrixXd>;                                                                    \
  DECLARE Eigen::EigenSolver<Eigen::MatrixXd>& Eigen::EigenSolver<Eigen::MatrixXd>::compute(                       \
      const Eigen::EigenBase<Eigen::MatrixXd>&, bool);                                                             \
  DECLARE Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>& Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>::compute( \
      const Eigen::EigenBase<Eigen::MatrixXd>&, int);

TENON_EIGEN_INSTANCES(extern template)
