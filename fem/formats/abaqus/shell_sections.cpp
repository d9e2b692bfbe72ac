#include "fem/formats/abaqus/shell_sections.hpp"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>

namespace tenon::fem::abaqus {

namespace {

std::string unread_material(const DraftMaterial& m) {
  return fmt::format("material '{}', neither isotropic nor a lamina,", m.material.name);
}

Ply ply_of(const DraftMaterial& m) {
  Ply ply = m.lamina.value_or(Ply{.E1 = m.material.E,
                                  .E2 = m.material.E,
                                  .nu12 = m.material.nu,
                                  .G12 = m.material.G,
                                  .G13 = m.material.G,
                                  .G23 = m.material.G});
  ply.rho = m.material.rho;
  return ply;
}

/// Layers and the directions that they have: 1 along the section's *ORIENTATION, turned by the layer's angle, or along
/// an *ORIENTATION of its own.
struct Layers {
  Draft& draft;
  const Block& block;
  DraftShellSection& out;
  bool directed = false;             ///< whether any layer has a direction
  bool unnamed = false;              ///< whether any of those has no orientation of its own
  std::vector<std::string> named{};  ///< the layers' own orientations, "" where they have none

  void read();
  void read_one(const DataLines& line);
  void direct();
  bool direct_named(const Mat3& axes);
};

/// From −z to z: thickness, points of integration, material, angle or orientation.
void Layers::read() {
  std::vector<Ply>& plies = out.section.plies;
  for (DataLines line(block); line.next();) read_one(line);
  if (plies.empty()) block.refuse("*SHELL SECTION has no data line", "Give the thickness and material of each layer");
  if (block.has("SYMMETRIC"))
    for (std::size_t k = plies.size(); k-- > 0;) {
      plies.push_back(Ply(plies[k]));
      named.push_back(std::string(named[k]));
    }
  for (const Ply& ply : plies) out.section.thickness += ply.thickness;
}

void Layers::read_one(const DataLines& line) {
  const DraftMaterial& m = draft.material(block, std::string(line.at(2)));
  if (!m.isotropic && !m.lamina) out.unread = unread_material(m);
  const auto angle = line.at(3).empty() ? 0.0 : parse_real(line.at(3));
  directed = directed || !m.isotropic;
  out.section.plies.push_back(ply_of(m));
  out.section.plies.back().thickness = line.positive(0, "the thickness of the layer");
  out.section.plies.back().angle = angle.value_or(0.0) * std::numbers::pi / 180.0;
  named.emplace_back(angle || m.isotropic ? std::string() : std::string(line.at(3)));
  unnamed = unnamed || (!m.isotropic && named.back().empty());
}

/// Abaqus projects an orientation whose second line names the axis that is near the normal; CalculiX takes the axes as
/// they stand. Both mean the same where axis 3 is the normal. A layer without an orientation, beside others that have
/// one, goes by the section's or by global x in Abaqus, by the layer's before or by global x in CalculiX.
void Layers::direct() {
  const auto own = std::ranges::find_if(named, [](const std::string& name) { return !name.empty(); });
  const std::string name = block.has("ORIENTATION") ? block.value("ORIENTATION") : own != named.end() ? *own : "";
  if (own != named.end() && unnamed) {
    out.unread = "layers without an ORIENTATION of their own beside layers that have one,";
    return;
  }
  if (name.empty()) {
    out.unread = "a material that is not isotropic, without ORIENTATION,";
    return;
  }
  const auto axes = orientation(draft, block, name);
  const long near_normal = orientation_axis(draft, block, name);
  if (!axes || near_normal == 1 || near_normal == 2) {
    out.unread =
        axes ? "an ORIENTATION whose axis 3 is not the normal" : "an ORIENTATION that turns from point to point";
    return;
  }
  out.material_axis = axes->col(0);
  if (direct_named(*axes) || near_normal == 0) out.normal = axes->col(2);
}

/// Angles of layers with axes of their own, about the axis 3 that all must share; whether there are any.
bool Layers::direct_named(const Mat3& axes) {
  bool any = false;
  for (std::size_t k = 0; k < named.size(); ++k) {
    if (named[k].empty()) continue;
    any = true;
    const auto own = orientation(draft, block, named[k]);
    if (!own || own->col(2).dot(axes.col(2)) < 1.0 - 1e-12)
      out.unread = fmt::format("a layer's ORIENTATION '{}' that does not share axis 3 with the others", named[k]);
    else
      out.section.plies[k].angle = std::atan2(own->col(0).dot(axes.col(1)), own->col(0).dot(axes.col(0)));
  }
  return any;
}

}  // namespace

DraftShellSection shell_section(Draft& draft, const Block& block) {
  DraftShellSection out{.section = {.name = block.value("ELSET")}, .material = {}, .normal = {}, .unread = {}};
  Layers layers{draft, block, out};
  if (block.has("COMPOSITE")) {
    layers.read();
    out.material.name = fmt::format("layers of {}", out.section.name);
  } else {
    const DraftMaterial& m = draft.material(block, block.value("MATERIAL"));
    out.material = m.material;
    DataLines line(block);
    if (!line.next()) block.refuse("*SHELL SECTION has no data line", "Give the thickness");
    out.section.thickness = line.positive(0, "the thickness");
    layers.directed = !m.isotropic;
    if (!m.isotropic && !m.lamina) out.unread = unread_material(m);
    if (!m.isotropic) {
      out.section.plies = {ply_of(m)};
      out.section.plies[0].thickness = out.section.thickness;
    }
  }
  if (layers.directed && out.unread.empty()) layers.direct();
  if (const std::string offset = block.upper_value("OFFSET"); !offset.empty() && parse_real(offset) != 0.0)
    out.unread = fmt::format("OFFSET={}, by which Abaqus moves the shell off its nodes and CalculiX does not,", offset);
  if (block.has("NODAL THICKNESS")) out.unread = "NODAL THICKNESS";
  return out;
}

void check_normal(const Model& model, std::span<const int> nodes, const Vec3& normal, const Block& section, long id) {
  const auto at = [&](std::size_t i) { return model.nodes[static_cast<std::size_t>(nodes[i])]; };
  const bool triangle = nodes.size() == 3 || nodes.size() == 6;
  const Vec3 n = triangle ? Vec3((at(1) - at(0)).cross(at(2) - at(0))) : Vec3((at(2) - at(0)).cross(at(3) - at(1)));
  if (n.dot(normal) < (1.0 - 1e-6) * n.norm())
    section.refuse(fmt::format("element {} does not have axis 3 of its ORIENTATION as its normal", id),
                   "Number its nodes the other way round, or have Abaqus' projection: '3, 0.' as second line of "
                   "*ORIENTATION, angles for the layers");
}

// corners first, then the middles of the edges behind them, then the centre
std::string add_shell(Model& model, std::span<const int> n, const Quad4& like) {
  const auto quad = [&](int a, int b, int c, int d) {
    Quad4 q = like;
    q.nodes = {a, b, c, d};
    model.elements.emplace_back(q);
  };
  const auto triangle = [&](int a, int b, int c) {
    model.elements.emplace_back(Tria3{.nodes = {a, b, c},
                                      .section = like.section,
                                      .material = like.material,
                                      .id = like.id,
                                      .material_axis = like.material_axis});
  };
  switch (n.size()) {
    case 3:
      triangle(n[0], n[1], n[2]);
      return {};
    case 4:
      quad(n[0], n[1], n[2], n[3]);
      return {};
    case 6:
      triangle(n[0], n[3], n[5]);
      triangle(n[3], n[1], n[4]);
      triangle(n[5], n[4], n[2]);
      triangle(n[3], n[4], n[5]);
      return "split into four triangles of three nodes";
    case 8:
      triangle(n[0], n[4], n[7]);
      triangle(n[1], n[5], n[4]);
      triangle(n[2], n[6], n[5]);
      triangle(n[3], n[7], n[6]);
      quad(n[4], n[5], n[6], n[7]);
      return "split into four triangles at its corners and a quadrilateral between them";
    default:
      quad(n[0], n[4], n[8], n[7]);
      quad(n[4], n[1], n[5], n[8]);
      quad(n[8], n[5], n[2], n[6]);
      quad(n[7], n[8], n[6], n[3]);
      return "split into four quadrilaterals of four nodes";
  }
}

}  // namespace tenon::fem::abaqus
