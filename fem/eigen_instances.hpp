#pragma once

#include <Eigen/Dense>

/// Short names for what Eigen's products are made of.
namespace tenon::fem::gemm {

using Index = Eigen::Index;
constexpr int columns = Eigen::ColMajor, rows = Eigen::RowMajor;
template <int Order>
using From = Eigen::internal::const_blas_data_mapper<double, Index, Order>;
using Into = Eigen::internal::blas_data_mapper<double, Index, columns>;
using Traits = Eigen::internal::gebp_traits<double, double>;
using Packet = Traits::LhsPacket4Packing;
constexpr int mr = Traits::mr, nr = Traits::nr, progress = Traits::LhsProgress;

}  // namespace tenon::fem::gemm

// A factor of a product copied into the order of the inner loop, products, and triangular solves: by storage order.
#define TENON_EIGEN_PACKS(DECLARE, ORDER)                                                                              \
  DECLARE struct Eigen::internal::gemm_pack_lhs<                                                                       \
      double, tenon::fem::gemm::Index, tenon::fem::gemm::From<tenon::fem::gemm::ORDER>, tenon::fem::gemm::mr,          \
      tenon::fem::gemm::progress, tenon::fem::gemm::Packet, tenon::fem::gemm::ORDER>;                                  \
  DECLARE struct Eigen::internal::gemm_pack_rhs<double, tenon::fem::gemm::Index,                                       \
                                                tenon::fem::gemm::From<tenon::fem::gemm::ORDER>, tenon::fem::gemm::nr, \
                                                tenon::fem::gemm::ORDER>;
#define TENON_EIGEN_PRODUCTS(DECLARE, LEFT, RIGHT)                                                                    \
  DECLARE struct Eigen::internal::general_matrix_vector_product<                                                      \
      tenon::fem::gemm::Index, double, tenon::fem::gemm::From<tenon::fem::gemm::LEFT>, tenon::fem::gemm::LEFT, false, \
      double, tenon::fem::gemm::From<tenon::fem::gemm::RIGHT>, false, Eigen::Specialized>;                            \
  DECLARE struct Eigen::internal::general_matrix_matrix_product<tenon::fem::gemm::Index, double,                      \
                                                                tenon::fem::gemm::LEFT, false, double,                \
                                                                tenon::fem::gemm::RIGHT, false, Eigen::ColMajor, 1>;
#define TENON_EIGEN_SOLVE(DECLARE, TRIANGLE, ORDER)                                                                    \
  DECLARE struct Eigen::internal::triangular_solve_matrix<double, tenon::fem::gemm::Index, Eigen::OnTheLeft, TRIANGLE, \
                                                          false, tenon::fem::gemm::ORDER, Eigen::ColMajor, 1>;

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
  TENON_EIGEN_PACKS(DECLARE, columns)                                                                                  \
  TENON_EIGEN_PACKS(DECLARE, rows)                                                                                     \
  DECLARE struct Eigen::internal::gebp_kernel<double, double, tenon::fem::gemm::Index, tenon::fem::gemm::Into,         \
                                              tenon::fem::gemm::mr, tenon::fem::gemm::nr, false, false>;               \
  TENON_EIGEN_PRODUCTS(DECLARE, columns, columns)                                                                      \
  TENON_EIGEN_PRODUCTS(DECLARE, columns, rows)                                                                         \
  TENON_EIGEN_PRODUCTS(DECLARE, rows, columns)                                                                         \
  TENON_EIGEN_PRODUCTS(DECLARE, rows, rows)                                                                            \
  TENON_EIGEN_SOLVE(DECLARE, Eigen::Lower, columns)                                                                    \
  TENON_EIGEN_SOLVE(DECLARE, Eigen::Lower, rows)                                                                       \
  TENON_EIGEN_SOLVE(DECLARE, Eigen::Upper, columns)                                                                    \
  TENON_EIGEN_SOLVE(DECLARE, Eigen::Upper, rows)                                                                       \
  TENON_EIGEN_SOLVE(DECLARE, Eigen::UnitLower, columns)                                                                \
  TENON_EIGEN_SOLVE(DECLARE, Eigen::UnitLower, rows)                                                                   \
  DECLARE void Eigen::internal::evaluateProductBlockingSizesHeuristic<double, double, 1, Eigen::Index>(                \
      Eigen::Index&, Eigen::Index&, Eigen::Index&, Eigen::Index);                                                      \
  DECLARE Eigen::EigenSolver<Eigen::MatrixXd>& Eigen::EigenSolver<Eigen::MatrixXd>::compute(                           \
      const Eigen::EigenBase<Eigen::MatrixXd>&, bool);                                                                 \
  DECLARE Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>& Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>::compute(     \
      const Eigen::EigenBase<Eigen::MatrixXd>&, int);                                                                  \
  DECLARE Eigen::LLT<Eigen::MatrixXd>& Eigen::LLT<Eigen::MatrixXd>::compute(const Eigen::EigenBase<Eigen::MatrixXd>&); \
  DECLARE void Eigen::LLT<Eigen::MatrixXd>::_solve_impl(const Eigen::VectorXd&, Eigen::VectorXd&) const;               \
  DECLARE void Eigen::LLT<Eigen::MatrixXd>::_solve_impl(const Eigen::MatrixXd&, Eigen::MatrixXd&) const;               \
  DECLARE Eigen::LDLT<Eigen::MatrixXd>& Eigen::LDLT<Eigen::MatrixXd>::compute(                                         \
      const Eigen::EigenBase<Eigen::MatrixXd>&);                                                                       \
  DECLARE void Eigen::LDLT<Eigen::MatrixXd>::_solve_impl(const Eigen::VectorXd&, Eigen::VectorXd&) const;              \
  DECLARE void Eigen::LDLT<Eigen::MatrixXd>::_solve_impl(const Eigen::MatrixXd&, Eigen::MatrixXd&) const;              \
  DECLARE Eigen::ColPivHouseholderQR<Eigen::MatrixXd>& Eigen::ColPivHouseholderQR<Eigen::MatrixXd>::compute(           \
      const Eigen::EigenBase<Eigen::MatrixXd>&);                                                                       \
  DECLARE void Eigen::ColPivHouseholderQR<Eigen::MatrixXd>::_solve_impl(const Eigen::VectorXd&, Eigen::VectorXd&)      \
      const;                                                                                                           \
  DECLARE void Eigen::CompleteOrthogonalDecomposition<Eigen::MatrixXd>::_solve_impl(const Eigen::VectorXd&,            \
                                                                                    Eigen::VectorXd&) const;           \
  DECLARE void Eigen::CompleteOrthogonalDecomposition<Eigen::MatrixXd>::_solve_impl(const Eigen::MatrixXd&,            \
                                                                                    Eigen::MatrixXd&) const;           \
  DECLARE void Eigen::FullPivLU<Eigen::MatrixXd>::_solve_impl(const Eigen::VectorXd&, Eigen::VectorXd&) const;         \
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
