#include <fmt/format.h>

#include <limits>
#include <set>

#include "fem/formats/nastran/properties.hpp"

namespace tenon::fem::nastran {
namespace {

using PropertyMap = std::unordered_map<long, Property>;

/// NSM and NSM1 of the properties of one type.
class Addition {
 public:
  Addition(Draft& draft, Properties& properties, const Card& card)
      : draft_(draft), properties_(properties), card_(card) {}

  /// Adds `value` per length or area to the properties that field `field` names.
  void add(const Range& range, double value, int field) {
    const std::string type = upper(card_.at(2));
    const PropertyMap* const named = of_type(type);
    if (!named) {
      draft_.losses.add_physical(fmt::format("{} {}", card_.name(), type),
                                 "non-structural mass is read for properties of bars, rods and shells", card_.place(2));
      return;
    }
    bool any = false;
    for (const auto& [id, property] : *named)
      if (id >= range.first && id <= range.last) {
        any = true;
        add_to(property, type, value, field);
      }
    if (!any)
      card_.refuse(field, fmt::format("names {} {}, which is not defined", type, range.first),
                   "Add the property or correct the number");
  }

 private:
  const PropertyMap* of_type(const std::string& type) const {
    if (type == "PSHELL" || type == "PCOMP" || type == "PCOMPG") return &properties_.shells;
    if (type == "PBAR" || type == "PBARL") return &properties_.bars;
    if (type == "PBEAM" || type == "PBEAML") return &properties_.beams;
    if (type == "PROD") return &properties_.rods;
    return type == "PTUBE" ? &properties_.tubes : nullptr;
  }

  void add_to(const Property& property, const std::string& type, double value, int field) {
    Model& model = draft_.deck.model;
    if (of_type(type) == &properties_.shells) {
      raise(model.shell_sections[static_cast<std::size_t>(property.section)].nsm, value, field);
      return;
    }
    std::set<int> sections{property.section};
    if (property.taper >= 0)
      for (const Station& station : model.tapers[static_cast<std::size_t>(property.taper)])
        sections.insert(station.section);
    for (const int index : sections) {
      BeamSection& section = model.beam_sections[static_cast<std::size_t>(index)];
      if (section.shear_y != 0.0 || section.shear_z != 0.0 || section.nsm_y != 0.0 || section.nsm_z != 0.0)
        draft_.losses.add_physical(fmt::format("{} {}", card_.name(), type),
                                   "where it lies in a section whose centres differ is not known here",
                                   card_.place(field));
      raise(section.nsm, value, field);
    }
  }

  void raise(double& nsm, double value, int field) const {
    nsm += value;
    if (nsm < 0.0) card_.refuse(field, "leaves a negative non-structural mass", "Correct its value");
  }

  Draft& draft_;
  Properties& properties_;
  const Card& card_;
};

/// NSM: SID TYPE, then a property and its value, and again.
void add_pairs(Addition& addition, const Card& card) {
  for (int i = 3; i <= card.size(); i += 2) {
    if (card.blank(i) && card.blank(i + 1)) continue;
    const long id = card.id(i, "ID");
    addition.add({id, id}, card.real(i + 1, "VALUE"), i);
  }
}

/// NSM1: SID TYPE VALUE, then properties, or ALL.
void add_to_list(Addition& addition, const Card& card) {
  const double value = card.real(3, "VALUE");
  if (upper(card.at(4)) == "ALL") {
    addition.add({1, std::numeric_limits<long>::max()}, value, 4);
    return;
  }
  for (const Range& range : Draft::ranges(card, 4)) addition.add(range, value, 4);
}

}  // namespace

void add_nonstructural_mass(Draft& draft, Properties& properties) {
  std::vector<Card> cards;
  for (const char* name : {"NSM", "NSM1", "NSML", "NSML1"})
    for (const Card& card : draft.take(name)) cards.push_back(card);
  for (const Card& card : selected(draft, "NSM", cards, draft.selection.nsm)) {
    Addition addition(draft, properties, card);
    if (card.name() == "NSM")
      add_pairs(addition, card);
    else if (card.name() == "NSM1")
      add_to_list(addition, card);
    else
      draft.losses.add_physical(card.name(), "a whole mass to be shared: give it per length or area by NSM1",
                                card.place());
  }
}

}  // namespace tenon::fem::nastran
