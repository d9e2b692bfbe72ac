#include <fmt/format.h>

#include <algorithm>

#include "reduction/modes.hpp"

namespace tenon::reduction {
namespace {

/// Translations alone, which need no places: what is known of rigid motions where nodes of matrices have none.
Eigen::MatrixXd translations(const fem::Structure& structure) {
  Eigen::MatrixXd R = Eigen::MatrixXd::Zero(structure.n(), 3);
  for (int i = 0; i < structure.n(); ++i) {
    const fem::Dof& dof = structure.dofs.free[static_cast<std::size_t>(i)];
    const bool scalar = std::ranges::find(structure.scalar_points, dof.node) != structure.scalar_points.end();
    if (dof.direction < 3 && !scalar) R(i, dof.direction) = 1.0;
  }
  return R;
}

}  // namespace

RowName row_name(const fem::Structure& structure) {
  return [&names = structure.dofs.names](int row) {
    const auto r = static_cast<std::size_t>(row);
    return r < names.size() ? names[r] : fmt::format("row {}", row);
  };
}

Modes solve_modes(const fem::Structure& structure, const ModesOptions& options) {
  const bool placed = std::ranges::all_of(structure.nodes, [](const fem::Vec3& x) { return x.allFinite(); });
  fem::Vec3 centroid = fem::Vec3::Zero();
  for (const fem::Vec3& x : structure.nodes) centroid += x / static_cast<double>(structure.nodes.size());
  ModesOptions own = options;
  own.rounding = structure.rounding;
  own.row_name = row_name(structure);
  return solve_modes(structure.K, structure.M,
                     placed ? fem::rigid_motions(structure, centroid) : translations(structure), own);
}

}  // namespace tenon::reduction
