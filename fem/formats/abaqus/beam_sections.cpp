#include "fem/formats/abaqus/beam_sections.hpp"

#include <fmt/format.h>

#include <cmath>

#include "fem/section_shapes.hpp"

namespace tenon::fem::abaqus {
namespace {

/// A line left blank, or none, is the default's.
void read_n1(DataLines& line, Vec3& n1) {
  if (line.blank_follows()) return;
  if (!line.next() || line.size() < 2) return;  // numbers of points of integration
  n1 = Vec3(line.real(0, "n1"), line.real(1, "n1"), line.real(2, "n1", 0.0));
  if (!(n1.norm() > 0.0)) line.fail(0, "a direction of some length");
}

// a along n1 (our y), b along n2 (our z); walls t1 (+1 side), t2 (+2), t3 (−1), t4 (−2)
void box_section(const DataLines& line, double nu, DraftBeamSection& out) {
  const double a = line.positive(0, "a"), b = line.positive(1, "b");
  const double t1 = line.positive(2, "t1"), t2 = line.positive(3, "t2"), t3 = line.positive(4, "t3"),
               t4 = line.positive(5, "t4");
  if (t1 != t3 || t2 != t4) {
    out.unread = "BOX with walls that differ from their opposite ones: its centroid lies off the nodes";
    return;
  }
  if (!(2.0 * t1 < a && 2.0 * t2 < b)) line.fail(2, "walls thinner than half the box");
  out.section = box(a, b, t2, t1, nu);
}

// l: nodes above the bottom; h along n2; flanges b1 (bottom) t1, b2 (top) t2; web t3
void i_section(const DataLines& line, DraftBeamSection& out) {
  const double l = line.real(0, "l"), h = line.positive(1, "h"), b1 = line.positive(2, "b1"),
               b2 = line.positive(3, "b2"), t1 = line.positive(4, "t1"), t2 = line.positive(5, "t2"),
               t3 = line.positive(6, "t3");
  if (b1 != b2 || t1 != t2) {
    out.unread = "I with two different flanges: its shear centre lies off its centroid";
    return;
  }
  const double web = h - 2.0 * t1;
  if (!(web > 0.0 && t3 < b1)) line.fail(1, "a height above both flanges, a web thinner than they are wide");
  const double A = 2.0 * b1 * t1 + web * t3;
  out.section = {.name = "I",
                 .A = A,
                 .Iy = (b1 * h * h * h - (b1 - t3) * web * web * web) / 12.0,
                 .Iz = (2.0 * t1 * b1 * b1 * b1 + web * t3 * t3 * t3) / 12.0,
                 .J = (2.0 * b1 * t1 * t1 * t1 + web * t3 * t3 * t3) / 3.0,  // thin walls
                 .kappa_y = 5.0 / 6.0 * 2.0 * b1 * t1 / A,                   // flanges
                 .kappa_z = web * t3 / A};                                   // web
  out.offset_2 = 0.5 * h - l;
}

void general_section(const Block& block, DataLines& line, DraftBeamSection& out) {
  const double A = line.positive(0, "A"), I11 = line.positive(1, "I11"), I12 = line.real(2, "I12", 0.0),
               I22 = line.positive(3, "I22"), J = line.positive(4, "J");
  out.section = {.name = "general", .A = A, .Iy = I11, .Iz = I22, .Iyz = I12, .J = J, .kappa_y = 1.0, .kappa_z = 1.0};
  read_n1(line, out.n1);
  if (block.keyword != "BEAM GENERAL SECTION") return;
  if (!line.next()) block.refuse("*BEAM GENERAL SECTION has no line with E and G", "Add it as the third data line");
  Material m{
      .name = block.value("ELSET"), .E = line.positive(0, "E"), .G = line.positive(1, "G"), .nu = 0.0, .rho = 0.0};
  m.nu = 0.5 * m.E / m.G - 1.0;
  if (const std::string density = block.value("DENSITY"); !density.empty()) {
    const auto value = parse_real(density);
    if (!value || !(*value >= 0.0)) block.refuse(fmt::format("DENSITY is '{}'", density), "Give a number");
    m.rho = *value;
  }
  out.material = m;
}

}  // namespace

DraftBeamSection beam_section(const Block& block, double nu) {
  DraftBeamSection out;
  const std::string shape =
      block.keyword == "BEAM GENERAL SECTION" && !block.has("SECTION") ? "GENERAL" : block.upper_value("SECTION");
  DataLines line(block);
  if (!line.next()) block.refuse(fmt::format("*{} has no data line", block.keyword), "Give the section's sizes");
  if (shape == "GENERAL") {
    general_section(block, line, out);
    return out;
  }
  if (block.keyword == "BEAM GENERAL SECTION") {
    out.unread = fmt::format("*BEAM GENERAL SECTION, SECTION={}", shape);
    return out;
  }
  if (shape == "RECT") {
    const double a = line.positive(0, "a");
    out.section =
        rectangle(a, line.at(1).empty() ? a : line.positive(1, "b"), nu);  // one number, a square: CalculiX, run
  } else if (shape == "CIRC" && line.at(1).empty()) {
    out.section = circle(line.positive(0, "the radius"), nu);
    out.one_number = true;
  } else if (shape == "CIRC") {
    const double d1 = line.positive(0, "the diameter in direction 1"), d2 = line.positive(1, "the one in direction 2");
    if (d1 != d2) out.unread = "CIRC with two different diameters (an ellipse)";
    out.section = circle(0.5 * d1, nu);
  } else if (shape == "PIPE") {
    const double outer = line.positive(0, "the outer radius"), wall = line.positive(1, "the wall");
    if (wall > outer) line.fail(1, "a wall thinner than the radius");
    out.section = tube(outer, outer - wall, nu);
  } else if (shape == "BOX") {
    box_section(line, nu, out);
  } else if (shape == "I") {
    i_section(line, out);
  } else {
    out.unread = shape.empty() ? "without SECTION" : fmt::format("SECTION={}", shape);
  }
  read_n1(line, out.n1);
  return out;
}

}  // namespace tenon::fem::abaqus
