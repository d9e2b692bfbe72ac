#include "reduction/shift_invert.hpp"

#include "reduction/panel_kernels.hpp"
#include "reduction/two_threads.hpp"

namespace tenon::reduction {

ShiftInvert::ShiftInvert(const Factor& factor, const fem::SparseMatrix& M) : factor_(factor) {
  const auto n = static_cast<std::size_t>(factor.n());
  std::vector<int> place(n);
  for (std::size_t k = 0; k < n; ++k) place[static_cast<std::size_t>(factor.permutation()[k])] = static_cast<int>(k);
  const auto each = [&](const auto& visit) {  // every entry of P M Pᵀ, both triangles
    for (int j = 0; j < M.outerSize(); ++j)
      for (fem::SparseMatrix::InnerIterator it(M, j); it; ++it) {
        const int r = place[static_cast<std::size_t>(it.row())], c = place[static_cast<std::size_t>(j)];
        visit(r, c, it.value());
        if (r != c) visit(c, r, it.value());
      }
  };
  start_.assign(n + 1, 0);
  each([&](int r, int, double) { ++start_[static_cast<std::size_t>(r) + 1]; });
  for (std::size_t k = 0; k < n; ++k) start_[k + 1] += start_[k];
  column_.resize(static_cast<std::size_t>(start_[n]));
  value_.resize(column_.size());
  std::vector<int> next(start_.begin(), start_.end() - 1);
  each([&](int r, int c, double value) {
    const auto t = static_cast<std::size_t>(next[static_cast<std::size_t>(r)]++);
    column_[t] = c;
    value_[t] = value;
  });
}

void ShiftInvert::multiply(const Panel& X, Panel& Y) const {
  in_two(rows(), value_.size() > 500000, [&](Eigen::Index begin, Eigen::Index end, int) {
    panel_kernels().rows(start_.data(), column_.data(), value_.data(), begin, end, X.data(), Y.data());
  });
}

void ShiftInvert::apply(const Eigen::Ref<const Eigen::MatrixXd>& X, Eigen::Ref<Eigen::MatrixXd> Y) const {
  Panel panel(rows(), 8), image(rows(), 8);
  for (Eigen::Index c = 0; c < X.cols(); c += 8) {
    pack(X, c, nullptr, panel);
    factor_.upper(panel);    // L⁻ᵀ
    multiply(panel, image);  // P M Pᵀ
    factor_.lower(image);    // L⁻¹
    unpack(image, c, nullptr, Y);
  }
}

void ShiftInvert::perform_op(const double* x, double* y) const {
  apply(Eigen::Map<const Eigen::MatrixXd>(x, rows(), 1), Eigen::Map<Eigen::MatrixXd>(y, rows(), 1));
}

}  // namespace tenon::reduction
