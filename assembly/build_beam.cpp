#include "assembly/build_beam.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "fem/structure.hpp"
#include "reduction/large_motion.hpp"
#include "titop/beam.hpp"

namespace tenon::assembly {

namespace {

const fem::BeamSection& section_of(const BeamSource& beam) { return std::get<fem::BeamSection>(beam.section.shape); }

// Columns: the beam's x, y and z axes in the body frame.
Mat3 beam_axes(const BeamSource& beam) {
  Mat3 R;
  R.col(0) = (beam.to - beam.from).normalized();
  R.col(2) = R.col(0).cross(*beam.section.orientation).normalized();
  R.col(1) = R.col(2).cross(R.col(0));
  return R;
}

// Shapes and participation from beam axes with the origin at P to the body frame.
ReducedBody set_into_frame(ReducedBody body, const BeamSource& beam) {
  const Mat3 R = beam_axes(beam);
  const fem::Mat6 R6 = fem::rotation6(R);
  body.reference = beam.from + R * body.reference;
  body.L = (body.L * R6.transpose()).eval();
  body.D = (R6 * body.D * R6.transpose()).eval();
  for (reduction::BodyPort& port : body.ports) {
    port.position = beam.from + R * port.position;
    port.Phi = (R6 * port.Phi).eval();
  }
  for (Vec3& node : body.node_positions) node = beam.from + R * node;
  for (Eigen::Index k = 0; k + 6 <= body.node_shapes.rows(); k += 6)
    body.node_shapes.middleRows<6>(k) = (R6 * body.node_shapes.middleRows<6>(k)).eval();
  return body;
}

// Keeps the modes that move in the x-y plane alone, of a body in the beam's own axes. A straight beam with principal
// axes has no others but those that move out of it; what rounding mixed in between becomes an exact zero.
ReducedBody in_plane(ReducedBody body) {
  const fem::Vec6 inside{{1.0, 1.0, 0.0, 0.0, 0.0, 1.0}};
  std::vector<Eigen::Index> kept;
  for (Eigen::Index j = 0; j < body.n(); ++j) {
    double in = 0.0, all = 0.0;
    for (Eigen::Index k = 0; k + 6 <= body.node_shapes.rows(); k += 6) {
      in += inside.cwiseProduct(body.node_shapes.col(j).segment<6>(k)).squaredNorm();
      all += body.node_shapes.col(j).segment<6>(k).squaredNorm();
    }
    if (in > 0.5 * all) kept.push_back(j);
  }
  body.omega = body.omega(kept).eval();
  body.zeta = body.zeta(kept).eval();
  body.L = (body.L(kept, Eigen::all) * inside.asDiagonal()).eval();
  for (reduction::BodyPort& port : body.ports) port.Phi = (inside.asDiagonal() * port.Phi(Eigen::all, kept)).eval();
  body.node_shapes = body.node_shapes(Eigen::all, kept).eval();
  for (Eigen::Index k = 0; k + 6 <= body.node_shapes.rows(); k += 6)
    body.node_shapes.middleRows<6>(k) = (inside.asDiagonal() * body.node_shapes.middleRows<6>(k)).eval();
  body.certificate.left_out.emplace_back("all flexibility out of the x-y plane: the scene takes the beam as planar");
  return body;
}

// The beam in its own axes with the origin at P. Traction is EA/l and bending EI/l³: turned into one another in a
// matrix, a slender beam's bending drowns in the rounding of its traction (2 % of ω at a slenderness of 1e6); along the
// axes they never meet.
fem::Model in_own_axes(const SceneBody& body, BeamSource beam) {
  beam.to = (beam.to - beam.from).norm() * Vec3::UnitX();
  beam.from = Vec3::Zero();
  beam.section.orientation = Vec3::UnitY();
  return beam_model(body, beam);
}

ReducedBody spatial(const SceneBody& body, const BeamSource& beam, const reduction::ReduceOptions& options) {
  return set_into_frame(reduction::reduce(fem::assemble(in_own_axes(body, beam)), body.parent_port, options), beam);
}

// So stiff out of the plane that the modes asked for are those in it; the mass matrix is that of the section as it is.
ReducedBody planar(const SceneBody& body, const BeamSource& beam, const reduction::ReduceOptions& options) {
  fem::Model model = in_own_axes(body, beam);
  const fem::MassProperties mass = fem::mass_properties(fem::assemble(model));
  for (fem::BeamSection& section : model.beam_sections) {
    section.Iy = 1e6 * section.Iz;
    section.J = 1e10 * section.Iz;
    section.kappa_z = 0.0;  // rigid in shear across the plane
  }
  ReducedBody reduced = in_plane(reduction::reduce(fem::assemble(model), body.parent_port, options));
  reduced.D = fem::rigid_mass(mass.mass, mass.centre - reduced.reference, mass.inertia);
  return set_into_frame(std::move(reduced), beam);
}

ReducedBody analytic(const SceneBody& body, const BeamSource& beam) {
  const fem::BeamSection& section = section_of(beam);
  const fem::Material& material = beam.section.material;
  titop::BeamProperties properties{.length = (beam.to - beam.from).norm(),
                                   .E = material.E,
                                   .G = material.G,
                                   .rho = material.rho + section.nsm / section.A,
                                   .A = section.A,
                                   .Iy = section.Iy,
                                   .Iz = section.Iz,
                                   .J = section.J,
                                   .Ip = section.Iy + section.Iz};
  const titop::BeamOptions options{.model = beam.model == BeamSource::Model::polynomial
                                                ? titop::BeamModel::polynomial
                                                : titop::BeamModel::clamped_free,
                                   .modes = beam.modes,
                                   .bend_xz = !beam.planar,
                                   .torsion = !beam.planar && section.J > 0.0,
                                   .zeta = body.damping};
  const ReducedBody made = set_into_frame(titop::beam_body(body.name, properties, options), beam);
  return reduction::rebase(made, reduction::port_index(made, body.parent_port));
}

}  // namespace

fem::Model beam_model(const SceneBody& body, const BeamSource& beam) {
  fem::Model model;
  model.source = fmt::format("beam '{}'", body.name);
  const int n = beam.elements;
  for (int k = 0; k <= n; ++k) {
    const double t = static_cast<double>(k) / n;
    model.nodes.push_back((1.0 - t) * beam.from + t * beam.to);
    model.node_ids.push_back(k + 1);
  }
  model.materials = {beam.section.material};
  const bool tapered = beam.section.taper != nullptr;
  model.beam_sections = {section_of(beam)};
  for (int k = 1; k <= n && tapered; ++k) {
    model.beam_sections.push_back(beam.section.taper(static_cast<double>(k) / n));
    model.tapers.push_back({{0.0, k - 1}, {1.0, k}});
  }
  for (int k = 0; k < n; ++k)
    model.elements.push_back(fem::Beam{.nodes = {k, k + 1},
                                       .section = tapered ? k : 0,
                                       .taper = tapered ? k : -1,
                                       .orientation = *beam.section.orientation,
                                       .rotary_inertia = beam.section.rotary_inertia,
                                       .id = k + 1});
  model.ports = {{"P", 0, Mat3::Identity()}, {"C", n, Mat3::Identity()}};
  return model;
}

fem::Model full_beam_model(const SceneBody& body, const BeamSource& beam) {
  fem::Model model = beam_model(body, beam);
  if (!beam.planar) return model;
  constexpr fem::Directions out_of_plane = 0b011100;
  fem::RigidLink link{.independent = 0, .dependents = {}, .directions = out_of_plane, .axes = beam_axes(beam), .id = 1};
  for (int k = 1; k <= beam.elements; ++k) link.dependents.push_back(k);
  model.rigid_links.push_back(std::move(link));
  return model;
}

ReducedBody make_beam(const SceneBody& body, const BeamSource& beam, const BodyPlan& plan,
                      const reduction::Progress& progress) {
  if (beam.model != BeamSource::Model::fe) return analytic(body, beam);
  reduction::ReduceOptions options = plan.options;
  options.progress = progress;
  options.nonlinear = false;  // follows in the axes of the scene
  ReducedBody reduced = beam.planar ? planar(body, beam, options) : spatial(body, beam, options);
  reduced.name = body.name;
  reduced.certificate.elements = beam.elements;
  if (plan.options.nonlinear) {
    const fem::Model model = beam_model(body, beam);
    reduction::add_large_motion(model, fem::assemble(model), reduced);
  }
  return reduced;
}

}  // namespace tenon::assembly
