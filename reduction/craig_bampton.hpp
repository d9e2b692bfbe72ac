#pragma once

#include <Eigen/Core>

#include "reduction/modes.hpp"
#include "reduction/partition.hpp"

namespace tenon::reduction {

/// Columns of T: motions with the parent port at rest; u = R x_P + T z.
struct Subspace {
  Eigen::MatrixXd T;     ///< n×z: unit motions of the child ports' dofs first (constraint modes), then modes
  Eigen::MatrixXd K_zz;  ///< z×z, TᵀKT
  Modes modes;           ///< of the interior, shapes in the order of Partition::interior
};

/// Craig-Bampton: constraint modes Ψ = −K_ii⁻¹ K_iC of the child ports and fixed-interface modes of (K_ii, M_ii), one
/// factorisation for both. With no child rows in the partition these are the modes clamped at the parent port alone,
/// children free: the `clamped_free` basis. The parent's constraint modes are not formed: R takes their place
/// (NUMERICS 4a), which imposes K R = 0 exactly. Craig and Bampton, AIAA J. 6 (1968) 1313–1319.
Subspace component_modes(const fem::Structure& structure, const Partition& parts, const ModesOptions& options);

}  // namespace tenon::reduction
