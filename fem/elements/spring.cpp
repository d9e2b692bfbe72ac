#include "fem/elements/spring.hpp"

#include <fmt/format.h>

#include "fem/error.hpp"

namespace tenon::fem {

void spring_matrices(const Spring& spring, ElementMatrices& out) {
  if (!(spring.k >= 0.0 && std::isfinite(spring.k)))
    throw ModelError(fmt::format("spring {} has the stiffness {:g}", spring.id, spring.k),
                     "Give a stiffness of at least zero");
  Eigen::Matrix<double, Eigen::Dynamic, 1, Eigen::ColMajor, 6, 1> b(0);  // elongation = b·u
  const auto end = [&](const Vec3& axis, double sign) {
    const Eigen::Index n = b.size(), more = axis == Vec3::Zero() ? 1 : 3;
    b.conservativeResize(n + more);
    if (more == 1)
      b[n] = sign;
    else
      b.tail<3>() = sign * axis;
  };
  end(spring.axis_a, 1.0);
  if (spring.node_b >= 0) end(spring.axis_b, -1.0);
  out.K.noalias() = spring.k * b * b.transpose();
  out.M.setZero(b.size(), b.size());
}

}  // namespace tenon::fem
