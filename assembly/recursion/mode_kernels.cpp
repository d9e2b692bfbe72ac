#include "assembly/recursion/mode_kernels.hpp"

#include <cmath>

// One compilation for each instruction set; the loader picks. Loops run over whole registers of eight.
#if defined(__x86_64__) && !defined(__SANITIZE_ADDRESS__)
#define TENON_CLONES __attribute__((target_clones("arch=skylake-avx512", "arch=haswell", "default")))
#else
#define TENON_CLONES
#endif

namespace tenon::assembly {

namespace {

// Eight doubles, one register or several.
using Row = double __attribute__((vector_size(64), aligned(8), may_alias));
static_assert(sizeof(Row) == pad * sizeof(double));

[[gnu::always_inline]] inline Row& row(double* x) { return *reinterpret_cast<Row*>(x); }
[[gnu::always_inline]] inline const Row& row(const double* x) { return *reinterpret_cast<const Row*>(x); }

}  // namespace

TENON_CLONES void add_child_modes(int n, const double* Gamma, const double* Pi, const double* Pi_T, const double* l,
                                  double* P_ff, double* P_rf) {
  const int height = padded(n);
  for (int j = 0; j < n; ++j) {
    const double* p = Pi + pad * j;
    double W[pad];
    row(W) = p[0] * row(Gamma) + p[1] * row(Gamma + pad) + p[2] * row(Gamma + 2 * pad) + p[3] * row(Gamma + 3 * pad) +
             p[4] * row(Gamma + 4 * pad) + p[5] * row(Gamma + 5 * pad);
    for (int block = j / pad * pad; block < height; block += pad) {  // the lower half is enough
      const double* shapes = Pi_T + block;
      row(P_ff + height * j + block) += W[0] * row(shapes) + W[1] * row(shapes + height) +
                                        W[2] * row(shapes + 2 * height) + W[3] * row(shapes + 3 * height) +
                                        W[4] * row(shapes + 4 * height) + W[5] * row(shapes + 5 * height);
    }
    double* rf = P_rf + pad * j;
    row(rf) += row(W);
    rf[3] += l[1] * W[2] - l[2] * W[1];
    rf[4] += l[2] * W[0] - l[0] * W[2];
    rf[5] += l[0] * W[1] - l[1] * W[0];
  }
}

TENON_CLONES int eliminate_modes(int n, double least, double* D, double* inverse, double* X, double* P_R) {
  const int height = padded(n);
  for (int j = 0; j < n; ++j) inverse[j] = D[height * j + j];  // what the pivots are left of
  Row P[6];
  for (int c = 0; c < 6; ++c) P[c] = row(P_R + pad * c);
  for (int j = 0; j < n; ++j) {
    double* column = D + height * j;
    const double pivot = column[j];
    if (!(pivot > least * inverse[j])) return j;
    const double scale = 1.0 / std::sqrt(pivot);
    inverse[j] = scale;
    for (int i = j / pad * pad; i <= j; ++i) column[i] = 0.0;
    for (int block = j / pad * pad; block < height; block += pad) row(column + block) *= scale;
    double* x = X + pad * j;
    const Row xj = row(x) * scale;
    row(x) = xj;
    for (int k = j + 1; k < n; ++k) {
      const double factor = column[k];
      for (int block = k / pad * pad; block < height; block += pad)
        row(D + height * k + block) -= factor * row(column + block);
      row(X + pad * k) -= factor * xj;
    }
    for (int c = 0; c < 6; ++c) P[c] -= xj[c] * xj;
  }
  for (int c = 0; c < 6; ++c) row(P_R + pad * c) = P[c];
  return -1;
}

TENON_CLONES void lower_sweep(int n, const double* L, const double* inverse, const double* X, double* y, double* z) {
  const int height = padded(n);
  Row sum = row(z);
  for (int j = 0; j < n; ++j) {
    const double value = y[j] * inverse[j];
    y[j] = value;  // the diagonal of L is kept as zero
    for (int block = j / pad * pad; block < height; block += pad) row(y + block) -= value * row(L + height * j + block);
    sum += value * row(X + pad * j);
  }
  row(z) = sum;
}

TENON_CLONES void upper_sweep(int n, const double* L, const double* inverse, const double* X, const double* alpha,
                              double* y) {
  const int height = padded(n);
  const Row a = row(alpha);
  for (int j = n - 1; j >= 0; --j) {
    Row sum = row(X + pad * j) * a;
    for (int block = j / pad * pad; block < height; block += pad) sum += row(L + height * j + block) * row(y + block);
    const double total = ((sum[0] + sum[4]) + (sum[1] + sum[5])) + ((sum[2] + sum[6]) + (sum[3] + sum[7]));
    y[j] = (y[j] - total) * inverse[j];
  }
}

TENON_CLONES void add_mode_forces(int n, const double* Pi_T, const double* f, double* z_f) {
  const int height = padded(n);
  for (int block = 0; block < height; block += pad) {
    Row sum = row(z_f + block);
    for (int r = 0; r < 6; ++r) sum += f[r] * row(Pi_T + height * r + block);
    row(z_f + block) = sum;
  }
}

}  // namespace tenon::assembly
