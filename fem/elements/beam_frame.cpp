#include "fem/elements/beam_frame.hpp"

#include <fmt/format.h>

#include <limits>

#include "fem/error.hpp"

namespace tenon::fem {

void refuse_beam(const Beam& beam, const std::string& what, const std::string& cure) {
  throw ModelError(fmt::format("beam element {}: {}", beam.id, what), cure);
}

void check_beam(const Beam& beam, const BeamSection& s, const Material& m) {
  if (!(m.E > 0.0))
    refuse_beam(beam, fmt::format("Young's modulus of material '{}' is {} Pa", m.name, m.E), "Give a positive one");
  if (!(s.A > 0.0))
    refuse_beam(beam, fmt::format("the area of section '{}' is {} m²", s.name, s.A), "Give a positive one");
  if (!(s.Iy >= 0.0 && s.Iz >= 0.0 && s.J >= 0.0 && s.Iy * s.Iz - s.Iyz * s.Iyz >= -1e-12 * s.Iy * s.Iz))
    refuse_beam(beam,
                fmt::format("section '{}' has second moments no area can have (Iy {}, Iz {}, Iyz {}, J {})", s.name,
                            s.Iy, s.Iz, s.Iyz, s.J),
                "They must satisfy Iy, Iz, J >= 0 and Iyz² <= Iy Iz");
  if (!(s.kappa_y >= 0.0 && s.kappa_z >= 0.0))
    refuse_beam(beam, fmt::format("section '{}' has a negative shear coefficient", s.name),
                "Give κ > 0, or 0 for rigid");
  if (!(m.G > 0.0) && (s.J > 0.0 || s.kappa_y > 0.0 || s.kappa_z > 0.0))
    refuse_beam(beam, fmt::format("material '{}' has no shear modulus, which its torsion or shear needs", m.name),
                "Give G, or E and Poisson's ratio");
  if (!(m.rho >= 0.0 && s.nsm >= 0.0))
    refuse_beam(beam, fmt::format("negative mass (density {}, non-structural {} kg/m)", m.rho, s.nsm),
                "Give masses >= 0");
}

BeamFrame::BeamFrame(const Beam& beam, std::span<const Vec3> nodes) {
  const Vec3 end_1 = nodes[static_cast<std::size_t>(beam.nodes[0])] + beam.offsets[0];
  const Vec3 end_2 = nodes[static_cast<std::size_t>(beam.nodes[1])] + beam.offsets[1];
  const Vec3 axis = end_2 - end_1;
  h = axis.norm();
  if (!(h > 4.0 * std::numeric_limits<double>::epsilon() * (end_1.norm() + end_2.norm())))
    refuse_beam(beam, "its length is zero (both ends lie at one place, offsets included)",
                "Delete it, or join the nodes by a rigid link");
  R.col(0) = axis / h;
  const Vec3 z = R.col(0).cross(beam.orientation);
  if (!(z.norm() > 1e-8 * beam.orientation.norm()))
    refuse_beam(beam, "its orientation vector is zero or parallel to its axis", "Choose one across the axis");
  R.col(2) = z.normalized();
  R.col(1) = R.col(2).cross(R.col(0));
}

Eigen::Matrix<double, 12, 1> end_displacements(const Beam& beam, const BeamFrame& frame,
                                               const Eigen::Ref<const Eigen::VectorXd>& u) {
  Eigen::Matrix<double, 12, 1> ends;
  for (int i = 0; i < 2; ++i) {
    const Vec3 v = u.segment<3>(6 * i), w = u.segment<3>(6 * i + 3);
    ends.segment<3>(6 * i) = frame.R.transpose() * (v + w.cross(beam.offsets[static_cast<std::size_t>(i)]));
    ends.segment<3>(6 * i + 3) = frame.R.transpose() * w;
  }
  return ends;
}

}  // namespace tenon::fem
