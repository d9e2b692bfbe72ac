#include "assembly/recursion/stiffening.hpp"

#include "reduction/geometric_stiffness.hpp"

namespace tenon::assembly {

using Eigen::Index;
using Eigen::VectorXd;

void add_stiffening(const Multibody& system, const VectorXd& q, Sweeps& sweeps) {
  const auto count = static_cast<int>(system.bodies.size());
  for (BodySweep& s : sweeps.bodies) {
    Vec6 felt = s.alpha_bias;  // less gravity
    felt.head<3>() -= s.world.R.transpose() * system.gravity;
    s.z_r = s.M.bottomRightCorner<6, 6>() * felt + s.b.tail<6>();
    s.port_wrenches.setZero();
  }
  for (int k = count - 1; k >= 0; --k) {  // tip to base: what each hinge carries
    const HingedBody& b = system.bodies[static_cast<std::size_t>(k)];
    BodySweep& s = sweeps.bodies[static_cast<std::size_t>(k)];
    if (s.K_G.size() > 0) {
      const Vec3 w = s.V.tail<3>(), felt = s.alpha_bias.head<3>() - s.world.R.transpose() * system.gravity;
      reduction::geometric_stiffness(*b.body->stiffening, felt, s.alpha_bias.tail<3>(), w, s.port_wrenches.data(),
                                     s.K_G);
      const Index n = b.modes();
      s.b.head(n).noalias() += s.K_G * q.segment(system.q_offset[static_cast<std::size_t>(k)], n);
    }
    if (b.parent < 0) continue;
    BodySweep& parent = sweeps.bodies[static_cast<std::size_t>(b.parent)];
    const Vec6 at_node = s.X.wrench(s.z_r);
    parent.z_r += fem::shift_wrench(at_node, s.to_node);
    if (parent.port_wrenches.size() > 0) parent.port_wrenches.segment<6>(6 * b.inner_port) -= at_node;
  }
}

SpinRatio spin_ratio(const Multibody& system, const Sweeps& sweeps) {
  SpinRatio worst;
  for (std::size_t k = 0; k < system.bodies.size(); ++k) {
    const ReducedBody& body = *system.bodies[k].body;
    if (body.n() == 0 || body.omega[0] == 0.0 || sweeps.bodies[k].K_G.size() > 0) continue;
    const double ratio = sweeps.bodies[k].V.tail<3>().norm() / body.omega[0];
    if (worst.body < 0 || ratio > worst.ratio) worst = {static_cast<int>(k), ratio};
  }
  return worst;
}

}  // namespace tenon::assembly
