#pragma once

#include <Eigen/Dense>

namespace tenon::gemm {

using Traits = Eigen::internal::gebp_traits<double, double>;
using Packet = Traits::LhsPacket4Packing;
constexpr int mr = Traits::mr, nr = Traits::nr, progress = Traits::LhsProgress;

}  // namespace tenon::gemm

/// What Eigen makes of dense double matrices, compiled once (in eigen_instances.cpp) for every room and test: its
/// decompositions, Householder reflections applied in blocks, the inner loops of products and triangular solves. Part
/// of their precompiled headers, no source needs to include it. It shortens the build; nothing depends on it.
#define TENON_EIGEN_INSTANCES(DECLARE)                                                                                 \
  DECLARE class Eigen::PartialPivLU<Eigen::MatrixXd>;                                                                  \
  DECLARE class Eigen::PartialPivLU<Eigen::MatrixXcd>;                                                                 \
  DECLARE class Eigen::FullPivLU<Eigen::MatrixXd>;                                                                     \
  DECLARE class Eigen::LLT<Eigen::MatrixXd>;                                                                           \
  DECLARE class Eigen::LDLT<Eigen::MatrixXd>;                                                                          \
  DECLARE class Eigen::HouseholderQR<Eigen::MatrixXd>;                                                                 \
  DECLARE class Eigen::ColPivHouseholderQR<Eigen::MatrixXd>;                                                           \
  DECLARE class Eigen::CompleteOrthogonalDecomposition<Eigen::MatrixXd>;                                               \
  DECLARE class Eigen::JacobiSVD<Eigen::MatrixXd>;                                                                     \
  DECLARE class Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>;                                                        \
  DECLARE class Eigen::GeneralizedSelfAdjointEigenSolver<Eigen::MatrixXd>;                                             \
  DECLARE class Eigen::EigenSolver<Eigen::MatrixXd>;                                                                   \
  DECLARE class Eigen::GeneralizedEigenSolver<Eigen::MatrixXd>;                                                        \
  DECLARE class Eigen::HessenbergDecomposition<Eigen::MatrixXd>;                                                       \
  DECLARE class Eigen::Tridiagonalization<Eigen::MatrixXd>;                                                            \
  DECLARE class Eigen::RealSchur<Eigen::MatrixXd>;                                                                     \
  DECLARE class Eigen::RealQZ<Eigen::MatrixXd>;                                                                        \
  DECLARE struct Eigen::internal::gemm_pack_lhs<                                                                       \
      double, Eigen::Index, Eigen::internal::const_blas_data_mapper<double, Eigen::Index, Eigen::ColMajor>,            \
      tenon::gemm::mr, tenon::gemm::progress, tenon::gemm::Packet, Eigen::ColMajor>;                                   \
  DECLARE struct Eigen::internal::gemm_pack_rhs<                                                                       \
      double, Eigen::Index, Eigen::internal::const_blas_data_mapper<double, Eigen::Index, Eigen::ColMajor>,            \
      tenon::gemm::nr, Eigen::ColMajor>;                                                                               \
  DECLARE struct Eigen::internal::gemm_pack_lhs<                                                                       \
      double, Eigen::Index, Eigen::internal::const_blas_data_mapper<double, Eigen::Index, Eigen::RowMajor>,            \
      tenon::gemm::mr, tenon::gemm::progress, tenon::gemm::Packet, Eigen::RowMajor>;                                   \
  DECLARE struct Eigen::internal::gemm_pack_rhs<                                                                       \
      double, Eigen::Index, Eigen::internal::const_blas_data_mapper<double, Eigen::Index, Eigen::RowMajor>,            \
      tenon::gemm::nr, Eigen::RowMajor>;                                                                               \
  DECLARE struct Eigen::internal::gebp_kernel<                                                                         \
      double, double, Eigen::Index, Eigen::internal::blas_data_mapper<double, Eigen::Index, Eigen::ColMajor>,          \
      tenon::gemm::mr, tenon::gemm::nr, false, false>;                                                                 \
  DECLARE struct Eigen::internal::general_matrix_vector_product<                                                       \
      Eigen::Index, double, Eigen::internal::const_blas_data_mapper<double, Eigen::Index, Eigen::ColMajor>,            \
      Eigen::ColMajor, false, double, Eigen::internal::const_blas_data_mapper<double, Eigen::Index, Eigen::RowMajor>,  \
      false, Eigen::Specialized>;                                                                                      \
  DECLARE struct Eigen::internal::general_matrix_vector_product<                                                       \
      Eigen::Index, double, Eigen::internal::const_blas_data_mapper<double, Eigen::Index, Eigen::ColMajor>,            \
      Eigen::ColMajor, false, double, Eigen::internal::const_blas_data_mapper<double, Eigen::Index, Eigen::ColMajor>,  \
      false, Eigen::Specialized>;                                                                                      \
  DECLARE struct Eigen::internal::general_matrix_vector_product<                                                       \
      Eigen::Index, double, Eigen::internal::const_blas_data_mapper<double, Eigen::Index, Eigen::RowMajor>,            \
      Eigen::RowMajor, false, double, Eigen::internal::const_blas_data_mapper<double, Eigen::Index, Eigen::ColMajor>,  \
      false, Eigen::Specialized>;                                                                                      \
  DECLARE struct Eigen::internal::general_matrix_vector_product<                                                       \
      Eigen::Index, double, Eigen::internal::const_blas_data_mapper<double, Eigen::Index, Eigen::RowMajor>,            \
      Eigen::RowMajor, false, double, Eigen::internal::const_blas_data_mapper<double, Eigen::Index, Eigen::RowMajor>,  \
      false, Eigen::Specialized>;                                                                                      \
  DECLARE struct Eigen::internal::triangular_solve_matrix<double, Eigen::Index, Eigen::OnTheLeft, Eigen::Lower, false, \
                                                          Eigen::ColMajor, Eigen::ColMajor, 1>;                        \
  DECLARE struct Eigen::internal::triangular_solve_matrix<double, Eigen::Index, Eigen::OnTheLeft, Eigen::Lower, false, \
                                                          Eigen::RowMajor, Eigen::ColMajor, 1>;                        \
  DECLARE struct Eigen::internal::triangular_solve_matrix<double, Eigen::Index, Eigen::OnTheLeft, Eigen::Upper, false, \
                                                          Eigen::ColMajor, Eigen::ColMajor, 1>;                        \
  DECLARE struct Eigen::internal::triangular_solve_matrix<double, Eigen::Index, Eigen::OnTheLeft, Eigen::Upper, false, \
                                                          Eigen::RowMajor, Eigen::ColMajor, 1>;                        \
  DECLARE struct Eigen::internal::triangular_solve_matrix<double, Eigen::Index, Eigen::OnTheLeft, Eigen::UnitLower,    \
                                                          false, Eigen::ColMajor, Eigen::ColMajor, 1>;                 \
  DECLARE struct Eigen::internal::triangular_solve_matrix<double, Eigen::Index, Eigen::OnTheLeft, Eigen::UnitLower,    \
                                                          false, Eigen::RowMajor, Eigen::ColMajor, 1>;                 \
  DECLARE Eigen::EigenSolver<Eigen::MatrixXd>& Eigen::EigenSolver<Eigen::MatrixXd>::compute(                           \
      const Eigen::EigenBase<Eigen::MatrixXd>&, bool);                                                                 \
  DECLARE Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>& Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>::compute(     \
      const Eigen::EigenBase<Eigen::MatrixXd>&, int);                                                                  \
  DECLARE Eigen::LLT<Eigen::MatrixXd>& Eigen::LLT<Eigen::MatrixXd>::compute(const Eigen::EigenBase<Eigen::MatrixXd>&); \
  DECLARE void Eigen::internal::tridiagonalization_inplace(Eigen::MatrixXd&, Eigen::VectorXd&);                        \
  DECLARE void Eigen::internal::apply_block_householder_on_the_left(                                                   \
      Eigen::Block<Eigen::MatrixXd, Eigen::Dynamic, Eigen::Dynamic>&,                                                  \
      const Eigen::Block<Eigen::MatrixXd, Eigen::Dynamic, Eigen::Dynamic>&,                                            \
      const Eigen::VectorBlock<const Eigen::VectorXd>&, bool);                                                         \
  DECLARE void Eigen::internal::apply_block_householder_on_the_left(                                                   \
      Eigen::Block<Eigen::VectorXd, Eigen::Dynamic, Eigen::Dynamic>&,                                                  \
      const Eigen::Block<Eigen::MatrixXd, Eigen::Dynamic, Eigen::Dynamic>&,                                            \
      const Eigen::VectorBlock<const Eigen::VectorXd>&, bool);                                                         \
  DECLARE void                                                                                                         \
  Eigen::MatrixBase<Eigen::Block<Eigen::MatrixXd, Eigen::Dynamic, Eigen::Dynamic>>::applyHouseholderOnTheLeft(         \
      const Eigen::Block<const Eigen::MatrixXd, Eigen::Dynamic, 1>&, const double&, double*);                          \
  DECLARE void                                                                                                         \
  Eigen::MatrixBase<Eigen::Block<Eigen::MatrixXd, Eigen::Dynamic, Eigen::Dynamic>>::applyHouseholderOnTheRight(        \
      const Eigen::Block<const Eigen::MatrixXd, Eigen::Dynamic, 1>&, const double&, double*);

TENON_EIGEN_INSTANCES(extern template)
