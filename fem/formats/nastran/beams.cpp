#include "fem/formats/nastran/beams.hpp"

#include <fmt/format.h>

namespace tenon::fem::nastran {
namespace {

/// Bars or beams: the two cards differ in their properties, and in what the line of their offsets is.
class LineReader {
 public:
  LineReader(Draft& draft, const Properties& properties, Register& known, ElementCells& cells)
      : draft_(draft), properties_(properties), known_(known), cells_(cells) {}

  void bars();
  void beams();

 private:
  struct Ends {
    Vec3 a, b;  ///< the nodes with their offsets
    Mat3 axes;  ///< x from a to b, y in the plane of the orientation
  };

  std::optional<Card> defaults(const char* name);
  const Vec3& at(int node) const { return draft_.deck.model.nodes[static_cast<std::size_t>(node)]; }
  const Mat3& axes(int node) const { return draft_.axes[static_cast<std::size_t>(node)]; }
  std::string offset_codes(const Card& card) const;
  Vec3 orientation(const Card& card, int node_a) const;
  Vec3 offset(const Card& card, int first, const char* label, char code, int node) const;
  void refuse_warping(const Card& card, const Property& property) const;
  bool read(const Card& card, const std::unordered_map<long, Property>& properties, const char* kind, Beam& beam,
            const Property*& property);
  Ends ends(const Card& card, const Beam& beam) const;
  void append(Beam beam);

