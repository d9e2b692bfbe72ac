#include "fem/formats/matrices/symmetric.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "fem/error.hpp"

namespace tenon::fem::matrices {

std::string to_string(const MatrixRow& row) {
  constexpr std::array<const char*, 6> directions{"ux", "uy", "uz", "rx", "ry", "rz"};
  if (row.scalar) return fmt::format("scalar point {}", row.node);
  return fmt::format("node {} {}", row.node, directions.at(static_cast<std::size_t>(row.direction)));
}

SparseMatrix lower_triangle(const std::string& name, const std::string& file, const std::vector<MatrixRow>& rows,
                            const std::vector<Entry>& entries, Stored stored) {
  const auto label = [&](int i) { return to_string(rows[static_cast<std::size_t>(i)]); };
  const auto upper_half = [](const Entry& e) { return e.row() < e.col(); };
  const auto key = [](const Entry& e) { return std::pair(std::max(e.row(), e.col()), std::min(e.row(), e.col())); };

  std::vector<double> largest(rows.size(), 0.0);
  for (const Entry& e : entries)
    for (const int i : {e.row(), e.col()}) {
      double& value = largest[static_cast<std::size_t>(i)];
      value = std::max(value, std::abs(e.value()));
    }

  // the two entries of a pair side by side, the lower one first
  std::vector<Entry> sorted = entries;
  std::ranges::sort(sorted, [&](const Entry& a, const Entry& b) {
    return key(a) != key(b) ? key(a) < key(b) : upper_half(a) < upper_half(b);
  });
  std::vector<Entry> lower;
  lower.reserve(sorted.size());
  for (std::size_t i = 0; i < sorted.size();) {
    const auto [row, column] = key(sorted[i]);
    const bool pair = i + 1 < sorted.size() && key(sorted[i + 1]) == key(sorted[i]);
    if ((pair && upper_half(sorted[i]) == upper_half(sorted[i + 1])) ||
        (pair && i + 2 < sorted.size() && key(sorted[i + 2]) == key(sorted[i])))
      throw InputError(
          {file},
          fmt::format("the entry ({}, {}) of {} stands twice", label(sorted[i].row()), label(sorted[i].col()), name),
          "Write the matrix with each entry once");
    const double a = sorted[i].value();
    const double b = pair ? sorted[i + 1].value() : row == column || stored == Stored::either ? a : 0.0;
    const double scale = std::max(largest[static_cast<std::size_t>(row)], largest[static_cast<std::size_t>(column)]);
    if (!(std::abs(a - b) <= 1e-6 * scale))
      throw InputError(
          {file},
          fmt::format("{} is not symmetric: {} and {} have {} on one side of the diagonal and {} on the other", name,
                      label(row), label(column), a, b),
          "Only symmetric stiffness and mass matrices are read (no gyroscopic, follower or friction terms), whole or "
          "in the way their format defines");
    if (const double mean = 0.5 * a + 0.5 * b; mean != 0.0) lower.emplace_back(row, column, mean);
    i += pair ? 2 : 1;
  }
  const auto n = static_cast<Eigen::Index>(rows.size());
  SparseMatrix result(n, n);
  result.setFromTriplets(lower.begin(), lower.end());
  return result;
}

SparseMatrix turned(const SparseMatrix& R, const SparseMatrix& lower) {
  const SparseMatrix whole = lower.selfadjointView<Eigen::Lower>();
  const SparseMatrix product = R * whole * SparseMatrix(R.transpose());
  SparseMatrix result = product.triangularView<Eigen::Lower>();
  result.makeCompressed();
  return result;
}

}  // namespace tenon::fem::matrices
