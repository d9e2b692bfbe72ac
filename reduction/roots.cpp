#include "reduction/roots.hpp"

#include <Eigen/Eigenvalues>
#include <Eigen/SVD>
#include <cassert>
#include <cmath>
#include <vector>

#include "fem/error.hpp"

extern "C" {  // LAPACK, as OpenBLAS carries it
void dgesdd_(const char* job, const int* m, const int* n, double* a, const int* lda, double* s, double* u,
             const int* ldu, double* vt, const int* ldvt, double* work, const int* lwork, int* iwork, int* info);
}

namespace tenon::reduction {

using Eigen::MatrixXd;
using fem::Mat6;
using fem::Vec6;

ThinSvd thin_svd(const MatrixXd& A) {
  constexpr Eigen::Index jacobi_up_to = 160;
  assert(A.rows() >= A.cols());
  if (A.cols() == 0) return {MatrixXd(A.rows(), 0), Eigen::VectorXd(0), MatrixXd(0, 0)};
  if (A.cols() > jacobi_up_to) return divide_and_conquer_svd(A);
  const Eigen::JacobiSVD<MatrixXd> svd(A, Eigen::ComputeThinU | Eigen::ComputeThinV);
  return {svd.matrixU(), svd.singularValues(), svd.matrixV()};
}

ThinSvd divide_and_conquer_svd(MatrixXd A) {
  const auto m = static_cast<int>(A.rows()), n = static_cast<int>(A.cols());
  ThinSvd svd{MatrixXd(m, n), Eigen::VectorXd(n), MatrixXd(n, n)};
  if (n == 0) return svd;
  MatrixXd Vt(n, n);
  std::vector<int> integers(static_cast<std::size_t>(8 * n));
  double size = 0.0;
  int query = -1, info = 0;
  dgesdd_("S", &m, &n, A.data(), &m, svd.sigma.data(), svd.U.data(), &m, Vt.data(), &n, &size, &query, integers.data(),
          &info);
  const int length = static_cast<int>(size);
  std::vector<double> work(static_cast<std::size_t>(length));
  dgesdd_("S", &m, &n, A.data(), &m, svd.sigma.data(), svd.U.data(), &m, Vt.data(), &n, work.data(), &length,
          integers.data(), &info);
  if (info != 0)
    throw NumericalError("the dense singular value decomposition did not converge", info,
                         "Check the matrix for entries that are not finite");
  svd.V = Vt.transpose();
  return svd;
}

Mat6 mass_root(const Mat6& D, const Vec6& scale) {
  const Vec6 s = scale.cwiseMax(0.0).cwiseSqrt();
  Vec6 inverse = Vec6::Zero();
  for (int i = 0; i < 6; ++i)
    if (s[i] > 0.0) inverse[i] = 1.0 / s[i];
  const MatrixXd scaled = inverse.asDiagonal() * (0.5 * (D + D.transpose())) * inverse.asDiagonal();
  const Eigen::SelfAdjointEigenSolver<MatrixXd> eigen(scaled);
  Vec6 root = Vec6::Zero();
  for (int i = 0; i < 6; ++i)
    if (eigen.eigenvalues()[i] > 1e-12) root[i] = std::sqrt(eigen.eigenvalues()[i]);
  return root.asDiagonal() * eigen.eigenvectors().transpose() * s.asDiagonal();
}

}  // namespace tenon::reduction
