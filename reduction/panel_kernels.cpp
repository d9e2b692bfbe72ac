#include "reduction/panel_kernels.hpp"

// One source for three instruction sets: V is a vector of doubles, pieces<V> of which make a row of a panel; J columns
// are taken together, so that their J rows of unknowns stay in registers while the long side streams by.
#define TENON_INLINE inline __attribute__((always_inline))

namespace tenon::reduction {

namespace {

// wrapped in a struct, for a template argument would lose the attribute
struct Vector8 {
  typedef double type __attribute__((vector_size(64)));
};
struct Vector4 {
  typedef double type __attribute__((vector_size(32)));
};
struct Vector2 {
  typedef double type __attribute__((vector_size(16)));
};

template <class V>
inline constexpr int pieces = 64 / static_cast<int>(sizeof(typename V::type));

// A row of a panel in registers; loads and stores need no alignment.
template <class V>
struct Row {
  typename V::type v[pieces<V>];

  TENON_INLINE void load(const double* p) { __builtin_memcpy(v, p, 64); }
  TENON_INLINE void store(double* p) const { __builtin_memcpy(p, v, 64); }
  TENON_INLINE void add(double a, const Row& x) {
    for (int p = 0; p < pieces<V>; ++p) v[p] += a * x.v[p];
  }
  TENON_INLINE void subtract(double a, const Row& x) {
    for (int p = 0; p < pieces<V>; ++p) v[p] -= a * x.v[p];
  }
};

// y_i ← y_i − Σ_k L_ik x_k for J columns
template <class V, int J>
TENON_INLINE void push(const double* L, std::int64_t ld, std::int64_t rows, const double* x, double* y) {
  Row<V> xs[J];
  for (int k = 0; k < J; ++k) xs[k].load(x + 8 * k);
  for (std::int64_t i = 0; i < rows; ++i) {
    Row<V> sum;
    sum.load(y + 8 * i);
    for (int k = 0; k < J; ++k) sum.subtract(L[k * ld + i], xs[k]);
    sum.store(y + 8 * i);
  }
}

// x_k ← x_k − Σ_i L_ik y_i for J columns
template <class V, int J>
TENON_INLINE void pull(const double* L, std::int64_t ld, std::int64_t rows, const double* y, double* x) {
  Row<V> xs[J];
  for (int k = 0; k < J; ++k) xs[k].load(x + 8 * k);
  for (std::int64_t i = 0; i < rows; ++i) {
    Row<V> yi;
    yi.load(y + 8 * i);
    for (int k = 0; k < J; ++k) xs[k].subtract(L[k * ld + i], yi);
  }
  for (int k = 0; k < J; ++k) xs[k].store(x + 8 * k);
}

template <class V>
TENON_INLINE void divide(double pivot, double* y) {
  const double inverse = 1.0 / pivot;
  for (int k = 0; k < 8; ++k) y[k] *= inverse;
}

template <class V, int J>
TENON_INLINE void lower_columns(const double* L, std::int64_t height, std::int64_t j, double* y) {
  for (int k = 0; k < J; ++k) {  // the J×J triangle
    const double* column = L + (j + k) * height + j + k;
    divide<V>(column[0], y + 8 * (j + k));
    push<V, 1>(column + 1, height, J - 1 - k, y + 8 * (j + k), y + 8 * (j + k + 1));
  }
  push<V, J>(L + j * height + j + J, height, height - j - J, y + 8 * j, y + 8 * (j + J));
}

template <class V, int J>
TENON_INLINE void upper_columns(const double* L, std::int64_t height, std::int64_t j, double* y) {
  pull<V, J>(L + j * height + j + J, height, height - j - J, y + 8 * (j + J), y + 8 * j);
  for (int k = J - 1; k >= 0; --k) {
    const double* column = L + (j + k) * height + j + k;
    pull<V, 1>(column + 1, height, J - 1 - k, y + 8 * (j + k + 1), y + 8 * (j + k));
    divide<V>(column[0], y + 8 * (j + k));
  }
}

template <class V, int J>
TENON_INLINE void lower_all(const double* L, std::int64_t height, std::int64_t columns, double* y) {
  std::int64_t j = 0;
  for (; j + J <= columns; j += J) lower_columns<V, J>(L, height, j, y);
  for (; j < columns; ++j) lower_columns<V, 1>(L, height, j, y);
}

template <class V, int J>
TENON_INLINE void upper_all(const double* L, std::int64_t height, std::int64_t columns, double* y) {
  std::int64_t j = columns;
  for (; j % J != 0; --j) upper_columns<V, 1>(L, height, j - 1, y);
  for (; j > 0; j -= J) upper_columns<V, J>(L, height, j - J, y);
}

template <class V, int J>
TENON_INLINE void pull_all(const double* A, std::int64_t lda, std::int64_t rows, std::int64_t columns, const double* W,
                           double* H) {
  std::int64_t j = 0;
  for (; j + J <= columns; j += J) pull<V, J>(A + j * lda, lda, rows, W, H + 8 * j);
  for (; j < columns; ++j) pull<V, 1>(A + j * lda, lda, rows, W, H + 8 * j);
}

template <class V, int J>
TENON_INLINE void push_all(const double* A, std::int64_t lda, std::int64_t rows, std::int64_t columns, const double* H,
                           double* W) {
  std::int64_t j = 0;
  for (; j + J <= columns; j += J) push<V, J>(A + j * lda, lda, rows, H + 8 * j, W);
  for (; j < columns; ++j) push<V, 1>(A + j * lda, lda, rows, H + 8 * j, W);
}

template <class V>
TENON_INLINE void rows_of(const int* start, const int* column, const double* value, std::int64_t begin,
                          std::int64_t end, const double* X, double* Y) {
  for (std::int64_t i = begin; i < end; ++i) {
    Row<V> sum{}, x;
    for (int t = start[i]; t < start[i + 1]; ++t) {
      x.load(X + 8 * static_cast<std::int64_t>(column[t]));
      sum.add(value[t], x);
    }
    sum.store(Y + 8 * i);
  }
}

template <class V>
TENON_INLINE void symmetric_of(std::int64_t n, const int* start, const int* row, const double* value, const double* X,
                               double* Y) {
  for (std::int64_t j = 0; j < n; ++j) {
    Row<V> xj, xi, yi, sum{};
    xj.load(X + 8 * j);
    for (int t = start[j]; t < start[j + 1]; ++t) {
      const std::int64_t i = row[t];
      xi.load(X + 8 * i);
      sum.add(value[t], xi);
      if (i == j) continue;
      yi.load(Y + 8 * i);
      yi.add(value[t], xj);
      yi.store(Y + 8 * i);
    }
    yi.load(Y + 8 * j);
    yi.add(1.0, sum);
    yi.store(Y + 8 * j);
  }
}

// the six loops for one instruction set
#define TENON_PANEL_KERNELS(NAME, TARGET, V, J)                                                           \
  struct NAME {                                                                                           \
    TARGET static void lower(const double* L, std::int64_t height, std::int64_t columns, double* y) {     \
      lower_all<V, J>(L, height, columns, y);                                                             \
    }                                                                                                     \
    TARGET static void upper(const double* L, std::int64_t height, std::int64_t columns, double* y) {     \
      upper_all<V, J>(L, height, columns, y);                                                             \
    }                                                                                                     \
    TARGET static void pull(const double* A, std::int64_t lda, std::int64_t rows, std::int64_t columns,   \
                            const double* W, double* H) {                                                 \
      pull_all<V, J>(A, lda, rows, columns, W, H);                                                        \
    }                                                                                                     \
    TARGET static void push(const double* A, std::int64_t lda, std::int64_t rows, std::int64_t columns,   \
                            const double* H, double* W) {                                                 \
      push_all<V, J>(A, lda, rows, columns, H, W);                                                        \
    }                                                                                                     \
    TARGET static void rows(const int* start, const int* column, const double* value, std::int64_t begin, \
                            std::int64_t end, const double* X, double* Y) {                               \
      rows_of<V>(start, column, value, begin, end, X, Y);                                                 \
    }                                                                                                     \
    TARGET static void symmetric(std::int64_t n, const int* start, const int* row, const double* value,   \
                                 const double* X, double* Y) {                                            \
      symmetric_of<V>(n, start, row, value, X, Y);                                                        \
    }                                                                                                     \
  }

TENON_PANEL_KERNELS(Plain, , Vector2, 2);
#if defined(__x86_64__)
TENON_PANEL_KERNELS(Avx2, __attribute__((target("avx2,fma"))), Vector4, 4);
TENON_PANEL_KERNELS(Avx512, __attribute__((target("avx512f"))), Vector8, 8);
#endif

template <class Set>
PanelKernels table() {
  return {Set::lower, Set::upper, Set::pull, Set::push, Set::rows, Set::symmetric};
}

PanelKernels choose() {
#if defined(__x86_64__)
  __builtin_cpu_init();
  if (__builtin_cpu_supports("avx512f")) return table<Avx512>();
  if (__builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma")) return table<Avx2>();
#endif
  return table<Plain>();
}

}  // namespace

const PanelKernels& panel_kernels() {
  static const PanelKernels kernels = choose();
  return kernels;
}

}  // namespace tenon::reduction
