#include "reduction/geometric_stiffness.hpp"

#include <fmt/format.h>

#include "fem/error.hpp"

namespace tenon::reduction {

void geometric_stiffness(const GeometricStiffness& stiffening, const Vec3& a, const Vec3& alpha, const Vec3& omega,
                         const double* wrenches, Eigen::Ref<Eigen::MatrixXd> K_G) {
  const Eigen::Index n = K_G.cols(), loads = stiffening.K_G.cols();
  const Vec3& w = omega;
  const double gamma[GeometricStiffness::inertia_loads] = {a.x(),         a.y(),         a.z(),         alpha.x(),
                                                           alpha.y(),     alpha.z(),     w.x() * w.x(), w.y() * w.y(),
                                                           w.z() * w.z(), w.x() * w.y(), w.x() * w.z(), w.y() * w.z()};
  K_G.setZero();
  for (Eigen::Index load = 0; load < loads; ++load) {
    const Eigen::Index port = load - GeometricStiffness::inertia_loads;
    const double g = port < 0 ? gamma[load] : wrenches != nullptr ? wrenches[port] : 0.0;
    if (g == 0.0) continue;
    for (Eigen::Index k = 0; k < n; ++k) K_G.col(k) += g * stiffening.K_G.col(load).segment(n * k, n);
  }
}

void check(const GeometricStiffness& stiffening, const ReducedBody& body) {
  const Eigen::Index n = body.omega.size();
  const auto loads = GeometricStiffness::inertia_loads + 6 * static_cast<Eigen::Index>(body.ports.size());
  const std::string redo = "It is damaged or of another body: compute it again";
  if (stiffening.K_G.rows() != n * n || stiffening.K_G.cols() != loads)
    throw ModelError(fmt::format("the geometric stiffness of body '{}' is {}×{} where {}×{} is expected", body.name,
                                 stiffening.K_G.rows(), stiffening.K_G.cols(), n * n, loads),
                     redo);
  if (!stiffening.K_G.allFinite())
    throw ModelError(fmt::format("the geometric stiffness of body '{}' is not finite", body.name), redo);
}

}  // namespace tenon::reduction
