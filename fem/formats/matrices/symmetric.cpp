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
                            std::vector<Entry> entries, Stored stored) {
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
  const auto before = [&](const Entry& a, const Entry& b) {
    return key(a) != key(b) ? key(a) < key(b) : upper_half(a) < upper_half(b);
  };
  if (!std::ranges::is_sorted(entries, before)) std::ranges::sort(entries, before);
  std::size_t kept = 0;  // what is kept replaces what is done
  for (std::size_t i = 0; i < entries.size();) {
    const auto [row, column] = key(entries[i]);
    const bool pair = i + 1 < entries.size() && key(entries[i + 1]) == key(entries[i]);
    if ((pair && upper_half(entries[i]) == upper_half(entries[i + 1])) ||
        (pair && i + 2 < entries.size() && key(entries[i + 2]) == key(entries[i])))
      throw InputError(
          {file},
          fmt::format("the entry ({}, {}) of {} stands twice", label(entries[i].row()), label(entries[i].col()), name),
          "Write the matrix with each entry once");
    const double a = entries[i].value();
    const double b = pair ? entries[i + 1].value() : row == column || stored == Stored::either ? a : 0.0;
    const double scale = std::max(largest[static_cast<std::size_t>(row)], largest[static_cast<std::size_t>(column)]);
    if (!(std::abs(a - b) <= 1e-6 * scale))
      throw InputError(
          {file},
          fmt::format("{} is not symmetric: {} and {} have {} on one side of the diagonal and {} on the other", name,
                      label(row), label(column), a, b),
          "Only symmetric stiffness and mass matrices are read (no gyroscopic, follower or friction terms), whole or "
          "in the way their format defines");
    if (const double mean = 0.5 * a + 0.5 * b; mean != 0.0) entries[kept++] = {row, column, mean};
    i += pair ? 2 : 1;
  }
  const auto n = static_cast<Eigen::Index>(rows.size());
  SparseMatrix result(n, n);
  entries.resize(kept);
  result.setFromTriplets(entries.begin(), entries.end());
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
