#include <fmt/format.h>

#include <Eigen/Geometry>
#include <map>
#include <variant>

#include "fem/error.hpp"
#include "fem/formats/deck.hpp"
#include "fem/formats/read_mesh.hpp"
#include "interfaces/cli/commands.hpp"
#include "interfaces/cli/input.hpp"
#include "interfaces/cli/output.hpp"

namespace tenon::cli {
namespace {

/// One name for each kind of element: one without does not compile.
struct KindName {
  const char* operator()(const fem::Beam&) const { return "beams"; }
  const char* operator()(const fem::Quad4&) const { return "4-node shells"; }
  const char* operator()(const fem::Tria3&) const { return "3-node shells"; }
  const char* operator()(const fem::PointMass&) const { return "lumped masses"; }
  const char* operator()(const fem::Spring&) const { return "springs"; }
  const char* operator()(const fem::Rod&) const { return "rods"; }
  const char* operator()(const fem::Bush&) const { return "springs in six directions"; }
};

/// How many of what a structural model holds, by name.
std::map<std::string, std::size_t> contents(const fem::Model& model) {
  std::map<std::string, std::size_t> counts;
  for (const fem::Element& element : model.elements) ++counts[std::visit(KindName{}, element)];
  const auto add = [&](const char* name, std::size_t count) {
    if (count > 0) counts[name] = count;
  };
  add("parts given as matrices", model.matrix_parts.size());
  add("rigid links", model.rigid_links.size());
  add("averaging links", model.average_links.size());
  add("linear constraints", model.constraints.size());
  add("supported dofs", model.supports.size());
  add("materials", model.materials.size());
  add("beam sections", model.beam_sections.size());
  add("shell sections", model.shell_sections.size());
  return counts;
}

std::size_t cells_in_set(const std::vector<std::vector<int>>& blocks) {
  std::size_t count = 0;
  for (const auto& block : blocks) count += block.size();
  return count;
}

/// The kinds of cells of a set, e.g. "line, quad".
std::string kinds_in_set(const fem::Mesh& mesh, const std::vector<std::vector<int>>& blocks) {
  std::vector<std::string_view> kinds;
  for (std::size_t b = 0; b < blocks.size(); ++b)
    if (!blocks[b].empty()) kinds.push_back(fem::name(mesh.cells[b].type));
  return fmt::format("{}", fmt::join(kinds, ", "));
}

Json to_json(const fem::Mesh& mesh, const fem::Model* model, const Eigen::AlignedBox3d& box) {
  Json object{{"source", mesh.source}, {"format", mesh.format}, {"points", mesh.points.size()}};
  object["cells"] = Json::object();
  for (const fem::CellBlock& block : mesh.cells) object["cells"][std::string(fem::name(block.type))] = block.size();
  object["point_sets"] = Json::object();
  for (const auto& [name, points] : mesh.point_sets) object["point_sets"][name] = points.size();
  object["cell_sets"] = Json::object();
  for (const auto& [name, blocks] : mesh.cell_sets)
    object["cell_sets"][name] = {{"cells", cells_in_set(blocks)}, {"kinds", kinds_in_set(mesh, blocks)}};
  if (!box.isEmpty())
    object["bounding_box_file_units"] = {{"min", {box.min().x(), box.min().y(), box.min().z()}},
                                         {"max", {box.max().x(), box.max().y(), box.max().z()}}};
  if (model) {
    object["model"] = Json::object();
    for (const auto& [name, count] : contents(*model)) object["model"][name] = count;
  }
  object["read_past"] = Json::array();
  for (const fem::Loss& loss : model ? model->losses : losses_of(mesh))
    object["read_past"].push_back(
        {{"name", loss.name}, {"count", loss.count}, {"note", loss.note}, {"changes_physics", loss.changes_physics}});
  return object;
}

void print_people(const fem::Mesh& mesh, const fem::Model* model, const Eigen::AlignedBox3d& box) {
  print(fmt::format("{}: {}, {} points", mesh.source, mesh.format, mesh.points.size()));
  if (!box.isEmpty())
    print(fmt::format("  bounding box, in the file's units: ({:g}, {:g}, {:g}) to ({:g}, {:g}, {:g})", box.min().x(),
                      box.min().y(), box.min().z(), box.max().x(), box.max().y(), box.max().z()));
  Table cells({"<cells", "count"});
  for (const fem::CellBlock& block : mesh.cells)
    cells.row({std::string(fem::name(block.type)), std::to_string(block.size())});
  if (!mesh.cells.empty()) print(""), print(cells);
  Table sets({"<set", "<of", "count"});
  for (const auto& [name, points] : mesh.point_sets) sets.row({name, "points", std::to_string(points.size())});
  for (const auto& [name, blocks] : mesh.cell_sets)
    sets.row({name, kinds_in_set(mesh, blocks), std::to_string(cells_in_set(blocks))});
  if (!mesh.point_sets.empty() || !mesh.cell_sets.empty()) print(""), print(sets);
  if (model) {
    Table parts({"<model", "count"});
    for (const auto& [name, count] : contents(*model)) parts.row({name, std::to_string(count)});
    print("");
    print(parts);
  } else {
    print("\n  A mesh carries no units, materials or sections: a scene gives them (tenon init writes one).");
  }
  const std::vector<std::string> losses = loss_lines(model ? model->losses : losses_of(mesh));
  print(losses.empty() ? "\n  Nothing was read past." : "\n  Read past:");
  for (const std::string& line : losses) print(wrapped(line, 4));
}

}  // namespace

int run(const InfoOptions& options) {
  const InputKind kind = kind_of(options.file);
  if (kind == InputKind::scene)
    throw InputError({options.file.string()}, "this is a scene, not a mesh", "Use `tenon check` for scenes");
  fem::Mesh mesh;
  fem::Model model;
  if (kind == InputKind::deck) {
    fem::Deck deck = fem::read_deck(options.file, true);
    mesh = std::move(deck.mesh);
    model = std::move(deck.model);
  } else {
    mesh = fem::read_mesh(options.file);
  }
  Eigen::AlignedBox3d box;
  for (const fem::Vec3& point : mesh.points) box.extend(point);
  const fem::Model* structural = kind == InputKind::deck ? &model : nullptr;
  if (options.json)
    print(to_json(mesh, structural, box));
  else
    print_people(mesh, structural, box);
  return done;
}

}  // namespace tenon::cli
