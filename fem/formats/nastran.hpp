#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "fem/model.hpp"

/// Nastran bulk data (.bdf, .dat, .nas, .blk): small, large and free field, INCLUDE, case control's choice of sets.
namespace tenon::fem {

struct NastranOptions {
  /// Read on when a card that would change stiffness or mass is not understood; it then stands in the losses.
  bool allow_losses = false;
  /// Sets to use instead of what case control selects; needed for files without case control that hold SPC or MPC
  /// cards.
  std::optional<long> spc_set;
  std::optional<long> mpc_set;
};

/// A deck as a mesh and as a structural model.
///
/// Units: every number stands in the deck's own consistent units. Nastran has no unit card, so the caller must know
/// them: with length L, mass M and time T, E and G are M/(L T²), rho M/L³, nsm of bars M/L and of shells M/L²,
/// areas L², second moments L⁴, point masses M, their inertia M L². PARAM,WTMASS is already multiplied into all masses,
/// so a deck in inch, pound-weight and second has mass unit lbf s²/in. Coefficients of LinearConstraint may mix lengths
/// and angles: a factor between a displacement and a rotation has the unit L.
///
/// Frames: nodes, orientation vectors and offsets are in the basic frame. Directions that a card gives in a
/// displacement frame CD are kept in the basic frame: a frame that only renames the axes renames the directions; in a
/// skew one an SPC or MPC becomes a LinearConstraint over the basic directions, and an RBE2 or RBAR a RigidLink with
/// axes.
struct NastranDeck {
  Mesh mesh;                        ///< GRIDs and elements; cell sets "pbar 100", point set "boundary"
  Model model;                      ///< its first nodes are those of the mesh, nodes made while reading follow
  std::vector<int> boundary_nodes;  ///< nodes of ASET, ASET1, BSET, BSET1 in the order of the cards
  std::vector<long> turned_nodes;   ///< GRIDs whose displacement frame CD is not the basic one
  std::string title;                ///< TITLE of the case control
  bool coupled_mass = false;        ///< PARAM,COUPMASS > 0
  double mass_factor = 1.0;         ///< PARAM,WTMASS, already applied
  bool auto_spc = true;             ///< unless PARAM,AUTOSPC,NO: hold_singular_directions gives Nastran's own solution
};

/// Reads a deck with everything it includes.
///
/// Mass. With PARAM,COUPMASS > 0 beams get BeamMass::nastran and shells their consistent mass. Without it Nastran
/// lumps: elements then refer to copies of their material and section without mass, and PointMass elements carry it at
/// the nodes (a bar half and half at its two ends, a shell ∫N_i ρt dA), one a node but for the ends of bars with
/// offsets.
///
/// Pin flags of CBAR become Beam::releases, in the element's axes. With COUPMASS they are refused: what mass Nastran
/// gives such a bar is not settled.
///
/// Sections. I1 bends in plane 1 (x–y) and becomes Iz, I2 becomes Iy; a blank K1 or K2 means rigid in shear (kappa 0).
/// PSHELL: blank MID2 gives bending_ratio 0; blank MID3 means rigid in shear, taken as shear_ratio 1000; MID2 and MID3
/// that differ from MID1 scale the two ratios. MID1 of a MAT8 or MAT2 makes a single ply in the axes of THETA or MCID,
/// its transverse shear that of MID3.
///
/// Shells. CQUADR and CTRIAR are read as CQUAD4 and CTRIA3, CQUAD8 and CTRIA6 split into four of these.
///
/// PCOMP, PCOMPG: plies of MAT8 or MAT1 in the axes of THETA or MCID, Z0 and ZOFFS become the element's offset; LAM
/// blank or, of PCOMP, SYM.
///
/// NSM and NSM1 that case control selects (NSMADD too) join the non-structural mass of properties.
///
/// Rods: CROD, CTUBE, CONROD bear force and torque (rod.hpp); with COUPMASS BeamMass::nastran, else half and half at
/// their ends. Springs: CELAS1 to CELAS4 act between two dofs, in the displacement frame of each grid, or to ground;
/// CBUSH at the point that S, or OCID with S1 to S3, gives, in the axes of CID, of GO or X, or of its line alone.
/// Damping (B, GE, CDAMP, CVISC) stands in the losses. Negative masses, stiffnesses and constants are refused at their
/// field.
///
/// Scalar points. An SPOINT, or the end of a CELAS3 or CELAS4, that springs or the selected MPCs name becomes a node
/// whose first dof is the scalar; others only stand in the losses. A scalar of the q-set is a coordinate of the reduced
/// body, not a dof of the model: it has no stiffness and no mass, stays zero in a fixed-interface run, and an equation
/// between it and a grid that no element uses recovers that grid's motion without touching the structure. An equation
/// that would give it stiffness is refused.
///
/// Throws InputError with file, line and column for everything that cannot be understood, and for every card that would
/// change stiffness or mass if it were read past (unless `allow_losses`).
/// Source: the cards' definitions in the Quick Reference Guides of MSC and NX Nastran.
NastranDeck read_nastran(const std::filesystem::path& path, const NastranOptions& options = {});

/// False for a file of grids, coordinate systems and elements alone, as mesh generators write it: it names properties
/// but gives none, so it is a mesh. Whatever else it says, an INCLUDE too, makes it a deck.
bool nastran_gives_sections(const std::filesystem::path& path);

/// The grids and cells of such a file, in its unit of length and in the basic frame; the cells of property 4 are the
/// set "property 4". Solids, offsets, pin flags, PS of GRID are losses that change stiffness. Throws as read_nastran.
Mesh read_nastran_mesh(const std::filesystem::path& path);

}  // namespace tenon::fem
