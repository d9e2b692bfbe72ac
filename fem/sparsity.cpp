#include "fem/sparsity.hpp"

#include <fmt/format.h>
#include <omp.h>

#include <algorithm>
#include <limits>
#include <numeric>

#include "fem/error.hpp"

namespace tenon::fem {
namespace {

/// Transpose of element → dofs: the elements that move each dof.
ElementDofs elements_of_dofs(const ElementDofs& elements, int n) {
  ElementDofs of_dof;
  of_dof.start.assign(static_cast<std::size_t>(n) + 1, 0);
  for (const int dof : elements.dofs) ++of_dof.start[static_cast<std::size_t>(dof) + 1];
  for (std::size_t i = 1; i < of_dof.start.size(); ++i) of_dof.start[i] += of_dof.start[i - 1];
  of_dof.dofs.resize(elements.dofs.size());
  std::vector<int> next(of_dof.start.begin(), of_dof.start.end() - 1);
  for (std::size_t e = 0; e < elements.size(); ++e)
    for (const int dof : elements.of(e))
      of_dof.dofs[static_cast<std::size_t>(next[static_cast<std::size_t>(dof)]++)] = static_cast<int>(e);
  return of_dof;
}

/// The rows of the lower triangle, column after column.
class ColumnRows {
 public:
  ColumnRows(const ElementDofs& elements, const ElementDofs& of_dof)
      : elements_(elements), of_dof_(of_dof), marked_(of_dof.size(), -1) {}

  /// Rows j and below of column j, rising.
  std::span<const int> of(int j) {
    const auto column = static_cast<std::size_t>(j);
    const bool same_elements =  // dofs of one node share their neighbours
        j > 0 && last_ == j - 1 && std::ranges::equal(of_dof_.of(column), of_dof_.of(column - 1));
    if (!same_elements) gather(j);
    last_ = j;
    auto lower = std::lower_bound(neighbours_.begin(), neighbours_.end(), j);
    if (lower == neighbours_.end() || *lower != j) lower = neighbours_.insert(lower, j);
    return {lower, neighbours_.end()};
  }

 private:
  void gather(int j) {
    neighbours_.clear();
    for (const int e : of_dof_.of(static_cast<std::size_t>(j)))
      for (const int i : elements_.of(static_cast<std::size_t>(e)))
        if (marked_[static_cast<std::size_t>(i)] != j) {
          marked_[static_cast<std::size_t>(i)] = j;
          neighbours_.push_back(i);
        }
    std::sort(neighbours_.begin(), neighbours_.end());
  }

