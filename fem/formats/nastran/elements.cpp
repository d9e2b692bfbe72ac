#include <fmt/format.h>

#include <array>
#include <cmath>
#include <numbers>

#include "fem/formats/nastran/properties.hpp"

namespace tenon::fem::nastran {
namespace {

constexpr std::array<CellType, 4> block_types{CellType::line, CellType::quad, CellType::triangle, CellType::vertex};

/// The mesh's blocks while they grow, one a cell type, with their sets.
struct Cells {
  std::array<CellBlock, 4> blocks;
  std::map<std::string, std::array<std::vector<int>, 4>> sets;

  template <class Nodes>
  void add(std::size_t block, const Nodes& nodes, long id, const std::string& set) {
    sets[set][block].push_back(static_cast<int>(blocks[block].ids.size()));
    blocks[block].nodes.insert(blocks[block].nodes.end(), nodes.begin(), nodes.end());
    blocks[block].ids.push_back(id);
  }

  void finish(Mesh& mesh) {
    for (std::size_t b = 0; b < blocks.size(); ++b) {
      if (blocks[b].ids.empty()) continue;
      blocks[b].type = block_types[b];
      mesh.cells.push_back(std::move(blocks[b]));
      for (auto& [name, cells] : sets) mesh.cell_sets[name].push_back(std::move(cells[b]));
    }
  }
};

struct ElementReader {
  Draft& draft;
  Properties properties;
  Register known{"element"};
  Cells cells;
  std::optional<Card> bar_defaults;  ///< BAROR

  const Vec3& at(int node) const { return draft.deck.model.nodes[static_cast<std::size_t>(node)]; }
  const Mat3& axes(int node) const { return draft.axes[static_cast<std::size_t>(node)]; }
  void carry(int node) { draft.carries[static_cast<std::size_t>(node)] = true; }

