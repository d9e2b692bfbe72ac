#pragma once

#include <cstdint>

namespace tenon::reduction {

/// The dense work of one supernode on eight interleaved right-hand sides. L: height×columns, column-major, its leading
/// columns×columns block lower triangular; y: height rows of eight, on a 64-byte boundary.
struct SupernodeKernels {
  /// y_head ← L₁₁⁻¹ y_head; y_tail ← y_tail − L₂₁ y_head.
  void (*lower)(const double* L, std::int64_t height, std::int64_t columns, double* y);
  /// y_head ← L₁₁⁻ᵀ (y_head − L₂₁ᵀ y_tail).
  void (*upper)(const double* L, std::int64_t height, std::int64_t columns, double* y);
};

/// The fastest kernels this processor has (AVX-512, AVX2 with FMA, or plain).
const SupernodeKernels& supernode_kernels();

}  // namespace tenon::reduction
