#include "reduction/eq1.hpp"

#include <cmath>
#include <limits>

#include "fem/error.hpp"
#include "reduction/dense.hpp"

namespace tenon::reduction {

namespace {

constexpr double massless = 1e-13;    // of the largest 1/ω²: below, a direction has no mass but rounding
constexpr double strainless = 1e-13;  // of the scaled K_zz: below, a direction has no stiffness but rounding

}  // namespace

ModalForm modal_form(const RelativeForm& relative) {
  const Eigen::Index n = relative.K_zz.rows();
  ModalForm modal;
  modal.L.resize(n, 6);
  if (n == 0) return modal;
  // z = S y with S K_zz S of unit diagonal: metres, radians and modal coordinates side by side
  const Eigen::VectorXd diagonal = relative.K_zz.diagonal();
  const bool positive = (diagonal.array() > 0.0).all();
  const Eigen::VectorXd S = positive ? Eigen::VectorXd(diagonal.cwiseSqrt().cwiseInverse()) : Eigen::VectorXd::Ones(n);
  Eigen::MatrixXd G = S.asDiagonal() * relative.K_zz * S.asDiagonal();
  const bool sound = positive && symmetric_eigen(G).values[0] > strainless && cholesky_in_place(G) < 0;
  if (!sound)
    throw ModelError(
        "the body can move without strain while its parent port is held",
        "Look for a mechanism or a hinge inside it, or a part so stiff that the rest is lost in its rounding, "
        "or take a parent port that holds all six directions");
  Eigen::MatrixXd C = S.asDiagonal() * relative.M_zz * S.asDiagonal();  // G⁻¹ S M_zz S G⁻ᵀ
  triangular_solve(G, C, false);
  C.transposeInPlace();
  triangular_solve(G, C, false);
  const SymmetricEigen e = symmetric_eigen(0.5 * (C + C.transpose()));
  const Eigen::VectorXd mu = e.values.reverse();  // 1/ω², descending
  modal.V = e.vectors.rowwise().reverse();
  triangular_solve(G, modal.V, true);
  modal.V = (S.asDiagonal() * modal.V).eval();  // VᵀK_zzV = 1 so far

  Eigen::Index finite = 0;
  while (finite < n && mu[finite] > massless * mu[0] && mu[finite] > 0.0) ++finite;
  if (finite == 0) throw ModelError("the body has stiffness but no mass at all", "Give its material a density");
  const double high = massless_frequency / std::sqrt(mu[finite - 1]);
  modal.massless = static_cast<int>(n - finite);
  modal.omega.resize(n);
  for (Eigen::Index k = 0; k < n; ++k) {
    modal.omega[k] = k < finite ? 1.0 / std::sqrt(mu[k]) : high;
    modal.V.col(k) *= modal.omega[k];
  }
  modal.L = modal.V.transpose() * relative.M_zP;
  modal.L.bottomRows(n - finite).setZero();
  return modal;
}

}  // namespace tenon::reduction
