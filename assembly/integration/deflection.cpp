#include "assembly/integration/deflection.hpp"

#include <algorithm>

namespace tenon::assembly {

double deflection(const Multibody& system, std::size_t k, const Eigen::VectorXd& q) {
  const ReducedBody& body = *system.bodies[k].body;
  const auto eta = q.segment(system.q_offset[k], body.n());
  double size = 0.0, displacement = 0.0, rotation = 0.0;
  for (const reduction::BodyPort& port : body.ports) {
    size = std::max(size, (port.position - body.reference).norm());
    displacement = std::max(displacement, (port.Phi.topRows<3>() * eta).norm());
    rotation = std::max(rotation, (port.Phi.bottomRows<3>() * eta).norm());
  }
  return std::max(rotation, size > 0.0 ? displacement / size : 0.0);
}

}  // namespace tenon::assembly
