#pragma once

#include <array>
#include <span>

#include "fem/model.hpp"

/// The quadrilateral in its mean plane, and what the surface between its nodes is beside it.
namespace tenon::fem {

using Vec4 = Eigen::Vector4d;

/// Natural coordinates of the corners, and h = rs.
inline const Vec4 corner_r(-1.0, 1.0, 1.0, -1.0), corner_s(-1.0, -1.0, 1.0, 1.0), corner_h(1.0, -1.0, 1.0, -1.0);

/// The quad flattened onto its mean plane, which is parallel to both diagonals: the nodes lie at ±d from it in turn.
struct FlatQuad {
  Mat3 R;                    ///< columns: element axes; x bisects the diagonals, along r
  Vec4 x, y;                 ///< corners in the plane [m]
  std::array<Vec3, 4> arms;  ///< node to corner, element axes [m]
};

/// @throws ModelError naming the element: zero area, folded or crossed corners
FlatQuad flat_quad(const Quad4& quad, std::span<const Vec3> nodes);

/// E of u_corner + E (w θx θy), rows (u v) of the corners: the flat membrane sees the strains of the surface through
/// the nodes instead of its own, where it resolves √(R t), and its rotation in the plane as before. No part in rigid
/// motions.
/// @param directors  of all nodes, zero where a node has none; or none at all
/// @param thickness  of the section [m]
/// @returns false for a flat quad and where a node has no director: E = 0, not filled in
using SurfaceTerms = Eigen::Matrix<double, 8, 12>;
bool surface_terms(const Quad4& quad, std::span<const Vec3> directors, const FlatQuad& flat, double thickness,
                   SurfaceTerms& E);

}  // namespace tenon::fem
