#include "reduction/supernodal.hpp"

#include <algorithm>
#include <queue>
#include <thread>

#include "reduction/panel_kernels.hpp"
#include "reduction/two_threads.hpp"

namespace tenon::reduction {

namespace {

constexpr Eigen::Index worth_packing = 20000;  // rows
constexpr double worth_a_thread = 2e6;         // entries of L below which starting a thread costs more than it saves

// working rows, on the heap once a solve
class Scratch {
 public:
  explicit Scratch(std::int64_t rows) : values_(static_cast<std::size_t>(8 * rows), 0.0) {}
  double* data() { return values_.data(); }

 private:
  std::vector<double> values_;
};

// where a thread finds row i: in X, or (ancestors' rows, second thread) in its own accumulator
struct Rows {
  double* X;
  double* own = nullptr;
  const int* slot = nullptr;
  double* operator()(int i) const {
    if (own != nullptr && slot[i] >= 0) return own + 8 * static_cast<std::int64_t>(slot[i]);
    return X + 8 * static_cast<std::int64_t>(i);
  }
};

void copy8(const double* from, double* to) { std::copy_n(from, 8, to); }
void add8(const double* from, double* to) {
  for (int k = 0; k < 8; ++k) to[k] += from[k];
}

void lower_sweep(const Supernodes& f, const double* values, const std::vector<int>& list, const Rows& at, Scratch& y) {
  const PanelKernels& kernel = panel_kernels();
  for (const int s : list) {
    const std::int64_t height = f.height(s), columns = f.columns(s);
    const int* rows = f.rows.data() + f.row_start[static_cast<std::size_t>(s)];
    double* head = at(rows[0]);
    copy8(head, y.data());
    for (std::int64_t k = 1; k < columns; ++k) copy8(head + 8 * k, y.data() + 8 * k);
    std::fill(y.data() + 8 * columns, y.data() + 8 * height, 0.0);
    kernel.lower(values + f.value_start[static_cast<std::size_t>(s)], height, columns, y.data());
    std::copy_n(y.data(), 8 * columns, head);
    for (std::int64_t k = columns; k < height; ++k) add8(y.data() + 8 * k, at(rows[k]));
  }
}

void upper_sweep(const Supernodes& f, const double* values, const std::vector<int>& list, double* X, Scratch& y) {
  const PanelKernels& kernel = panel_kernels();
  for (auto it = list.rbegin(); it != list.rend(); ++it) {
    const int s = *it;
    const std::int64_t height = f.height(s), columns = f.columns(s);
    const int* rows = f.rows.data() + f.row_start[static_cast<std::size_t>(s)];
    for (std::int64_t k = 0; k < height; ++k) copy8(X + 8 * static_cast<std::int64_t>(rows[k]), y.data() + 8 * k);
    kernel.upper(values + f.value_start[static_cast<std::size_t>(s)], height, columns, y.data());
    std::copy_n(y.data(), 8 * columns, X + 8 * static_cast<std::int64_t>(rows[0]));
  }
}

}  // namespace

void pack(const Eigen::Ref<const Eigen::MatrixXd>& X, Eigen::Index first, const int* order, Panel& panel) {
  const Eigen::Index width = std::min<Eigen::Index>(8, X.cols() - first);
  if (width < 8) panel.setZero();
  in_two(panel.rows(), panel.rows() > worth_packing, [&](Eigen::Index begin, Eigen::Index end, int) {
    for (Eigen::Index k = begin; k < end; ++k)
      for (Eigen::Index j = 0; j < width; ++j) panel(k, j) = X(order == nullptr ? k : order[k], first + j);
  });
}

void unpack(const Panel& panel, Eigen::Index first, const int* order, Eigen::Ref<Eigen::MatrixXd> X) {
  const Eigen::Index width = std::min<Eigen::Index>(8, X.cols() - first);
  in_two(panel.rows(), panel.rows() > worth_packing, [&](Eigen::Index begin, Eigen::Index end, int) {
    for (Eigen::Index k = begin; k < end; ++k)
      for (Eigen::Index j = 0; j < width; ++j) X(order == nullptr ? k : order[k], first + j) = panel(k, j);
  });
}

TriangularSolver::TriangularSolver(Supernodes shape, int threads) : shape_(std::move(shape)) {
  for (int s = 0; s < shape_.size(); ++s) longest_ = std::max<std::int64_t>(longest_, shape_.height(s));
  if (threads == 0) threads = static_cast<int>(std::min(2u, std::max(1u, std::thread::hardware_concurrency())));
  if (threads > 1)
    split();
  else
    for (int s = 0; s < shape_.size(); ++s) top_.push_back(s);
}

// Subtrees to two threads: the heaviest open subtree is opened (its root joins the common top) until the largest is a
// small part of all, then subtrees go to the lighter thread, heaviest first.
void TriangularSolver::split() {
  const int count = shape_.size();
  std::vector<int> parent(static_cast<std::size_t>(count), -1), owner(static_cast<std::size_t>(shape_.n));
  std::vector<double> work(static_cast<std::size_t>(count));
  for (int s = 0; s < count; ++s)
    for (int c = shape_.first[static_cast<std::size_t>(s)]; c < shape_.first[static_cast<std::size_t>(s) + 1]; ++c)
      owner[static_cast<std::size_t>(c)] = s;
  std::vector<std::vector<int>> children(static_cast<std::size_t>(count));
  double total = 0.0;
  std::vector<int> roots;
  for (int s = 0; s < count; ++s) {  // children come before their parents
    const auto u = static_cast<std::size_t>(s);
    const double own = static_cast<double>(shape_.height(s)) * shape_.columns(s);
    work[u] += own;
    total += own;
    if (shape_.height(s) > shape_.columns(s)) {
      parent[u] = owner[static_cast<std::size_t>(
          shape_.rows[static_cast<std::size_t>(shape_.row_start[u] + shape_.columns(s))])];
      work[static_cast<std::size_t>(parent[u])] += work[u];
      children[static_cast<std::size_t>(parent[u])].push_back(s);
    } else {
      roots.push_back(s);
    }
  }
  std::vector<int> assignment(static_cast<std::size_t>(count), 2);  // 0, 1: thread; 2: common top
  if (total < worth_a_thread) {
    for (int s = 0; s < count; ++s) top_.push_back(s);
    return;
  }
  const auto lighter = [&](int a, int b) {
    return work[static_cast<std::size_t>(a)] < work[static_cast<std::size_t>(b)];
  };
  std::priority_queue<int, std::vector<int>, decltype(lighter)> open(lighter, std::move(roots));
  while (!open.empty() && work[static_cast<std::size_t>(open.top())] > 0.1 * total) {
    const int s = open.top();
    open.pop();
    for (const int child : children[static_cast<std::size_t>(s)]) open.push(child);
  }
  double load[2] = {0.0, 0.0};
  while (!open.empty()) {
    const int s = open.top();
    open.pop();
    const int thread = load[1] < load[0] ? 1 : 0;
    load[thread] += work[static_cast<std::size_t>(s)];
    assignment[static_cast<std::size_t>(s)] = thread;
  }
  for (int s = count - 1; s >= 0; --s) {  // descendants follow the root of their subtree
    const int p = parent[static_cast<std::size_t>(s)];
    if (p >= 0 && assignment[static_cast<std::size_t>(p)] != 2)
      assignment[static_cast<std::size_t>(s)] = assignment[static_cast<std::size_t>(p)];
  }
  top_slot_.assign(static_cast<std::size_t>(shape_.n), -1);
  for (int s = 0; s < count; ++s) {
    const int a = assignment[static_cast<std::size_t>(s)];
    (a == 2 ? top_ : part_[a]).push_back(s);
    if (a != 2) continue;
    for (int c = shape_.first[static_cast<std::size_t>(s)]; c < shape_.first[static_cast<std::size_t>(s) + 1]; ++c) {
      top_slot_[static_cast<std::size_t>(c)] = static_cast<int>(top_rows_.size());
      top_rows_.push_back(c);
    }
  }
  parallel_share_ = std::min(load[0], load[1]) / total;
}

void TriangularSolver::lower(const double* values, Panel& X) const {
  Scratch y(longest_);
  Scratch own(part_[1].empty() ? 0 : static_cast<std::int64_t>(top_rows_.size()));  // what the second part owes the top
  both(
      !part_[1].empty(), [&] { lower_sweep(shape_, values, part_[0], {X.data()}, y); },
      [&] {
        Scratch z(longest_);
        lower_sweep(shape_, values, part_[1], {X.data(), own.data(), top_slot_.data()}, z);
      });
  for (std::size_t k = 0; k < top_rows_.size() && !part_[1].empty(); ++k)
    add8(own.data() + 8 * k, X.data() + 8 * static_cast<std::int64_t>(top_rows_[k]));
  lower_sweep(shape_, values, top_, {X.data()}, y);
}

void TriangularSolver::upper(const double* values, Panel& X) const {
  Scratch y(longest_);
  upper_sweep(shape_, values, top_, X.data(), y);
  both(
      !part_[1].empty(), [&] { upper_sweep(shape_, values, part_[0], X.data(), y); },
      [&] {
        Scratch z(longest_);
        upper_sweep(shape_, values, part_[1], X.data(), z);
      });
}

}  // namespace tenon::reduction
