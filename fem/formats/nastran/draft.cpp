#include "fem/formats/nastran/draft.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace tenon::fem::nastran {

LossReport::Entry& LossReport::entry(const std::string& name, const std::string& note) {
  const auto [position, added] = index_.try_emplace({name, note}, entries_.size());
  if (added) entries_.push_back({{name, 0, note, false}, {}});
  Entry& found = entries_[position->second];
  ++found.loss.count;
  return found;
}

void LossReport::add_physical(const std::string& name, const std::string& note, const Place& place) {
  Entry& found = entry(name, note);
  if (!found.loss.changes_physics) found.first = place;
  found.loss.changes_physics = true;
}

std::vector<Loss> LossReport::losses() const {
  std::vector<Loss> result;
  for (const Entry& e : entries_) result.push_back(e.loss);
  return result;
}

void LossReport::refuse_physical() const {
  const Entry* first = nullptr;
  std::string all;
  for (const Entry& e : entries_) {
    if (!e.loss.changes_physics) continue;
    if (!first) first = &e;
    all += fmt::format("{}{} ({} found, first at {}): {}", all.empty() ? "" : "; ", e.loss.name, e.loss.count,
                       to_string(e.first), e.loss.note);
  }
  if (first)
    throw InputError(first->first, "reading on would change stiffness or mass: " + all,
                     "Replace what is named by cards that are read, or allow losses when it does not matter");
}

bool Register::admit(long id, const Card& card, LossReport& losses) {
  const auto [position, added] = cards_.try_emplace(id, card);
  if (added) return true;
  const Card& earlier = *position;
  if (!earlier.same_as(card))
    card.refuse(
        1, fmt::format("{}: {} {} stands already at {}, with other values", id, kind_, id, to_string(earlier.place())),
        "Give it a number of its own or remove one of the two");
  losses.add(card.name(), "repeated, identical card");
  return false;
}

namespace {

bool meets(const std::vector<Range>& ranges, const Range& other) {
  return std::ranges::any_of(ranges, [&](const Range& r) { return r.first <= other.last && other.first <= r.last; });
}

}  // namespace

bool ScalarPoints::any_in(const Range& range) const { return meets(points, range); }
bool ScalarPoints::in_q_set(long id) const { return meets(q_set, {id, id}); }
bool ScalarPoints::is_held(long id) const { return meets(held, {id, id}); }

void sort_cards(const Text& text, Draft& draft) {
  std::vector<std::vector<Card>> by_name(text.names.size());
  std::vector<std::size_t> counts(text.names.size(), 0);
  for (const CardSpan& span : text.cards) ++counts[span.name];
  for (std::size_t n = 0; n < counts.size(); ++n) by_name[n].reserve(counts[n]);
  for (const CardSpan& span : text.cards) by_name[span.name].emplace_back(text, span);
  for (std::size_t n = 0; n < by_name.size(); ++n) draft.cards[text.names[n]] = std::move(by_name[n]);
}

std::vector<Card> Draft::take(const std::string& name) {
  const auto found = cards.find(name);
  if (found == cards.end()) return {};
  std::vector<Card> result = std::move(found->second);
  cards.erase(found);
  return result;
}

int Draft::node(const Card& card, int field, const char* label) const {
  const long id = card.id(field, label);
  const int* const found = node_of.find(id);
  if (!found)
    card.refuse(field, fmt::format("field {} names GRID {}, which is not defined", label, id),
                "Add the GRID card or correct the number");
  return *found;
}

int Draft::make_node(const Vec3& position, long id) {
  deck.model.nodes.push_back(position);
  deck.model.node_ids.push_back(id);
  axes.push_back(Mat3::Identity());
  permanent_spc.push_back(0);
  carries.push_back(false);
  governed.push_back(0);
  return static_cast<int>(deck.model.nodes.size()) - 1;
}

std::vector<Range> Draft::ranges(const Card& card, int first, int last) {
  std::vector<Range> result;
  for (int i = first; i <= last; ++i) {
    if (card.blank(i)) continue;
    if (upper(card.at(i)) != "THRU") {
      const long id = card.id(i, "ID");
      result.push_back({id, id});
      continue;
    }
    if (result.empty()) card.fail(i, "ID", "a number before THRU");
    const long end = card.id(++i, "ID after THRU");
    if (end < result.back().first) card.fail(i, "ID after THRU", fmt::format("at least {}", result.back().first));
    result.back().last = end;
  }
  if (result.empty()) card.fail(first, "ID", "at least one number");
  return result;
}

std::vector<int> Draft::nodes_in(const Range& range, const Card& card) const {
  std::vector<int> nodes;
  for (auto id = std::ranges::lower_bound(sorted_grids, range.first); id != sorted_grids.end() && *id <= range.last;
       ++id)
    nodes.push_back(*node_of.find(*id));
  if (nodes.empty() && !scalars.any_in(range))
    card.refuse(0,
                range.first == range.last
                    ? fmt::format("names GRID {}, which is not defined", range.first)
                    : fmt::format("names GRIDs {} to {}, none of which is defined", range.first, range.last),
                "Add the GRID card or correct the number");
  return nodes;
}

void read_scalar_points(Draft& draft) {
  for (const char* name : {"CELAS3", "CELAS4"})  // what they name is a scalar point without an SPOINT
    if (const auto cards = draft.cards.find(name); cards != draft.cards.end())
      for (const Card& card : cards->second)
        for (const int field : {3, 4})
          if (const auto id = parse_integer(card.at(field)); id && *id > 0 && !draft.node_of.find(*id))
            draft.scalars.points.push_back({*id, *id});
  for (const Card& card : draft.take("SPOINT"))
    for (const Range& range : draft.ranges(card, 1)) {
      draft.scalars.points.push_back(range);
      const auto grid = std::ranges::lower_bound(draft.sorted_grids, range.first);
      if (grid != draft.sorted_grids.end() && *grid <= range.last)
        card.refuse(0, fmt::format("gives scalar points the number {}, which is a GRID", *grid),
                    "Number scalar points apart from the grids");
      draft.losses.add("SPOINT", "scalar points: no part of the model unless a spring or a selected MPC names them");
    }
  for (const Card& card : draft.take("QSET"))
    for (int i = 1; i <= card.size(); i += 2) {
      const long id = card.id(i, "ID");
      draft.scalars.q_set.push_back({id, id});
      draft.losses.add("QSET", "generalised coordinates belong to the reduced body, not to the model");
    }
  for (const Card& card : draft.take("QSET1")) {
    for (const Range& range : draft.ranges(card, 2)) draft.scalars.q_set.push_back(range);
    draft.losses.add("QSET1", "generalised coordinates belong to the reduced body, not to the model");
  }
}

}  // namespace tenon::fem::nastran
