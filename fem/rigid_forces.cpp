#include "fem/rigid_forces.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>

#include "fem/matrix_part.hpp"

namespace tenon::fem {
namespace {

constexpr double of_the_largest = 1e-3;  // rows that hardly move: the rounding of R elsewhere, ε against a limit
constexpr double apart = 1e-6;           // of the model's size: nodes of a spring that a rotation pulls

bool reaches_ground(const Model& model) {
  if (!model.supports.empty()) return true;
  if (std::ranges::any_of(model.constraints, [](const LinearConstraint& c) { return c.terms.size() == 1; }))
    return true;
  Eigen::AlignedBox3d box;
  for (const Vec3& x : model.nodes)
    if (x.allFinite()) box.extend(x);
  const double near = box.isEmpty() ? 0.0 : apart * box.diagonal().norm();
  return std::ranges::any_of(model.elements, [&](const Element& element) {
    if (const auto* bush = std::get_if<Bush>(&element)) return bush->node_b < 0;
    const auto* spring = std::get_if<Spring>(&element);
    if (spring == nullptr) return false;
    const auto place = [&](int node) -> const Vec3& { return model.nodes[static_cast<std::size_t>(node)]; };
    return spring->node_b < 0 || (place(spring->node_a) - place(spring->node_b)).norm() > near;
  });
}

}  // namespace

double RigidForces::ratio(Eigen::Index row, Eigen::Index motion) const {
  const double f = std::abs(force(row, motion));
  return f == 0.0 ? 0.0 : f / terms(row, motion);
}

double RigidForces::ratio(Eigen::Index row) const {
  double most = 0.0;
  for (Eigen::Index j = 0; j < force.cols(); ++j)
    if (const double here = ratio(row, j); !(here <= most)) most = here;  // NaN counts as the worst
  return most;
}

RigidForces::Worst RigidForces::worst() const {
  Worst worst;
  for (Eigen::Index i = 0; i < force.rows(); ++i)
    if (const double here = ratio(i); !(here <= worst.ratio)) worst = {here, i};
  return worst;
}

RigidForces rigid_forces(const SparseMatrix& K, const Eigen::Ref<const Eigen::MatrixXd>& R) {
  using RowMajor = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
  const Eigen::VectorXd root = K.diagonal().cwiseAbs().cwiseSqrt();
  const RowMajor X = R, size = root.asDiagonal() * R.cwiseAbs();
  RowMajor F = RowMajor::Zero(X.rows(), X.cols()), terms = F;
  for (int j = 0; j < K.outerSize(); ++j)
    for (SparseMatrix::InnerIterator it(K, j); it; ++it) {
      const Eigen::Index i = it.row();
      F.row(i) += it.value() * X.row(j);
      terms.row(i) += size.row(j);
      if (i == j) continue;
      F.row(j) += it.value() * X.row(i);
      terms.row(j) += size.row(i);
    }
  if (X.rows() > 0) terms.rowwise() += of_the_largest * size.colwise().maxCoeff();
  return {F, root.asDiagonal() * terms};
}

double rigid_rounding(const Model& model) {
  const bool strict = model.elements.empty() || reaches_ground(model);
  double limit = strict ? rigid_limit::of_elements : rigid_limit::of_tied_nodes;
  for (const auto& part : model.matrix_parts) limit = std::max(limit, part->rounding);
  return limit;
}

}  // namespace tenon::fem
