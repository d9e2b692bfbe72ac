#include <fmt/format.h>

#include <cmath>
#include <set>

#include "fem/checks/cells.hpp"

namespace tenon::fem {
namespace {

using checks::Places;

/// Σ c u = 0 must hold for the six motions of a rigid body, else the equation holds the body to the ground.
void check_rigid_motions(const Model& model, const CheckLimits& limits, std::vector<Finding>& findings) {
  std::vector<char> scalar(model.nodes.size(), 0);
  for (const int node : model.scalar_points) scalar[static_cast<std::size_t>(node)] = 1;
  Places places;
  double worst = 0.0;
  for (const LinearConstraint& constraint : model.constraints) {
    if (constraint.terms.empty()) continue;
    Vec6 sum = Vec6::Zero(), size = Vec6::Zero();
    const Vec3& about = model.nodes[static_cast<std::size_t>(constraint.terms.front().dof.node)];
    for (const LinearConstraint::Term& term : constraint.terms) {
      const auto node = static_cast<std::size_t>(term.dof.node);
      if (scalar[node] != 0) continue;
      const Vec6 c = term.coefficient * tau(model.nodes[node] - about).row(term.dof.direction).transpose();
      sum += c;
      size += c.cwiseAbs();
    }
    double ratio = 0.0;
    for (int j = 0; j < 6; ++j)
      if (size(j) > 0.0) ratio = std::max(ratio, std::abs(sum(j)) / size(j));
    worst = std::max(worst, ratio);
    if (ratio > limits.constraint)
      places.add(ratio,
                 fmt::format("linear constraint {} ({})", constraint.id, name(model, constraint.terms.front().dof)));
  }
  places.report(findings,
                {.severity = Severity::warning,
                 .check = "constraints_hold",
                 .what = "linear constraints that a rigid motion does not satisfy: they hold the body to the ground",
                 .value = worst,
                 .limit = limits.constraint,
                 .cure = "Nothing to do where they are supports; else give each lever arm its rotation term"},
                limits.listed);
}

}  // namespace

// The link passes the support on, which is exact; programs that eliminate one set after the other refuse the model.
void checks::check_supports(const Model& model, const CheckLimits& limits, std::vector<Finding>& findings) {
  std::set<std::pair<int, int>> held;
  for (const Support& support : model.supports) held.emplace(support.dof.node, support.dof.direction);
  Places places;
  const auto look = [&](const Dof& dof, const std::string& link) {
    if (held.contains({dof.node, dof.direction})) places.add(0.0, fmt::format("{} of {}", name(model, dof), link));
  };
  const auto look_all = [&](int node, Directions directions, const std::string& link) {
    for (int d = 0; d < 6; ++d)
      if ((directions >> d) & 1U) look({node, d}, link);
  };
  for (const RigidLink& link : model.rigid_links) {
    if (!link.axes.isIdentity(0.0)) continue;  // its directions are no single dofs
    for (const int node : link.dependents) look_all(node, link.directions, link_name(model, link));
  }
  for (const AverageLink& link : model.average_links) look_all(link.reference, link.directions, link_name(model, link));
  for (const LinearConstraint& row : model.constraints)
    if (!row.terms.empty()) look(row.terms.front().dof, fmt::format("linear constraint {}", row.id));
  places.report(findings,
                {.severity = Severity::warning,
                 .check = "held_dependents",
                 .what = "supports on dofs that a link makes dependent: they hold what the link follows as well",
                 .cure = "Hold the independent node instead, or leave the direction out of the link"},
                limits.listed);
}

std::vector<Finding> check_constraints(const Model& model, const DofMap& dofs, const CheckLimits& limits) {
  std::vector<Finding> findings;
  check_rigid_motions(model, limits, findings);
  Places redundant, twice, zero, ill;
  double least = 1.0;
  for (const ConstraintNote& note : dofs.notes) {
    const std::string where = fmt::format("{} of {}", name(model, note.dof), note.link);
    switch (note.kind) {
      case ConstraintNote::Kind::redundant:
        redundant.add(0.0, where);
        break;
      case ConstraintNote::Kind::dependent_twice:
        twice.add(0.0, where);
        break;
      case ConstraintNote::Kind::forced_zero:
        zero.add(0.0, where);
        break;
      case ConstraintNote::Kind::ill_determined:
        least = std::min(least, note.figure);
        ill.add(-note.figure, where);
    }
  }
  zero.report(findings,
              {.severity = Severity::warning,
               .check = "over_constrained",
               .what = "dofs that links and constraints together leave no motion, although no support holds them",
               .cure = "Take out the link that contradicts the ones before it, or hold the dof by a support"},
              limits.listed);
  ill.report(findings,
             {.severity = Severity::error,
              .check = "constraints_ill_determined",
              .what = "constraints that differ from the ones before them by their last digits only",
              .value = least,
              .limit = 1e-6,
              .cure = "Take them out where they repeat others, or write their coefficients with all digits"},
             limits.listed);
  twice.report(findings,
               {.severity = Severity::note,
                .check = "dependent_twice",
                .what = "dofs that two links make dependent; another dof of the second link was given up",
                .cure = "Nothing to do: both hold. Other programs may refuse it"},
               limits.listed);
  redundant.report(findings,
                   {.severity = Severity::note,
                    .check = "redundant_constraints",
                    .what = "rows of links and constraints that say nothing new",
                    .cure = "Nothing to do: they do not contradict"},
                   limits.listed);
  return findings;
}

}  // namespace tenon::fem
