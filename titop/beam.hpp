#pragma once

#include <string>

#include "reduction/reduced_body.hpp"

namespace tenon::titop {

/// A uniform straight beam along x, SI. I_y = ∫z² dA and I_z = ∫y² dA about the principal axes through the centroid,
/// which is also taken as the shear centre.
struct BeamProperties {
  double length = 0.0;  ///< l [m]
  double E = 0.0;       ///< Young's modulus [Pa]
  double G = 0.0;       ///< shear modulus [Pa]; only torsion needs it
  double rho = 0.0;     ///< density [kg/m³]
  double A = 0.0;       ///< cross-section, S in the paper [m²]
  double Iy = 0.0;      ///< [m⁴] bends in the plane (P, x, z)
  double Iz = 0.0;      ///< [m⁴] bends in the plane (P, x, y)
  double J = 0.0;       ///< Saint-Venant torsion constant [m⁴]
  double Ip = 0.0;      ///< polar moment of area, I_y + I_z for the usual section [m⁴]
};

enum class BeamModel {
  polynomial,   ///< G_f,pol of the TITOP paper: quintic polynomials, eqs (14)–(17), four modes per plane
  clamped_free  ///< G_f,n: the first n modes of the clamped-free beam, eqs (12), (13)
};

/// Most clamped-free modes per plane. Beyond it the inertia that they leave at the parent port, ~4/(π⁴n³) of the
/// whole, is no longer resolved in double precision to 1e-8.
inline constexpr int most_beam_modes = 100;

/// A direction that is switched off is rigid: no modes, exact zeros in L and Phi, its inertia stays in D.
struct BeamOptions {
  BeamModel model = BeamModel::polynomial;
  int modes = 2;         ///< clamped-free modes per bending plane, 1 .. most_beam_modes; not used by `polynomial`
  bool bend_xy = true;   ///< bending in the plane (P, x, y), stiffness E I_z
  bool bend_xz = true;   ///< bending in the plane (P, x, z), stiffness E I_y
  bool traction = true;  ///< one mode, linear in x: eq (23)
  bool torsion = true;   ///< likewise, with G J and ρ I_p
  double zeta = 0.0;     ///< damping ratio of every mode
  int samples = 21;      ///< points along the axis with shapes for pictures, ends included; 0: none
};

/// The Euler-Bernoulli beam as a cantilever body: parent port "P" at the origin, child port "C" at (l, 0, 0), modes
/// ascending, mass-normalised, the larger end component positive. Shear deformation and rotary inertia of bending are
/// neglected; traction and torsion keep one linear shape whose frequency is 10 % high (√3 against π/2).
/// Errors: those of the basis (bending_basis.hpp); the matrices themselves are exact to round-off in any units and at
/// any slenderness. Throws ModelError for a number that makes no beam.
reduction::ReducedBody beam_body(std::string name, const BeamProperties& beam, const BeamOptions& options = {});

}  // namespace tenon::titop
