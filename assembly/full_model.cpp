#include "assembly/full_model.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "fem/constraints.hpp"
#include "fem/error.hpp"
#include "fem/matrix_part.hpp"

namespace tenon::assembly {
namespace {

using fem::Model;

int add_node(Model& model, const Vec3& x) {
  model.nodes.push_back(x);
  model.node_ids.push_back(-1);
  return static_cast<int>(model.nodes.size()) - 1;
}

/// Where one part's nodes, sections and materials went in the whole, and how the part is turned.
struct Move {
  Mat3 R;
  Vec3 origin;
  int node = 0, material = 0, beam_section = 0, shell_section = 0, taper = 0;

  Vec3 point(const Vec3& x) const { return R * x + origin; }
};

void move(fem::Beam& e, const Move& m) {
  for (int& node : e.nodes) node += m.node;
  for (Vec3& offset : e.offsets) offset = m.R * offset;
  e.orientation = m.R * e.orientation;
  e.section += m.beam_section;
  if (e.taper >= 0) e.taper += m.taper;
  e.material += m.material;
}

void move(fem::Quad4& e, const Move& m) {
  for (int& node : e.nodes) node += m.node;
  e.material_axis = m.R * e.material_axis;
  e.section += m.shell_section;
  e.material += m.material;
}

void move(fem::Tria3& e, const Move& m) {
  for (int& node : e.nodes) node += m.node;
  e.material_axis = m.R * e.material_axis;
  e.section += m.shell_section;
  e.material += m.material;
}

void move(fem::Rod& e, const Move& m) {
  for (int& node : e.nodes) node += m.node;
  e.section += m.beam_section;
  e.material += m.material;
}

void move(fem::Bush& e, const Move& m) {
  e.node_a += m.node;
  if (e.node_b >= 0) e.node_b += m.node;
  e.axes = m.R * e.axes;
  e.offset = m.R * e.offset;
}

/// Scalar points keep their one direction.
void move(fem::Spring& e, const Move& m, const std::vector<char>& scalar) {
  const auto turn = [&](int node, int dof, Vec3& axis) {
    if (node < 0 || scalar[static_cast<std::size_t>(node)] != 0 || m.R.isIdentity(0.0)) return;
    axis = m.R * (axis == Vec3::Zero() ? Vec3(Vec3::Unit(dof % 3)) : axis);
  };
  turn(e.node_a, e.dof_a, e.axis_a);
  turn(e.node_b, e.dof_b, e.axis_b);
  e.node_a += m.node;
  if (e.node_b >= 0) e.node_b += m.node;
}

void move(fem::PointMass& e, const Move& m) {
  e.node += m.node;
  e.offset = m.R * e.offset;
  e.inertia = (m.R * e.inertia * m.R.transpose()).eval();
}

/// Rows over displacements of a part are rows over displacements of the whole, turned: Σ c u_d = Σ c (R e_d)ᵀ u.
fem::LinearConstraint moved(const fem::LinearConstraint& row, const Move& m, const std::vector<char>& scalar) {
  fem::LinearConstraint result{{}, row.id};
  for (const auto& t : row.terms) {
    if (scalar[static_cast<std::size_t>(t.dof.node)] != 0) {
      result.terms.push_back({{t.dof.node + m.node, 0}, t.coefficient});
      continue;
    }
    const int block = 3 * (t.dof.direction / 3);
    for (int i = 0; i < 3; ++i)
      if (const double c = t.coefficient * m.R(i, t.dof.direction % 3); c != 0.0)
        result.terms.push_back({{t.dof.node + m.node, block + i}, c});
  }
  return result;
}

/// An averaging link as rows in its part's own axes, so that its listed directions may be turned with the part.
void add_average_link(Model& whole, const fem::AverageLink& link, const Model& part, const Move& m) {
  if (m.R.isIdentity(0.0)) {
    fem::AverageLink copy = link;
    copy.reference += m.node;
    for (auto& group : copy.nodes) group.node += m.node;
    whole.average_links.push_back(std::move(copy));
    return;
  }
  const fem::Mat6X A = fem::averaging_matrix(part, link);
  const std::vector<char> scalar(part.nodes.size(), 0);
  for (int d = 0; d < 6; ++d) {
    if (((link.directions >> d) & 1U) == 0) continue;
    fem::LinearConstraint row{{{{link.reference, d}, 1.0}}, link.id};
    Eigen::Index column = 0;
    for (const auto& group : link.nodes)
      for (int i = 0; i < 6; ++i)
        if (((group.directions >> i) & 1U) != 0) row.terms.push_back({{group.node, i}, -A(d, column++)});
    whole.constraints.push_back(moved(row, m, scalar));
  }
}

/// Appends a part; returns the index of its first node.
int append(Model& whole, const Model& part, const Mat3& R, const Vec3& origin) {
  const Move m{R,
               origin,
               static_cast<int>(whole.nodes.size()),
               static_cast<int>(whole.materials.size()),
               static_cast<int>(whole.beam_sections.size()),
               static_cast<int>(whole.shell_sections.size()),
               static_cast<int>(whole.tapers.size())};
  std::vector<char> scalar(part.nodes.size(), 0);
  for (const int node : part.scalar_points) {
    scalar[static_cast<std::size_t>(node)] = 1;
    whole.scalar_points.push_back(node + m.node);
  }
  for (const Vec3& x : part.nodes) whole.nodes.push_back(m.point(x));
  whole.node_ids.insert(whole.node_ids.end(), part.node_ids.begin(), part.node_ids.end());
  whole.materials.insert(whole.materials.end(), part.materials.begin(), part.materials.end());
  whole.beam_sections.insert(whole.beam_sections.end(), part.beam_sections.begin(), part.beam_sections.end());
  for (std::vector<fem::Station> taper : part.tapers) {
    for (fem::Station& station : taper) station.section += m.beam_section;
    whole.tapers.push_back(std::move(taper));
  }
  whole.shell_sections.insert(whole.shell_sections.end(), part.shell_sections.begin(), part.shell_sections.end());
  for (fem::Element element : part.elements) {
    std::visit(
        [&](auto& e) {
          if constexpr (std::is_same_v<std::decay_t<decltype(e)>, fem::Spring>)
            move(e, m, scalar);
          else
            move(e, m);
        },
        element);
    whole.elements.push_back(element);
  }
  for (const auto& matrices : part.matrix_parts) whole.matrix_parts.push_back(fem::moved(*matrices, R, m.node, scalar));
  for (fem::RigidLink link : part.rigid_links) {
    link.independent += m.node;
    for (int& node : link.dependents) node += m.node;
    link.axes = R * link.axes;
    whole.rigid_links.push_back(std::move(link));
  }
  for (const fem::AverageLink& link : part.average_links) add_average_link(whole, link, part, m);
  for (const fem::LinearConstraint& row : part.constraints) whole.constraints.push_back(moved(row, m, scalar));
  for (const fem::Support& support : part.supports) {
    if (R.isIdentity(0.0) || scalar[static_cast<std::size_t>(support.dof.node)] != 0)
      whole.supports.push_back({{support.dof.node + m.node, support.dof.direction}});
    else
      whole.constraints.push_back(moved({{{support.dof, 1.0}}, 0}, m, scalar));
  }
  return m.node;
}

/// A rigid body as a mass at its reference and rigid links to its ports; returns the node of each port.
std::vector<int> append_rigid(Model& whole, const ReducedBody& body, const Mat3& R, const Vec3& origin) {
  const int node = add_node(whole, R * body.reference + origin);
  const double m = body.D.topLeftCorner<3, 3>().trace() / 3.0;
  Vec3 c = Vec3::Zero();
  if (m > 0.0) {
    const Mat3 S = body.D.bottomLeftCorner<3, 3>() / m;
    c = Vec3(S(2, 1), S(0, 2), S(1, 0));
  }
  const Mat3 J_c = body.D.bottomRightCorner<3, 3>() + m * fem::skew(c) * fem::skew(c);
  whole.elements.emplace_back(fem::PointMass{node, m, R * J_c * R.transpose(), R * c, 0});
  std::vector<int> ports;
  for (const auto& port : body.ports) {
    ports.push_back(add_node(whole, R * port.position + origin));
    whole.rigid_links.push_back({node, {ports.back()}, fem::all_six, Mat3::Identity(), 0});
  }
  return ports;
}

/// u_child = u_parent + axis θ at coincident ports; θ is a scalar point with the drive's stiffness and inertia.
int add_joint(FullModel& full, const Joint& joint, const Vec3& axis) {
  Model& model = full.model;
  const int parent =
      full.port_node[static_cast<std::size_t>(joint.parent.body)][static_cast<std::size_t>(joint.parent.port)];
  const int child =
      full.port_node[static_cast<std::size_t>(joint.child.body)][static_cast<std::size_t>(joint.child.port)];
  int angle = -1;
  if (joint.kind == JointKind::revolute) {
    angle = add_node(model, model.nodes[static_cast<std::size_t>(child)]);
    model.scalar_points.push_back(angle);
    for (int d = 1; d < 6; ++d) model.supports.push_back({{angle, d}});
    if (joint.stiffness > 0.0) model.elements.emplace_back(fem::Spring{angle, 0, -1, 0, joint.stiffness, 0});
    if (joint.inertia > 0.0)
      model.elements.emplace_back(fem::PointMass{angle, joint.inertia, Mat3::Zero(), Vec3::Zero(), 0});
  }
  for (int d = 0; d < 6; ++d) {
    fem::LinearConstraint row{{{{child, d}, 1.0}, {{parent, d}, -1.0}}, 0};
    if (angle >= 0 && d >= 3 && axis(d - 3) != 0.0) row.terms.push_back({{angle, 0}, -axis(d - 3)});
    model.constraints.push_back(std::move(row));
  }
  return angle;
}

}  // namespace

FullModel full_model(const Network& network, const std::vector<const Model*>& models) {
  const Placement placement = place(network);
  FullModel full;
  full.model.source = "full assembly";
  for (std::size_t b = 0; b < network.bodies.size(); ++b) {
    const ReducedBody& body = network.bodies[b];
    const Mat3& R = placement.R[b];
    const Vec3& origin = placement.origin[b];
    full.first_node.push_back(static_cast<int>(full.model.nodes.size()));
    if (models[b] == nullptr) {
      if (body.n() > 0)
        throw ModelError(
            fmt::format("body '{}' is known only as a reduced body, so there is no full model of it", body.name),
            "Give its mesh in the scene (fe: ...), or leave out --full");
      full.port_node.push_back(append_rigid(full.model, body, R, origin));
      continue;
    }
    const int first = append(full.model, *models[b], R, origin);
    std::vector<int> nodes;
    for (const auto& port : body.ports) {
      const auto found = std::find_if(models[b]->ports.begin(), models[b]->ports.end(),
                                      [&](const fem::Port& p) { return p.name == port.name; });
      if (found == models[b]->ports.end())
        throw ModelError(fmt::format("body '{}' has no port '{}' in its FE model", body.name, port.name),
                         "Name the port in the scene's ports");
      nodes.push_back(first + found->node);
    }
    full.port_node.push_back(std::move(nodes));
  }
  for (const Joint& joint : network.joints) {
    const Vec3 axis =
        placement.R[static_cast<std::size_t>(joint.parent.body)] * port_of(network, joint.parent).axes * joint.axis;
    full.angle_node.push_back(add_joint(full, joint, axis));
  }
  for (const LumpedMass& mass : network.masses) {
    const Mat3& R = placement.R[static_cast<std::size_t>(mass.at.body)];
    full.model.elements.emplace_back(
        fem::PointMass{full.port_node[static_cast<std::size_t>(mass.at.body)][static_cast<std::size_t>(mass.at.port)],
                       mass.mass, R * mass.inertia * R.transpose(), Vec3::Zero(), 0});
  }
  for (const PortRef& port : network.ground)
    for (int d = 0; d < 6; ++d)
      full.model.supports.push_back(
          {{full.port_node[static_cast<std::size_t>(port.body)][static_cast<std::size_t>(port.port)], d}});
  return full;
}

}  // namespace tenon::assembly
