#include "fem/formats/abaqus/shell_sections.hpp"

#include <fmt/format.h>

namespace tenon::fem::abaqus {

DraftShellSection shell_section(Draft& draft, const Block& block) {
  const DraftMaterial& named = draft.material(block, block.value("MATERIAL"));
  DraftShellSection out{.section = {.name = block.value("ELSET")}, .material = named.material, .unread = {}};
  if (block.has("COMPOSITE")) out.unread = "COMPOSITE";
  if (!named.isotropic) out.unread = fmt::format("material '{}' that is not isotropic", named.material.name);
  if (const std::string offset = block.upper_value("OFFSET"); !offset.empty() && parse_real(offset) != 0.0)
    out.unread = fmt::format("OFFSET={}", offset);
  if (block.has("NODAL THICKNESS")) out.unread = "NODAL THICKNESS";
  if (!out.unread.empty()) return out;
  DataLines line(block);
  if (!line.next()) block.refuse("*SHELL SECTION has no data line", "Give the thickness");
  out.section.thickness = line.positive(0, "the thickness");
  return out;
}

// corners first, then the middles of the edges behind them, then the centre
std::string add_shell(Model& model, std::span<const int> n, const Quad4& like) {
  const auto quad = [&](int a, int b, int c, int d) {
    Quad4 q = like;
    q.nodes = {a, b, c, d};
    model.elements.emplace_back(q);
  };
  const auto triangle = [&](int a, int b, int c) {
    model.elements.emplace_back(
        Tria3{.nodes = {a, b, c}, .section = like.section, .material = like.material, .id = like.id});
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
