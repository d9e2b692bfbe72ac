#include "reduction/modes.hpp"

namespace tenon::reduction {

Modes solve_modes(const fem::Structure& structure, const ModesOptions& options) {
  fem::Vec3 centroid = fem::Vec3::Zero();
  for (const fem::Vec3& x : structure.nodes) centroid += x / static_cast<double>(structure.nodes.size());
  return solve_modes(structure.K, structure.M, fem::rigid_motions(structure, centroid), options, structure.dofs.names);
}

}  // namespace tenon::reduction
