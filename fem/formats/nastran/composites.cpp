#include <fmt/format.h>

#include <numbers>
#include <set>

#include "fem/formats/nastran/properties.hpp"

namespace tenon::fem::nastran {
namespace {

/// LAM: blank, or SYM, which lists the lower half.
bool symmetric(const Card& card) {
  const std::string lam = upper(card.at(8));
  const bool sym = lam == "SYM" && card.name() == "PCOMP";
  if (!lam.empty() && !sym)
    card.fail(8, "LAM",
              fmt::format("a blank{}: laminates without bending, membrane or order of plies are not read",
                          card.name() == "PCOMP" ? " or SYM" : ""));
  return sym;
}

/// What plies name.
struct PlyMaterials {
  const MaterialIndex& isotropic;
  const Orthotropic& orthotropic;
  const Model& model;

  Ply at(const Card& card, int field, long id) const {
    if (const auto found = orthotropic.mat8.find(id); found != orthotropic.mat8.end()) return found->second;
    const auto mat1 = isotropic.find(id);
    if (mat1 == isotropic.end())
      card.refuse(field, fmt::format("field MIDi names material {}, which is not defined by a MAT8 or MAT1", id),
                  "Add the card or correct the number");
    return of(model.materials[static_cast<std::size_t>(mat1->second)]);
  }

  static Ply of(const Material& m) {
    return {.E1 = m.E, .E2 = m.E, .nu12 = m.nu, .G12 = m.G, .G13 = m.G, .G23 = m.G, .rho = m.rho};
  }
};

double radians(const Card& card, int field) { return card.real(field, "THETAi", 0.0) * std::numbers::pi / 180.0; }

/// MIDi Ti THETAi SOUTi, two a line; blanks of material and thickness are those of the ply before.
std::vector<Ply> plies_of_pcomp(const Card& card, const PlyMaterials& materials) {
  std::vector<Ply> plies;
  long material = 0;
  double thickness = 0.0;
  for (int field = 9; field < 9 + 4 * ((card.size() - 8 + 3) / 4); field += 4) {
    if (card.blank(field) && card.blank(field + 1) && card.blank(field + 2)) continue;
    if (!card.blank(field) || material == 0) material = card.id(field, "MIDi");
    if (!card.blank(field + 1) || thickness == 0.0) thickness = card.positive(field + 1, "Ti");
    Ply ply = materials.at(card, field, material);
    ply.thickness = thickness;
    ply.angle = radians(card, field + 2);
    plies.push_back(ply);
  }
  return plies;
}

/// GPLYIDi MIDi Ti THETAi SOUTi, one a line, whose numbers differ.
std::vector<Ply> plies_of_pcompg(const Card& card, const PlyMaterials& materials) {
  std::vector<Ply> plies;
  std::set<long> numbers;
  for (int field = 9; field <= card.size(); field += 8) {
    if (!numbers.insert(card.id(field, "GPLYIDi")).second)
      card.refuse(field, fmt::format("gives two plies the number {}", card.at(field)), "Number them apart");
    Ply ply = materials.at(card, field + 1, card.id(field + 1, "MIDi"));
    ply.thickness = card.positive(field + 2, "Ti");
    ply.angle = radians(card, field + 3);
    plies.push_back(ply);
  }
  return plies;
}

}  // namespace

void read_composites(Draft& draft, const MaterialIndex& materials, const Orthotropic& orthotropic,
                     Properties& properties) {
  Model& model = draft.deck.model;
  Register known("PCOMP or PCOMPG");
  std::vector<Card> cards = draft.take("PCOMP");
  for (const Card& card : draft.take("PCOMPG")) cards.push_back(card);
  for (const Card& card : cards) {
    const long id = card.id(1, "PID");
    if (!known.admit(id, card, draft.losses)) continue;
    if (properties.shells.contains(id))
      card.refuse(1, fmt::format("{} is the number of a PSHELL too", id), "Number properties apart");
    const bool pcomp = card.name() == "PCOMP", sym = symmetric(card);
    ShellSection s;
    s.name = fmt::format("{} {}", pcomp ? "pcomp" : "pcompg", id);
    s.nsm = card.non_negative(3, "NSM", 0.0);
    if (card.real(7, "GE", 0.0) != 0.0)
      draft.losses.add(card.name() + " GE", "structural damping is no part of K and M");
    const PlyMaterials named{materials, orthotropic, model};
    s.plies = pcomp ? plies_of_pcomp(card, named) : plies_of_pcompg(card, named);
    if (s.plies.empty()) card.fail(pcomp ? 9 : 10, pcomp ? "MID1" : "MIDi", "the material of the first ply");
    if (sym)
      for (std::size_t k = s.plies.size(); k-- > 0;) s.plies.push_back(Ply(s.plies[k]));
    for (const Ply& ply : s.plies) s.thickness += ply.thickness;
    const double offset = card.blank(2) ? 0.0 : card.real(2, "Z0") + 0.5 * s.thickness;
    properties.add_laminate(id, std::move(s), offset, model);
  }
}

}  // namespace tenon::fem::nastran
