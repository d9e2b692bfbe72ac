#pragma once

#include <Eigen/Core>
#include <vector>

#include "reduction/factor.hpp"

namespace tenon::reduction {

/// The symmetric operator C = L⁻¹P M PᵀL⁻ᵀ of A = K + sM = PᵀLLᵀP, s ≥ 0. C y = μ y with y = LᵀP x is
/// M x = μ (K + sM) x, that is K x = λ M x with λ = 1/μ − s: the lowest modes have the largest μ, the infinite modes of
/// a singular M have μ = 0, and neither a singular M nor a free-floating K disturbs (NUMERICS 4d).
/// Shapes of Spectra's operators (rows, cols, perform_op) and of block_lanczos (apply). Keeps a reference to the
/// factor.
class ShiftInvert {
 public:
  using Scalar = double;

  ShiftInvert(const Factor& factor, const fem::SparseMatrix& M);

  Eigen::Index rows() const { return factor_.n(); }
  Eigen::Index cols() const { return factor_.n(); }
  /// Y = C X for a block of columns.
  void apply(const Eigen::Ref<const Eigen::MatrixXd>& X, Eigen::Ref<Eigen::MatrixXd> Y) const;
  /// y = C x.
  void perform_op(const double* x, double* y) const;

  /// x = PᵀL⁻ᵀ y: the shapes that belong to vectors of C.
  Eigen::MatrixXd shapes(const Eigen::Ref<const Eigen::MatrixXd>& Y) const { return factor_.half_solve_transposed(Y); }

 private:
  void multiply(const Panel& X, Panel& Y) const;

  const Factor& factor_;
  std::vector<int> start_, column_;  ///< P M Pᵀ, both triangles, in compressed rows
  std::vector<double> value_;
};

}  // namespace tenon::reduction
