#include "fem/error.hpp"
#include "reduction/count.hpp"
#include "reduction/sparse.hpp"
#include "reduction/subspace.hpp"

namespace tenon::reduction {

namespace {

// Free-free modes need the mass of every rigid motion; a straight bar without torsional inertia has none about its
// axis.
Eigen::MatrixXd rigid_modes(const fem::Structure& structure, const Eigen::MatrixXd& R) try {
  return null_motions(structure.K, structure.M, R, structure.rounding);
} catch (const ModelError&) {
  throw ModelError("a rigid motion of the body carries no mass, and the basis 'rubin' takes free-free modes",
                   "Take craig-bampton-inertia-relief or craig-bampton, which hold the parent port, or give it mass "
                   "(density, torsional inertia of bars, point masses)");
}

}  // namespace

// Over the rows i that are not the parent's: F̄ is in equilibrium, so K X = F̄ with X_P = 0 is K_ii X_i = F̄_i.
Subspace free_modes(const fem::Structure& structure, const Partition& parts, const Eigen::MatrixXd& R,
                    const ModesOptions& options) {
  Subspace space;
  Modes& modes = space.modes;
  const Eigen::MatrixXd rigid = rigid_modes(structure, R);
  modes.lambda = Eigen::VectorXd::Zero(rigid.cols());
  modes.shapes = rigid;
  modes.rigid = static_cast<int>(rigid.cols());
  if (options.count > 0 || options.band) {
    ModesOptions wanted = options;
    wanted.count += modes.rigid;
    wanted.row_name = row_name(structure);
    Count count;
    const ShiftedFactor free =
        choose_shift(structure.K, structure.M, rigid, row_name(structure), [&](const Factor& ordered) {
          if (options.certify || options.band) count.prepare(structure.K, structure.M, ordered);
        });
    modes = solve_modes(structure.K, structure.M, free, rigid, wanted, &count);
  }
  if (modes.rigid > rigid.cols())
    throw ModelError("the body can move without strain while its parent port is held",
                     "Look for a mechanism or a hinge inside it, or take a parent port that holds all six directions");

  ShiftedFactor clamped = order_interior(structure, parts);
  factor_interior(structure, parts, clamped);
  const auto solve = [&](const Eigen::MatrixXd& F) -> Eigen::MatrixXd {
    Eigen::MatrixXd X = Eigen::MatrixXd::Zero(F.rows(), F.cols());
    X(parts.interior, Eigen::all) = clamped.factor.solve(Eigen::MatrixXd(F(parts.interior, Eigen::all)));
    return X;
  };
  ResidualShapes residual = residual_shapes(solve, structure.M, modes, unit_loads(structure, parts));

  const Eigen::Index statics = residual.X.cols(), kept = modes.lambda.size() - modes.rigid;
  space.T.resize(structure.n(), statics + kept);
  space.T << residual.X, modes.shapes.rightCols(kept);
  for (int d = 0; d < 6; ++d)  // Φ ← Φ − R Φ_P, R_P = 1
    if (const int row = parts.ports[static_cast<std::size_t>(parts.parent)][static_cast<std::size_t>(d)]; row >= 0) {
      const Eigen::RowVectorXd at_parent = space.T.row(row).tail(kept);
      space.T.rightCols(kept) -= R.col(d) * at_parent;
    }
  space.K_zz = Eigen::MatrixXd::Zero(statics + kept, statics + kept);
  space.K_zz.topLeftCorner(statics, statics) = residual.K;
  space.K_zz.diagonal().tail(kept) = modes.lambda.tail(kept);
  space.statics = static_cast<int>(statics);
  space.dropped = std::move(residual.dropped);
  modes.lambda = modes.lambda.tail(kept).eval();
  modes.shapes.resize(0, 0);
  return space;
}

}  // namespace tenon::reduction
