#include "fem/elements/point_mass.hpp"

#include <fmt/format.h>

#include <Eigen/Eigenvalues>

#include "fem/error.hpp"

namespace tenon::fem {

void point_mass_matrices(const PointMass& point, ElementMatrices& out) {
  const std::string who = fmt::format("point mass {}", point.id);
  if (!(point.mass >= 0.0 && std::isfinite(point.mass)))
    throw ModelError(fmt::format("{}: its mass is {} kg", who, point.mass), "Give a mass >= 0");
  const double size = point.inertia.norm();
  if (!((point.inertia - point.inertia.transpose()).norm() <= 1e-12 * size))
    throw ModelError(who + ": its inertia is not symmetric", "Give I_xy = I_yx and so on; products enter negated");
  if (size > 0.0) {
    Eigen::SelfAdjointEigenSolver<Mat3> principal;
    principal.computeDirect(point.inertia, Eigen::EigenvaluesOnly);
    if (principal.eigenvalues()[0] < -1e-7 * size)  // computeDirect is accurate to about √ε
      throw ModelError(
          fmt::format("{}: its inertia has the negative principal value {} kg m²", who, principal.eigenvalues()[0]),
          "Check the signs of the products of inertia");
  }
  out.K.setZero(6, 6);
  out.M = rigid_mass(point.mass, point.offset, point.inertia);
}

}  // namespace tenon::fem
