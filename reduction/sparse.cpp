#include "reduction/sparse.hpp"

#include <algorithm>
#include <cmath>

#include "reduction/panel_kernels.hpp"
#include "reduction/supernodal.hpp"
#include "reduction/two_threads.hpp"

namespace tenon::reduction {

Eigen::MatrixXd symmetric_product(const fem::SparseMatrix& A, const Eigen::Ref<const Eigen::MatrixXd>& X) {
  Eigen::MatrixXd Y(X.rows(), X.cols());
  if (X.cols() == 1) {
    Y.noalias() = A.selfadjointView<Eigen::Lower>() * X;
    return Y;
  }
  const Eigen::Index panels = (X.cols() + 7) / 8;
  in_two(panels, A.nonZeros() > 100000, [&](Eigen::Index begin, Eigen::Index end, int) {
    Panel in(X.rows(), 8), out(X.rows(), 8);
    for (Eigen::Index p = begin; p < end; ++p) {
      pack(X, 8 * p, nullptr, in);
      out.setZero();
      panel_kernels().symmetric(A.cols(), A.outerIndexPtr(), A.innerIndexPtr(), A.valuePtr(), in.data(), out.data());
      unpack(out, 8 * p, nullptr, Y);
    }
  });
  return Y;
}

Eigen::VectorXd absolute_product(const fem::SparseMatrix& A, const Eigen::Ref<const Eigen::VectorXd>& x) {
  Eigen::VectorXd y = Eigen::VectorXd::Zero(A.rows());
  for (int j = 0; j < A.outerSize(); ++j)
    for (fem::SparseMatrix::InnerIterator it(A, j); it; ++it) {
      const double a = std::abs(it.value());
      y[it.row()] += a * std::abs(x[j]);
      if (it.row() != j) y[j] += a * std::abs(x[it.row()]);
    }
  return y;
}

fem::SparseMatrix shifted(const fem::SparseMatrix& K, const fem::SparseMatrix& M, double s) {
  const int n = static_cast<int>(K.rows());
  fem::SparseMatrix A(n, n);
  std::vector<int> start{0}, rows;
  std::vector<double> values;
  const auto entries = static_cast<std::size_t>(std::max(K.nonZeros(), M.nonZeros()));
  start.reserve(static_cast<std::size_t>(n) + 1);
  rows.reserve(entries);
  values.reserve(entries);
  for (int j = 0; j < n; ++j) {  // merge two sorted columns, the diagonal always there
    fem::SparseMatrix::InnerIterator k(K, j), m(M, j);
    if ((!k || k.row() != j) && (!m || m.row() != j)) {
      rows.push_back(j);
      values.push_back(0.0);
    }
    while (k || m) {
      const bool from_k = k && (!m || k.row() <= m.row()), from_m = m && (!k || m.row() <= k.row());
      rows.push_back(static_cast<int>(from_k ? k.row() : m.row()));
      values.push_back((from_k ? k.value() : 0.0) + (from_m ? s * m.value() : 0.0));
      if (from_k) ++k;
      if (from_m) ++m;
    }
    start.push_back(static_cast<int>(rows.size()));
  }
  A = Eigen::Map<const fem::SparseMatrix>(n, n, static_cast<Eigen::Index>(rows.size()), start.data(), rows.data(),
                                          values.data());
  return A;
}

fem::SparseMatrix principal(const fem::SparseMatrix& A, const std::vector<int>& keep) {
  std::vector<int> place(static_cast<std::size_t>(A.rows()), -1);
  for (std::size_t k = 0; k < keep.size(); ++k) place[static_cast<std::size_t>(keep[k])] = static_cast<int>(k);
  const auto n = static_cast<int>(keep.size());
  fem::SparseMatrix B(n, n);
  B.reserve(A.nonZeros());
  for (int j = 0; j < n; ++j) {
    B.startVec(j);
    for (fem::SparseMatrix::InnerIterator it(A, keep[static_cast<std::size_t>(j)]); it; ++it)
      if (const int i = place[static_cast<std::size_t>(it.row())]; i >= 0) B.insertBack(i, j) = it.value();
  }
  B.finalize();
  return B;
}

}  // namespace tenon::reduction
