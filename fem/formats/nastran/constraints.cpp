#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <set>

#include "fem/formats/nastran/draft.hpp"

namespace tenon::fem::nastran {
namespace {

std::string set_kind(const char* kind, long set) { return fmt::format("{} set {}", kind, set); }

/// Directions of one half (translations or rotations) held in a skew frame: one equation each, reduced so that every
/// one has its own first term and none of the others' first terms.
void hold_skew(Model& model, int node, int half, Eigen::Matrix<double, Eigen::Dynamic, 3> rows) {
  std::array<int, 3> pivot{-1, -1, -1};
  for (int k = 0; k < rows.rows(); ++k) {
    int row = 0, column = 0;
    rows.bottomRows(rows.rows() - k).cwiseAbs().maxCoeff(&row, &column);
    rows.row(k).swap(rows.row(k + row));
    rows.row(k) /= rows(k, column);
    for (int other = 0; other < rows.rows(); ++other)
      if (other != k) rows.row(other) -= rows(other, column) * rows.row(k);
    pivot[static_cast<std::size_t>(k)] = column;
  }
  for (int k = 0; k < rows.rows(); ++k) {
    const int first = pivot[static_cast<std::size_t>(k)];
    LinearConstraint held;
    held.id = model.node_ids[static_cast<std::size_t>(node)];
    held.terms.push_back({{node, half + first}, 1.0});
    for (int j = 0; j < 3; ++j)
      if (j != first && rows(k, j) != 0.0) held.terms.push_back({{node, half + j}, rows(k, j)});
    model.constraints.push_back(std::move(held));
  }
}

/// Holds directions given in the node's displacement frame.
void hold(Draft& draft, int node, unsigned components) {
  const Mat3& axes = draft.axes[static_cast<std::size_t>(node)];
  for (const int half : {0, 3}) {
    const unsigned part = components & (0b111U << half);
    if (const auto basic = basic_directions(part, axes)) {
      for (int d = half; d < half + 3; ++d)
        if (*basic >> d & 1) draft.deck.model.supports.push_back({{node, d}});
      continue;
    }
    Eigen::Matrix<double, Eigen::Dynamic, 3> rows(0, 3);
    for (int d = 0; d < 3; ++d) {
      if ((part >> (half + d) & 1U) == 0) continue;
      rows.conservativeResize(rows.rows() + 1, 3);
      rows.bottomRows<1>() = axes.col(d).transpose();
    }
    hold_skew(draft.deck.model, node, half, rows);
  }
}

/// Terms of an MPC stand at fields 2 and 5, 10 and 13, 18 and 21, ...
int next_term(int field) { return field + (field % 8 == 2 ? 3 : 5); }

/// One MPC card as it becomes an equation; equal dofs are added up.
struct Equation {
  Draft& draft;
  const Card& card;
  LinearConstraint sum = {};
  Dof dependent = {};      ///< the dof to eliminate: of a skew direction its largest part
  bool defines = false;    ///< it is a scalar point, and this is the first equation that names it
  bool q_scalar = false;   ///< a term is a generalised coordinate of the q-set
  bool structure = false;  ///< a term is a dof that elements or links use

