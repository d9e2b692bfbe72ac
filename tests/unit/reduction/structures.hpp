#pragma once

#include <Eigen/SparseCore>
#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include "fem/structure.hpp"

/// Structures written by hand, element by element, for tests whose expected values are closed forms.
namespace tenon::tests {

using fem::SparseMatrix;
using Triplets = std::vector<Eigen::Triplet<double>>;

inline SparseMatrix lower(int n, const Triplets& entries) {
  Triplets kept;
  for (const auto& t : entries)
    if (t.row() >= t.col()) kept.push_back(t);
  SparseMatrix A(n, n);
  A.setFromTriplets(kept.begin(), kept.end());
  A.makeCompressed();
  return A;
}

inline SparseMatrix lower(const Eigen::MatrixXd& A) {
  Triplets entries;
  for (int i = 0; i < A.rows(); ++i)
    for (int j = 0; j <= i; ++j)
      if (A(i, j) != 0.0) entries.emplace_back(i, j, A(i, j));
  return lower(static_cast<int>(A.rows()), entries);
}

struct Pencil {
  SparseMatrix K, M;
};

/// Chain of masses; spring k[i] joins mass i−1 to mass i, k[0] the ground to mass 0, k[n] mass n−1 to the ground (0:
/// free).
inline Pencil chain(const std::vector<double>& k, const std::vector<double>& m) {
  const int n = static_cast<int>(m.size());
  Triplets K, M;
  for (int i = 0; i < n; ++i) {
    const auto u = static_cast<std::size_t>(i);
    K.emplace_back(i, i, k[u] + k[u + 1]);
    if (i > 0) K.emplace_back(i, i - 1, -k[u]);
    M.emplace_back(i, i, m[u]);
  }
  return {lower(n, K), lower(n, M)};
}

/// n equal masses and springs; the ends fixed or free.
inline Pencil uniform_chain(int n, double k, double m, bool fixed_start, bool fixed_end) {
  std::vector<double> springs(static_cast<std::size_t>(n) + 1, k);
  if (!fixed_start) springs.front() = 0.0;
  if (!fixed_end) springs.back() = 0.0;
  return chain(springs, std::vector<double>(static_cast<std::size_t>(n), m));
}

/// −∇² by five points on an nx×ny grid with all edges held, unit masses; eigenvalues 4 sin²(iπ/2(nx+1)) + 4
/// sin²(jπ/2(ny+1)).
inline Pencil grid(int nx, int ny) {
  Triplets K, M;
  for (int i = 0; i < nx; ++i)
    for (int j = 0; j < ny; ++j) {
      const int r = i * ny + j;
      K.emplace_back(r, r, 4.0);
      if (j > 0) K.emplace_back(r, r - 1, -1.0);
      if (i > 0) K.emplace_back(r, r - ny, -1.0);
      M.emplace_back(r, r, 1.0);
    }
  return {lower(nx * ny, K), lower(nx * ny, M)};
}

inline std::vector<double> grid_eigenvalues(int nx, int ny) {
  std::vector<double> all;
  const auto one = [](int i, int n) {
    const double s = std::sin(i * std::numbers::pi / (2.0 * (n + 1)));
    return 4.0 * s * s;
  };
  for (int i = 1; i <= nx; ++i)
    for (int j = 1; j <= ny; ++j) all.push_back(one(i, nx) + one(j, ny));
  std::sort(all.begin(), all.end());
  return all;
}

/// Independent copies of a pencil on the diagonal: every eigenvalue repeated.
inline Pencil repeated(const Pencil& one, int copies) {
  const int n = static_cast<int>(one.K.rows());
  Triplets K, M;
  for (int c = 0; c < copies; ++c)
    for (int j = 0; j < n; ++j) {
      for (SparseMatrix::InnerIterator it(one.K, j); it; ++it)
        K.emplace_back(c * n + static_cast<int>(it.row()), c * n + j, it.value());
      for (SparseMatrix::InnerIterator it(one.M, j); it; ++it)
        M.emplace_back(c * n + static_cast<int>(it.row()), c * n + j, it.value());
    }
  return {lower(copies * n, K), lower(copies * n, M)};
}

}  // namespace tenon::tests
