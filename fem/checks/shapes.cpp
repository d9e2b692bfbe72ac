#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>

#include "fem/checks/cells.hpp"
#include "fem/elements/shell_shape.hpp"

namespace tenon::fem::checks {
namespace {

constexpr double degrees = 180.0 / std::numbers::pi;

double angle_between(const Vec3& a, const Vec3& b) { return degrees * std::atan2(a.cross(b).norm(), a.dot(b)); }

/// What a quad or triangle is judged by; a rectangle has 0, 0, 90°, 90°, 90°, its ratio of sides, 1.
struct Shape {
  double warp = 0.0, taper = 0.0, skew = 90.0, angle_min = 0.0, angle_max = 0.0, aspect = 1.0, jacobian = 1.0;
  bool flat = false;  ///< no area at all, or folded over itself
  bool convex = true;
};

Shape quad_shape(const std::array<Vec3, 4>& x) {
  Shape shape;
  const Vec3 d1 = x[2] - x[0], d2 = x[3] - x[1];
  const Vec3 n2 = d1.cross(d2);  // twice the area, along the normal of the mean plane
  const double area = 0.5 * n2.norm();
  double longest = 0.0, shortest = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < 4; ++i) {
    const double side = (x[(i + 1) % 4] - x[i]).norm();
    longest = std::max(longest, side);
    shortest = std::min(shortest, side);
  }
  shape.flat = !spans_area(d1, d2);
  if (shape.flat) return shape;
  const Vec3 n = n2.normalized();
  shape.aspect = longest / shortest;
  // The corners lie at ±h off the plane that is parallel to both diagonals, midway between them.
  shape.warp = 0.5 * std::abs(n.dot(x[1] - x[0])) / (0.5 * (d1.norm() + d2.norm()));
  const double mid_sides = angle_between(x[1] + x[2] - x[0] - x[3], x[2] + x[3] - x[0] - x[1]);
  shape.skew = std::min(mid_sides, 180.0 - mid_sides);
  shape.angle_min = 360.0;
  double least = std::numeric_limits<double>::infinity(), most = -least;
  for (std::size_t i = 0; i < 4; ++i) {
    const Vec3 on = x[(i + 1) % 4] - x[i], back = x[(i + 3) % 4] - x[i];
    const double J = n.dot(on.cross(back));  // 4 det ∂x/∂(r, s) at the corner = twice its triangle
    double angle = angle_between(on, back);
    if (J < 0.0) angle = 360.0 - angle;
    shape.convex = shape.convex && turns(J, n2.norm());
    shape.angle_min = std::min(shape.angle_min, angle);
    shape.angle_max = std::max(shape.angle_max, angle);
    shape.taper = std::max(shape.taper, std::abs(J / area - 1.0));  // |2 A_i / A − 1|
    least = std::min(least, J);
    most = std::max(most, J);
  }
  shape.jacobian = least / most;
  return shape;
}

Shape triangle_shape(const std::array<Vec3, 4>& x) {
  Shape shape;
  const double area = 0.5 * (x[1] - x[0]).cross(x[2] - x[0]).norm();
  double longest = 0.0;
  shape.angle_min = 180.0;
  for (std::size_t i = 0; i < 3; ++i) {
    const Vec3 on = x[(i + 1) % 3] - x[i], back = x[(i + 2) % 3] - x[i];
    longest = std::max(longest, on.norm());
    shape.angle_min = std::min(shape.angle_min, angle_between(on, back));
    shape.angle_max = std::max(shape.angle_max, angle_between(on, back));
  }
  shape.flat = !spans_area(x[1] - x[0], x[2] - x[0]);
  if (!shape.flat) shape.aspect = longest * longest * std::numbers::sqrt3 / (4.0 * area);
  return shape;
}

/// One figure of all shells, and how it is said.
struct Measure {
  const char *check, *what, *unit;
  double limit;
  bool above;  ///< larger is worse
  Places places{};

