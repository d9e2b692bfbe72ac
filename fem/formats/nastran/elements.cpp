#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <span>

#include "fem/formats/nastran/beams.hpp"

namespace tenon::fem::nastran {
namespace {

struct ElementReader {
  Draft& draft;
  Properties properties;
  Register known{"element"};
  ElementCells cells;

  const Vec3& at(int node) const { return draft.deck.model.nodes[static_cast<std::size_t>(node)]; }
  const Mat3& axes(int node) const { return draft.axes[static_cast<std::size_t>(node)]; }
  void carry(int node) { draft.carries[static_cast<std::size_t>(node)] = true; }

  void rod(const Card& card, const Property& property, int first_node);
  Vec3 material_axis(const Card& card, int field, const Vec3& a, const Vec3& b, const Vec3& normal) const;
  void corner_thickness(const Card& card, int tflag, int first, int n, double thickness) const;
  template <class Shell>
  void shell(const Card& card, std::size_t block);
  template <int n>
  void second_order_shell(const Card& card);
  void point_mass(const Card& card);
};

// G1 G2; torsion acts between the rotations about the line that joins them
void ElementReader::rod(const Card& card, const Property& property, int first_node) {
  Rod rod{.section = property.section, .material = property.material, .id = card.id(1, "EID")};
  rod.nodes = {draft.node(card, first_node, "G1"), draft.node(card, first_node + 1, "G2")};
  const Vec3 &a = at(rod.nodes[0]), &b = at(rod.nodes[1]);
  if (!((b - a).norm() > 1e-12 * (a.norm() + b.norm())))
    card.refuse(first_node,
                fmt::format("{} has no length: both ends lie at ({:g}, {:g}, {:g})", rod.id, a.x(), a.y(), a.z()),
                "Correct the grids; a spring between coincident grids is a CBUSH");
  if (draft.deck.coupled_mass) rod.mass = BeamMass::nastran;
  carry(rod.nodes[0]);
  carry(rod.nodes[1]);
  cells.add(0, rod.nodes, rod.id, draft.deck.model.beam_sections[static_cast<std::size_t>(rod.section)].name);
  draft.deck.model.elements.emplace_back(rod);
}

// THETA in degrees from the side G1-G2 about the normal, or MCID, whose x axis it is; zero for a blank
Vec3 ElementReader::material_axis(const Card& card, int field, const Vec3& a, const Vec3& b, const Vec3& normal) const {
  if (card.blank(field)) return Vec3::Zero();
  if (const auto system = parse_integer(card.at(field))) return draft.frame_at(card, field, "MCID", *system, a).col(0);
  const double theta = card.real(field, "THETA") * std::numbers::pi / 180.0;
  const Vec3 n = normal.normalized(), x = (b - a - n * n.dot(b - a)).normalized();
  return std::cos(theta) * x + std::sin(theta) * n.cross(x);
}

/// TFLAG, and T1.. from field `first`: Nastran's shells may differ in thickness at their corners, ours do not.
void ElementReader::corner_thickness(const Card& card, int tflag, int first, int n, double thickness) const {
  const double unit = card.integer(tflag, "TFLAG", 0) == 1 ? thickness : 1.0;
  for (int i = first; i < first + n; ++i)
    if (!card.blank(i) && std::abs(card.real(i, "T") * unit - thickness) > 1e-6 * thickness)
      draft.losses.add_physical(card.name() + " T1..T4", "thickness at the corners that differs from PSHELL's",
                                card.place(i));
}

template <class Shell>
void ElementReader::shell(const Card& card, std::size_t block) {
  constexpr std::array<const char*, 4> labels{"G1", "G2", "G3", "G4"};
  Shell shell;
  shell.id = card.id(1, "EID");
  if (!known.admit(shell.id, card, draft.losses)) return;
  const Property& property = Properties::find(properties.shells, "PSHELL or PCOMP", card, 2);
  shell.section = property.section;
  shell.material = property.material;
  const int n = static_cast<int>(shell.nodes.size());
  for (int i = 0; i < n; ++i) {
    const int node = draft.node(card, 3 + i, labels[static_cast<std::size_t>(i)]);
    for (int j = 0; j < i; ++j)
      if (shell.nodes[static_cast<std::size_t>(j)] == node)
        card.refuse(3 + i, fmt::format("{} names GRID {} at two corners", shell.id, card.at(3 + i)),
                    "Write a collapsed quadrilateral as CTRIA3");
    shell.nodes[static_cast<std::size_t>(i)] = node;
    carry(node);
  }
  const auto& section = draft.deck.model.shell_sections[static_cast<std::size_t>(shell.section)];
  // behind the corners: THETA, ZOFFS; on the second line TFLAG and T1..
  shell.offset = card.real(4 + n, "ZOFFS", 0.0) + property.offset;
  corner_thickness(card, 10, 11, n, section.thickness);
  const Vec3 p = at(shell.nodes[0]), diagonal = at(shell.nodes[2]) - p;
  const Vec3 other = at(shell.nodes.back()) - (n == 4 ? at(shell.nodes[1]) : p);
  const double size = diagonal.norm() + other.norm() + 1e-4 * p.norm();
  if (n == 4 ? !(diagonal.cross(other).norm() > 1e-12 * size * size)
             : !(diagonal.cross(at(shell.nodes[1]) - p).norm() > 1e-12 * size * size))
    card.refuse(3, fmt::format("{} has no area", shell.id), "Correct its grids");
  if (!section.plies.empty())
    shell.material_axis = material_axis(card, 3 + n, p, at(shell.nodes[1]), diagonal.cross(other));
  cells.add(block, shell.nodes, shell.id, section.name);
  draft.deck.model.elements.emplace_back(shell);
}

/// The elements that n corners, then n middles of their sides, then a quadrilateral's centre become.
constexpr std::array<std::array<std::size_t, 4>, 4> quads_of_8{
    {{0, 4, 8, 7}, {4, 1, 5, 8}, {8, 5, 2, 6}, {7, 8, 6, 3}}};
constexpr std::array<std::array<std::size_t, 3>, 4> triangles_of_6{{{0, 3, 5}, {3, 1, 4}, {5, 4, 2}, {3, 4, 5}}};

// CQUAD8 (n = 4): G1..G8, T1..T4, THETA, ZOFFS, TFLAG; CTRIA6 (3): G1..G6, THETA, ZOFFS, T1..T3, TFLAG
template <int n>
void ElementReader::second_order_shell(const Card& card) {
  constexpr std::array<const char*, 8> labels{"G1", "G2", "G3", "G4", "G5", "G6", "G7", "G8"};
  constexpr int theta = n == 4 ? 15 : 9, thickness = 11, tflag = thickness + n + (n == 4 ? 2 : 0);
  const long id = card.id(1, "EID");
  if (!known.admit(id, card, draft.losses)) return;
  const Property& property = Properties::find(properties.shells, "PSHELL or PCOMP", card, 2);
  std::array<int, 2 * n + 1> nodes{};
  for (int i = 0; i < 2 * n; ++i) {
    const auto k = static_cast<std::size_t>(i);
    if (i >= n && card.blank(3 + i))
      card.fail(3 + i, labels[k],
                fmt::format("the grid in the middle of a side: write an element without them as {}",
                            n == 4 ? "CQUAD4" : "CTRIA3"));
    nodes[k] = draft.node(card, 3 + i, labels[k]);
    if (std::find(nodes.begin(), nodes.begin() + i, nodes[k]) != nodes.begin() + i)
      card.refuse(3 + i, fmt::format("{} names GRID {} twice", id, card.at(3 + i)),
                  "Give every place a grid of its own");
    carry(nodes[k]);
  }
  const auto& section = draft.deck.model.shell_sections[static_cast<std::size_t>(property.section)];
  corner_thickness(card, tflag, thickness, n, section.thickness);
  cells.add(n == 4 ? 4 : 5, std::span(nodes).first(2 * n), id, section.name);

  const Vec3 p = at(nodes[0]), other = at(nodes[n - 1]) - (n == 4 ? at(nodes[1]) : p);
  const Vec3 normal = (at(nodes[n == 4 ? 2 : 1]) - p).cross(other);
  if (normal.isZero(0.0)) card.refuse(3, fmt::format("{} has no area", id), "Correct its grids");
  const double offset = card.real(theta + 1, "ZOFFS", 0.0) + property.offset;
  Vec3 axis = Vec3::Zero();
  if (!section.plies.empty())
    axis = card.blank(theta) ? Vec3(at(nodes[1]) - p) : material_axis(card, theta, p, at(nodes[1]), normal);
  if constexpr (n == 4) {  // the serendipity functions' centre, ½ Σ middles − ¼ Σ corners
    Vec3 centre = Vec3::Zero();
    for (std::size_t i = 0; i < 8; ++i) centre += (i < 4 ? -0.25 : 0.5) * at(nodes[i]);
    nodes[8] = draft.make_node(centre, -id);
    carry(nodes[8]);
    draft.losses.add(card.name(), "split into four quadrilaterals of four nodes, with a node made in the middle");
    for (const auto& q : quads_of_8)
      draft.deck.model.elements.emplace_back(Quad4{
          {nodes[q[0]], nodes[q[1]], nodes[q[2]], nodes[q[3]]}, property.section, property.material, id, offset, axis});
  } else {
    draft.losses.add(card.name(), "split into four triangles of three nodes");
    for (const auto& t : triangles_of_6)
      draft.deck.model.elements.emplace_back(
          Tria3{{nodes[t[0]], nodes[t[1]], nodes[t[2]]}, property.section, property.material, id, offset, axis});
  }
}

// mass M at G + X, inertia I about the centre of mass, both in CID; off-diagonal terms of the tensor are −I21, −I31,
// −I32
void ElementReader::point_mass(const Card& card) {
  PointMass p;
  p.id = card.id(1, "EID");
  if (!known.admit(p.id, card, draft.losses)) return;
  p.node = draft.node(card, 2, "G");
  const long cid = card.integer(3, "CID", 0);
  p.mass = card.real(4, "M", 0.0);
  if (p.mass < 0.0)  // Nastran takes it; what it trims away may leave M without a definite sign
    card.fail(4, "M",
              "a mass that is not negative: with one, modes may have no real frequency; take it off the mass that it "
              "corrects (the other CONM2 of its grid, NSM, RHO)");
  const Vec3 x(card.real(5, "X1", 0.0), card.real(6, "X2", 0.0), card.real(7, "X3", 0.0));
  const double i11 = card.real(9, "I11", 0.0), i21 = card.real(10, "I21", 0.0), i22 = card.real(11, "I22", 0.0);
  const double i31 = card.real(12, "I31", 0.0), i32 = card.real(13, "I32", 0.0), i33 = card.real(14, "I33", 0.0);
  Mat3 inertia;
  inertia << i11, -i21, -i31, -i21, i22, -i32, -i31, -i32, i33;
  Mat3 frame = Mat3::Identity();
  if (cid > 0) frame = draft.frame_at(card, 3, "CID", cid, at(p.node));
  p.offset = cid == -1 ? Vec3(x - at(p.node)) : Vec3(frame * x);
  p.inertia = frame * inertia * frame.transpose();
  carry(p.node);
  cells.add(3, std::array{p.node}, p.id, "conm2");
  draft.deck.model.elements.emplace_back(p);
}

}  // namespace

void read_elements(Draft& draft) {
  MaterialIndex materials;
  ElementReader reader{draft, read_properties(draft, materials), Register{"element"}, {}};
  std::size_t count = draft.deck.model.elements.size();
  for (const char* name : {"CBAR", "CBEAM", "CROD", "CONROD", "CTUBE", "CQUAD4", "CQUADR", "CTRIA3", "CTRIAR", "CONM2"})
    if (const auto found = draft.cards.find(name); found != draft.cards.end()) count += found->second.size();
  draft.deck.model.elements.reserve(count);
  const auto is_new = [&](const Card& card) { return reader.known.admit(card.id(1, "EID"), card, draft.losses); };
  read_beams(draft, reader.properties, reader.known, reader.cells);
  for (const Card& card : draft.take("CROD"))
    if (is_new(card)) reader.rod(card, Properties::find(reader.properties.rods, "PROD", card, 2), 3);
  for (const Card& card : draft.take("CTUBE"))
    if (is_new(card)) reader.rod(card, Properties::find(reader.properties.tubes, "PTUBE", card, 2), 3);
  for (const Card& card : draft.take("CONROD"))  // EID G1 G2 MID A J C NSM
    if (is_new(card))
      reader.rod(card, rod_property(draft, materials, card, 4, fmt::format("conrod {}", card.id(1, "EID"))), 2);
  for (const Card& card : draft.take("CQUAD4")) reader.shell<Quad4>(card, 1);
  for (const Card& card : draft.take("CTRIA3")) reader.shell<Tria3>(card, 2);
  for (const Card& card : draft.take("CQUADR")) reader.shell<Quad4>(card, 1);
  for (const Card& card : draft.take("CTRIAR")) reader.shell<Tria3>(card, 2);
  for (const Card& card : draft.take("CQUAD8")) reader.second_order_shell<4>(card);
  for (const Card& card : draft.take("CTRIA6")) reader.second_order_shell<3>(card);
  for (const Card& card : draft.take("CONM2")) reader.point_mass(card);
  read_springs(draft, reader.known);
  reader.cells.finish(draft.deck.mesh);
}

}  // namespace tenon::fem::nastran
