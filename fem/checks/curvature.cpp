#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>

#include "fem/checks/cells.hpp"
#include "fem/shell_directors.hpp"

namespace tenon::fem::checks {
namespace {

/// Whether a corner is further than 20° from a right angle; of triangles, whose right angle alone is even, above it.
bool is_skew(std::span<const Vec3> x) {
  const double limit = std::sin(20.0 / 180.0 * std::numbers::pi);
  for (std::size_t i = 0; i < x.size(); ++i) {
    const Vec3 on = x[(i + 1) % x.size()] - x[i], back = x[(i + x.size() - 1) % x.size()] - x[i];
    const double cosine = on.dot(back) / (on.norm() * back.norm());
    if ((x.size() == 4 ? std::abs(cosine) : -cosine) > limit) return true;
  }
  return false;
}

/// h² κ, h² the area and κ the largest curvature between two corners, whose normals are n in either sense; 0 where they
/// have none.
double area_times_curvature(std::span<const Vec3> x, std::span<const Vec3> n) {
  double curvature = 0.0;
  for (std::size_t i = 0; i < x.size(); ++i)
    for (std::size_t j = 0; j < i; ++j)
      if (const double apart = (x[i] - x[j]).norm(); apart > 0.0)
        curvature = std::max(curvature, n[i].cross(n[j]).norm() / apart);
  const std::size_t last = x.size() - 1;  // of a triangle x₂ twice
  return 0.5 * (x[2] - x[0]).cross(x[last] - x[1]).norm() * curvature;
}

}  // namespace

// A thin shell bends within √(R t) of edges and loads, and deflects there without strain in its surface. Skew elements
// larger than that cannot: the README of fem/ has what they are off by.
void check_curvature(const Model& model, const CheckLimits& limits, std::vector<Finding>& findings) {
  const std::vector<Vec3> directors = shell_directors(model);
  Places places;
  const auto look = [&](const auto& shell) {
    constexpr std::size_t size = std::tuple_size_v<decltype(shell.nodes)>;
    if (static_cast<std::size_t>(shell.section) >= model.shell_sections.size()) return;  // a model under way
    std::array<Vec3, size> x, n;
    for (std::size_t i = 0; i < size; ++i) {
      const auto node = static_cast<std::size_t>(shell.nodes[i]);
      x[i] = model.nodes[node];
      n[i] = directors[node];
    }
    const double t = model.shell_sections[static_cast<std::size_t>(shell.section)].thickness;
    const double ratio = area_times_curvature(x, n) / t;
    if (ratio > limits.curvature && is_skew(x)) places.add(ratio, fmt::format("element {} ({:.3g})", shell.id, ratio));
  };
  for (const Element& element : model.elements)
    if (const auto* const quad = std::get_if<Quad4>(&element))
      look(*quad);
    else if (const auto* const triangle = std::get_if<Tria3>(&element))
      look(*triangle);
  const double worst = places.empty() ? 0.0 : places.worst();
  places.report(findings,
                {.severity = Severity::warning,
                 .check = "curvature",
                 .what = "skew shells too large for their curvature and thickness: area over radius times thickness",
                 .value = worst,
                 .limit = limits.curvature,
                 .cure = fmt::format("Mesh {:.1f} times finer there, or with lines along and across the curvature: "
                                     "deflections and frequencies are several per cent off, or more",
                                     std::ceil(10.0 * std::sqrt(worst / limits.curvature)) / 10.0)},
                limits.listed);
}

}  // namespace tenon::fem::checks
