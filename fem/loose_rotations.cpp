#include "fem/loose_rotations.hpp"

#include <Eigen/Eigenvalues>
#include <map>

#include "fem/matrix_part.hpp"

namespace tenon::fem {
namespace {

/// Σ x̂ x̂ᵀ of the rods with torsion at each node.
std::map<int, Mat3> turned_by_rods(const Model& model) {
  std::map<int, Mat3> turned;
  for (const Element& element : model.elements) {
    const auto* rod = std::get_if<Rod>(&element);
    if (!rod || !(model.beam_sections[static_cast<std::size_t>(rod->section)].J > 0.0)) continue;
    const Vec3 x =
        (model.nodes[static_cast<std::size_t>(rod->nodes[1])] - model.nodes[static_cast<std::size_t>(rod->nodes[0])])
            .normalized();
    for (const int node : rod->nodes) turned.try_emplace(node, Mat3::Zero()).first->second += x * x.transpose();
  }
  return turned;
}

/// Takes out nodes whose rotations something else holds, moves or names.
struct TakeOut {
  std::map<int, Mat3>& turned;

  void operator()(const Rod&) const {}
  void operator()(const PointMass& e) const {
    if (e.inertia != Mat3::Zero() || e.offset != Vec3::Zero()) turned.erase(e.node);
  }
  void operator()(const Spring& e) const {
    if (e.dof_a > 2) turned.erase(e.node_a);
    if (e.dof_b > 2) turned.erase(e.node_b);
  }
  void operator()(const Bush& e) const {
    turned.erase(e.node_a);
    turned.erase(e.node_b);
  }
  template <class Other>
  void operator()(const Other& e) const {
    for (const int node : e.nodes) turned.erase(node);
  }
};

}  // namespace

std::vector<LinearConstraint> loose_rotations(const Model& model) {
  std::map<int, Mat3> turned = turned_by_rods(model);
  if (turned.empty()) return {};
  const TakeOut take_out{turned};
  for (const Element& element : model.elements) std::visit(take_out, element);
  for (const auto& part : model.matrix_parts)
    for (const Dof& dof : part->dofs) turned.erase(dof.node);
  for (const RigidLink& link : model.rigid_links) {
    turned.erase(link.independent);
    for (const int node : link.dependents) turned.erase(node);
  }
  for (const AverageLink& link : model.average_links) {
    turned.erase(link.reference);
    for (const auto& group : link.nodes) turned.erase(group.node);
  }
  for (const LinearConstraint& row : model.constraints)
    for (const auto& term : row.terms) turned.erase(term.dof.node);
  for (const Support& support : model.supports)
    if (support.dof.direction > 2) turned.erase(support.dof.node);
  for (const Port& port : model.ports) turned.erase(port.node);

  std::vector<LinearConstraint> rows;
  for (const auto& [node, S] : turned) {
    const Eigen::SelfAdjointEigenSolver<Mat3> eigen(S);
    for (int k = 0; k < 3; ++k) {
      const Vec3 v = eigen.eigenvectors().col(k);
      if (eigen.eigenvalues()[k] > 1e-12 * S.trace() || v.cwiseAbs().maxCoeff() == 1.0) continue;
      LinearConstraint row{{}, model.node_ids[static_cast<std::size_t>(node)]};
      for (int d = 0; d < 3; ++d)
        if (std::abs(v[d]) > 1e-15) row.terms.push_back({{node, 3 + d}, v[d]});
      rows.push_back(std::move(row));
    }
  }
  return rows;
}

}  // namespace tenon::fem
