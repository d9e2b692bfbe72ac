#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

namespace tenon::reduction {

/// Eight right-hand sides side by side: one row of a panel is one cache line, so a factor read once from memory serves
/// eight solves.
using Panel = Eigen::Matrix<double, Eigen::Dynamic, 8, Eigen::RowMajor>;

/// Columns first .. first + 8 of X (fewer at the end: zeros) as a panel; row k of it is row order[k] of X (order may be
/// null).
void pack(const Eigen::Ref<const Eigen::MatrixXd>& X, Eigen::Index first, const int* order, Panel& panel);
/// The inverse: row k of the panel becomes row order[k] of X.
void unpack(const Panel& panel, Eigen::Index first, const int* order, Eigen::Ref<Eigen::MatrixXd> X);

/// The shape of a supernodal Cholesky factor L: supernode s holds the columns first[s] .. first[s+1]; their common rows
/// are rows[row_start[s] .. row_start[s+1]), the columns themselves first; its values are a dense column-major block at
/// values[value_start[s]].
struct Supernodes {
  int n = 0;
  std::vector<int> first;
  std::vector<std::int64_t> row_start;
  std::vector<int> rows;
  std::vector<std::int64_t> value_start;

  int size() const { return static_cast<int>(first.size()) - 1; }
  int columns(int s) const { return first[static_cast<std::size_t>(s) + 1] - first[static_cast<std::size_t>(s)]; }
  int height(int s) const {
    return static_cast<int>(row_start[static_cast<std::size_t>(s) + 1] - row_start[static_cast<std::size_t>(s)]);
  }
};

/// Triangular solves with L for eight right-hand sides at once, on two threads when the elimination tree splits: each
/// thread takes whole subtrees, what they owe to the common ancestors is added up, and the ancestors follow.
class TriangularSolver {
 public:
  TriangularSolver() = default;
  /// `threads` 0: as many as the machine has, two at most.
  explicit TriangularSolver(Supernodes shape, int threads = 0);

  /// X ← L⁻¹ X. X has n rows; `values` are the factor's.
  void lower(const double* values, Panel& X) const;
  /// X ← L⁻ᵀ X.
  void upper(const double* values, Panel& X) const;

  const Supernodes& shape() const { return shape_; }
  /// Share of the work of the larger of the two threads in the subtrees, and of the common ancestors; for reports.
  double parallel_share() const { return parallel_share_; }

 private:
  void split();

  Supernodes shape_;
  std::vector<int> part_[2];   ///< supernodes of each thread, ascending
  std::vector<int> top_;       ///< the common ancestors, ascending
  std::vector<int> top_rows_;  ///< rows of the ancestors
  std::vector<int> top_slot_;  ///< for every row: its place among top_rows_, or −1
  std::int64_t longest_ = 0;   ///< rows of the tallest supernode
  double parallel_share_ = 0.0;
};

}  // namespace tenon::reduction
