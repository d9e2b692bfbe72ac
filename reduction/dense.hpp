#pragma once

#include <Eigen/Core>

/// The few dense operations whose speed matters, over BLAS and LAPACK.
namespace tenon::reduction {

/// Aᵀ B.
Eigen::MatrixXd transposed_product(const Eigen::Ref<const Eigen::MatrixXd>& A,
                                   const Eigen::Ref<const Eigen::MatrixXd>& B);

/// A B.
Eigen::MatrixXd product(const Eigen::Ref<const Eigen::MatrixXd>& A, const Eigen::Ref<const Eigen::MatrixXd>& B);

/// C ← C − A B.
void subtract_product(const Eigen::Ref<const Eigen::MatrixXd>& A, const Eigen::Ref<const Eigen::MatrixXd>& B,
                      Eigen::Ref<Eigen::MatrixXd> C);

/// Eigenpairs of a symmetric matrix (lower triangle read), eigenvalues ascending.
struct SymmetricEigen {
  Eigen::VectorXd values;
  Eigen::MatrixXd vectors;  ///< orthonormal columns
};
/// Divide and conquer (LAPACK dsyevd); throws NumericalError when it does not converge.
SymmetricEigen symmetric_eigen(Eigen::MatrixXd A);

/// The lower Cholesky factor of a symmetric matrix (lower triangle read); −1, or the index of the first pivot that is
/// not positive. A is overwritten by L, its upper triangle by zeros.
int cholesky_in_place(Eigen::MatrixXd& A);

/// B ← L⁻¹ B, or L⁻ᵀ B when `transposed`.
void triangular_solve(const Eigen::MatrixXd& L, Eigen::Ref<Eigen::MatrixXd> B, bool transposed);

/// While one lives, CHOLMOD's OpenMP loops of this thread and OpenBLAS of the whole process run on one thread: Debian's
/// CHOLMOD oversubscribes otherwise (a factor of 2.6 lost). The last one to go restores the settings.
class ThreadLimit {
 public:
  ThreadLimit();
  ~ThreadLimit();
  ThreadLimit(const ThreadLimit&) = delete;
  ThreadLimit& operator=(const ThreadLimit&) = delete;

 private:
  int levels_;
};

}  // namespace tenon::reduction
