#include "assembly/kinematics.hpp"

#include <cmath>

namespace tenon::assembly {

using fem::Mat6;
using fem::Vec6;

double natural_length(const Placement& placement) { return placement.size > 0.0 ? placement.size : 1.0; }

Eigen::VectorXd natural_amplitudes(const ReducedBody& body, double length) {
  const double mass = body.D(0, 0);
  Eigen::RowVectorXd mobility = Eigen::RowVectorXd::Constant(body.n(), mass > 0.0 ? 1e-3 / std::sqrt(mass) : 1e-3);
  if (body.n() > 0)
    for (const reduction::BodyPort& port : body.ports) {
      mobility = mobility.cwiseMax(port.Phi.topRows<3>().cwiseAbs().colwise().maxCoeff());
      mobility = mobility.cwiseMax(length * port.Phi.bottomRows<3>().cwiseAbs().colwise().maxCoeff());
    }
  return mobility.cwiseInverse().transpose();
}

Eigen::MatrixXd port_rows(const ReducedBody& body, int port, const Mat3& R) {
  const reduction::BodyPort& p = body.ports[static_cast<std::size_t>(port)];
  Eigen::MatrixXd rows(6, 6 + body.n());
  rows.leftCols<6>() = fem::tau(R * (p.position - body.reference));
  rows.rightCols(body.n()) = fem::rotation6(R) * p.Phi;
  return rows;
}

Vec3 joint_axis(const Network& network, const Placement& placement, const Joint& joint) {
  const Mat3& R = placement.R[static_cast<std::size_t>(joint.parent.body)];
  return (R * port_of(network, joint.parent).axes * joint.axis).normalized();
}

Mat6 lumped_mass(const LumpedMass& lump, const Mat3& R) {
  Mat6 M = Mat6::Zero();
  M.topLeftCorner<3, 3>() = lump.mass * Mat3::Identity();
  M.bottomRightCorner<3, 3>() = R * lump.inertia * R.transpose();
  return M;
}

titop::Channel channel(const Input& input) { return {input.name, !input.joint && input.direction < 3 ? "N" : "N m"}; }

titop::Channel channel(const Output& output) {
  const std::string length = !output.joint && output.direction < 3 ? "m" : "rad";
  switch (output.quantity) {
    case Quantity::position:
      return {output.name, length};
    case Quantity::velocity:
      return {output.name, length + "/s"};
    default:
      return {output.name, length + "/s²"};
  }
}

}  // namespace tenon::assembly
