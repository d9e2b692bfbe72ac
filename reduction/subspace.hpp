#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "reduction/modes.hpp"
#include "reduction/partition.hpp"
#include "reduction/residual.hpp"
#include "reduction/shift.hpp"

namespace tenon::reduction {

/// Columns of T: motions with the parent port at rest; u = R x_P + T z.
struct Subspace {
  Eigen::MatrixXd T;     ///< n×z: constraint modes of the child ports' dofs, then static shapes, then modes
  Eigen::MatrixXd K_zz;  ///< z×z, TᵀKT, block diagonal in that order
  Modes modes;           ///< the eigenpairs kept (their shapes are moved into T)
  int statics = 0;       ///< residual static shapes
  std::vector<std::string> dropped;  ///< static shapes that were not independent
};

/// Constraint modes Ψ = −K_ii⁻¹K_iC of the child rows, residual static responses of the interior to `loads` (n rows,
/// may have no columns), modes of (K_ii, M_ii): one factorisation for all three. With child rows it is Craig-Bampton,
/// with inertia loads M R the P5 basis of NUMERICS 3 for any body; without, the modes are clamped at the parent port
/// alone. The parent's constraint modes are not formed: R takes their place (NUMERICS 4a), which imposes K R = 0
/// exactly. The static shapes vanish at the ports held, so K couples them neither to Ψ nor to the modes. Craig and
/// Bampton, AIAA J. 6 (1968) 1313–1319.
Subspace component_modes(const fem::Structure& structure, const Partition& parts, const Loads& loads,
                         const ModesOptions& options);

/// Rubin's basis: modes of the free body and residual inertia-relief attachment modes of every port's dofs, the
/// parent's included; `options` counts flexible modes. R: rigid motions about the parent port, n×6. The attachment
/// modes solve K X = (1 − MΦΦᵀ)E with the rigid motions among Φ, a load in equilibrium, so holding the parent port
/// causes no reactions and the clamped K_ii is factored instead of the singular K. Modes are taken relative to the
/// rigid motion with the parent port, T = Φ − R Φ_P. `parts` with children free. Throws ModelError when a rigid motion
/// has no mass. Rubin, AIAA J. 13 (1975) 995–1006.
Subspace free_modes(const fem::Structure& structure, const Partition& parts, const Eigen::MatrixXd& R,
                    const ModesOptions& options);

/// A unit load for every dof of every port but `without` (−1: of every port).
Loads unit_loads(const fem::Structure& structure, const Partition& parts, int without = -1);

/// K_ii ordered and analysed, not yet factored.
ShiftedFactor order_interior(const fem::Structure& structure, const Partition& parts);
/// Factors it; throws ModelError naming a dof that can move without strain while the other rows are held.
void factor_interior(const fem::Structure& structure, const Partition& parts, ShiftedFactor& ordered);

}  // namespace tenon::reduction
