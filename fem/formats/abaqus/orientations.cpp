#include <fmt/format.h>

#include <Eigen/Geometry>
#include <cmath>
#include <numbers>

#include "fem/formats/abaqus/draft.hpp"

namespace tenon::fem::abaqus {
namespace {

const Block& named(const Draft& draft, const Block& user, const std::string& name) {
  std::vector<std::string> names;
  for (const Block& block : draft.text.blocks) {
    if (block.keyword != "ORIENTATION" || block.scope != user.scope) continue;
    if (upper(block.value("NAME")) == upper(name)) return block;
    names.push_back(block.value("NAME"));
  }
  const std::string near = near_miss(name, names);
  user.refuse(fmt::format("there is no orientation '{}'", name),
              near.empty() ? "Define it by *ORIENTATION" : fmt::format("Did you mean '{}'?", near));
}

/// Of the second data line.
long turning_axis(const DataLines& line) {
  const long axis = line.at(0).empty() ? 1 : line.integer(0, "an axis 1 to 3");
  if (axis < 1 || axis > 3) line.fail(0, "an axis 1 to 3");
  return axis;
}

}  // namespace

long orientation_axis(const Draft& draft, const Block& user, const std::string& name) {
  DataLines line(named(draft, user, name));
  return line.next() && line.next() ? turning_axis(line) : 0;
}

// points a, b and perhaps the origin c: x along a − c, b − c in the x-y plane; then an axis number and an angle about
// it
std::optional<Mat3> orientation(const Draft& draft, const Block& user, const std::string& name) {
  const Block& block = named(draft, user, name);
  const std::string system = block.upper_value("SYSTEM"), definition = block.upper_value("DEFINITION");
  if ((!system.empty() && !system.starts_with("R")) || (!definition.empty() && definition != "COORDINATES"))
    return std::nullopt;
  DataLines line(block);
  if (!line.next()) block.refuse("*ORIENTATION has no data line", "Give the points a and b of its axes");
  const auto point = [&](std::size_t first, const char* what) {
    return Vec3(line.real(first, what, 0.0), line.real(first + 1, what, 0.0), line.real(first + 2, what, 0.0));
  };
  const Vec3 c = point(6, "the origin"), a = point(0, "point a") - c, b = point(3, "point b") - c, z = a.cross(b);
  if (!(z.norm() > 1e-9 * a.norm() * b.norm()))
    line.refuse(0, "points a and b lie on one line with the origin: they fix no axes", "Correct one of them");
  Mat3 axes;
  axes << a.normalized(), z.normalized().cross(a.normalized()), z.normalized();
  axes = draft.scope(block).rotation * axes;
  if (!line.next()) return axes;
  const long about = turning_axis(line);
  const double angle = line.real(1, "an angle in degrees", 0.0) * std::numbers::pi / 180.0;
  const Vec3 axis = axes.col(about - 1);
  return Mat3(Eigen::AngleAxisd(angle, axis).toRotationMatrix() * axes);
}

}  // namespace tenon::fem::abaqus
