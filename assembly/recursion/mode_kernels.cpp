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

// y −= a x over `length` numbers, a multiple of eight
[[gnu::always_inline]] inline void subtract(int length, double a, const double* x, double* y) {
  for (int i = 0; i < length; ++i) y[i] -= a * x[i];
}

}  // namespace

TENON_CLONES void add_child_modes(int n, const double* Gamma, const double* Pi, const double* Pi_T, const double* l,
                                  double* P_ff, double* P_rf) {
  const int height = padded(n);
  for (int j = 0; j < n; ++j) {
    double W[pad] = {};
    for (int r = 0; r < 6; ++r) {
      const double p = Pi[pad * j + r];
      for (int i = 0; i < pad; ++i) W[i] += p * Gamma[pad * r + i];
    }
    double* column = P_ff + height * j;
    for (int r = 0; r < 6; ++r) subtract(height, -W[r], Pi_T + height * r, column);
    double* rf = P_rf + pad * j;
    for (int i = 0; i < 6; ++i) rf[i] += W[i];
    rf[3] += l[1] * W[2] - l[2] * W[1];
    rf[4] += l[2] * W[0] - l[0] * W[2];
    rf[5] += l[0] * W[1] - l[1] * W[0];
  }
}

TENON_CLONES int eliminate_modes(int n, double least, double* D, double* inverse, double* X, double* P_R) {
  const int height = padded(n);
  for (int j = 0; j < n; ++j) inverse[j] = D[height * j + j];  // what the pivots are left of
  for (int j = 0; j < n; ++j) {
    double* column = D + height * j;
    const double pivot = column[j];
    if (!(pivot > least * inverse[j])) return j;
    const double scale = 1.0 / std::sqrt(pivot);
    inverse[j] = scale;
    for (int i = 0; i <= j; ++i) column[i] = 0.0;
    for (int i = 0; i < height; ++i) column[i] *= scale;
    double* x = X + pad * j;
    for (int i = 0; i < pad; ++i) x[i] *= scale;
    for (int k = j + 1; k < n; ++k) {
      subtract(height, column[k], column, D + height * k);
      subtract(pad, column[k], x, X + pad * k);
    }
    for (int c = 0; c < 6; ++c) subtract(pad, x[c], x, P_R + pad * c);
  }
  return -1;
}

TENON_CLONES void lower_sweep(int n, const double* L, const double* inverse, const double* X, double* y, double* z) {
  const int height = padded(n);
  for (int j = 0; j < n; ++j) {
    const double value = y[j] * inverse[j];
    y[j] = value;  // the diagonal of L is kept as zero
    subtract(height, value, L + height * j, y);
    subtract(pad, -value, X + pad * j, z);
  }
}

TENON_CLONES void upper_sweep(int n, const double* L, const double* inverse, const double* X, const double* alpha,
                              double* y) {
  const int height = padded(n);
  for (int j = n - 1; j >= 0; --j) {
    const double *column = L + height * j, *x = X + pad * j;
    double sum[pad];
    for (int i = 0; i < pad; ++i) sum[i] = x[i] * alpha[i];
    for (int block = j / pad * pad; block < height; block += pad)
      for (int i = 0; i < pad; ++i) sum[i] += column[block + i] * y[block + i];
    const double total = ((sum[0] + sum[4]) + (sum[1] + sum[5])) + ((sum[2] + sum[6]) + (sum[3] + sum[7]));
    y[j] = (y[j] - total) * inverse[j];
  }
}

TENON_CLONES void add_mode_forces(int n, const double* Pi_T, const double* f, double* z_f) {
  const int height = padded(n);
  for (int r = 0; r < 6; ++r) subtract(height, -f[r], Pi_T + height * r, z_f);
}

}  // namespace tenon::assembly
