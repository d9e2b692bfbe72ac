#include <fmt/format.h>

#include <Eigen/Geometry>
#include <cmath>

#include "fem/elements/beam_frame.hpp"
#include "fem/elements/section_line.hpp"
#include "fem/elements/shell_theory.hpp"
#include "fem/error.hpp"
#include "fem/structure.hpp"

namespace tenon::fem {
namespace {

/// m, Σ m x and ∫ρ x xᵀ about the origin, plus the inertia that is not of points (sections' own rotary inertia).
struct Moments {
  double m = 0.0;
  Vec3 first = Vec3::Zero();
  Mat3 second = Mat3::Zero();
  Mat3 rotary = Mat3::Zero();

  void add_point(double mass, const Vec3& x) {
    m += mass;
    first += mass * x;
    second += mass * x * x.transpose();
  }

  MassProperties properties() const {
    MassProperties p;
    p.mass = m;
    if (m > 0.0) p.centre = first / m;
    const Mat3 about_centre = second - m * p.centre * p.centre.transpose();
    p.inertia = about_centre.trace() * Mat3::Identity() - about_centre + rotary;
    return p;
  }
};

/// Mass along the axis, non-structural mass at its own centre, and the section's rotary inertia about its two bending
/// axes and (unless Nastran's convention is in force) its own axis.
void add(const Model& model, const Beam& beam, Moments& sum) {
  const Material& material = model.materials[static_cast<std::size_t>(beam.material)];
  const BeamFrame frame(beam, model.nodes);
  const Vec3 a = model.nodes[static_cast<std::size_t>(beam.nodes[0])] + beam.offsets[0];
  const Vec3 x = frame.R.col(0), y = frame.R.col(1), z = frame.R.col(2);
  const SectionLine line(model, beam);
  BeamSection section;
  constexpr std::array<double, 3> at{0.1127016653792583, 0.5, 0.8872983346207417}, weight{5.0 / 18, 8.0 / 18, 5.0 / 18};
  for (std::size_t piece = 0; piece < line.pieces(); ++piece)
    for (std::size_t g = 0; g < at.size(); ++g) {
      const double from = line.begin(piece), part = line.begin(piece + 1) - from, t = from + at[g] * part;
      line.at(piece, t, section);
      const double length = weight[g] * part * frame.h, rho_l = material.rho * length;
      const Vec3 centroid = a + t * frame.h * x;
      sum.add_point(rho_l * section.A, centroid);
      sum.add_point(section.nsm * length, centroid + section.nsm_y * y + section.nsm_z * z);
      if (beam.mass == BeamMass::nastran) continue;
      sum.rotary += rho_l * (section.Iy + section.Iz) * x * x.transpose();
      if (!beam.rotary_inertia) continue;
      sum.rotary += rho_l * (section.Iy * y * y.transpose() + section.Iz * z * z.transpose() -
                             section.Iyz * (y * z.transpose() + z * y.transpose()));
    }
}

/// The section of a shell as its elements see it.
template <typename Shell>
ShellTheory theory_of(const Model& model, const Shell& shell) {
  return shell_theory(model.shell_sections[static_cast<std::size_t>(shell.section)],
                      model.materials[static_cast<std::size_t>(shell.material)], "shell", shell.id);
}

/// A point of a shell: mass per area × area, at its height, and the rotary inertia about the two axes in its plane.
void add_shell_point(const ShellTheory& theory, double offset, const Vec3& x, const Vec3& normal, double area,
                     Moments& sum) {
  sum.add_point(theory.mass * area, x + (offset + theory.mass_height) * normal);
  sum.rotary += theory.rotary * area * (Mat3::Identity() - normal * normal.transpose());
}

void add(const Model& model, const Quad4& quad, Moments& sum) {
  const ShellTheory theory = theory_of(model, quad);
  std::array<Vec3, 4> x;
  for (std::size_t i = 0; i < 4; ++i) x[i] = model.nodes[static_cast<std::size_t>(quad.nodes[i])];
  const Vec3 centre = 0.25 * (x[0] + x[1] + x[2] + x[3]), normal = (x[2] - x[0]).cross(x[3] - x[1]).normalized();
  for (Vec3& corner : x) corner -= normal.dot(corner - centre) * normal;  // a warped quad lies in its mean plane
  constexpr std::array<double, 3> at{-0.7745966692414834, 0.0, 0.7745966692414834},
      weight{5.0 / 9.0, 8.0 / 9.0, 5.0 / 9.0};
  for (std::size_t i = 0; i < 3; ++i)
    for (std::size_t j = 0; j < 3; ++j) {
      const double r = at[i], s = at[j];
      const Vec3 point = 0.25 * ((1 - r) * (1 - s) * x[0] + (1 + r) * (1 - s) * x[1] + (1 + r) * (1 + s) * x[2] +
                                 (1 - r) * (1 + s) * x[3]);
      const Vec3 g_r = 0.25 * ((1 - s) * (x[1] - x[0]) + (1 + s) * (x[2] - x[3]));
      const Vec3 g_s = 0.25 * ((1 - r) * (x[3] - x[0]) + (1 + r) * (x[2] - x[1]));
      const Vec3 n = g_r.cross(g_s);
      add_shell_point(theory, quad.offset, point, n.normalized(), weight[i] * weight[j] * n.norm(), sum);
    }
}

void add(const Model& model, const Tria3& tria, Moments& sum) {
  const ShellTheory theory = theory_of(model, tria);
  std::array<Vec3, 3> x;
  for (std::size_t i = 0; i < 3; ++i) x[i] = model.nodes[static_cast<std::size_t>(tria.nodes[i])];
  const Vec3 n = 0.5 * (x[1] - x[0]).cross(x[2] - x[0]);
  for (std::size_t i = 0; i < 3; ++i)  // mid-sides integrate quadratics exactly
    add_shell_point(theory, tria.offset, 0.5 * (x[i] + x[(i + 1) % 3]), n.normalized(), n.norm() / 3.0, sum);
}

void add(const Model& model, const PointMass& mass, Moments& sum) {
  sum.add_point(mass.mass, model.nodes[static_cast<std::size_t>(mass.node)] + mass.offset);
  sum.rotary += mass.inertia;
}

void add(const Model& model, const Rod& rod, Moments& sum) {
  const Material& material = model.materials[static_cast<std::size_t>(rod.material)];
  const BeamSection& section = model.beam_sections[static_cast<std::size_t>(rod.section)];
  const Vec3& a = model.nodes[static_cast<std::size_t>(rod.nodes[0])];
  const Vec3 along = model.nodes[static_cast<std::size_t>(rod.nodes[1])] - a;
  const double length = along.norm(), mass = (material.rho * section.A + section.nsm) * length;
  const double apart =
      rod.mass == BeamMass::nastran ? 0.5 : 0.5 / std::sqrt(3.0);  // Nastran's rods bear it at their ends
  for (const double s : {0.5 - apart, 0.5 + apart}) sum.add_point(0.5 * mass, a + s * along);
  if (rod.mass != BeamMass::nastran)
    sum.rotary += material.rho * (section.Iy + section.Iz) / length * along * along.transpose();
}

void add(const Model&, const Spring&, Moments&) {}
void add(const Model&, const Bush&, Moments&) {}

}  // namespace

MassProperties geometric_mass_properties(const Model& model) {
  if (!model.matrix_parts.empty())
    throw ModelError(fmt::format("{}: matrices have no volumes and densities", model.source), "Take the mass of M");
  Moments sum;
  for (const Element& element : model.elements) std::visit([&](const auto& e) { add(model, e, sum); }, element);
  return sum.properties();
}

Eigen::MatrixXd rigid_motions(const Structure& structure, const Vec3& point) {
  Eigen::MatrixXd R = Eigen::MatrixXd::Zero(structure.n(), 6);
  std::vector<char> scalar(structure.nodes.size(), 0);
  for (const int node : structure.scalar_points) scalar[static_cast<std::size_t>(node)] = 1;
  for (int i = 0; i < structure.n(); ++i) {
    const Dof& dof = structure.dofs.free[static_cast<std::size_t>(i)];
    const auto node = static_cast<std::size_t>(dof.node);
    if (scalar[node] != 0) continue;
    if (!structure.nodes[node].allFinite())
      throw ModelError(fmt::format("the place of {} is not known", structure.dofs.names[static_cast<std::size_t>(i)]),
                       "Rigid motions need it: give x y z of the node beside the matrices");
    R.row(i) = tau(structure.nodes[node] - point).row(dof.direction);
  }
  return R;
}

MassProperties mass_properties(const Structure& structure) {
  Vec3 centroid = Vec3::Zero();
  for (const Vec3& x : structure.nodes)
    if (x.allFinite()) centroid += x / static_cast<double>(structure.nodes.size());
  const Eigen::MatrixXd R = rigid_motions(structure, centroid);
  const Mat6 D = R.transpose() * (structure.M.selfadjointView<Eigen::Lower>() * R);
  MassProperties p;
  p.mass = D.topLeftCorner<3, 3>().trace() / 3.0;
  if (p.mass <= 0.0) return p;
  const Mat3 S = D.bottomLeftCorner<3, 3>() / p.mass;  // m skew(c) below the diagonal of the rigid mass matrix
  const Vec3 c(0.5 * (S(2, 1) - S(1, 2)), 0.5 * (S(0, 2) - S(2, 0)), 0.5 * (S(1, 0) - S(0, 1)));
  p.centre = centroid + c;
  p.inertia = D.bottomRightCorner<3, 3>() + p.mass * skew(c) * skew(c);
  return p;
}

}  // namespace tenon::fem
