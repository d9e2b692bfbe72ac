#include "fem/formats/matrices/symmetric.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <numeric>
#include <tuple>
#include <utility>

#include "fem/error.hpp"

namespace tenon::fem::matrices {

std::string to_string(const MatrixRow& row) {
  constexpr std::array<const char*, 6> directions{"ux", "uy", "uz", "rx", "ry", "rz"};
  if (row.scalar) return fmt::format("scalar point {}", row.node);
  return fmt::format("node {} {}", row.node, directions.at(static_cast<std::size_t>(row.direction)));
}

namespace {

/// Sorts one column by its keys.
void sort_column(int* keys, double* values, int count, std::vector<std::pair<int, double>>& scratch) {
  if (std::is_sorted(keys, keys + count)) return;
  scratch.clear();
  for (int i = 0; i < count; ++i) scratch.emplace_back(keys[i], values[i]);
  std::ranges::sort(scratch, {}, &std::pair<int, double>::first);
  for (int i = 0; i < count; ++i) std::tie(keys[i], values[i]) = scratch[static_cast<std::size_t>(i)];
}

}  // namespace

std::variant<SparseMatrix, Asymmetry> lower_triangle(Eigen::Index n, std::vector<Entry> entries, Stored stored,
                                                     double tolerance) {
  assert(n < 1 << 30);
  std::vector<double> largest(static_cast<std::size_t>(n), 0.0);
  SparseMatrix A(n, n);
  int* const start = A.outerIndexPtr();
  for (const Entry& e : entries) {
    for (const int i : {e.row(), e.col()}) {
      double& value = largest[static_cast<std::size_t>(i)];
      value = std::max(value, std::abs(e.value()));
    }
    ++start[std::min(e.row(), e.col()) + 1];
  }
  std::partial_sum(start, start + n + 1, start);

  // columns of the lower triangle; a row's key is twice its number, one more for an entry of the upper triangle
  A.resizeNonZeros(static_cast<Eigen::Index>(entries.size()));
  int* const keys = A.innerIndexPtr();
  double* const values = A.valuePtr();
  std::vector<int> next(start, start + n);
  for (const Entry& e : entries) {
    const int at = next[static_cast<std::size_t>(std::min(e.row(), e.col()))]++;
    keys[at] = 2 * std::max(e.row(), e.col()) + (e.row() < e.col() ? 1 : 0);
    values[at] = e.value();
  }
  std::vector<Entry>().swap(entries);

  Asymmetry worst;
  double gap = tolerance;
  int kept = 0;  // what is kept replaces what is done
  std::vector<std::pair<int, double>> scratch;
  for (int column = 0, begin = 0; column < n; ++column) {
    const int end = start[column + 1];
    sort_column(keys + begin, values + begin, end - begin, scratch);
    for (int i = begin; i < end; ++i) {
      const int row = keys[i] / 2;
      const bool upper = keys[i] % 2 != 0, pair = i + 1 < end && keys[i + 1] / 2 == row;
      if (pair && (keys[i + 1] == keys[i] || stored == Stored::one))
        return Asymmetry{true, upper ? column : row, upper ? row : column, values[i], values[i + 1]};
      if (pair && i + 2 < end && keys[i + 2] == keys[i + 1])  // once below the diagonal, twice above it
        return Asymmetry{true, column, row, values[i + 1], values[i + 2]};
      const double a = values[i], b = pair ? values[++i] : row == column || stored != Stored::both ? a : 0.0;
      const double scale = std::max(largest[static_cast<std::size_t>(row)], largest[static_cast<std::size_t>(column)]);
      if (std::abs(a - b) > gap * scale) {
        gap = std::abs(a - b) / scale;
        worst = {false, row, column, upper ? b : a, upper ? a : b};
      }
      const double mean = 0.5 * a + 0.5 * b;
      if (mean == 0.0) continue;
      keys[kept] = row;
      values[kept++] = mean;
    }
    begin = end;
    start[column + 1] = kept;
  }
  if (gap > tolerance) return worst;
  if (kept < A.data().size()) {
    A.resizeNonZeros(kept);
    A.data().squeeze();
  }
  return A;
}

SparseMatrix lower_triangle(const std::string& name, const std::string& file, const std::vector<MatrixRow>& rows,
                            std::vector<Entry> entries, Stored stored) {
  auto result = lower_triangle(static_cast<Eigen::Index>(rows.size()), std::move(entries), stored, 1e-6);
  const auto* const fault = std::get_if<Asymmetry>(&result);
  if (!fault) return std::move(std::get<SparseMatrix>(result));
  const std::string row = to_string(rows[static_cast<std::size_t>(fault->row)]),
                    column = to_string(rows[static_cast<std::size_t>(fault->column)]);
  if (fault->twice)
    throw InputError({file}, fmt::format("the entry ({}, {}) of {} stands twice", row, column, name),
                     "Write the matrix with each entry once");
  throw InputError(
      {file},
      fmt::format("{} is not symmetric: {} and {} have {} on one side of the diagonal and {} on the other", name, row,
                  column, fault->lower, fault->upper),
      "Only symmetric stiffness and mass matrices are read (no gyroscopic, follower or friction terms), whole or "
      "in the way their format defines");
}

SparseMatrix turned(const SparseMatrix& R, const SparseMatrix& lower) {
  const SparseMatrix whole = lower.selfadjointView<Eigen::Lower>();
  const SparseMatrix product = R * whole * SparseMatrix(R.transpose());
  SparseMatrix result = product.triangularView<Eigen::Lower>();
  result.makeCompressed();
  return result;
}

}  // namespace tenon::fem::matrices
