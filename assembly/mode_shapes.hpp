#pragma once

#include <string>
#include <vector>

#include "assembly/second_order.hpp"

namespace tenon::assembly {

/// Where a body's nodes lie at rest and how they move, world axes.
struct BodyShapes {
  std::string name;
  std::vector<Vec3> nodes;       ///< N [m]; of a body without node shapes: its reference, then its ports
  Eigen::MatrixXd translations;  ///< 3N×columns
  bool skeleton = false;         ///< nodes are the reference and the ports only
};

/// Translations of all nodes for coordinates ξ of the assembled system, one motion a column (e.g. SystemModes::shapes):
/// u = R (a + θ × r + Ψ η), with (a, θ) the reference's motion, r the node's arm and Ψ its modal shape.
std::vector<BodyShapes> node_motions(const Network& network, const SecondOrderSystem& system,
                                     const Eigen::Ref<const Eigen::MatrixXd>& xi);

}  // namespace tenon::assembly
