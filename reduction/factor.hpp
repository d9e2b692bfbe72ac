#pragma once

#include <Eigen/Core>
#include <memory>
#include <string>
#include <vector>

#include "fem/structure.hpp"
#include "reduction/supernodal.hpp"

namespace tenon::reduction {

/// Figures of a sparse Cholesky factorisation.
struct FactorReport {
  std::string ordering;               ///< "AMD" or "METIS", whichever predicted fewer operations
  double nonzeros = 0.0;              ///< of L
  double flops = 0.0;                 ///< of the numeric factorisation
  bool long_indices = false;          ///< 64-bit indices were needed
  double reciprocal_condition = 0.0;  ///< rough: (least / greatest diagonal entry of L)²
  double lost_digits = 0.0;  ///< decimal digits lost to cancellation in the worst pivot: log10 max A_jj / L_jj²
  int weakest_row = -1;      ///< row of that pivot
  double analyse_seconds = 0.0, factor_seconds = 0.0;
};

/// A = PᵀL LᵀP of a sparse symmetric positive definite matrix by CHOLMOD's supernodal method, and solves with it.
/// Keeps the analysis, so that matrices of one pattern can be factored one after another. Solves are const and may run
/// on several threads at a time.
class Factor {
 public:
  /// Orders and analyses the pattern of A (lower triangle): AMD and METIS side by side, the cheaper is kept.
  explicit Factor(const fem::SparseMatrix& A);
  ~Factor();
  Factor(Factor&&) noexcept;
  Factor& operator=(Factor&&) noexcept;

  /// Numeric factorisation of a matrix of the analysed pattern. Returns −1, or the row whose pivot is not positive:
  /// then there is no factor and A is not positive definite.
  int try_factorize(const fem::SparseMatrix& A);
  /// The same; throws NumericalError naming the row (and `names`[row] when given) where A is not positive definite.
  void factorize(const fem::SparseMatrix& A, const std::vector<std::string>& names = {});

  int n() const;
  const FactorReport& report() const;
  /// permutation()[k] is the row of A that stands at place k of L.
  const std::vector<int>& permutation() const;

  /// A⁻¹ B, n×k.
  Eigen::MatrixXd solve(const Eigen::Ref<const Eigen::MatrixXd>& B) const;
  /// L⁻¹ P B, n×k.
  Eigen::MatrixXd half_solve(const Eigen::Ref<const Eigen::MatrixXd>& B) const;
  /// PᵀL⁻ᵀ Y, n×k.
  Eigen::MatrixXd half_solve_transposed(const Eigen::Ref<const Eigen::MatrixXd>& Y) const;

  /// The same on panels in the order of L: X ← L⁻¹X and X ← L⁻ᵀX.
  void lower(Panel& X) const;
  void upper(Panel& X) const;

 private:
  struct Implementation;
  std::unique_ptr<Implementation> implementation_;
};

/// Factor of A in one step.
Factor factorize(const fem::SparseMatrix& A, const std::vector<std::string>& names = {});

}  // namespace tenon::reduction
