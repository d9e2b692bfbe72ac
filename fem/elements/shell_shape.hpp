#pragma once

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <span>

#include "fem/spatial.hpp"

/// What quadrilateral and triangle share of their shape. One meaning of an area and of a corner for the elements, which
/// refuse those without, and for the checks, which name them beforehand.
namespace tenon::fem {

/// Whether the diagonals of a quad, or two sides of a triangle, span an area beyond round-off.
inline bool spans_area(const Vec3& a, const Vec3& b) {
  return a.cross(b).norm() > 1e-10 * (a.squaredNorm() + b.squaredNorm());
}

/// Whether a quad turns at a corner by less than 180° beyond round-off. `corner`: twice the corner's triangle, against
/// the quad's normal negative; `quad`: twice the quad's area.
inline bool turns(double corner, double quad) { return corner > 1e-8 * quad; }

/// Slopes of the surface's normals at the nodes against an element's plane.
template <std::size_t N>
using NormalTilts = std::array<Eigen::Vector2d, N>;

/// `R`: columns are the element's axes, z its normal. False where a node has no normal or one of another surface, or
/// where all are the plane's: the element is flat.
template <std::size_t N>
bool normal_tilts(const std::array<int, N>& nodes, std::span<const Vec3> directors, const Mat3& R, NormalTilts<N>& m) {
  if (directors.empty()) return false;
  double largest = 0.0;
  for (std::size_t i = 0; i < N; ++i) {
    const Vec3 n = R.transpose() * directors[static_cast<std::size_t>(nodes[i])];
    if (!(std::abs(n.z()) > 0.5)) return false;
    m[i] = n.template head<2>() / n.z();
    largest = std::max(largest, m[i].norm());
  }
  return largest > 1e-9;
}

template <std::size_t N>
Eigen::Vector2d mean_tilt(const NormalTilts<N>& m) {
  Eigen::Vector2d sum(0.0, 0.0);
  for (const Eigen::Vector2d& tilt : m) sum += tilt;
  return sum / static_cast<double>(N);
}

/// 1 / (1 + m̂² A / 12 t²), m̂ the largest tilt against their mean: near to 1 where elements of area A resolve √(R t), to
/// 0 where they do not.
template <std::size_t N>
double resolved_share(const NormalTilts<N>& m, double area, double thickness) {
  const Eigen::Vector2d mean = mean_tilt(m);
  double spread2 = 0.0;
  for (const Eigen::Vector2d& tilt : m) spread2 = std::max(spread2, (tilt - mean).squaredNorm());
  return 1.0 / (1.0 + spread2 * area / (12.0 * thickness * thickness));
}

}  // namespace tenon::fem
