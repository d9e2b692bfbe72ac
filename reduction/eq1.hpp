#pragma once

#include <Eigen/Core>

namespace tenon::reduction {

/// A body in coordinates (x_P, z): x_P its rigid motion with the parent port, z the motion relative to it.
///   M̂ = [D M_zPᵀ; M_zP M_zz], K̂ = diag(0, K_zz); K_zz positive definite, M_zz may be singular.
struct RelativeForm {
  Eigen::MatrixXd K_zz, M_zz;
  Eigen::MatrixXd M_zP;  ///< z×6
};

/// The same in modal coordinates z = V η: eq (1) of the TITOP paper.
struct ModalForm {
  Eigen::VectorXd omega;  ///< [rad/s], ascending
  Eigen::MatrixXd V;      ///< z×n
  Eigen::MatrixXd L;      ///< n×6
  int massless = 0;       ///< trailing modes that stand for directions without mass
};

/// Massless directions get this many times the highest finite frequency: their static flexibility is exact, their
/// dynamic error (ω/ω_massless)² at most 1e-6 at the highest finite mode.
inline constexpr double massless_frequency = 1e3;

/// K_zz V = M_zz V Ω², VᵀM_zzV = 1, L = VᵀM_zP (NUMERICS 4a). A direction v with M_zz v = 0 and vᵀK_zzv = 1 becomes the
/// mode V = ω v with L = 0, so that V ω⁻² Vᵀ is its flexibility. Throws ModelError when K_zz is not positive definite:
/// the body can move without strain while its parent port is held.
ModalForm modal_form(const RelativeForm& relative);

}  // namespace tenon::reduction
