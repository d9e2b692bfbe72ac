#pragma once

#include "assembly/mode_shapes.hpp"
#include "assembly/scene.hpp"
#include "fem/formats/vtu.hpp"
#include "fem/model.hpp"

/// Mode shapes as arrays of displacement on one grid, each named "mode 07, 1.2345 Hz" and scaled so that the largest
/// displacement is a tenth of the model's size.
namespace tenon::report {

struct ModePictures {
  fem::Mesh mesh;  ///< points [m] and cells
  std::vector<fem::PointArray> modes;
};

/// Of an assembled scene: FE bodies by their elements, others by lines from their reference to their ports.
ModePictures mode_pictures(const assembly::Scene& scene, const assembly::Network& network,
                           const assembly::SecondOrderSystem& system, const assembly::SystemModes& modes, int count);

/// Of one structural model: `shapes` are columns over all 6 dofs of its nodes, `omega` their frequencies [rad/s].
ModePictures mode_pictures(const fem::Model& model, const Eigen::MatrixXd& shapes, const Eigen::VectorXd& omega);

}  // namespace tenon::report