  void bar(const Card& card);
  Vec3 orientation(const Card& card, int node_a) const;
  std::string offset_codes(const Card& card) const;
  Vec3 offset(const Card& card, int first, const char* label, char code, int node) const;
  Vec3 material_axis(const Card& card, int field, const Vec3& a, const Vec3& b, const Vec3& normal) const;
  template <class Shell>
  void shell(const Card& card, std::size_t block);
  void point_mass(const Card& card);
};

/// OFFT, three letters: where the orientation vector and the two offsets are given.
std::string ElementReader::offset_codes(const Card& card) const {
  const Card& source = card.blank(8) && bar_defaults ? *bar_defaults : card;
  const std::string codes = source.blank(8) ? "GGG" : upper(source.at(8));
  const auto known_code = [&](std::size_t i, std::string_view allowed) {
    return i < codes.size() && allowed.find(codes[i]) != std::string_view::npos;
  };
  if (codes.size() != 3 || !known_code(0, "GB") || !known_code(1, "GOE") || !known_code(2, "GOE"))
    source.fail(8, "OFFT", "three letters such as GGG or BGG");
  return codes;
}

// v from components in the displacement frame of GA (or basic), or from GA towards G0
Vec3 ElementReader::orientation(const Card& card, int node_a) const {
  const bool own = !card.blank(5) || !card.blank(6) || !card.blank(7);
  if (!own && !bar_defaults)
    card.fail(5, "X1/G0", "a grid or a vector that fixes the orientation of the section (BAROR gives none either)");
  const Card& source = own ? card : *bar_defaults;
  if (parse_integer(source.at(5)) && source.blank(6) && source.blank(7))
    return at(draft.node(source, 5, "G0")) - at(node_a);
  const Vec3 v(source.real(5, "X1", 0.0), source.real(6, "X2", 0.0), source.real(7, "X3", 0.0));
  return offset_codes(card)[0] == 'B' ? v : Vec3(axes(node_a) * v);
}

Vec3 ElementReader::offset(const Card& card, int first, const char* label, char code, int node) const {
  const Vec3 w(card.real(first, label, 0.0), card.real(first + 1, label, 0.0), card.real(first + 2, label, 0.0));
  if (code != 'G' && w != Vec3::Zero())
    card.fail(8, "OFFT", "G for this end: offsets in the element's own frame are not read");
  return axes(node) * w;
}

void ElementReader::bar(const Card& card) {
  Beam beam;
  beam.id = card.id(1, "EID");
  if (!known.admit(beam.id, card, draft.losses)) return;
  const Card& named = card.blank(2) && bar_defaults && !bar_defaults->blank(2) ? *bar_defaults : card;
  const Property& property = Properties::find(properties.bars, "PBAR", named, 2);
  beam.section = property.section;
  beam.material = property.material;
  beam.nodes = {draft.node(card, 3, "GA"), draft.node(card, 4, "GB")};
  beam.orientation = orientation(card, beam.nodes[0]);
  const std::string codes = offset_codes(card);
  beam.offsets = {offset(card, 11, "WA", codes[1], beam.nodes[0]), offset(card, 14, "WB", codes[2], beam.nodes[1])};
  for (const int pin : {9, 10}) {
    const unsigned flags = card.components(pin, pin == 9 ? "PA" : "PB");
    if (flags != 0 && draft.deck.coupled_mass)
      draft.losses.add_physical("CBAR pin flags",
                                "with COUPMASS: how it shares the mass of a bar with released ends is not known here",
                                card.place(pin));
    beam.releases[static_cast<std::size_t>(pin - 9)] = static_cast<Directions>(flags);
  }

  const Vec3 a = at(beam.nodes[0]) + beam.offsets[0], b = at(beam.nodes[1]) + beam.offsets[1], axis = b - a;
  if (!(axis.norm() > 1e-12 * (a.norm() + b.norm())))
    card.refuse(3, fmt::format("{} has no length: both ends lie at ({:g}, {:g}, {:g})", beam.id, a.x(), a.y(), a.z()),
                "Join coincident grids by an RBE2, or correct the grids");
  if (!(axis.cross(beam.orientation).norm() > 1e-9 * axis.norm() * beam.orientation.norm()))
    card.refuse(5, fmt::format("{} has an orientation vector along its own axis (or of no length)", beam.id),
                "Give a vector or a grid G0 off the bar's axis");
  if (draft.deck.coupled_mass) {
    beam.mass = BeamMass::nastran;
    beam.rotary_inertia = false;
  }
  carry(beam.nodes[0]);
  carry(beam.nodes[1]);
  const auto& section = draft.deck.model.beam_sections[static_cast<std::size_t>(beam.section)];
  cells.add(0, beam.nodes, beam.id, section.name);
  draft.deck.model.elements.emplace_back(beam);
}

// THETA in degrees from the side G1-G2 about the normal, or MCID, whose x axis it is; zero for a blank
Vec3 ElementReader::material_axis(const Card& card, int field, const Vec3& a, const Vec3& b, const Vec3& normal) const {
  if (card.blank(field)) return Vec3::Zero();
  if (const auto system = parse_integer(card.at(field))) return draft.frame_at(card, field, "MCID", *system, a).col(0);
  const double theta = card.real(field, "THETA") * std::numbers::pi / 180.0;
  const Vec3 n = normal.normalized(), x = (b - a - n * n.dot(b - a)).normalized();
  return std::cos(theta) * x + std::sin(theta) * n.cross(x);
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
  const double unit = card.integer(10, "TFLAG", 0) == 1 ? section.thickness : 1.0;
  for (int i = 11; i < 11 + n; ++i)
    if (!card.blank(i) && std::abs(card.real(i, "T") * unit - section.thickness) > 1e-6 * section.thickness)
      draft.losses.add_physical(card.name() + " T1..T4", "thickness at the corners that differs from PSHELL's",
                                card.place(i));
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

// mass M at G + X, inertia I about the centre of mass, both in CID; off-diagonal terms of the tensor are −I21, −I31,
// −I32
void ElementReader::point_mass(const Card& card) {
  PointMass p;
  p.id = card.id(1, "EID");
  if (!known.admit(p.id, card, draft.losses)) return;
  p.node = draft.node(card, 2, "G");
  const long cid = card.integer(3, "CID", 0);
  p.mass = card.real(4, "M", 0.0);
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
  ElementReader reader{draft, read_properties(draft), Register{"element"}, {}, {}};
  for (const Card& card : draft.take("BAROR")) {
    if (reader.bar_defaults && !reader.bar_defaults->same_as(card))
      card.refuse(0, "stands twice", "Keep one BAROR card");
    reader.bar_defaults = card;
  }
  std::size_t count = draft.deck.model.elements.size();
  for (const char* name : {"CBAR", "CQUAD4", "CTRIA3", "CONM2"})
    if (const auto found = draft.cards.find(name); found != draft.cards.end()) count += found->second.size();
  draft.deck.model.elements.reserve(count);
  for (const Card& card : draft.take("CBAR")) reader.bar(card);
  for (const Card& card : draft.take("CQUAD4")) reader.shell<Quad4>(card, 1);
  for (const Card& card : draft.take("CTRIA3")) reader.shell<Tria3>(card, 2);
  for (const Card& card : draft.take("CONM2")) reader.point_mass(card);
  reader.cells.finish(draft.deck.mesh);
}

}  // namespace tenon::fem::nastran
