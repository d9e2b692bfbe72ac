#pragma once

#include <array>
#include <string>
#include <unordered_map>

#include "fem/formats/nastran/draft.hpp"

/// Materials and sections of a deck: MAT1, MAT2, MAT8, PBAR, PBARL, PBEAM, PBEAML, PROD, PTUBE, PSHELL, PCOMP, PCOMPG.
namespace tenon::fem::nastran {

/// What an element's property number leads to: indices into the model.
struct Property {
  int section = 0;
  int material = 0;
  double offset = 0.0;  ///< of PCOMP: from the reference plane to the middle surface
  int taper = -1;       ///< of PBEAM, PBEAML: of Model::tapers
  /// Of these: the centroid from the shear centre, at the ends.
  std::array<Eigen::Vector2d, 2> neutral{Eigen::Vector2d::Zero(), Eigen::Vector2d::Zero()};
  bool warps = false;  ///< of these: its torsion would be stiffer with warping held
};

using MaterialIndex = std::unordered_map<long, int>;  ///< MAT1 by MID

/// MAT2: σ = G ε in the plane as MID1 and MID2, [G11 G12; G12 G22] the transverse shear as MID3.
struct Anisotropic {
  Mat3 G;
  double rho = 0.0;
};

/// Materials with directions, by MID.
struct Orthotropic {
  std::unordered_map<long, Ply> mat8;
  std::unordered_map<long, Anisotropic> mat2;

  bool contains(long id) const { return mat8.contains(id) || mat2.contains(id); }
};

Orthotropic read_orthotropic(Draft& draft);

/// The single ply of a PSHELL whose MID1 is a MAT8 or MAT2: MID2 the same, MID3 blank (rigid in transverse shear), a
/// MAT1, MAT8 or MAT2 with TS/T. Refuses other bending and what couples shear and extension in the ply's axes.
Ply single_ply(const Card& card, const Orthotropic& orthotropic, const MaterialIndex& materials, const Model& model);

struct Properties {
  std::unordered_map<long, Property> bars, beams;  ///< PBAR and PBARL, PBEAM and PBEAML by PID
  std::unordered_map<long, Property> shells;       ///< PSHELL, PCOMP and PCOMPG
  std::unordered_map<long, Property> rods, tubes;  ///< PROD, PTUBE

  /// The property an element names; throws InputError at the field.
  static const Property& find(const std::unordered_map<long, Property>& properties, const char* kind, const Card& card,
                              int field);

  /// A section of plies, with a material for the elements to name; the plies have their own.
  void add_laminate(long id, ShellSection section, double offset, Model& model);
};

void read_bar_sections(Draft& draft, const MaterialIndex& materials, Properties& properties);   ///< PBAR, PBARL
void read_beam_sections(Draft& draft, const MaterialIndex& materials, Properties& properties);  ///< PBEAM, PBEAML

/// PCOMP, PCOMPG: plies from bottom to top, each in the axes that THETA of the element and of the ply give.
void read_composites(Draft& draft, const MaterialIndex& materials, const Orthotropic& orthotropic,
                     Properties& properties);

/// NSM, NSM1, NSMADD that case control selects: more non-structural mass for properties.
void add_nonstructural_mass(Draft& draft, Properties& properties);

/// The material that a card names; throws InputError at the field.
int material(const MaterialIndex& materials, const Card& card, int field, const char* label);

/// MID A J C NSM, from field `first` on, as PROD and CONROD have them; appended to the draft's model.
Property rod_property(Draft& draft, const MaterialIndex& materials, const Card& card, int first, std::string name);

/// Appends materials and sections to the draft's model; fills `materials`.
Properties read_properties(Draft& draft, MaterialIndex& materials);

}  // namespace tenon::fem::nastran