  const ElementDofs& elements_;
  const ElementDofs& of_dof_;
  std::vector<int> marked_, neighbours_;
  int last_ = -1;
};

/// Calls each(j) for all columns, every thread with a run of neighbouring ones, after make() has made it a `each`.
template <class Make>
void for_columns(int n, Make make) {
#pragma omp parallel
  {
    const long thread = omp_get_thread_num(), threads = omp_get_num_threads();
    auto each = make();
    for (long j = n * thread / threads; j < n * (thread + 1) / threads; ++j) each(static_cast<int>(j));
  }
}

/// Column-major order, terms of one entry summed in the order they came in.
void sum_by_entry(std::vector<Eigen::Triplet<double>>& terms) {
  std::ranges::stable_sort(
      terms, [](const auto& a, const auto& b) { return a.col() != b.col() ? a.col() < b.col() : a.row() < b.row(); });
  std::size_t kept = 0;
  for (const auto& t : terms) {
    if (kept > 0 && terms[kept - 1].row() == t.row() && terms[kept - 1].col() == t.col())
      terms[kept - 1] = {t.row(), t.col(), terms[kept - 1].value() + t.value()};
    else
      terms[kept++] = t;
  }
  terms.resize(kept);
}

/// Those of column j, once summed by entry.
std::span<const Eigen::Triplet<double>> of_column(const Beside& beside, int j) {
  const auto& strip = beside[static_cast<std::size_t>(j / columns_of_strip)];
  const auto column = [](const auto& t) { return t.col(); };
  return {std::ranges::lower_bound(strip, j, {}, column), std::ranges::upper_bound(strip, j, {}, column)};
}

}  // namespace

int LowerTriangle::position(int i, int j, int from) const {
  const auto column = static_cast<std::size_t>(j);
  const int *const begin = row.data() + std::max(from, start[column]), *const end = row.data() + start[column + 1];
  const int* const at = std::lower_bound(begin, end, i);
  return at != end && *at == i ? static_cast<int>(at - row.data()) : -1;
}

LowerTriangle lower_zeros(const ElementDofs& elements, int n) {
  const ElementDofs of_dof = elements_of_dofs(elements, n);
  LowerTriangle A;
  A.start.assign(static_cast<std::size_t>(n) + 1, 0);
  for_columns(n, [&] {  // first count, then fill: the arrays are allocated once, at their size
    return [&A, rows = ColumnRows(elements, of_dof)](int j) mutable {
      A.start[static_cast<std::size_t>(j) + 1] = static_cast<int>(rows.of(j).size());
    };
  });
  const long entries = std::accumulate(A.start.begin(), A.start.end(), 0L);
  if (entries > std::numeric_limits<int>::max())
    throw NumericalError("the stiffness matrix has more entries than 32-bit indices can number",
                         static_cast<double>(entries),
                         "Use a coarser mesh, or cut the body in two and join the parts by ports");
  std::partial_sum(A.start.begin(), A.start.end(), A.start.begin());
  A.row.resize(entries);
  A.value.resize(entries);
  for_columns(n, [&] {
    return [&A, rows = ColumnRows(elements, of_dof)](int j) mutable {
      const int at = A.start[static_cast<std::size_t>(j)];
      const std::span<const int> of_j = rows.of(j);
      std::ranges::copy(of_j, A.row.data() + at);
      std::fill_n(A.value.data() + at, of_j.size(), 0.0);
    };
  });
  return A;
}

LowerTriangle zeros_of_pattern(const SparseMatrix& A) {
  LowerTriangle zeros;
  const int *const outer = A.outerIndexPtr(), *const inner = A.innerIndexPtr();
  zeros.start.assign(outer, outer + A.cols() + 1);
  zeros.row.resize(A.nonZeros());
  zeros.value.resize(A.nonZeros());
  for_columns(static_cast<int>(A.cols()), [&] {
    return [&](int j) {
      std::copy(inner + outer[j], inner + outer[j + 1], zeros.row.data() + outer[j]);
      std::fill(zeros.value.data() + outer[j], zeros.value.data() + outer[j + 1], 0.0);
    };
  });
  return zeros;
}

Eigen::VectorXd diagonal(const SparseMatrix& lower) {
  const int *const outer = lower.outerIndexPtr(), *const inner = lower.innerIndexPtr();
  Eigen::VectorXd d(lower.cols());
#pragma omp parallel for schedule(static)
  for (int j = 0; j < static_cast<int>(lower.cols()); ++j)  // the first entry of its column, if any
    d(j) = outer[j] < outer[j + 1] && inner[outer[j]] == j ? lower.valuePtr()[outer[j]] : 0.0;
  return d;
}

SparseMatrix without_zeros(LowerTriangle A, Beside beside) {
  const int n = static_cast<int>(A.start.size()) - 1;
#pragma omp parallel for schedule(dynamic)
  for (auto& strip : beside) sum_by_entry(strip);
  SparseMatrix result(n, n);
  int* const outer = result.outerIndexPtr();
  const auto range = [&](int j) {
    return std::pair(A.start[static_cast<std::size_t>(j)], A.start[static_cast<std::size_t>(j) + 1]);
  };
  for_columns(n, [&] {
    return [&](int j) {
      const auto [from, to] = range(j);
      const auto kept = std::count_if(A.value.data() + from, A.value.data() + to, [](double v) { return v != 0.0; });
      outer[j + 1] = static_cast<int>(kept) + static_cast<int>(of_column(beside, j).size());
    };
  });
  std::partial_sum(outer, outer + n + 1, outer);
  result.resizeNonZeros(outer[n]);
  int* const row = result.innerIndexPtr();
  for_columns(n, [&] {
    return [&](int j) {
      const auto [from, to] = range(j);
      int* end = row + outer[j];
      for (int t = from; t < to; ++t)
        if (A.value[t] != 0.0) *end++ = A.row[t];
      for (const auto& t : of_column(beside, j)) *end++ = t.row();
      if (!of_column(beside, j).empty()) std::sort(row + outer[j], end);
    };
  });
  A.row = {};
  double* const value = result.valuePtr();
  for_columns(n, [&] {
    return [&](int j) {
      int from = range(j).first;
      auto next = of_column(beside, j).begin();
      const auto last = of_column(beside, j).end();
      for (int t = outer[j]; t < outer[j + 1]; ++t) {
        if (next != last && next->row() == row[t]) {
          value[t] = (next++)->value();
          continue;
        }
        while (A.value[from] == 0.0) ++from;
        value[t] = A.value[from++];
      }
    };
  });
  return result;
}

}  // namespace tenon::fem