  Draft& draft_;
  const Properties& properties_;
  Register& known_;
  ElementCells& cells_;
  std::optional<Card> defaults_;  ///< BAROR, BEAMOR
};

std::optional<Card> LineReader::defaults(const char* name) {
  std::optional<Card> found;
  for (const Card& card : draft_.take(name)) {
    if (found && !found->same_as(card)) card.refuse(0, "stands twice", fmt::format("Keep one {} card", name));
    found = card;
  }
  return found;
}

/// OFFT, three letters: where the orientation vector and the two offsets are given.
std::string LineReader::offset_codes(const Card& card) const {
  const Card& source = card.blank(8) && defaults_ ? *defaults_ : card;
  const std::string codes = source.blank(8) ? "GGG" : upper(source.at(8));
  const auto known_code = [&](std::size_t i, std::string_view allowed) {
    return i < codes.size() && allowed.find(codes[i]) != std::string_view::npos;
  };
  if (codes.size() != 3 || !known_code(0, "GB") || !known_code(1, "GOE") || !known_code(2, "GOE"))
    source.fail(8, "OFFT", "three letters such as GGG or BGG");
  return codes;
}

// v from components in the displacement frame of GA (or basic), or from GA towards G0
Vec3 LineReader::orientation(const Card& card, int node_a) const {
  const bool own = !card.blank(5) || !card.blank(6) || !card.blank(7);
  if (!own && !defaults_)
    card.fail(5, "X1/G0",
              fmt::format("a grid or a vector that fixes the orientation of the section ({} gives none either)",
                          card.name() == "CBAR" ? "BAROR" : "BEAMOR"));
  const Card& source = own ? card : *defaults_;
  if (parse_integer(source.at(5)) && source.blank(6) && source.blank(7))
    return at(draft_.node(source, 5, "G0")) - at(node_a);
  const Vec3 v(source.real(5, "X1", 0.0), source.real(6, "X2", 0.0), source.real(7, "X3", 0.0));
  return offset_codes(card)[0] == 'B' ? v : Vec3(axes(node_a) * v);
}

Vec3 LineReader::offset(const Card& card, int first, const char* label, char code, int node) const {
  const Vec3 w(card.real(first, label, 0.0), card.real(first + 1, label, 0.0), card.real(first + 2, label, 0.0));
  if (code != 'G' && w != Vec3::Zero())
    card.fail(8, "OFFT", "G for this end: offsets in the element's own frame are not read");
  return axes(node) * w;
}

/// What both cards have; false for a second card of an element.
bool LineReader::read(const Card& card, const std::unordered_map<long, Property>& properties, const char* kind,
                      Beam& beam, const Property*& property) {
  beam.id = card.id(1, "EID");
  if (!known_.admit(beam.id, card, draft_.losses)) return false;
  const Card& named = card.blank(2) && defaults_ && !defaults_->blank(2) ? *defaults_ : card;
  property = &Properties::find(properties, kind, named, 2);
  beam.section = property->section;
  beam.taper = property->taper;
  beam.material = property->material;
  beam.nodes = {draft_.node(card, 3, "GA"), draft_.node(card, 4, "GB")};
  beam.orientation = orientation(card, beam.nodes[0]);
  const std::string codes = offset_codes(card);
  beam.offsets = {offset(card, 11, "WA", codes[1], beam.nodes[0]), offset(card, 14, "WB", codes[2], beam.nodes[1])};
  for (const int pin : {9, 10}) {
    const unsigned flags = card.components(pin, pin == 9 ? "PA" : "PB");
    if (flags != 0 && draft_.deck.coupled_mass)
      draft_.losses.add_physical(card.name() + " pin flags",
                                 "with COUPMASS: how it shares the mass of a bar with released ends is not known here",
                                 card.place(pin));
    beam.releases[static_cast<std::size_t>(pin - 9)] = static_cast<Directions>(flags);
  }
  if (draft_.deck.coupled_mass) {
    beam.mass = BeamMass::nastran;
    beam.rotary_inertia = false;
  }
  return true;
}

LineReader::Ends LineReader::ends(const Card& card, const Beam& beam) const {
  Ends e{at(beam.nodes[0]) + beam.offsets[0], at(beam.nodes[1]) + beam.offsets[1], Mat3::Identity()};
  const Vec3 axis = e.b - e.a;
  if (!(axis.norm() > 1e-12 * (e.a.norm() + e.b.norm())))
    card.refuse(
        3, fmt::format("{} has no length: both ends lie at ({:g}, {:g}, {:g})", beam.id, e.a.x(), e.a.y(), e.a.z()),
        "Join coincident grids by an RBE2, or correct the grids");
  if (!(axis.cross(beam.orientation).norm() > 1e-9 * axis.norm() * beam.orientation.norm()))
    card.refuse(5, fmt::format("{} has an orientation vector along its own axis (or of no length)", beam.id),
                "Give a vector or a grid G0 off the bar's axis");
  e.axes.col(0) = axis.normalized();
  e.axes.col(2) = axis.cross(beam.orientation).normalized();
  e.axes.col(1) = e.axes.col(2).cross(e.axes.col(0));
  return e;
}

void LineReader::append(Beam beam) {
  for (const int node : beam.nodes) draft_.carries[static_cast<std::size_t>(node)] = true;
  const auto& section = draft_.deck.model.beam_sections[static_cast<std::size_t>(beam.section)];
  cells_.add(0, beam.nodes, beam.id, section.name);
  draft_.deck.model.elements.emplace_back(beam);
}

void LineReader::bars() {
  defaults_ = defaults("BAROR");
  for (const Card& card : draft_.take("CBAR")) {
    Beam beam;
    const Property* property = nullptr;
    if (!read(card, properties_.bars, "PBAR or PBARL", beam, property)) continue;
    ends(card, beam);
    append(beam);
  }
}

/// SA and SB hold the ends against warping where they are joined to others or supported; without them it is free.
void LineReader::refuse_warping(const Card& card, const Property& property) const {
  if (card.blank(17) && card.blank(18)) return;
  if (property.warps)
    draft_.losses.add_physical("CBEAM SA, SB", "warping of the section held at the ends", card.place(17));
  else
    draft_.losses.add("CBEAM SA, SB", "the section does not warp");
}

// grids and offsets place the shear centres; our beams run through the centroids
void LineReader::beams() {
  defaults_ = defaults("BEAMOR");
  for (const Card& card : draft_.take("CBEAM")) {
    Beam beam;
    const Property* property = nullptr;
    if (!read(card, properties_.beams, "PBEAM or PBEAML", beam, property)) continue;
    refuse_warping(card, *property);
    const bool centred = property->neutral[0].isZero(0.0) && property->neutral[1].isZero(0.0);
    if (beam.releases != std::array<Directions, 2>{} && !centred)
      draft_.losses.add_physical("CBEAM pin flags", "at shear centres off the centroids", card.place(9));
    const Ends e = ends(card, beam);
    for (std::size_t i = 0; i < 2; ++i) beam.offsets[i] += e.axes.rightCols<2>() * property->neutral[i];
    append(beam);
  }
}

}  // namespace

void read_beams(Draft& draft, const Properties& properties, Register& known, ElementCells& cells) {
  LineReader reader(draft, properties, known, cells);
  reader.bars();
  reader.beams();
}

}  // namespace tenon::fem::nastran
