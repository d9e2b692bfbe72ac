#pragma once

#include <memory>
#include <vector>

#include "fem/structure.hpp"

namespace tenon::reduction {

/// Result of one factorisation LDLᵀ of K − σM.
struct Inertia {
  int negative = 0;             ///< negative pivots: eigenvalues below σ, by Sylvester's law
  int null_pivots = 0;          ///< pivots too small to have a sign
  double backward_error = 0.0;  ///< ‖(K − σM)x − b‖∞ / (‖K − σM‖∞ ‖x‖∞ + ‖b‖∞) of a check solve
  double nearest = 0.0;  ///< estimate of |λ − σ| for the eigenvalue next to σ (one inverse iteration; 0: not asked)
};

/// Counts eigenvalues of K φ = λ M φ below a shift by the inertia of K − σM. An LDLᵀ without pivoting (CHOLMOD's,
/// Eigen's) may lose every digit on an indefinite matrix; sequential MUMPS pivots with 1×1 and 2×2 blocks at supernodal
/// speed. MUMPS keeps global state: a lock lets one instance work at a time.
class InertiaCounter {
 public:
  /// Analyses the common pattern of K and M (lower triangles). `permutation` (row at each place, may be empty) spares
  /// MUMPS its own ordering.
  InertiaCounter(const fem::SparseMatrix& K, const fem::SparseMatrix& M, const std::vector<int>& permutation = {});
  ~InertiaCounter();
  InertiaCounter(const InertiaCounter&) = delete;
  InertiaCounter& operator=(const InertiaCounter&) = delete;

  /// Factors K − σM, of the pattern analysed, and counts. Throws NumericalError when the factorisation or its check
  /// solve fails.
  Inertia count(const fem::SparseMatrix& K, const fem::SparseMatrix& M, double sigma, bool estimate_nearest = false);

 private:
  struct Implementation;
  std::unique_ptr<Implementation> implementation_;
};

}  // namespace tenon::reduction
