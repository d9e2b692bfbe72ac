#pragma once

#include <cmath>

#include "assembly/recursion/multibody.hpp"
#include "chain_data.hpp"

namespace tenon::bench {

/// A link of 1 m with modes of its own, cantilever, hung by its reference: less work than the paper counts for
/// free-free modes, for node d does not deform.
inline std::shared_ptr<const reduction::ReducedBody> link(int modes) {
  reduction::ReducedBody body =
      reduction::rigid_body("link", mass, fem::Vec3(0.5 * length, 0.0, 0.0), inertia * fem::Mat3::Identity(),
                            {{"P", fem::Vec3::Zero(), fem::Mat3::Identity(), {}},
                             {"C", length * fem::Vec3::UnitX(), fem::Mat3::Identity(), {}}});
  body.omega = Eigen::VectorXd::LinSpaced(modes, 10.0, 50.0);
  body.zeta = Eigen::VectorXd::Constant(modes, 0.01);
  body.L = Eigen::MatrixXd::NullaryExpr(modes, 6, [&](Eigen::Index i, Eigen::Index j) {
    return 0.3 * std::cos(1.0 + 2.4 * static_cast<double>(i * 6 + j)) / std::sqrt(modes);
  });
  body.ports[0].Phi = fem::Mat6X::Zero(6, modes);
  body.ports[1].Phi = fem::Mat6X::NullaryExpr(6, modes, [&](Eigen::Index i, Eigen::Index j) {
    return 0.5 * std::sin(0.7 + 1.9 * static_cast<double>(i + 6 * j));
  });
  return std::make_shared<const reduction::ReducedBody>(body);
}

/// Links on revolute hinges; the axis of every second one is tilted about x.
inline assembly::Multibody chain(int bodies, int modes) {
  assembly::Multibody mb = serial_chain(link(modes), bodies, assembly::Deformation::dropped);
  mb.gravity = fem::Vec3(0.0, 0.0, -9.81);
  for (std::size_t k = 1; k < mb.bodies.size(); k += 2)
    mb.bodies[k].inner_axes = mb.bodies[k].outer_axes = fem::Mat3(Eigen::AngleAxisd(tilt, fem::Vec3::UnitX()));
  return mb;
}

inline assembly::MotionState bent(const assembly::Multibody& mb) {
  assembly::MotionState s = rest_state(mb);
  const Eigen::VectorXd delta = Eigen::VectorXd::NullaryExpr(mb.nv, [](Eigen::Index i) { return bend(i); });
  move(mb, delta, s.q);
  s.v = -delta;
  return s;
}

}  // namespace tenon::bench
