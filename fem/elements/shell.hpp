#pragma once

#include <span>

#include "fem/elements/element_matrices.hpp"
#include "fem/model.hpp"

namespace tenon::fem {

/// Stiffness and mass of a four-node shell, 24×24; a warped one lies in its mean plane, its nodes joined to the corners
/// by rigid arms, and has the membrane strains of the curved surface where it resolves √(R t) (quad4_geometry.cpp).
/// Membrane with incompatible modes, MITC4 shear with edge rotations (exact thin limit), drilling stiffness relative to
/// the membrane's rotation, no drilling mass. Laminates couple membrane and bending; an offset carries the middle
/// surface off the nodes along the normal. Theory: shell_theory.hpp, laminate.hpp, quad4.cpp.
/// @param nodes  positions of all nodes of the model [m]
/// @param directors  of all nodes (`shell_directors`), zero where a node has none; without them the quad is flat
/// @throws ModelError naming the element: zero area, folded or crossed corners, thickness, E or G ≤ 0, ν outside
///         (−1, 1/2], negative ratios or mass; a ply that is none, a laminate's direction along the normal.
void quad4_matrices(const Quad4& quad, const ShellSection& section, const Material& material,
                    std::span<const Vec3> nodes, ElementMatrices& out, std::span<const Vec3> directors = {});

/// The same for three nodes, 18×18: OPT membrane (its drilling rotations are real stiffness), MITC3 shear with edge
/// rotations. On curved shells the facet's membrane is freed of what bending of the surface gives it (tria3.cpp).
/// @param directors  of all nodes (`shell_directors`), zero where a node has none; without them the shell is faceted
/// @throws ModelError as above.
void tria3_matrices(const Tria3& tria, const ShellSection& section, const Material& material,
                    std::span<const Vec3> nodes, ElementMatrices& out, std::span<const Vec3> directors = {});

/// Geometric stiffness (24×24, of a triangle 18×18) of the element's mean membrane stress resultants N [N/m] that the
/// displacement u causes:
///   Σ over u, v, w of ∫ ∇u_iᵀ N ∇u_i dA,
/// u, v bilinear (in a triangle linear), w with the linked deflections of the edges; N = A ε + B κ acts in the middle
/// surface, at the ends of an offset's rigid arms. Stress that varies over the element, moments, shear and the
/// second-order rotation of the arms (of an offset, of a warped quad) are left out.
/// @param u  the element's displacements, basic frame
/// @throws ModelError as above
void quad4_geometric_stiffness(const Quad4& quad, const ShellSection& section, const Material& material,
                               std::span<const Vec3> nodes, const Eigen::Ref<const Eigen::VectorXd>& u,
                               ElementMatrices::Matrix& out, std::span<const Vec3> directors = {});
void tria3_geometric_stiffness(const Tria3& tria, const ShellSection& section, const Material& material,
                               std::span<const Vec3> nodes, const Eigen::Ref<const Eigen::VectorXd>& u,
                               ElementMatrices::Matrix& out, std::span<const Vec3> directors = {});

}  // namespace tenon::fem