  void look(double value, const Cell& cell) {
    if (above ? value > limit : value < limit)
      places.add(above ? value : -value, fmt::format("element {} ({:.3g}{})", cell.id, value, unit));
  }
};

}  // namespace

void check_shapes(const Cells& cells, const CheckLimits& limits, std::vector<Finding>& findings) {
  Places flat, short_line, folded;
  Measure measures[] = {
      {"warp", "quads whose corners leave their mean plane by more than the limit times their mean diagonal", "",
       limits.warp, true},
      {"taper", "quads whose corner triangles differ too much from half their area", "", limits.taper, true},
      {"skew_quad", "quads whose lines between mid-sides cross at too small an angle", "°", limits.skew_quad, false},
      {"angle_min", "quads with too small an interior angle", "°", limits.angle_min, false},
      {"angle_max", "quads with too large an interior angle", "°", limits.angle_max_quad, true},
      {"jacobian", "quads whose least Jacobian is too small a part of the largest", "", limits.jacobian, false},
      {"skew_triangle", "triangles with too small an angle", "°", limits.skew_triangle, false},
      {"angle_max_triangle", "triangles with too large an angle", "°", limits.angle_max_triangle, true},
      {"aspect", "shells too long for their width", "", limits.aspect, true}};
  auto& [warp, taper, skew, angle_min, angle_max, jacobian, skew_triangle, angle_triangle, aspect] = measures;
  for (const Cell& cell : cells.cells) {
    std::array<Vec3, 4> x;
    for (std::size_t i = 0; i < static_cast<std::size_t>(cell.size); ++i)
      x[i] = cells.points[static_cast<std::size_t>(cell.corners[i])];
    if (cell.size == 2) {
      if ((x[1] - x[0]).norm() <= 1e-12 * cells.diagonal) short_line.add(0.0, fmt::format("element {}", cell.id));
      continue;
    }
    if (cell.size < 3) continue;
    const Shape shape = cell.size == 4 ? quad_shape(x) : triangle_shape(x);
    if (shape.flat) {
      flat.add(0.0, fmt::format("element {}", cell.id));
      continue;
    }
    aspect.look(shape.aspect, cell);
    if (cell.size == 3) {
      skew_triangle.look(shape.angle_min, cell);
      angle_triangle.look(shape.angle_max, cell);
      continue;
    }
    if (!shape.convex) {
      folded.add(-shape.jacobian, fmt::format("element {} ({:.3g})", cell.id, shape.jacobian));
      continue;
    }
    warp.look(shape.warp, cell);
    taper.look(shape.taper, cell);
    skew.look(shape.skew, cell);
    angle_min.look(shape.angle_min, cell);
    angle_max.look(shape.angle_max, cell);
    jacobian.look(shape.jacobian, cell);
  }
  flat.report(findings,
              {.severity = Severity::error,
               .check = "no_area",
               .what = "shells without area",
               .cure = "Correct their nodes or take them out"},
              limits.listed);
  folded.report(findings,
                {.severity = Severity::error,
                 .check = "inverted",
                 .what = "quads that are folded or concave: their Jacobian is not positive at a corner",
                 .value = folded.empty() ? 0.0 : -folded.worst(),
                 .limit = 0.0,
                 .cure = "Give their nodes in order around the element, or mesh anew there"},
                limits.listed);
  short_line.report(findings,
                    {.severity = Severity::warning,
                     .check = "no_length",
                     .what = "line elements without length between their nodes",
                     .cure = "Correct their nodes; a beam needs length, a spring or bush does not"},
                    limits.listed);
  for (Measure& measure : measures) {
    const double worst = measure.places.empty() ? 0.0 : measure.places.worst();
    measure.places.report(
        findings,
        {.severity = Severity::warning,
         .check = measure.check,
         .what = measure.what,
         .value = measure.above ? worst : -worst,
         .limit = measure.limit,
         .cure = "Mesh finer or more evenly there, or see that results do not hang on these elements"},
        limits.listed);
  }
}

}  // namespace tenon::fem::checks
