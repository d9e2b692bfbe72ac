#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "fem/checks/cells.hpp"
#include "fem/rigid_forces.hpp"
#include "fem/singular_directions.hpp"

namespace tenon::fem {
namespace {

using checks::Places;

constexpr std::array<const char*, 6> motion_names{"translation x", "translation y", "translation z",
                                                  "rotation x",    "rotation y",    "rotation z"};

double diagonal_of(const Model& model) { return checks::cells_of(model).diagonal; }

Vec3 centre_of(const Structure& s) {
  Vec3 centre = Vec3::Zero();
  for (const Vec3& x : s.nodes) centre += x / static_cast<double>(s.nodes.size());
  return centre;
}

/// A rigid body weighs the same in every direction.
void check_mass_by_direction(const Structure& s, const CheckLimits& limits, std::vector<Finding>& findings) {
  const Eigen::MatrixXd R = rigid_motions(s, Vec3::Zero()).leftCols<3>();
  const Vec3 m = (R.transpose() * (s.M.selfadjointView<Eigen::Lower>() * R)).diagonal();
  const double least = m.minCoeff(), most = m.maxCoeff();
  if (!(most - least <= limits.mass * most))
    findings.push_back({.severity = Severity::error,
                        .check = "mass_by_direction",
                        .what = fmt::format("the mass is {:.6g} in x, {:.6g} in y, {:.6g} in z", m.x(), m.y(), m.z()),
                        .count = 1,
                        .value = (most - least) / most,
                        .limit = limits.mass,
                        .cure = "Look for masses on scalar points or on dofs that are held or dropped"});
}

/// Matrices have no geometry to weigh them against.
void check_mass_of_matrices(const Structure& s, const CheckLimits& limits, std::vector<Finding>& findings) {
  findings.push_back({.check = "mass",
                      .what = fmt::format("{:.6g} kg by M alone: matrices have no geometry to check it against",
                                          mass_properties(s).mass),
                      .cure = ""});
  check_mass_by_direction(s, limits, findings);
}

void check_mass(const Model& model, const Structure& s, const CheckLimits& limits, std::vector<Finding>& findings) {
  const MassProperties a = mass_properties(s), b = geometric_mass_properties(model);
  if (!(b.mass > 0.0) && !(a.mass > 0.0)) {
    findings.push_back({.severity = Severity::warning,
                        .check = "mass",
                        .what = "the model has no mass",
                        .count = 1,
                        .value = 0.0,
                        .cure = "Give its materials a density, or masses to its nodes"});
    return;
  }
  const double size = std::max(diagonal_of(model), 1e-300);
  const auto look = [&](const char* check, const char* what, double gap, double limit, Severity severity) {
    findings.push_back({.severity = gap <= limit ? Severity::note : severity,
                        .check = check,
                        .what = fmt::format("{}: {:.1e} apart", what, gap),
                        .count = gap <= limit ? 0 : 1,
                        .value = gap,
                        .limit = limit,
                        .cure = "Look for dofs that are dropped, held or tied although they carry mass"});
  };
  look("mass", "mass of M against geometry", std::abs(a.mass - b.mass) / std::max(a.mass, b.mass), limits.mass,
       Severity::error);
  look("centre", "centre of mass of M against geometry, over the size of the model",
       (a.centre - b.centre).norm() / size, limits.mass, Severity::error);
  const double inertia = std::max(a.inertia.norm(), b.inertia.norm());
  look("inertia", "inertia of M against geometry", inertia > 0.0 ? (a.inertia - b.inertia).norm() / inertia : 0.0,
       limits.inertia, Severity::warning);
  check_mass_by_direction(s, limits, findings);
}

void check_grounding(const Structure& s, const CheckLimits& limits, std::vector<Finding>& findings) {
  const RigidForces rigid = rigid_forces(s.K, rigid_motions(s, centre_of(s)));
  Places places;
  double worst = 0.0;
  for (Eigen::Index i = 0; i < rigid.force.rows(); ++i) {
    const double ratio = rigid.ratio(i);
    worst = std::max(worst, ratio);
    if (ratio <= s.rounding) continue;
    Eigen::Index motion = 0;
    while (motion < 5 && rigid.ratio(i, motion) < ratio) ++motion;
    places.add(ratio, fmt::format("{} ({:.3g} per unit {})", s.dofs.names[static_cast<std::size_t>(i)],
                                  rigid.force(i, motion), motion_names[static_cast<std::size_t>(motion)]));
  }
  if (places.empty()) {
    findings.push_back(
        {.check = "grounding",
         .what = fmt::format("rigid motions cost no force: |K R| / |K| |R| = {:.1e} in the worst row", worst),
         .value = worst,
         .limit = s.rounding,
         .cure = ""});
    return;
  }
  places.report(
      findings,
      {.severity = Severity::error,
       .check = "grounding",
       .what = "dofs that a rigid motion loads: something ties the model to the ground",
       .value = worst,
       .limit = s.rounding,
       .cure = "Look for springs to ground, springs between nodes apart from each other, and constraints that "
               "no rigid motion satisfies"},
      limits.listed);
}

void check_singular(const Structure& s, const CheckLimits& limits, std::vector<Finding>& findings) {
  Places places;
  double least = 1.0;
  for (const SingularDirection& direction : singular_directions(s, limits.singular)) {
    least = std::min(least, direction.ratio);
    places.add(-direction.ratio, name(s, direction));
  }
  places.report(findings,
                {.severity = Severity::warning,
                 .check = "singular_dofs",
                 .what = "dofs without stiffness of their own: mechanisms, or modes of zero frequency",
                 .value = std::max(least, 0.0),
                 .limit = limits.singular,
                 .cure = "Hold them, tie them, or give them stiffness"},
                limits.listed);
}

void check_dropped(const Model& model, const Structure& s, const CheckLimits& limits, std::vector<Finding>& findings) {
  Places places;
  for (const Dof& dof : s.dofs.unused) places.add(0.0, name(model, dof));
  places.report(findings,
                {.severity = Severity::note,
                 .check = "dropped_dofs",
                 .what = "dofs without stiffness and mass, which were dropped",
                 .cure = ""},
                limits.listed);
}

}  // namespace

std::vector<Finding> check_matrices(const Model& model, const Structure& free, const CheckLimits& limits) {
  std::vector<Finding> findings;
  const bool placed = std::ranges::all_of(model.nodes, [](const Vec3& x) { return x.allFinite(); });
  if (!placed) {
    findings.push_back({.check = "places",
                        .what = "the places of nodes are not known: mass and rigid motions are not checked",
                        .cure = "Give the coordinates in the label file"});
  } else {
    model.matrix_parts.empty() ? check_mass(model, free, limits, findings)
                               : check_mass_of_matrices(free, limits, findings);
    check_grounding(free, limits, findings);
    if (!model.matrix_parts.empty())  // the other program may have left held dofs out
      for (Finding& finding : findings)
        if (finding.severity == Severity::error) finding.severity = Severity::warning;
  }
  check_singular(free, limits, findings);
  check_dropped(model, free, limits, findings);
  return findings;
}

}  // namespace tenon::fem
