#include "reduction/supernodal_kernels.hpp"

// One source for three instruction sets: V is a vector of lanes(V) doubles, 8/lanes(V) of which make a row of a panel;
// J columns are taken together, their J×8 unknowns stay in registers while the rows stream by.
#define TENON_INLINE inline __attribute__((always_inline))

namespace tenon::reduction {

namespace {

// wrapped in a struct, for a template argument would lose the attributes
struct Vector8 {
  typedef double type __attribute__((vector_size(64), may_alias));
};
struct Vector4 {
  typedef double type __attribute__((vector_size(32), may_alias));
};
struct Vector2 {
  typedef double type __attribute__((vector_size(16), may_alias));
};

template <class V>
inline constexpr int pieces = 64 / static_cast<int>(sizeof(typename V::type));

template <class V>
TENON_INLINE typename V::type* row(double* y, std::int64_t i) {
  return reinterpret_cast<typename V::type*>(y + 8 * i);
}

// y_i ← y_i − Σ_j L_ij x_j, rows begin..height; x_j = row j of y
template <class V, int J>
TENON_INLINE void push(const double* L, std::int64_t height, std::int64_t j, std::int64_t begin, double* y) {
  typename V::type x[J][pieces<V>];
  const double* column[J];
  for (int k = 0; k < J; ++k) {
    for (int p = 0; p < pieces<V>; ++p) x[k][p] = row<V>(y, j + k)[p];
    column[k] = L + (j + k) * height;
  }
  for (std::int64_t i = begin; i < height; ++i) {
    auto* yi = row<V>(y, i);
    for (int p = 0; p < pieces<V>; ++p) {
      typename V::type sum = yi[p];
      for (int k = 0; k < J; ++k) sum -= column[k][i] * x[k][p];
      yi[p] = sum;
    }
  }
}

// x_j ← x_j − Σ_i L_ij y_i, rows begin..height
template <class V, int J>
TENON_INLINE void pull(const double* L, std::int64_t height, std::int64_t j, std::int64_t begin, double* y) {
  typename V::type x[J][pieces<V>];
  const double* column[J];
  for (int k = 0; k < J; ++k) {
    for (int p = 0; p < pieces<V>; ++p) x[k][p] = row<V>(y, j + k)[p];
    column[k] = L + (j + k) * height;
  }
  for (std::int64_t i = begin; i < height; ++i) {
    const auto* yi = row<V>(y, i);
    for (int k = 0; k < J; ++k)
      for (int p = 0; p < pieces<V>; ++p) x[k][p] -= column[k][i] * yi[p];
  }
  for (int k = 0; k < J; ++k)
    for (int p = 0; p < pieces<V>; ++p) row<V>(y, j + k)[p] = x[k][p];
}

template <class V>
TENON_INLINE void divide(double pivot, double* y, std::int64_t j) {
  const double inverse = 1.0 / pivot;
  for (int p = 0; p < pieces<V>; ++p) row<V>(y, j)[p] *= inverse;
}

template <class V, int J>
TENON_INLINE void lower_columns(const double* L, std::int64_t height, std::int64_t j, double* y) {
  for (int k = 0; k < J; ++k) {  // the J×J triangle
    divide<V>(L[(j + k) * height + j + k], y, j + k);
    for (int i = k + 1; i < J; ++i)
      for (int p = 0; p < pieces<V>; ++p) row<V>(y, j + i)[p] -= L[(j + k) * height + j + i] * row<V>(y, j + k)[p];
  }
  push<V, J>(L, height, j, j + J, y);
}

template <class V, int J>
TENON_INLINE void upper_columns(const double* L, std::int64_t height, std::int64_t j, double* y) {
  pull<V, J>(L, height, j, j + J, y);
  for (int k = J - 1; k >= 0; --k) {
    for (int i = k + 1; i < J; ++i)
      for (int p = 0; p < pieces<V>; ++p) row<V>(y, j + k)[p] -= L[(j + k) * height + j + i] * row<V>(y, j + i)[p];
    divide<V>(L[(j + k) * height + j + k], y, j + k);
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

void lower_plain(const double* L, std::int64_t height, std::int64_t columns, double* y) {
  lower_all<Vector2, 2>(L, height, columns, y);
}
void upper_plain(const double* L, std::int64_t height, std::int64_t columns, double* y) {
  upper_all<Vector2, 2>(L, height, columns, y);
}

#if defined(__x86_64__)
__attribute__((target("avx2,fma"))) void lower_avx2(const double* L, std::int64_t height, std::int64_t columns,
                                                    double* y) {
  lower_all<Vector4, 4>(L, height, columns, y);
}
__attribute__((target("avx2,fma"))) void upper_avx2(const double* L, std::int64_t height, std::int64_t columns,
                                                    double* y) {
  upper_all<Vector4, 4>(L, height, columns, y);
}
__attribute__((target("avx512f"))) void lower_avx512(const double* L, std::int64_t height, std::int64_t columns,
                                                     double* y) {
  lower_all<Vector8, 8>(L, height, columns, y);
}
__attribute__((target("avx512f"))) void upper_avx512(const double* L, std::int64_t height, std::int64_t columns,
                                                     double* y) {
  upper_all<Vector8, 8>(L, height, columns, y);
}
#endif

SupernodeKernels choose() {
#if defined(__x86_64__)
  __builtin_cpu_init();
  if (__builtin_cpu_supports("avx512f")) return {lower_avx512, upper_avx512};
  if (__builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma")) return {lower_avx2, upper_avx2};
#endif
  return {lower_plain, upper_plain};
}

}  // namespace

const SupernodeKernels& supernode_kernels() {
  static const SupernodeKernels kernels = choose();
  return kernels;
}

}  // namespace tenon::reduction
