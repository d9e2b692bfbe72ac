#include <fmt/format.h>

#include <Eigen/Eigenvalues>

#include "fem/checks/cells.hpp"

namespace tenon::fem::checks {

// ½ tr(J) − J = ∫ x xᵀ dm has no negative principal value: no principal moment is above the sum of the other two.
// Lumped masses are found, not refused: K and M ask for no more than J ≥ 0, and a node may carry one moment alone.
void check_masses(const Model& model, const CheckLimits& limits, std::vector<Finding>& findings) {
  constexpr double rounding = 1.01;  // inertias are known to few digits, and flat bodies lie on the limit
  Places places;
  double worst = 0.0;
  for (const Element& element : model.elements) {
    const auto* const point = std::get_if<PointMass>(&element);
    if (!point || point->inertia == Mat3::Zero()) continue;
    const Vec3 J = Eigen::SelfAdjointEigenSolver<Mat3>(point->inertia, Eigen::EigenvaluesOnly).eigenvalues();
    if (!(J[2] > rounding * (J[0] + J[1]))) continue;
    const double ratio = J[2] / std::max(J[0] + J[1], 1e-300);
    worst = std::max(worst, ratio);
    places.add(ratio, fmt::format("point mass {} at {} ({:.4g}, {:.4g}, {:.4g})", point->id,
                                  name(model, {point->node, 0}).substr(0, name(model, {point->node, 0}).rfind(' ')),
                                  J[0], J[1], J[2]));
  }
  places.report(findings,
                {.severity = Severity::warning,
                 .check = "impossible_inertia",
                 .what = "inertias that no body has: a principal moment is more than the sum of the other two",
                 .value = worst,
                 .limit = rounding,
                 .cure = "Check units, signs of products and axes; modes are as given, large motion turns it wrongly"},
                limits.listed);
}

}  // namespace tenon::fem::checks
