#pragma once

#include <limits>
#include <string>
#include <vector>

#include "fem/structure.hpp"

/// What a user of GROUNDCHECK, WEIGHTCHECK, GEOMCHECK or pyYeti's cbcheck looks at before he trusts a model: values
/// only.
namespace tenon::fem {

enum class Severity { note, warning, error };

/// One thing that was looked at and what it says.
struct Finding {
  Severity severity = Severity::note;
  std::string check{};               ///< stable key, e.g. "coincident_nodes"
  std::string what{};                ///< a sentence, without its places
  std::vector<std::string> where{};  ///< "node 45 rz", "element 7": the file's numbers, the worst first, not all
  long count = 0;                    ///< of all places
  double value = std::numeric_limits<double>::quiet_NaN();  ///< the worst figure; NaN where there is none
  double limit = std::numeric_limits<double>::quiet_NaN();  ///< what it is held against
  std::string cure{};
};

bool has_error(const std::vector<Finding>& findings);

/// Limits of the checks. Those of element shapes are the defaults of Nastran's GEOMCHECK (Quick Reference Guide) but
/// for aspect and Jacobian ratio, which it does not test for shells.
struct CheckLimits {
  int listed = 5;                 ///< places named in a finding
  double coincident = 1e-6;       ///< distance over the diagonal of the model's box
  double mass = 1e-9;             ///< relative; centre of mass over the box's diagonal
  double inertia = 1e-2;          ///< relative: lumped and consistent mass differ by O(h²)
  double constraint = 1e-6;       ///< |Σ c R| over Σ |c R| of a linear constraint: its coefficients are often rounded
  double singular = 1e-8;         ///< least stiffness of a node's 3×3 block over the block's trace (Nastran's EPZERO)
  double warp = 0.05;             ///< distance of corners from the mean plane over the mean diagonal
  double taper = 0.5;             ///< |2 A_i / A − 1|, A_i the triangle at corner i
  double skew_quad = 30.0;        ///< angle between the lines that join mid-sides [deg], at least
  double skew_triangle = 10.0;    ///< least angle [deg]
  double angle_min = 30.0;        ///< interior, quads [deg]
  double angle_max_quad = 150.0;  ///< [deg]
  double angle_max_triangle = 160.0;  ///< [deg]
  double aspect = 10.0;               ///< longest over shortest side; triangles: √3/2 · longest side over its height
  double curvature = 10.0;            ///< h²/(R t) of skew shells, h² their area, R the least radius between corners
  double jacobian = 0.1;              ///< least over largest Jacobian determinant at the corners, at least
};

/// Checks that need neither stiffness nor mass: nodes without elements, coincident nodes, parts that nothing connects,
/// duplicate elements, shapes, free edges and normals of shells; of models also how far shells resolve their curvature.
/// O(n log n).
std::vector<Finding> check_mesh(const Mesh& mesh, const CheckLimits& limits = {});
std::vector<Finding> check_geometry(const Model& model, const CheckLimits& limits = {});

/// Of these, how far shells resolve their curvature: what bounds the accuracy of a body made of them.
std::vector<Finding> check_curvature(const Model& model, const CheckLimits& limits = {});

/// Checks of the assembled matrices: mass against geometry, K R = 0, singular dofs, dropped dofs. `free` was assembled
/// from `model` without its supports.
std::vector<Finding> check_matrices(const Model& model, const Structure& free, const CheckLimits& limits = {});

/// Rigid motions that links and constraints obstruct, and what the elimination of constraints found.
std::vector<Finding> check_constraints(const Model& model, const DofMap& dofs, const CheckLimits& limits = {});

/// All of the above; matrices only where no element is faulty. Supports are left out: a check of the body, not of how
/// it is held; the matrices looked at go to `assembled`. Throws ModelError as `assemble`.
std::vector<Finding> check_model(const Model& model, const CheckLimits& limits = {}, Structure* assembled = nullptr);

}  // namespace tenon::fem
