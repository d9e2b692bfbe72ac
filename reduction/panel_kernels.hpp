#pragma once

#include <cstdint>

namespace tenon::reduction {

/// Inner loops on panels (rows of eight doubles, one for each of eight right-hand sides), for the instruction set of
/// the processor at hand.
struct PanelKernels {
  /// One supernode of L, height×columns, column-major, its leading block lower triangular; y: height rows.
  /// y_head ← L₁₁⁻¹ y_head; y_tail ← y_tail − L₂₁ y_head.
  void (*lower)(const double* L, std::int64_t height, std::int64_t columns, double* y);
  /// y_head ← L₁₁⁻ᵀ (y_head − L₂₁ᵀ y_tail).
  void (*upper)(const double* L, std::int64_t height, std::int64_t columns, double* y);
  /// H ← H − AᵀW: A rows×columns, column-major with leading dimension lda; W rows; H columns.
  void (*pull)(const double* A, std::int64_t lda, std::int64_t rows, std::int64_t columns, const double* W, double* H);
  /// W ← W − A H.
  void (*push)(const double* A, std::int64_t lda, std::int64_t rows, std::int64_t columns, const double* H, double* W);
  /// Y_i ← Σ_j A_ij X_j for rows begin..end of a matrix in compressed rows.
  void (*rows)(const int* start, const int* column, const double* value, std::int64_t begin, std::int64_t end,
               const double* X, double* Y);
  /// Y ← Y + A X of a symmetric matrix, lower triangle in compressed columns.
  void (*symmetric)(std::int64_t n, const int* start, const int* row, const double* value, const double* X, double* Y);
};

/// The fastest kernels this processor has (AVX-512, AVX2 with FMA, or plain).
const PanelKernels& panel_kernels();

}  // namespace tenon::reduction
