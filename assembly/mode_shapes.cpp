#include "assembly/mode_shapes.hpp"

namespace tenon::assembly {

std::vector<BodyShapes> node_motions(const Network& network, const SecondOrderSystem& system,
                                     const Eigen::Ref<const Eigen::MatrixXd>& xi) {
  const Eigen::MatrixXd q = system.N * xi;
  std::vector<BodyShapes> all;
  for (std::size_t b = 0; b < network.bodies.size(); ++b) {
    const ReducedBody& body = network.bodies[b];
    const Mat3& R = system.placement.R[b];
    const Vec3& origin = system.placement.origin[b];
    const auto reference = q.middleRows(system.offset[b], 6);
    const auto eta = q.middleRows(system.offset[b] + 6, body.n());

    BodyShapes shapes;
    shapes.name = body.name;
    shapes.skeleton = body.node_positions.empty();
    std::vector<Vec3> positions = body.node_positions;  // body frame
    if (shapes.skeleton) {
      positions.push_back(body.reference);
      for (const reduction::BodyPort& port : body.ports) positions.push_back(port.position);
    }
    shapes.translations.resize(static_cast<Eigen::Index>(3 * positions.size()), xi.cols());
    for (std::size_t k = 0; k < positions.size(); ++k) {
      const auto row = static_cast<Eigen::Index>(k);
      auto u = shapes.translations.middleRows<3>(3 * row);
      u = reference.topRows<3>() - fem::skew(R * (positions[k] - body.reference)) * reference.bottomRows<3>();
      if (!shapes.skeleton)
        u += R * (body.node_shapes.middleRows<3>(6 * row) * eta);
      else if (k > 0)
        u += R * (body.ports[k - 1].Phi.topRows<3>() * eta);
      shapes.nodes.push_back(origin + R * positions[k]);
    }
    all.push_back(std::move(shapes));
  }
  return all;
}

}  // namespace tenon::assembly
