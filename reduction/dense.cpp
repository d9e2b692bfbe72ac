#include "reduction/dense.hpp"

#include <cblas.h>
#include <omp.h>

#include <algorithm>
#include <mutex>
#include <vector>

#include "fem/error.hpp"
#include "reduction/panel_kernels.hpp"
#include "reduction/supernodal.hpp"
#include "reduction/two_threads.hpp"

extern "C" {  // LAPACK, as OpenBLAS carries it
void dsyevd_(const char* job, const char* triangle, const int* n, double* a, const int* lda, double* w, double* work,
             const int* lwork, int* iwork, const int* liwork, int* info);
void dpotrf_(const char* triangle, const int* n, double* a, const int* lda, int* info);
}

namespace tenon::reduction {

namespace {

constexpr Eigen::Index tall = 20;          // rows a column, from where on a block is tall
constexpr Eigen::Index stretch = 1024;     // rows a stretch: its panel (64 kB) stays in the cache
constexpr Eigen::Index worth_two = 20000;  // rows from where on a second thread pays

int blas_int(Eigen::Index n) { return static_cast<int>(n); }

void gemm(CBLAS_TRANSPOSE op, double alpha, const Eigen::Ref<const Eigen::MatrixXd>& A,
          const Eigen::Ref<const Eigen::MatrixXd>& B, double beta, double* C, Eigen::Index rows, Eigen::Index ld) {
  if (rows == 0 || B.cols() == 0 || B.rows() == 0) return;
  cblas_dgemm(CblasColMajor, op, CblasNoTrans, blas_int(rows), blas_int(B.cols()), blas_int(B.rows()), alpha, A.data(),
              blas_int(A.outerStride()), B.data(), blas_int(B.outerStride()), beta, C, blas_int(ld));
}

}  // namespace

// Tall blocks go through the panel kernels, a stretch of rows at a time: BLAS packs A anew for every call, which costs
// several times the product when B has eight columns.
Eigen::MatrixXd transposed_product(const Eigen::Ref<const Eigen::MatrixXd>& A,
                                   const Eigen::Ref<const Eigen::MatrixXd>& B) {
  Eigen::MatrixXd C = Eigen::MatrixXd::Zero(A.cols(), B.cols());
  if (A.rows() < tall * std::max(A.cols(), B.cols())) {
    gemm(CblasTrans, 1.0, A, B, 0.0, C.data(), A.cols(), C.rows());
    return C;
  }
  Panel H[2] = {Panel(A.cols(), 8), Panel(A.cols(), 8)};
  for (Eigen::Index c = 0; c < B.cols(); c += 8) {
    const Eigen::Index width = std::min<Eigen::Index>(8, B.cols() - c);
    H[0].setZero();
    H[1].setZero();
    in_two(A.rows(), A.rows() > worth_two, [&](Eigen::Index begin, Eigen::Index end, int part) {
      Panel W = Panel::Zero(stretch, 8);
      for (Eigen::Index i = begin; i < end; i += stretch) {
        const Eigen::Index rows = std::min(stretch, end - i);
        W.topLeftCorner(rows, width) = B.block(i, c, rows, width);
        panel_kernels().pull(A.data() + i, A.outerStride(), rows, A.cols(), W.data(), H[part].data());
      }
    });
    C.middleCols(c, width) = -(H[0] + H[1]).leftCols(width);
  }
  return C;
}

Eigen::MatrixXd product(const Eigen::Ref<const Eigen::MatrixXd>& A, const Eigen::Ref<const Eigen::MatrixXd>& B) {
  Eigen::MatrixXd C = Eigen::MatrixXd::Zero(A.rows(), B.cols());
  gemm(CblasNoTrans, 1.0, A, B, 0.0, C.data(), A.rows(), C.rows());
  return C;
}

void subtract_product(const Eigen::Ref<const Eigen::MatrixXd>& A, const Eigen::Ref<const Eigen::MatrixXd>& B,
                      Eigen::Ref<Eigen::MatrixXd> C) {
  if (A.rows() < tall * std::max(A.cols(), B.cols())) {
    gemm(CblasNoTrans, -1.0, A, B, 1.0, C.data(), A.rows(), C.outerStride());
    return;
  }
  Panel H(A.cols(), 8);
  for (Eigen::Index c = 0; c < B.cols(); c += 8) {
    const Eigen::Index width = std::min<Eigen::Index>(8, B.cols() - c);
    H.setZero();
    H.leftCols(width) = B.middleCols(c, width);
    in_two(A.rows(), A.rows() > worth_two, [&](Eigen::Index begin, Eigen::Index end, int) {
      Panel W = Panel::Zero(stretch, 8);
      for (Eigen::Index i = begin; i < end; i += stretch) {
        const Eigen::Index rows = std::min(stretch, end - i);
        W.topLeftCorner(rows, width) = C.block(i, c, rows, width);
        panel_kernels().push(A.data() + i, A.outerStride(), rows, A.cols(), H.data(), W.data());
        C.block(i, c, rows, width) = W.topLeftCorner(rows, width);
      }
    });
  }
}

SymmetricEigen symmetric_eigen(Eigen::MatrixXd A) {
  SymmetricEigen result;
  const int n = blas_int(A.rows());
  result.values.resize(n);
  if (n == 0) return result;
  int info = 0, query = -1, integers = 0;
  double reals = 0.0;
  dsyevd_("V", "L", &n, A.data(), &n, result.values.data(), &reals, &query, &integers, &query, &info);
  const int n_reals = static_cast<int>(reals), n_integers = integers;
  std::vector<double> work(static_cast<std::size_t>(n_reals));
  std::vector<int> integer_work(static_cast<std::size_t>(n_integers));
  dsyevd_("V", "L", &n, A.data(), &n, result.values.data(), work.data(), &n_reals, integer_work.data(), &n_integers,
          &info);
  if (info != 0)
    throw NumericalError("the dense symmetric eigenvalue solver did not converge", info,
                         "Check the matrix for entries that are not finite");
  result.vectors = std::move(A);
  return result;
}

int cholesky_in_place(Eigen::MatrixXd& A) {
  const int n = blas_int(A.rows());
  if (n == 0) return -1;
  int info = 0;
  dpotrf_("L", &n, A.data(), &n, &info);
  A.triangularView<Eigen::StrictlyUpper>().setZero();
  return info - 1;
}

void triangular_solve(const Eigen::MatrixXd& L, Eigen::Ref<Eigen::MatrixXd> B, bool transposed) {
  if (L.rows() == 0 || B.cols() == 0) return;
  cblas_dtrsm(CblasColMajor, CblasLeft, CblasLower, transposed ? CblasTrans : CblasNoTrans, CblasNonUnit,
              blas_int(L.rows()), blas_int(B.cols()), 1.0, L.data(), blas_int(L.rows()), B.data(),
              blas_int(B.outerStride()));
}

namespace {

// OpenBLAS has one setting for the whole process: the first limit to come changes it, the last to go restores it
struct BlasThreads {
  std::mutex lock;
  int limits = 0, before = 0;
};

BlasThreads& blas_threads_of_process() {
  static BlasThreads state;
  return state;
}

}  // namespace

ThreadLimit::ThreadLimit() : levels_(omp_get_max_active_levels()) {
  omp_set_max_active_levels(0);
  BlasThreads& blas = blas_threads_of_process();
  const std::lock_guard lock(blas.lock);
  if (blas.limits++ > 0) return;
  blas.before = openblas_get_num_threads();
  openblas_set_num_threads(1);
}

ThreadLimit::~ThreadLimit() {
  omp_set_max_active_levels(levels_);
  BlasThreads& blas = blas_threads_of_process();
  const std::lock_guard lock(blas.lock);
  if (--blas.limits == 0) openblas_set_num_threads(blas.before);
}

}  // namespace tenon::reduction
