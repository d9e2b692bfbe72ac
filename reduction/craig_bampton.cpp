#include "reduction/subspace.hpp"

#include <fmt/format.h>

#include "fem/error.hpp"
#include "reduction/count.hpp"
#include "reduction/dense.hpp"
#include "reduction/shift.hpp"
#include "reduction/sparse.hpp"

namespace tenon::reduction {

namespace {

// the rows `rows` and columns `columns` of a symmetric matrix, dense
Eigen::MatrixXd dense_block(const fem::SparseMatrix& A, const std::vector<int>& rows, const std::vector<int>& columns) {
  std::vector<int> row_place(static_cast<std::size_t>(A.rows()), -1), column_place(row_place);
  for (std::size_t k = 0; k < rows.size(); ++k) row_place[static_cast<std::size_t>(rows[k])] = static_cast<int>(k);
  for (std::size_t k = 0; k < columns.size(); ++k)
    column_place[static_cast<std::size_t>(columns[k])] = static_cast<int>(k);
  Eigen::MatrixXd B =
      Eigen::MatrixXd::Zero(static_cast<Eigen::Index>(rows.size()), static_cast<Eigen::Index>(columns.size()));
  const auto put = [&](Eigen::Index i, Eigen::Index j, double value) {
    const int r = row_place[static_cast<std::size_t>(i)], c = column_place[static_cast<std::size_t>(j)];
    if (r >= 0 && c >= 0) B(r, c) = value;
  };
  for (int j = 0; j < A.outerSize(); ++j)
    for (fem::SparseMatrix::InnerIterator it(A, j); it; ++it) {
      put(it.row(), j, it.value());
      put(j, it.row(), it.value());
    }
  return B;
}

// the rows `rows` of A
Eigen::MatrixXd rows_of(const Eigen::MatrixXd& A, const std::vector<int>& rows) { return A(rows, Eigen::all); }

}  // namespace

Loads unit_loads(const fem::Structure& structure, const Partition& parts, int without) {
  std::vector<int> rows;
  Loads units;
  for (std::size_t k = 0; k < parts.ports.size(); ++k)
    for (std::size_t d = 0; d < 6 && static_cast<int>(k) != without; ++d)
      if (const int row = parts.ports[k][d]; row >= 0) {
        rows.push_back(row);
        units.names.push_back(fmt::format("port '{}' {}", structure.ports[k].name, directions[d]));
      }
  units.F = Eigen::MatrixXd::Zero(structure.n(), static_cast<Eigen::Index>(rows.size()));
  for (std::size_t k = 0; k < rows.size(); ++k) units.F(rows[k], static_cast<Eigen::Index>(k)) = 1.0;
  return units;
}

ShiftedFactor order_interior(const fem::Structure& structure, const Partition& parts) {
  fem::SparseMatrix K_ii = principal(structure.K, parts.interior);
  Factor factor(K_ii);
  return {0.0, std::move(K_ii), std::move(factor)};
}

// K_ii of a body held at its ports must be positive definite; a singular one has a mechanism inside
void factor_interior(const fem::Structure& structure, const Partition& parts, ShiftedFactor& ordered) {
  int row = ordered.factor.try_factorize(ordered.A);
  if (row < 0) row = free_row(ordered.A, ordered.factor);
  if (row >= 0) {
    const int dof = parts.interior[static_cast<std::size_t>(row)];
    throw ModelError(
        fmt::format("{} can move without strain while all ports are held", row_name(structure)(dof)),
        "Look there for a hinge, a node without rotational stiffness, a part that hangs by a thread, or one so stiff "
        "that the rest is lost in its rounding");
  }
}

Subspace component_modes(const fem::Structure& structure, const Partition& parts, const Loads& loads,
                         const ModesOptions& options) {
  const auto children = static_cast<Eigen::Index>(parts.children.size());
  const auto interior = static_cast<Eigen::Index>(parts.interior.size());
  Subspace space;
  Eigen::MatrixXd Psi(interior, children);
  Eigen::MatrixXd K_CC = dense_block(structure.K, parts.children, parts.children);
  ResidualShapes residual{Eigen::MatrixXd(interior, 0), Eigen::MatrixXd(0, 0), {}};
  if (interior > 0) {
    const fem::SparseMatrix M_ii = principal(structure.M, parts.interior);
    ShiftedFactor factored = order_interior(structure, parts);
    const bool modes = options.count > 0 || options.band;
    Count count;
    if (modes && (options.certify || options.band)) count.prepare(factored.A, M_ii, factored.factor);
    factor_interior(structure, parts, factored);
    if (children > 0) {
      const Eigen::MatrixXd K_iC = dense_block(structure.K, parts.interior, parts.children);
      Psi = -factored.factor.solve(K_iC);     // Ψ = −K_ii⁻¹ K_iC
      K_CC += transposed_product(K_iC, Psi);  // K_CC − K_Ci K_ii⁻¹ K_iC
      K_CC = 0.5 * (K_CC + K_CC.transpose()).eval();
    }
    space.modes.shapes.resize(interior, 0);
    if (modes) {
      ModesOptions inside = options;
      inside.row_name = [&](int row) { return row_name(structure)(parts.interior[static_cast<std::size_t>(row)]); };
      space.modes = solve_modes(factored.A, M_ii, factored, Eigen::MatrixXd(interior, 0), inside, &count);
    }
    if (loads.F.cols() > 0)
      residual = residual_shapes([&](const Eigen::MatrixXd& F) { return factored.factor.solve(F); }, M_ii, space.modes,
                                 {rows_of(loads.F, parts.interior), loads.names});
  }
  const Eigen::Index statics = residual.X.cols(), kept = space.modes.lambda.size();
  space.T = Eigen::MatrixXd::Zero(structure.n(), children + statics + kept);
  for (Eigen::Index c = 0; c < children; ++c) space.T(parts.children[static_cast<std::size_t>(c)], c) = 1.0;
  space.T(parts.interior, Eigen::seqN(0, children)) = Psi;
  space.T(parts.interior, Eigen::seqN(children, statics)) = residual.X;
  if (kept > 0) space.T(parts.interior, Eigen::lastN(kept)) = space.modes.shapes;
  space.K_zz = Eigen::MatrixXd::Zero(space.T.cols(), space.T.cols());
  space.K_zz.topLeftCorner(children, children) = K_CC;
  space.K_zz.block(children, children, statics, statics) = residual.K;
  space.K_zz.diagonal().tail(kept) = space.modes.lambda;
  space.statics = static_cast<int>(statics);
  space.dropped = std::move(residual.dropped);
  space.modes.shapes.resize(0, 0);
  return space;
}

}  // namespace tenon::reduction
