#include "reduction/shift_invert.hpp"

#include <algorithm>
#include <thread>

namespace tenon::reduction {

ShiftInvert::ShiftInvert(const Factor& factor, const fem::SparseMatrix& M) : factor_(factor) {
  Eigen::PermutationMatrix<Eigen::Dynamic> P(factor.n());  // P.indices()[row] = place
  for (int k = 0; k < factor.n(); ++k) P.indices()[factor.permutation()[static_cast<std::size_t>(k)]] = k;
  M_.resize(M.rows(), M.cols());
  fem::SparseMatrix permuted(M.rows(), M.cols());
  permuted = M.selfadjointView<Eigen::Lower>().twistedBy(P);
  M_ = permuted;
}

void ShiftInvert::multiply(const Panel& X, Panel& Y) const {
  const auto rows_between = [&](Eigen::Index begin, Eigen::Index end) {
    for (Eigen::Index i = begin; i < end; ++i) {
      Eigen::Matrix<double, 1, 8> sum = Eigen::Matrix<double, 1, 8>::Zero();
      for (Eigen::SparseMatrix<double, Eigen::RowMajor>::InnerIterator it(M_, i); it; ++it)
        sum += it.value() * X.row(it.col());
      Y.row(i) = sum;
    }
  };
  const Eigen::Index n = M_.rows();
  if (M_.nonZeros() < 500000 || std::thread::hardware_concurrency() < 2) {
    rows_between(0, n);
    return;
  }
  std::thread second(rows_between, n / 2, n);
  rows_between(0, n / 2);
  second.join();
}

void ShiftInvert::apply(const Eigen::Ref<const Eigen::MatrixXd>& X, Eigen::Ref<Eigen::MatrixXd> Y) const {
  const Eigen::Index n = rows();
  Panel panel(n, 8), image(n, 8);
  for (Eigen::Index c = 0; c < X.cols(); c += 8) {
    const Eigen::Index width = std::min<Eigen::Index>(8, X.cols() - c);
    if (width < 8) panel.setZero();
    for (Eigen::Index k = 0; k < n; ++k)
      for (Eigen::Index j = 0; j < width; ++j) panel(k, j) = X(k, c + j);
    factor_.upper(panel);    // L⁻ᵀ
    multiply(panel, image);  // P M Pᵀ
    factor_.lower(image);    // L⁻¹
    for (Eigen::Index k = 0; k < n; ++k)
      for (Eigen::Index j = 0; j < width; ++j) Y(k, c + j) = image(k, j);
  }
}

void ShiftInvert::perform_op(const double* x, double* y) const {
  apply(Eigen::Map<const Eigen::MatrixXd>(x, rows(), 1), Eigen::Map<Eigen::MatrixXd>(y, rows(), 1));
}

}  // namespace tenon::reduction
