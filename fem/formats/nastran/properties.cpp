#include "fem/formats/nastran/properties.hpp"

#include <fmt/format.h>

#include <cmath>
#include <numbers>

namespace tenon::fem::nastran {
namespace {

/// κ that stands for "rigid in transverse shear" in a shell: a thousandth of the usual shear flexibility is left.
constexpr double rigid_shear_ratio = 1000.0;

// G = E / (2 (1 + ν)) gives the third of E, G, ν; with E or G alone the other two are as in the manuals
Material elastic(const Card& card) {
  Material m;
  m.name = fmt::format("mat1 {}", card.id(1, "MID"));
  const bool has_e = !card.blank(2), has_g = !card.blank(3), has_nu = !card.blank(4);
  m.E = card.non_negative(2, "E", 0.0);
  m.G = card.non_negative(3, "G", 0.0);
  m.nu = card.real(4, "NU", 0.0);
  m.rho = card.non_negative(5, "RHO", 0.0);
  if (!has_e && !has_g) card.fail(2, "E", "a number here or in field G: a material needs one of the two");
  if (!has_g && has_nu) m.G = m.E / (2.0 * (1.0 + m.nu));
  if (!has_e && has_nu) m.E = 2.0 * (1.0 + m.nu) * m.G;
  if (!has_nu && has_e && has_g) {
    if (!(m.G > 0.0)) card.fail(3, "G", "a number above zero, or a blank");
    m.nu = m.E / (2.0 * m.G) - 1.0;
  } else if (has_nu && !(m.nu > -1.0 && m.nu <= 0.5)) {
    card.fail(4, "NU", "a Poisson's ratio above -1 and at most 0.5, as of every stable isotropic material");
  }
  return m;
}

MaterialIndex read_materials(Draft& draft) {
  MaterialIndex index;
  Register known("MAT1");
  for (const Card& card : draft.take("MAT1")) {
    const long id = card.id(1, "MID");
    if (!known.admit(id, card, draft.losses)) continue;
    const Material m = elastic(card);
    const bool all_three = !card.blank(2) && !card.blank(3) && !card.blank(4);
    if (all_three && std::abs(m.E - 2.0 * (1.0 + m.nu) * m.G) > 0.01 * m.E)
      draft.losses.add("MAT1", "E, G and NU given, not those of an isotropic material: each is used as it stands");
    if (card.real(8, "GE", 0.0) != 0.0) draft.losses.add("MAT1 GE", "structural damping is no part of K and M");
    index.emplace(id, static_cast<int>(draft.deck.model.materials.size()));
    draft.deck.model.materials.push_back(m);
  }
  return index;
}

// OD and T, which is half of OD where it is blank or zero: a solid bar
Property tube_property(Draft& draft, const MaterialIndex& materials, const Card& card) {
  const double od = card.positive(3, "OD"), t = card.non_negative(4, "T", 0.0);
  if (t > 0.5 * od) card.fail(4, "T", fmt::format("at most half of OD = {:g}", od));
  if (card.real(6, "OD2", od) != od)
    draft.losses.add_physical("PTUBE OD2", "a tapered tube: its first diameter alone would count", card.place(6));
  const double id = t > 0.0 ? od - 2.0 * t : 0.0;
  BeamSection s;
  s.name = fmt::format("ptube {}", card.id(1, "PID"));
  s.A = 0.25 * std::numbers::pi * (od * od - id * id);
  s.J = 0.125 * s.A * (od * od + id * id);  // π/32 (OD⁴ − ID⁴)
  s.nsm = card.non_negative(5, "NSM", 0.0);
  const int section = static_cast<int>(draft.deck.model.beam_sections.size());
  draft.deck.model.beam_sections.push_back(s);
  return {section, material(materials, card, 2, "MID")};
}

void read_rods(Draft& draft, const MaterialIndex& materials, Properties& properties) {
  Register known_rods("PROD"), known_tubes("PTUBE");
  for (const Card& card : draft.take("PROD"))
    if (const long id = card.id(1, "PID"); known_rods.admit(id, card, draft.losses))
      properties.rods.emplace(id, rod_property(draft, materials, card, 2, fmt::format("prod {}", id)));
  for (const Card& card : draft.take("PTUBE"))
    if (const long id = card.id(1, "PID"); known_tubes.admit(id, card, draft.losses))
      properties.tubes.emplace(id, tube_property(draft, materials, card));
}

/// MID4 other than MID1 would couple membrane and bending.
void refuse_coupling(Draft& draft, const Card& card) {
  if (!card.blank(11) && card.id(11, "MID4") != card.id(2, "MID1"))
    draft.losses.add_physical("PSHELL MID4", "coupling of membrane and bending", card.place(11));
}

void read_shells(Draft& draft, const MaterialIndex& materials, const Orthotropic& orthotropic, Properties& properties) {
  Register known("PSHELL");
  for (const Card& card : draft.take("PSHELL")) {
    const long id = card.id(1, "PID");
    if (!known.admit(id, card, draft.losses)) continue;
    if (card.blank(2)) card.fail(2, "MID1", "a material: a shell without membrane stiffness is not read");
    if (orthotropic.contains(card.id(2, "MID1"))) {
      ShellSection s{.name = fmt::format("pshell {}", id)};
      s.plies.push_back(single_ply(card, orthotropic, materials, draft.deck.model));
      s.thickness = s.plies[0].thickness;
      s.nsm = card.real(8, "NSM", 0.0);
      refuse_coupling(draft, card);
      properties.add_laminate(id, std::move(s), 0.0, draft.deck.model);
      continue;
    }
    const int membrane = material(materials, card, 2, "MID1");
    const auto& all = draft.deck.model.materials;
    const auto get = [&](int field, const char* label) -> const Material& {
      return all[static_cast<std::size_t>(material(materials, card, field, label))];
    };
    const Material& first = all[static_cast<std::size_t>(membrane)];
    ShellSection s;
    s.name = fmt::format("pshell {}", id);
    s.thickness = card.positive(3, "T");
    s.nsm = card.non_negative(8, "NSM", 0.0);
    if (card.blank(4)) {
      s.bending_ratio = s.shear_ratio = 0.0;
      if (!card.blank(6)) card.fail(6, "MID3", "a blank: without MID2 there is no bending to carry the shear");
    } else {
      const Material& bending = get(4, "MID2");
      if (std::abs(bending.nu - first.nu) > 1e-9)
        card.fail(4, "MID2", "a material with the Poisson's ratio of MID1: others are not read");
      s.bending_ratio = card.non_negative(5, "12I/T**3", 1.0) * bending.E / first.E;
      s.shear_ratio =
          card.blank(6) ? rigid_shear_ratio : card.non_negative(7, "TS/T", 5.0 / 6.0) * get(6, "MID3").G / first.G;
    }
    if (!std::isfinite(s.bending_ratio) || !std::isfinite(s.shear_ratio))
      card.fail(2, "MID1", "a material with E and G above zero");
    refuse_coupling(draft, card);
    properties.shells.emplace(id, Property{static_cast<int>(draft.deck.model.shell_sections.size()), membrane});
    draft.deck.model.shell_sections.push_back(s);
  }
}

}  // namespace

const Property& Properties::find(const std::unordered_map<long, Property>& properties, const char* kind,
                                 const Card& card, int field) {
  const long id = card.blank(field) ? card.id(1, "EID") : card.id(field, "PID");
  const auto found = properties.find(id);
  if (found == properties.end())
    card.refuse(field, fmt::format("field PID names property {}, which is not defined by a {}", id, kind),
                fmt::format("Add the {} card or correct the number", kind));
  return found->second;
}

void Properties::add_laminate(long id, ShellSection section, double offset, Model& model) {
  shells.emplace(
      id, Property{static_cast<int>(model.shell_sections.size()), static_cast<int>(model.materials.size()), offset});
  model.materials.push_back({.name = section.name});
  model.shell_sections.push_back(std::move(section));
}

int material(const MaterialIndex& materials, const Card& card, int field, const char* label) {
  const auto found = materials.find(card.id(field, label));
  if (found == materials.end())
    card.refuse(field, fmt::format("field {} names material {}, which is not defined by a MAT1", label, card.at(field)),
                "Add the MAT1 card or correct the number");
  return found->second;
}

Property rod_property(Draft& draft, const MaterialIndex& materials, const Card& card, int first, std::string name) {
  BeamSection s;
  s.name = std::move(name);
  s.A = card.non_negative(first + 1, "A", 0.0);
  s.J = card.non_negative(first + 2, "J", 0.0);
  if (s.A == 0.0 && s.J == 0.0) card.fail(first + 1, "A", "a number above zero here or in field J");
  s.nsm = card.non_negative(first + 4, "NSM", 0.0);
  const int m = material(materials, card, first, "MID");
  const Material& named = draft.deck.model.materials[static_cast<std::size_t>(m)];
  if ((s.A > 0.0 && !(named.E > 0.0)) || (s.J > 0.0 && !(named.G > 0.0)))
    card.fail(first, "MID", fmt::format("a material with {}", s.A > 0.0 && !(named.E > 0.0) ? "E" : "G (for J)"));
  draft.deck.model.beam_sections.push_back(s);
  return {static_cast<int>(draft.deck.model.beam_sections.size()) - 1, m};
}

Properties read_properties(Draft& draft, MaterialIndex& materials) {
  Properties properties;
  materials = read_materials(draft);
  read_bar_sections(draft, materials, properties);
  read_beam_sections(draft, materials, properties);
  read_rods(draft, materials, properties);
  const Orthotropic orthotropic = read_orthotropic(draft);
  read_shells(draft, materials, orthotropic, properties);
  read_composites(draft, materials, orthotropic, properties);
  add_nonstructural_mass(draft, properties);
  return properties;
}

}  // namespace tenon::fem::nastran
