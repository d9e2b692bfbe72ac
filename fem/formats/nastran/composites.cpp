#include <fmt/format.h>

#include <algorithm>
#include <numbers>

#include "fem/formats/nastran/properties.hpp"

namespace tenon::fem::nastran {
namespace {

Ply isotropic(const Material& m) {
  return {.E1 = m.E, .E2 = m.E, .nu12 = m.nu, .G12 = m.G, .G13 = m.G, .G23 = m.G, .rho = m.rho};
}

/// LAM: blank, or SYM, which lists the lower half.
bool symmetric(const Card& card) {
  const std::string lam = upper(card.at(8));
  if (!lam.empty() && lam != "SYM")
    card.fail(8, "LAM", "a blank or SYM: laminates without bending, membrane or order of plies are not read");
  return lam == "SYM";
}

}  // namespace

void read_composites(Draft& draft, const MaterialIndex& materials, const Orthotropic& orthotropic,
                     Properties& properties) {
  Model& model = draft.deck.model;
  Register known("PCOMP");
  for (const Card& card : draft.take("PCOMP")) {
    const long id = card.id(1, "PID");
    if (!known.admit(id, card, draft.losses)) continue;
    if (properties.shells.contains(id))
      card.refuse(1, fmt::format("{} is the number of a PSHELL too", id), "Number properties apart");
    ShellSection s;
    s.name = fmt::format("pcomp {}", id);
    s.nsm = card.non_negative(3, "NSM", 0.0);
    const bool sym = symmetric(card);
    if (card.real(7, "GE", 0.0) != 0.0) draft.losses.add("PCOMP GE", "structural damping is no part of K and M");
    long material = 0;
    double thickness = 0.0;
    for (int field = 9; field < 9 + 4 * ((card.size() - 8 + 3) / 4); field += 4) {
      if (card.blank(field) && card.blank(field + 1) && card.blank(field + 2)) continue;
      if (!card.blank(field) || material == 0) material = card.id(field, "MIDi");
      if (!card.blank(field + 1) || thickness == 0.0) thickness = card.positive(field + 1, "Ti");
      Ply ply;
      if (const auto found = orthotropic.mat8.find(material); found != orthotropic.mat8.end())
        ply = found->second;
      else if (const auto mat1 = materials.find(material); mat1 != materials.end())
        ply = isotropic(model.materials[static_cast<std::size_t>(mat1->second)]);
      else
        card.refuse(field,
                    fmt::format("field MIDi names material {}, which is not defined by a MAT8 or MAT1", material),
                    "Add the card or correct the number");
      ply.thickness = thickness;
      ply.angle = card.real(field + 2, "THETAi", 0.0) * std::numbers::pi / 180.0;
      s.plies.push_back(ply);
    }
    if (s.plies.empty()) card.fail(9, "MID1", "the material of the first ply");
    if (sym)
      for (std::size_t k = s.plies.size(); k-- > 0;) s.plies.push_back(Ply(s.plies[k]));
    for (const Ply& ply : s.plies) s.thickness += ply.thickness;
    const double offset = card.blank(2) ? 0.0 : card.real(2, "Z0") + 0.5 * s.thickness;
    properties.add_laminate(id, std::move(s), offset, model);
  }
}

}  // namespace tenon::fem::nastran
