#pragma once

#include <vector>

#include "fem/model.hpp"

namespace tenon::fem {

/// Unit normals of the surface that shells approximate, one a node; zero where it has none: at creases (the normal of
/// an element more than 20° off the mean of those around the node), and at nodes without shells. A quadric z = g·x + ½
/// x·B x, fitted by least squares to the nodes around, gives n ∝ e_z − g: error O(h³) of a smooth surface inside, O(h²)
/// at its edges, where two rings of elements are taken. The sense is that of the first element of the node. Empty for a
/// model without shells.
std::vector<Vec3> shell_directors(const Model& model);

}  // namespace tenon::fem
