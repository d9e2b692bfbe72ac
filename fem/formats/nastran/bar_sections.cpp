#include <fmt/format.h>

#include "fem/formats/nastran/named_shapes.hpp"
#include "fem/formats/nastran/properties.hpp"

namespace tenon::fem::nastran {
namespace {

void read_pbar(Draft& draft, const Card& card, const MaterialIndex& materials, Properties& properties) {
  const long id = card.id(1, "PID");
  BeamSection s;
  s.name = fmt::format("pbar {}", id);
  s.A = card.non_negative(3, "A", 0.0);
  s.Iz = card.non_negative(4, "I1", 0.0);  // plane 1 is the element's x–y plane
  s.Iy = card.non_negative(5, "I2", 0.0);
  s.J = card.non_negative(6, "J", 0.0);
  s.nsm = card.non_negative(7, "NSM", 0.0);
  s.kappa_y = card.non_negative(17, "K1", 0.0);
  s.kappa_z = card.non_negative(18, "K2", 0.0);
  s.Iyz = card.real(19, "I12", 0.0);
  if (s.Iyz * s.Iyz > s.Iy * s.Iz)
    card.fail(19, "I12", fmt::format("I12² at most I1·I2 = {:g}, as of every real section", s.Iy * s.Iz));
  if (s.Iyz != 0.0 && (s.kappa_y != 0.0 || s.kappa_z != 0.0)) {
    draft.losses.add("PBAR", "K1 and K2 have no effect beside I12, as in Nastran");
    s.kappa_y = s.kappa_z = 0.0;
  }
  properties.bars.emplace(id, Property{.section = static_cast<int>(draft.deck.model.beam_sections.size()),
                                       .material = material(materials, card, 2, "MID")});
  draft.deck.model.beam_sections.push_back(s);
}

// PID MID GROUP TYPE, from field 9 on DIMi and NSM; a bar lies along its centroids whatever the shape
void read_pbarl(Draft& draft, const Card& card, const MaterialIndex& materials, Properties& properties) {
  const long id = card.id(1, "PID");
  const int n = dimensions_of(card), m = material(materials, card, 2, "MID");
  std::vector<double> dim;
  for (int i = 0; i < n; ++i) dim.push_back(card.positive(9 + i, "DIM"));
  BeamSection s = named_shape(card, dim, 9, draft.deck.model.materials[static_cast<std::size_t>(m)].nu);
  s.name = fmt::format("pbarl {}", id);
  s.nsm = card.non_negative(9 + n, "NSM", 0.0);
  s.shear_y = s.shear_z = 0.0;  // as Nastran's bar has it
  if (s.Iyz != 0.0) s.kappa_y = s.kappa_z = 0.0;
  draft.losses.add("PBARL", "J and shear coefficients are those of our section shapes");
  properties.bars.emplace(id,
                          Property{.section = static_cast<int>(draft.deck.model.beam_sections.size()), .material = m});
  draft.deck.model.beam_sections.push_back(s);
}

}  // namespace

void read_bar_sections(Draft& draft, const MaterialIndex& materials, Properties& properties) {
  Register known("PBAR or PBARL");
  for (const Card& card : draft.take("PBAR"))
    if (known.admit(card.id(1, "PID"), card, draft.losses)) read_pbar(draft, card, materials, properties);
  for (const Card& card : draft.take("PBARL"))
    if (known.admit(card.id(1, "PID"), card, draft.losses)) read_pbarl(draft, card, materials, properties);
}

}  // namespace tenon::fem::nastran
