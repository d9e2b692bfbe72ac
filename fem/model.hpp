#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <string>
#include <variant>
#include <vector>

#include "fem/mesh.hpp"
#include "fem/spatial.hpp"

/// The structural model: what a mesh becomes once materials, sections, masses, links and ports are known. SI units.
/// Every node has six dofs [ux uy uz rx ry rz] in the basic frame.
namespace tenon::fem {

struct Material {
  std::string name;
  double E = 0.0;    ///< Young's modulus [Pa]
  double G = 0.0;    ///< shear modulus [Pa]
  double nu = 0.0;   ///< Poisson's ratio
  double rho = 0.0;  ///< density [kg/m³]
};

/// Section constants in the element's own axes (x along the beam, y in the plane of the orientation vector).
struct BeamSection {
  std::string name;
  double A = 0.0;        ///< area [m²]
  double Iy = 0.0;       ///< second moment about y (bending in x–z) [m⁴]
  double Iz = 0.0;       ///< second moment about z (bending in x–y) [m⁴]
  double Iyz = 0.0;      ///< product of inertia [m⁴]
  double J = 0.0;        ///< torsion constant [m⁴]
  double kappa_y = 0.0;  ///< shear coefficient for forces along y; 0 means rigid in shear (κ → ∞, Euler-Bernoulli)
  double kappa_z = 0.0;  ///< shear coefficient for forces along z
  double nsm = 0.0;      ///< non-structural mass per length [kg/m]
  double shear_y = 0.0, shear_z = 0.0;  ///< shear centre, from the centroid [m]
  double nsm_y = 0.0, nsm_z = 0.0;      ///< centre of the non-structural mass, from the centroid [m]
};

/// A section at a place along a beam.
struct Station {
  double at = 0.0;  ///< fraction of the length
  int section = 0;
};

/// A layer of a laminate, orthotropic in its axes 1, 2.
struct Ply {
  double thickness = 0.0;       ///< [m]
  double angle = 0.0;           ///< from the section's direction 1 to the ply's, about the normal [rad]
  double E1 = 0.0, E2 = 0.0;    ///< [Pa]
  double nu12 = 0.0;            ///< −ε₂/ε₁ under σ₁
  double G12 = 0.0;             ///< [Pa]
  double G13 = 0.0, G23 = 0.0;  ///< transverse [Pa]; both 0: rigid in transverse shear
  double rho = 0.0;             ///< [kg/m³]
};

struct ShellSection {
  std::string name;
  double thickness = 0.0;          ///< [m]; of a laminate the sum of its plies'
  double nsm = 0.0;                ///< non-structural mass per area [kg/m²], in the middle surface
  double bending_ratio = 1.0;      ///< 12 I / t³
  double shear_ratio = 5.0 / 6.0;  ///< κ
  std::vector<Ply> plies = {};     ///< from −z to z; when given, material and both ratios have no part
};

/// A set of directions as bits 0..5 (bit 0 = ux). all_six = 0b111111.
using Directions = std::uint8_t;
inline constexpr Directions all_six = 0b111111;

/// Which mass matrix a beam gets.
///  high_order: consistent plus c K_e, c the leading error of 1/λ: O(h²) more accurate, rigid masses unchanged.
///  consistent: the kinetic energy of the exact static shapes.
///  nastran:    Nastran's COUPMASS bar: Euler-Bernoulli consistent, axial part averaged with lumped, no torsional
///  inertia.
enum class BeamMass { high_order, consistent, nastran };

struct Beam {
  std::array<int, 2> nodes{};
  int section = 0;
  int taper = -1;  ///< of Model::tapers: sections along the beam, of which `section` is the first; −1: one throughout
  int material = 0;
  Vec3 orientation = Vec3::UnitZ();  ///< with the axis spans the element's x–y plane (Nastran's v)
  std::array<Vec3, 2> offsets{Vec3::Zero(),
                              Vec3::Zero()};  ///< from node to beam end (the section's centroid), basic frame [m]
  BeamMass mass = BeamMass::high_order;
  bool rotary_inertia = true;            ///< of the section in bending; ignored by `nastran`
  std::array<Directions, 2> releases{};  ///< force-free directions of each beam end, element axes (Nastran's pin flags)
  long id = 0;
};

struct Quad4 {
  std::array<int, 4> nodes{};
  int section = 0;
  int material = 0;
  long id = 0;
  double offset = 0.0;                ///< from the nodes to the middle surface, along the element's normal [m]
  Vec3 material_axis = Vec3::Zero();  ///< projected on the element: a laminate's direction 1; zero: nodes 1 to 2
};

struct Tria3 {
  std::array<int, 3> nodes{};
  int section = 0;
  int material = 0;
  long id = 0;
  double offset = 0.0;                ///< from the nodes to the middle surface, along the element's normal [m]
  Vec3 material_axis = Vec3::Zero();  ///< projected on the element: a laminate's direction 1; zero: nodes 1 to 2
};

/// Mass at `offset` from its node, inertia about its own centre of mass, axes of the basic frame.
struct PointMass {
  int node = 0;
  double mass = 0.0;            ///< [kg]
  Mat3 inertia = Mat3::Zero();  ///< [kg m²]
  Vec3 offset = Vec3::Zero();   ///< [m]
  long id = 0;
};

/// k between two dofs, or from one dof to ground (node_b < 0). Ends apart from each other are not moved to one point: a
/// rigid motion may load them.
struct Spring {
  int node_a = 0, dof_a = 0;
  int node_b = -1, dof_b = 0;
  double k = 0.0;  ///< [N/m] or [N m/rad]
  long id = 0;
  /// Unit vectors, basic frame, in place of the axis of dof_a and dof_b, which then only tell displacement (0..2) from
  /// rotation (3..5); zero: the axis itself.
  Vec3 axis_a = Vec3::Zero(), axis_b = Vec3::Zero();
};

/// A bar that bears axial force and torque but does not bend: A, J, nsm of its section; Iy + Iz is the polar inertia.
struct Rod {
  std::array<int, 2> nodes{};
  int section = 0;  ///< of beam_sections
  int material = 0;
  BeamMass mass = BeamMass::high_order;  ///< `nastran`: COUPMASS of CROD, see elements/rod.hpp
  long id = 0;
};

/// Springs in all six directions that act at one point between two nodes, or between one and ground (node_b < 0); the
/// nodes hang rigidly on the point, so that no rigid motion loads them.
struct Bush {
  int node_a = 0, node_b = -1;
  std::array<double, 6> k{};     ///< along and about `axes` [N/m, N m/rad]
  Mat3 axes = Mat3::Identity();  ///< columns: the springs' axes in the basic frame
  Vec3 offset = Vec3::Zero();    ///< from node_a to the point, basic frame [m]
  long id = 0;
};

using Element = std::variant<Beam, Quad4, Tria3, PointMass, Spring, Rod, Bush>;

/// One of the six dofs of a node, 0..5.
struct Dof {
  int node = 0;
  int direction = 0;
};

/// RBE2: the listed directions of every dependent node follow the independent node as a rigid body.
struct RigidLink {
  int independent = 0;
  std::vector<int> dependents;
  Directions directions = all_six;
  Mat3 axes = Mat3::Identity();  ///< columns: the directions' axes in the basic frame
  long id = 0;
};

/// RBE3: the listed directions of `reference` are the weighted average motion of the others.
struct AverageLink {
  struct Group {
    int node = 0;
    double weight = 1.0;
    Directions directions = 0b000111;
  };
  int reference = 0;
  Directions directions = all_six;
  std::vector<Group> nodes;
  long id = 0;
};

/// MPC: Σ coefficient · u(dof) = 0; the first term is the one to eliminate where that is possible.
struct LinearConstraint {
  struct Term {
    Dof dof;
    double coefficient = 0.0;
  };
  std::vector<Term> terms;
  long id = 0;
};

/// SPC: the dof is held at zero.
struct Support {
  Dof dof;
};

/// A place where the body can be joined: a node with six dofs and axes for its joint.
struct Port {
  std::string name;
  int node = 0;
  Mat3 axes = Mat3::Identity();  ///< columns: the port's axes in the body frame
};

struct MatrixPart;  // matrix_part.hpp

struct Model {
  std::string source;
  std::vector<Vec3> nodes;         ///< [m]; NaN where the file does not tell a place (nodes of matrices)
  std::vector<long> node_ids;      ///< the file's numbers, for messages; < 0 for nodes made here
  std::vector<int> scalar_points;  ///< nodes that are one scalar dof (direction 0), without position
  std::vector<Material> materials;
  std::vector<BeamSection> beam_sections;
  std::vector<std::vector<Station>> tapers;  ///< sections at 0, …, 1 of a beam's length, rising
  std::vector<ShellSection> shell_sections;
  std::vector<Element> elements;
  std::vector<std::shared_ptr<const MatrixPart>> matrix_parts;  ///< given as K and M
  std::vector<RigidLink> rigid_links;
  std::vector<AverageLink> average_links;
  std::vector<LinearConstraint> constraints;
  std::vector<Support> supports;
  std::vector<Port> ports;
  std::vector<Loss> losses;
};

/// "node 45", with the file's number, or "port tip" where the node was made for a port.
std::string name(const Model& model, int node);
/// "node 45 rz".
std::string name(const Model& model, const Dof& dof);

/// "rigid link 7", with the file's number, or "rigid link of port tip" where it was made for a port.
std::string link_name(const Model& model, const RigidLink& link);
std::string link_name(const Model& model, const AverageLink& link);

/// The place of a node [m]. Throws ModelError when the file that it came from does not tell it.
const Vec3& position(const Model& model, int node);

}  // namespace tenon::fem
