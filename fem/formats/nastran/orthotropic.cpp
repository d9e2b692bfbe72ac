#include <fmt/format.h>

#include <cmath>

#include "fem/formats/nastran/properties.hpp"

namespace tenon::fem::nastran {
namespace {

/// MAT8: E1 E2 NU12 G12 G1Z G2Z RHO; G1Z and G2Z blank or zero stand for rigid.
std::unordered_map<long, Ply> read_mat8(Draft& draft) {
  std::unordered_map<long, Ply> index;
  Register known("MAT8");
  for (const Card& card : draft.take("MAT8")) {
    const long id = card.id(1, "MID");
    if (!known.admit(id, card, draft.losses)) continue;
    Ply ply;
    ply.E1 = card.positive(2, "E1");
    ply.E2 = card.positive(3, "E2");
    ply.nu12 = card.real(4, "NU12");
    ply.G12 = card.positive(5, "G12");
    ply.G13 = card.non_negative(6, "G1Z", 0.0);
    ply.G23 = card.non_negative(7, "G2Z", 0.0);
    ply.rho = card.non_negative(8, "RHO", 0.0);
    if (!(ply.nu12 * ply.nu12 * ply.E2 < ply.E1))
      card.fail(4, "NU12", fmt::format("a number below √(E1/E2) = {:.4g} in size", std::sqrt(ply.E1 / ply.E2)));
    if ((ply.G13 == 0.0) != (ply.G23 == 0.0))
      card.fail(ply.G13 == 0.0 ? 6 : 7, ply.G13 == 0.0 ? "G1Z" : "G2Z", "a number above zero, as its neighbour has");
    index.emplace(id, ply);
  }
  return index;
}

/// MAT2: G11 G12 G13 G22 G23 G33 RHO.
std::unordered_map<long, Anisotropic> read_mat2(Draft& draft) {
  std::unordered_map<long, Anisotropic> index;
  Register known("MAT2");
  for (const Card& card : draft.take("MAT2")) {
    const long id = card.id(1, "MID");
    if (!known.admit(id, card, draft.losses)) continue;
    Anisotropic m{.G = Mat3::Zero(), .rho = card.non_negative(8, "RHO", 0.0)};
    constexpr std::array<const char*, 6> labels{"G11", "G12", "G13", "G22", "G23", "G33"};
    for (int i = 0, field = 2; i < 3; ++i)
      for (int j = i; j < 3; ++j, ++field)
        m.G(i, j) = m.G(j, i) = card.real(field, labels[static_cast<std::size_t>(field - 2)], 0.0);
    index.emplace(id, m);
  }
  return index;
}

/// In the plane: E1 = G11 − G12²/G22, E2 = G22 − G12²/G11, ν12 = G12/G22.
Ply in_plane(const Card& card, const Anisotropic& m) {
  if (m.G(0, 2) != 0.0 || m.G(1, 2) != 0.0)
    card.fail(2, "MID1", "a MAT2 with G13 and G23 zero: shear coupled with extension is read of plies only (PCOMP)");
  if (!(m.G(0, 0) > 0.0 && m.G(2, 2) > 0.0 && m.G(0, 0) * m.G(1, 1) > m.G(0, 1) * m.G(0, 1)))
    card.fail(2, "MID1", "a MAT2 whose stiffness is positive: G11, G33 and G11·G22 − G12² above zero");
  const double G12 = m.G(0, 1);
  return {.E1 = m.G(0, 0) - G12 * G12 / m.G(1, 1),
          .E2 = m.G(1, 1) - G12 * G12 / m.G(0, 0),
          .nu12 = G12 / m.G(1, 1),
          .G12 = m.G(2, 2),
          .rho = m.rho};
}

/// G13, G23 of the material of MID3.
std::array<double, 2> transverse(const Card& card, const Orthotropic& orthotropic, const MaterialIndex& materials,
                                 const Model& model) {
  const long id = card.id(6, "MID3");
  if (const auto found = orthotropic.mat8.find(id); found != orthotropic.mat8.end())
    return {found->second.G13, found->second.G23};
  if (const auto found = orthotropic.mat2.find(id); found != orthotropic.mat2.end()) {
    const Mat3& G = found->second.G;
    if (!(G(0, 0) > 0.0 && G(1, 1) > 0.0 && G(0, 1) == 0.0))
      card.fail(6, "MID3", "a MAT2 with G11 and G22, the transverse shear moduli, above zero and G12 zero");
    return {G(0, 0), G(1, 1)};
  }
  if (const auto found = materials.find(id); found != materials.end()) {
    const double G = model.materials[static_cast<std::size_t>(found->second)].G;
    return {G, G};
  }
  card.refuse(6, fmt::format("field MID3 names material {}, which is not defined by a MAT1, MAT2 or MAT8", id),
              "Add the card or correct the number");
}

}  // namespace

Orthotropic read_orthotropic(Draft& draft) { return {.mat8 = read_mat8(draft), .mat2 = read_mat2(draft)}; }

Ply single_ply(const Card& card, const Orthotropic& orthotropic, const MaterialIndex& materials, const Model& model) {
  const long id = card.id(2, "MID1");
  const auto mat8 = orthotropic.mat8.find(id);
  Ply ply = mat8 != orthotropic.mat8.end() ? mat8->second : in_plane(card, orthotropic.mat2.at(id));
  if (card.blank(4) || card.id(4, "MID2") != id)
    card.fail(4, "MID2", fmt::format("{}, the material of MID1: with directions only a homogeneous plate is read", id));
  if (std::abs(card.real(5, "12I/T**3", 1.0) - 1.0) > 1e-9)
    card.fail(5, "12I/T**3", "1.0 or a blank: with directions only a homogeneous plate is read (a sandwich as PCOMP)");
  ply.G13 = ply.G23 = 0.0;  // rigid
  if (!card.blank(6)) {
    const double ratio = card.non_negative(7, "TS/T", 5.0 / 6.0) / (5.0 / 6.0);  // a single ply's own is 5/6
    const auto [G13, G23] = transverse(card, orthotropic, materials, model);
    ply.G13 = ratio * G13;
    ply.G23 = ratio * G23;
  }
  ply.thickness = card.positive(3, "T");
  return ply;
}

}  // namespace tenon::fem::nastran
