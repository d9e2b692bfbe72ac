#pragma once

#include <filesystem>

#include "fem/model.hpp"

/// Abaqus and CalculiX input decks (.inp), flat: nodes, elements, sets, materials, sections, masses, springs,
/// constraints and supports; *INCLUDE.
namespace tenon::fem {

struct AbaqusOptions {
  /// Read on when a keyword that would change stiffness or mass is not understood; it then stands in the losses.
  bool allow_losses = false;
};

/// A deck as a mesh and as a structural model.
///
/// Units: every number stands in the deck's own consistent units, as in a Nastran deck (nastran.hpp).
///
/// Sets. *NSET and *ELSET, NSET= of *NODE, ELSET= of *ELEMENT, ranges and sets of sets; names do not differ by case.
/// Element sets are cell sets, node sets point sets.
///
/// Parts. Each *INSTANCE gets the blocks of its *PART, moved, then turned (their n1 and *ORIENTATION too; what else has
/// directions is refused in a turned one). Sets of a part are "instance.set", in the mesh as well. The first instance
/// keeps the numbers of its nodes and elements; those of the next, and those of the assembly itself, count from a power
/// of ten above them, which the losses name.
///
/// Steps. The model is that of the first *FREQUENCY step, without one that of the last step: *BOUNDARY of steps up to
/// it holds, OP=NEW takes away those before its step. Frequencies about a loaded state (*STATIC before, with
/// PERTURBATION or NLGEOM) are refused.
///
/// Elements. B31 and its like are beams (not B33, nor those of open sections); B32 (three nodes) two beams; S3, S4
/// shells; S6 four triangles; S8 four triangles and a quadrilateral in the middle, S9 four quadrilaterals: each split
/// is a notice in the losses. MASS, ROTARYI, SPRING1, SPRING2 (own axes by *ORIENTATION), SPRINGA. T3D2 is a rod, T3D3
/// two rods whose middle node follows the ends across them. Elements of solids, membranes and every other kind are kept
/// as cells and stand in the losses as carrying stiffness and mass where the deck gives them a section.
///
/// Sections. The local 1-direction n1 becomes the orientation (y), n2 = t × n1 is z: I11 → Iy, I22 → Iz. CIRC with one
/// number has a radius (Abaqus), with two a diameter in each direction (CalculiX). Shear coefficients are Cowper's,
/// those of the programs differ in the third digit. COMPOSITE shells and those of LAMINA or ENGINEERING CONSTANTS are
/// laminates, their direction 1 the projection of an *ORIENTATION whose second line names axis 3; without that line,
/// and with orientations of the layers' own, for elements across axis 3 alone: else the two programs differ. Some
/// layers with an orientation of their own and some without are refused, for the same reason.
///
/// Throws InputError with file, line and column for everything that cannot be understood, and for every keyword that
/// would change stiffness or mass if it were read past (unless `allow_losses`).
/// Source: the keyword references of Abaqus and CalculiX CrunchiX.
struct AbaqusDeck {
  Mesh mesh;
  Model model;                ///< its first nodes are those of the mesh
  std::string title;          ///< *HEADING
  bool has_sections = false;  ///< else the file is a mesh whose sections come from elsewhere
};

AbaqusDeck read_abaqus(const std::filesystem::path& path, const AbaqusOptions& options = {});

/// Whether the file, with all that it includes, gives any element a section.
bool abaqus_gives_sections(const std::filesystem::path& path);

}  // namespace tenon::fem
