#include <fmt/format.h>

#include <array>
#include <utility>

#include "fem/formats/nastran/draft.hpp"

namespace tenon::fem::nastran {
namespace {

unsigned whole_halves(unsigned components) {
  return ((components & 0b000111U) ? 0b000111U : 0U) | ((components & 0b111000U) ? 0b111000U : 0U);
}

/// Directions at a node in the basic frame, or (skew frame) as they are with the axes they refer to.
struct LinkDirections {
  Directions directions = 0;
  Mat3 axes = Mat3::Identity();
  bool skew = false;
};

LinkDirections link_directions(const Draft& draft, int node, unsigned components) {
  const Mat3& axes = draft.axes[static_cast<std::size_t>(node)];
  if (const auto basic = basic_directions(components, axes)) return {*basic, Mat3::Identity(), false};
  return {static_cast<Directions>(components), axes, true};
}

void govern(Draft& draft, int node, const LinkDirections& d) {
  draft.governed[static_cast<std::size_t>(node)] |= d.skew ? whole_halves(d.directions) : d.directions;
}

unsigned some_components(const Card& card, int field, const char* label) {
  const unsigned bits = card.components(field, label);
  if (bits == 0) card.fail(field, label, "directions as digits 1 to 6");
  return bits;
}

bool is_number_with_point(std::string_view text) { return !parse_integer(text) && parse_real(text); }

/// Rigid links of grids whose `components`, in the displacement frame of each, follow the independent one.
void follow(Draft& draft, const Card& card, int independent, const std::vector<int>& dependents, unsigned components) {
  const long id = card.id(1, "EID");
  std::vector<RigidLink>& links = draft.deck.model.rigid_links;
  const std::size_t first = links.size();
  for (const int node : dependents) {
    if (node == independent)
      card.refuse(
          0,
          fmt::format("{} makes GRID {} follow itself", id, draft.deck.model.node_ids[static_cast<std::size_t>(node)]),
          "Remove it from the dependent grids");
    const LinkDirections d = link_directions(draft, node, components);
    govern(draft, node, d);
    const bool same = links.size() > first && links.back().directions == d.directions && links.back().axes == d.axes;
    if (same)
      links.back().dependents.push_back(node);
    else
      links.push_back({independent, {node}, d.directions, d.axes, id});
  }
  draft.carries[static_cast<std::size_t>(independent)] = true;
}

// EID GN CM GM1 GM2 ... [ALPHA]
void rbe2(Draft& draft, const Card& card) {
  const int independent = draft.node(card, 2, "GN");
  const unsigned components = some_components(card, 3, "CM");
  std::vector<int> dependents;
  const bool has_alpha = card.size() > 4 && is_number_with_point(card.at(card.size()));
  for (const Range& range : draft.ranges(card, 4, has_alpha ? card.size() - 1 : card.size()))
    for (const int node : draft.nodes_in(range, card)) dependents.push_back(node);
  if (dependents.empty()) card.fail(4, "GM1", "a GRID");
  follow(draft, card, independent, dependents, components);
}

// EID GA GB CNA CNB CMA CMB [ALPHA]: one end is independent in all six directions
void rbar(Draft& draft, const Card& card) {
  const int a = draft.node(card, 2, "GA"), b = draft.node(card, 3, "GB");
  const std::array<unsigned, 4> c{card.components(4, "CNA"), card.components(5, "CNB"), card.components(6, "CMA"),
                                  card.components(7, "CMB")};
  const auto& [independent_a, independent_b, dependent_a, dependent_b] = c;
  const bool from_a = independent_a == all_six && independent_b == 0 && dependent_a == 0,
             from_b = independent_b == all_six && independent_a == 0 && dependent_b == 0;
  if (!from_a && !from_b)
    card.refuse(4, "has independent directions at both ends, or fewer than six",
                "Write 123456 as CNA and leave CNB and CMA blank, or the other way round");
  const unsigned dependent = from_a ? dependent_b : dependent_a;
  follow(draft, card, from_a ? a : b, {from_a ? b : a}, dependent == 0 ? unsigned{all_six} : dependent);
}

// EID GA GB CB [ALPHA]
void rbar1(Draft& draft, const Card& card) {
  const unsigned dependent = card.components(4, "CB");
  follow(draft, card, draft.node(card, 2, "GA"), {draft.node(card, 3, "GB")},
         dependent == 0 ? unsigned{all_six} : dependent);
}

// EID - REFGRID REFC, then groups WT C G G ..., then perhaps UM and ALPHA
void rbe3(Draft& draft, const Card& card) {
  AverageLink link;
  link.id = card.id(1, "EID");
  if (!card.blank(2)) card.fail(2, "2", "a blank");
  link.reference = draft.node(card, 3, "REFGRID");
  const unsigned wanted = some_components(card, 4, "REFC");
  double weight = 0.0;
  unsigned components = 0;
  for (int i = 5; i <= card.size(); ++i) {
    if (card.blank(i)) continue;
    const std::string word = upper(card.at(i));
    if (word == "UM") {
      draft.losses.add("RBE3 UM", "another choice of dependent dofs for the same equations");
      break;
    }
    if (word == "ALPHA") break;
    if (is_number_with_point(word)) {
      weight = card.non_negative(i, "WT", 0.0);
      do ++i;
      while (i < card.size() && card.blank(i));
      components = some_components(card, i, "C");
      continue;
    }
    if (components == 0) card.fail(i, "WT1", "a weight with a decimal point");
    const int node = draft.node(card, i, "G");
    if (node == link.reference)
      card.refuse(i, fmt::format("{} averages its reference GRID {} over itself", link.id, card.at(3)),
                  "Remove it from the averaged grids");
    const LinkDirections d = link_directions(draft, node, components);
    if (d.skew)
      card.refuse(i,
                  fmt::format("{} averages some directions only of GRID {}, whose displacement frame is skew", link.id,
                              card.at(i)),
                  "Average all three translations (123), or give the grid a displacement frame along the basic axes");
    if (weight > 0.0) link.nodes.push_back({node, weight, d.directions});
    draft.carries[static_cast<std::size_t>(node)] = true;
  }
  if (link.nodes.empty()) card.refuse(0, fmt::format("{} averages no grid", link.id), "Give weights and grids");

  const LinkDirections d = link_directions(draft, link.reference, wanted);
  govern(draft, link.reference, d);
  if (d.skew) {  // a node with the whole average motion, which the reference follows in its own directions
    const int reference = link.reference;
    link.reference = draft.make_node(draft.deck.model.nodes[static_cast<std::size_t>(reference)], -link.id);
    draft.deck.model.rigid_links.push_back({link.reference, {reference}, d.directions, d.axes, link.id});
  } else {
    link.directions = d.directions;
  }
  draft.deck.model.average_links.push_back(std::move(link));
}

}  // namespace

void read_links(Draft& draft) {
  Register known("rigid element");
  using Read = void (*)(Draft&, const Card&);
  constexpr std::array<std::pair<const char*, Read>, 4> kinds{
      {{"RBE2", rbe2}, {"RBE3", rbe3}, {"RBAR", rbar}, {"RBAR1", rbar1}}};
  for (const auto& [name, read] : kinds)
    for (const Card& card : draft.take(name))
      if (known.admit(card.id(1, "EID"), card, draft.losses)) read(draft, card);
}

void read_boundary(Draft& draft) {
  std::map<int, unsigned> components;
  const auto add = [&](const Card& card, const Range& range, unsigned bits) {
    if (draft.scalars.any_in(range)) draft.losses.add(card.name(), "scalar points are no nodes of the boundary");
    for (const int node : draft.nodes_in(range, card)) {
      const auto [known, added] = components.try_emplace(node, 0U);
      if (added) draft.deck.boundary_nodes.push_back(node);
      known->second |= bits;
    }
  };
  for (const char* name : {"ASET", "BSET"})
    for (const Card& card : draft.take(name))
      for (int i = 1; i <= card.size(); i += 2) {
        if (card.blank(i) && card.blank(i + 1)) continue;
        const long id = card.id(i, "ID");
        add(card, {id, id}, card.components(i + 1, "C"));
      }
  for (const char* name : {"ASET1", "BSET1"})
    for (const Card& card : draft.take(name)) {
      const unsigned bits = card.components(1, "C");
      for (const Range& range : draft.ranges(card, 2)) add(card, range, bits);
    }
  if (!components.empty())
    draft.losses.add("ASET",
                     "boundary of a reduced body; Nastran's frequencies are those of the static condensation to "
                     "it, the deck's own here those of all its dofs");
  for (const auto& [node, bits] : components)
    if (bits != all_six)
      draft.losses.add("ASET/BSET", "some directions of a grid only: as a boundary node it takes all six");
  if (!draft.deck.boundary_nodes.empty()) draft.deck.mesh.point_sets["boundary"] = draft.deck.boundary_nodes;
}

}  // namespace tenon::fem::nastran
