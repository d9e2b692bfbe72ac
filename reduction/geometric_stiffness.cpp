#include "reduction/geometric_stiffness.hpp"

#include <fmt/format.h>

#include <vector>

#include "fem/error.hpp"
#include "reduction/dense.hpp"
#include "reduction/free_rows.hpp"
#include "reduction/partition.hpp"
#include "reduction/shape_integrals.hpp"
#include "reduction/sparse.hpp"
#include "reduction/subspace.hpp"

namespace tenon::reduction {

namespace {

// ω × (ω × l) per ω_iω_j at every node, in the order of the loads; angular accelerations cancel: e_i × e_j + e_j × e_i
Eigen::MatrixXd centrifugal_field(const fem::Structure& structure, const Vec3& reference) {
  Eigen::MatrixXd field = Eigen::MatrixXd::Zero(6 * static_cast<Eigen::Index>(structure.nodes.size()), 6);
  for (std::size_t node = 0; node < structure.nodes.size(); ++node) {
    const Vec3 l = structure.nodes[node] - reference;
    for (int load = 0; load < 6; ++load) {
      const Vec3 e_i = Vec3::Unit(symmetric_row[load]), e_j = Vec3::Unit(symmetric_column[load]);
      Vec3 a = e_i.cross(e_j.cross(l));
      if (load >= 3) a += e_j.cross(e_i.cross(l));
      field.block<3, 1>(6 * static_cast<Eigen::Index>(node), load) = a;
    }
  }
  return field;
}

}  // namespace

GeometricStiffness geometric_stiffness(const fem::Model& model, const fem::Structure& structure,
                                       const ReducedBody& body) {
  const Eigen::Index n = body.omega.size(), ports = static_cast<Eigen::Index>(body.ports.size());
  constexpr int inertia = GeometricStiffness::inertia_loads;
  GeometricStiffness out{Eigen::MatrixXd::Zero((n + 3) * (n + 3), inertia + 6 * ports), Mat6::Zero()};
  if (n == 0) return out;
  const auto refuse = [&](const std::string& what, const std::string& cure) {
    throw ModelError(fmt::format("geometric stiffness of body '{}': {}", body.name, what), cure);
  };
  if (body.kind != ReducedBody::Kind::cantilever) refuse("it is not held anywhere", "Hang it by a port first (rebase)");
  if (body.node_shapes.rows() != 6 * static_cast<Eigen::Index>(structure.nodes.size()))
    refuse(fmt::format("its {} node shapes are not those of {} nodes", body.node_shapes.rows() / 6,
                       structure.nodes.size()),
           "Reduce it with its node shapes kept, and give the structure it was reduced from");

  const Partition parts = partition(structure, body.ports[static_cast<std::size_t>(body.parent)].name, true);
  const Eigen::MatrixXd R = fem::rigid_motions(structure, body.reference);
  Eigen::MatrixXd fields(structure.n(), inertia);
  fields << R, free_rows(structure, centrifugal_field(structure, body.reference));
  for (const int point : structure.scalar_points)
    if (const int row = structure.dofs.row({point, 0}); row >= 0) fields.row(row).setZero();
  Eigen::MatrixXd F = Eigen::MatrixXd::Zero(structure.n(), inertia + 6 * ports);
  F.leftCols<inertia>() = -symmetric_product(structure.M, fields);
  out.spin = R.transpose() * F.middleCols<6>(6);
  for (Eigen::Index p = 0; p < ports; ++p)
    for (Eigen::Index d = 0; d < 6; ++d)
      if (const int row = parts.ports[static_cast<std::size_t>(p)][static_cast<std::size_t>(d)];
          row >= 0 && p != body.parent)
        F(row, inertia + 6 * p + d) = 1.0;

  ShiftedFactor held = order_interior(structure, parts);
  factor_interior(structure, parts, held);
  Eigen::MatrixXd U = Eigen::MatrixXd::Zero(F.rows(), F.cols());
  U(parts.interior, Eigen::all) = held.factor.solve(F(parts.interior, Eigen::all));
  Eigen::MatrixXd Pi(structure.n(), n + 3);
  Pi << free_rows(structure, body.node_shapes), R.rightCols<3>();
  for (Eigen::Index load = 0; load < F.cols(); ++load) {
    if (U.col(load).isZero(0.0)) continue;
    const fem::SparseMatrix K_sigma = fem::geometric_stiffness(model, structure, U.col(load));
    const Eigen::MatrixXd K = transposed_product(Pi, symmetric_product(K_sigma, Pi));
    Eigen::Map<Eigen::MatrixXd>(out.K.col(load).data(), n + 3, n + 3) = 0.5 * (K + K.transpose());
  }
  return out;
}

void geometric_stiffness(const GeometricStiffness& stiffening, const Vec3& a, const Vec3& alpha, const Vec3& omega,
                         const double* wrenches, Eigen::Ref<Eigen::MatrixXd> K_G) {
  const Eigen::Index n = K_G.cols(), loads = stiffening.K.cols();
  const Vec3& w = omega;
  const double gamma[GeometricStiffness::inertia_loads] = {a.x(),         a.y(),         a.z(),         alpha.x(),
                                                           alpha.y(),     alpha.z(),     w.x() * w.x(), w.y() * w.y(),
                                                           w.z() * w.z(), w.x() * w.y(), w.x() * w.z(), w.y() * w.z()};
  K_G.setZero();
  for (Eigen::Index load = 0; load < loads; ++load) {
    const Eigen::Index port = load - GeometricStiffness::inertia_loads;
    const double g = port < 0 ? gamma[load] : wrenches != nullptr ? wrenches[port] : 0.0;
    if (g == 0.0) continue;
    for (Eigen::Index k = 0; k < n; ++k) K_G.col(k) += g * stiffening.K.col(load).segment((n + 3) * k, n);
  }
}

}  // namespace tenon::reduction
