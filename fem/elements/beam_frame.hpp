#pragma once

#include <span>
#include <string>

#include "fem/model.hpp"

/// What all beam elements share: their axes, and what they refuse.
namespace tenon::fem {

/// ModelError "beam element 7: …".
[[noreturn]] void refuse_beam(const Beam& beam, const std::string& what, const std::string& cure);

/// Refuses constants that no section or material has.
void check_beam(const Beam& beam, const BeamSection& section, const Material& material);

/// A beam's own axes: x from end 1 to end 2, y in the plane of the orientation vector.
struct BeamFrame {
  Mat3 R;          ///< columns: the axes in the basic frame
  double h = 0.0;  ///< length between the ends [m]

  /// @throws ModelError for a beam without length, or with its orientation along its axis
  BeamFrame(const Beam& beam, std::span<const Vec3> nodes);

  /// Offsets of the ends in the beam's axes.
  std::array<Vec3, 2> arms(const Beam& beam) const {
    return {R.transpose() * beam.offsets[0], R.transpose() * beam.offsets[1]};
  }
};

/// What the ends of the beam do, in its axes, when its nodes move by u (basic frame, 12).
Eigen::Matrix<double, 12, 1> end_displacements(const Beam& beam, const BeamFrame& frame,
                                               const Eigen::Ref<const Eigen::VectorXd>& u);

}  // namespace tenon::fem
