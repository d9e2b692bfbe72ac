#include "assembly/build_beam.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "fem/structure.hpp"
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

// Keeps the modes that move in the x-y plane of the beam alone. A straight beam with principal axes has no others but
// those that move out of it; what rounding mixed in between becomes an exact zero.
ReducedBody in_plane(ReducedBody body, const BeamSource& beam) {
  const fem::Mat6 R6 = fem::rotation6(beam_axes(beam));
  const fem::Vec6 inside{{1.0, 1.0, 0.0, 0.0, 0.0, 1.0}};
  const fem::Mat6 P = R6 * inside.asDiagonal() * R6.transpose();
  std::vector<Eigen::Index> kept;
  for (Eigen::Index j = 0; j < body.n(); ++j) {
    double in = 0.0, all = 0.0;
    for (Eigen::Index k = 0; k + 6 <= body.node_shapes.rows(); k += 6) {
      in += (P * body.node_shapes.col(j).segment<6>(k)).squaredNorm();
      all += body.node_shapes.col(j).segment<6>(k).squaredNorm();
    }
    if (in > 0.5 * all) kept.push_back(j);
  }
  const Eigen::MatrixXd C = body.C;
  body.omega = body.omega(kept).eval();
  body.zeta = body.zeta(kept).eval();
  if (C.size() > 0) body.C = C(kept, kept);
  body.L = (body.L(kept, Eigen::all) * P).eval();
  for (reduction::BodyPort& port : body.ports) port.Phi = (P * port.Phi(Eigen::all, kept)).eval();
  body.node_shapes = body.node_shapes(Eigen::all, kept).eval();
  for (Eigen::Index k = 0; k + 6 <= body.node_shapes.rows(); k += 6)
    body.node_shapes.middleRows<6>(k) = (P * body.node_shapes.middleRows<6>(k)).eval();
  body.certificate.left_out.emplace_back("all flexibility out of the x-y plane: the scene takes the beam as planar");
  return body;
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
  model.beam_sections = {section_of(beam)};
  for (int k = 0; k < n; ++k)
    model.elements.push_back(fem::Beam{.nodes = {k, k + 1},
                                       .orientation = *beam.section.orientation,
                                       .rotary_inertia = beam.section.rotary_inertia,
                                       .id = k + 1});
  model.ports = {{"P", 0, Mat3::Identity()}, {"C", n, Mat3::Identity()}};
  return model;
}

ReducedBody make_beam(const SceneBody& body, const BeamSource& beam, const BodyPlan& plan,
                      const reduction::Progress& progress) {
  if (beam.model != BeamSource::Model::fe) return analytic(body, beam);
  fem::Model model = beam_model(body, beam);
  const int elements = static_cast<int>(model.elements.size());
  // out-of-plane bending must not share a frequency with bending in the plane, lest their modes mix
  if (beam.planar) model.beam_sections[0].Iy = 1.7 * model.beam_sections[0].Iz;
  reduction::ReduceOptions options = plan.options;
  options.progress = progress;
  if (beam.planar) options.modes *= 3;  // bending out of the plane and torsion are dropped afterwards
  ReducedBody reduced = reduction::reduce(fem::assemble(model), body.parent_port, options);
  reduced.name = body.name;
  reduced.certificate.elements = elements;
  return beam.planar ? in_plane(std::move(reduced), beam) : reduced;
}

}  // namespace tenon::assembly