  void add(const Dof& dof, double coefficient);
  void scalar_term(int field, long id);
  void grid_term(int field);
  LinearConstraint finish();
};

bool same(const Dof& a, const Dof& b) { return a.node == b.node && a.direction == b.direction; }

void Equation::add(const Dof& dof, double coefficient) {
  for (auto& term : sum.terms)
    if (same(term.dof, dof)) {
      term.coefficient += coefficient;
      return;
    }
  sum.terms.push_back({dof, coefficient});
}

void Equation::scalar_term(int field, long id) {
  if (card.components(field + 1, "C") > 1) card.fail(field + 1, "C", "0, 1 or a blank for a scalar point");
  const bool known = draft.scalar_node.contains(id), in_q_set = draft.scalars.in_q_set(id);
  std::vector<int> fields;
  for (int k = 2; k <= card.size(); k = next_term(k)) fields.push_back(k);
  const Dof scalar{scalar_node(draft, card, id, fields), 0};
  const bool first = !known && !in_q_set && !draft.scalars.is_held(id);
  if (field == 2 || (first && !defines)) dependent = scalar;
  defines = defines || first;
  q_scalar = q_scalar || in_q_set;
  add(scalar, card.real(field + 2, "A"));
}

void Equation::grid_term(int field) {
  const int node = draft.node(card, field, "G");
  const auto n = static_cast<std::size_t>(node);
  const unsigned bits = card.components(field + 1, "C");
  if (!std::has_single_bit(bits)) card.fail(field + 1, "C", "one digit 1 to 6");
  const int direction = std::countr_zero(bits), half = direction / 3 * 3;
  const double coefficient = card.real(field + 2, "A");
  const Vec3 axis = draft.axes[n].col(direction - half);
  int largest = 0;
  axis.cwiseAbs().maxCoeff(&largest);
  if (field == 2) dependent = {node, half + largest};
  if (const auto along = basic_axis(axis)) {
    add({node, half + along->direction}, coefficient * along->sign);
    structure = structure || draft.carries[n] || (draft.governed[n] >> (half + along->direction) & 1U);
  } else {
    for (int d = 0; d < 3; ++d) add({node, half + d}, coefficient * axis[d]);
    structure = structure || draft.carries[n] || (draft.governed[n] >> half & 0b111U);
  }
}

LinearConstraint Equation::finish() {
  if (q_scalar && structure)
    card.refuse(
        0, fmt::format("of set {} would give a scalar point of the q-set stiffness or mass of the structure", sum.id),
        "Join the q-set only to grids that no element uses (recovery points), or do not select this set");
  std::erase_if(sum.terms, [](const auto& term) { return term.coefficient == 0.0; });
  if (sum.terms.empty()) card.refuse(0, "says 0 = 0: its terms cancel", "Correct or remove the equation");
  const auto first = std::ranges::find_if(sum.terms, [&](const auto& term) { return same(term.dof, dependent); });
  if (first != sum.terms.end()) std::rotate(sum.terms.begin(), first, first + 1);
  return std::move(sum);
}

// SID G1 C1 A1 G2 C2 A2 - | - G3 C3 A3 G4 C4 A4 - | ...; the first dof is the dependent one
LinearConstraint equation(Draft& draft, const Card& card) {
  Equation e{draft, card};
  e.sum.id = card.id(1, "SID");
  for (int field = 2; field <= card.size(); field = next_term(field)) {
    if (card.blank(field) && card.blank(field + 1) && card.blank(field + 2)) continue;
    const long id = card.id(field, "G");
    if (field == 2 && card.real(4, "A1") == 0.0) card.fail(4, "A1", "a number other than zero");
    if (draft.scalars.contains(id))
      e.scalar_term(field, id);
    else
      e.grid_term(field);
  }
  return e.finish();
}

}  // namespace

int scalar_node(Draft& draft, const Card& card, long id, const std::vector<int>& fields) {
  if (const auto found = draft.scalar_node.find(id); found != draft.scalar_node.end()) return found->second;
  Vec3 place = Vec3::Zero();
  for (const int k : fields)
    if (const int* const grid = draft.node_of.find(parse_integer(card.at(k)).value_or(0))) {
      place = draft.deck.model.nodes[static_cast<std::size_t>(*grid)];
      break;
    }
  const int node = draft.make_node(place, id);
  draft.scalar_node.emplace(id, node);
  draft.deck.model.scalar_points.push_back(node);
  return node;
}

std::vector<Card> selected(Draft& draft, const char* kind, const std::vector<Card>& cards,
                           const std::optional<Choice>& choice) {
  std::set<long> wanted, present;
  Register known_adds(std::string(kind) + "ADD");
  bool by_add = false;
  for (const Card& card : draft.take(std::string(kind) + "ADD")) {
    const long id = card.id(1, "SID");
    if (!known_adds.admit(id, card, draft.losses)) continue;
    const bool chosen = choice && choice->set == id;
    if (!chosen) {
      draft.losses.add(fmt::format("{}ADD {}", kind, id), "set that is not selected");
      continue;
    }
    by_add = true;
    for (int i = 2; i <= card.size(); ++i)
      if (!card.blank(i)) wanted.insert(card.id(i, "S"));
  }
  if (choice && !by_add) wanted.insert(choice->set);

  std::vector<Card> result;
  for (const Card& card : cards) {
    const long id = card.id(1, "SID");
    present.insert(id);
    if (wanted.contains(id))
      result.push_back(card);
    else if (choice || draft.selection.has_case_control)
      draft.losses.add(set_kind(kind, id), "set that is not selected");
    else
      draft.losses.add_physical(
          set_kind(kind, id),
          fmt::format("no case control selects it: write 'CEND', '{} = {}' and 'BEGIN BULK' above the cards", kind, id),
          card.place());
  }
  for (const long id : wanted)
    if (!present.contains(id))
      throw InputError(choice->place,
                       fmt::format("{} set {} is selected, but no {} card has that number", kind, id, kind),
                       "Select a set that exists, or none");
  return result;
}

void read_supports(Draft& draft) {
  std::vector<Card> cards = draft.take("SPC");
  for (const Card& card : draft.take("SPC1")) cards.push_back(card);
  std::vector<unsigned> held = draft.permanent_spc;
  const auto add = [&](const Card& card, const Range& range, unsigned bits, const char* label, int field) {
    if (draft.scalars.any_in(range)) draft.scalars.held.push_back(range);
    for (const int node : draft.nodes_in(range, card)) {
      if (bits == 0) card.fail(field, label, "directions as digits 1 to 6");
      held[static_cast<std::size_t>(node)] |= bits;
    }
  };
  for (const Card& card : selected(draft, "SPC", cards, draft.selection.spc)) {
    if (card.name() == "SPC1") {
      for (const Range& range : draft.ranges(card, 3)) add(card, range, card.components(2, "C"), "C", 2);
      continue;
    }
    for (int i = 2; i <= card.size(); i += 3) {
      if (card.blank(i) && card.blank(i + 1)) continue;
      const long id = card.id(i, "G");
      add(card, {id, id}, card.components(i + 1, "C"), "C", i + 1);
      if (card.real(i + 2, "D", 0.0) != 0.0) draft.losses.add("SPC D", "enforced motion is a load: the dof is held");
    }
  }
  for (std::size_t node = 0; node < held.size(); ++node)
    if (held[node] != 0) hold(draft, static_cast<int>(node), held[node]);
}

void read_equations(Draft& draft) {
  for (const Card& card : selected(draft, "MPC", draft.take("MPC"), draft.selection.mpc))
    draft.deck.model.constraints.push_back(equation(draft, card));
  for (const auto& [id, node] : draft.scalar_node)
    if (draft.scalars.is_held(id)) draft.deck.model.supports.push_back({{node, 0}});
}

}  // namespace tenon::fem::nastran
