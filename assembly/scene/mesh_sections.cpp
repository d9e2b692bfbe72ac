#include "assembly/scene/mesh_sections.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <set>

#include "assembly/scene/split_cells.hpp"

namespace tenon::assembly {
namespace {

using fem::CellBlock;
using fem::CellType;
using fem::Mesh;

/// Per block, per cell: the index of its section, or −1.
using Cover = std::vector<std::vector<int>>;

int dimension_of(const SceneSection& section) {
  return std::holds_alternative<fem::BeamSection>(section.shape) ? 1 : 2;
}

const char* cells_of_dimension(int dimension) {
  return dimension == 1 ? "lines" : dimension == 2 ? "triangles or quadrilaterals" : "solids";
}

/// Sets that the scene uses to hold, join or load points.
std::set<std::string> used_sets(const SceneBody& body, const FeSource& fe) {
  std::set<std::string> names;
  for (const ScenePort& port : body.ports)
    if (port.where.kind == NodeSelector::Kind::set) names.insert(port.where.name);
  for (const SceneSupport& support : fe.supports) names.insert(support.set);
  for (const SceneNodeMass& mass : fe.masses)
    if (mass.where.kind == NodeSelector::Kind::set) names.insert(mass.where.name);
  return names;
}

std::set<std::string> ignored_sets(const FeSource& fe) {
  std::set<std::string> names;
  for (const SceneSet& set : fe.ignore) names.insert(set.name);
  return names;
}

[[noreturn]] void refuse_unknown(const Mesh& mesh, const std::string& set, const Place& place) {
  std::vector<std::string> names;
  for (const auto& [name, cells] : mesh.cell_sets) names.push_back(name);
  const std::string near = fem::near_miss(set, names);
  throw InputError(place, fmt::format("{} has no set of cells '{}'", mesh.source, set),
                   !near.empty()   ? fmt::format("Did you mean '{}'?", near)
                   : names.empty() ? "It names no sets; write `everywhere` for all cells"
                                   : fmt::format("Its sets are: {}", fmt::join(names, ", ")));
}

void cover_set(const Mesh& mesh, const FeSource& fe, int index, Cover& cover) {
  const SceneSection& section = fe.sections[static_cast<std::size_t>(index)];
  const auto found = mesh.cell_sets.find(section.set);
  if (found == mesh.cell_sets.end()) {
    if (mesh.point_sets.contains(section.set))
      throw InputError(section.place, fmt::format("set '{}' holds points and no cells", section.set),
                       "Name a set of cells");
    refuse_unknown(mesh, section.set, section.place);
  }
  int covered = 0;
  for (std::size_t b = 0; b < found->second.size(); ++b) {
    if (fem::dimension(mesh.cells[b].type) != dimension_of(section)) continue;
    for (const int cell : found->second[b]) {
      int& owner = cover[b][static_cast<std::size_t>(cell)];
      if (owner >= 0 && owner != index)
        throw InputError(
            section.place,
            fmt::format("sections '{}' and '{}' both name cell {}", fe.sections[static_cast<std::size_t>(owner)].set,
                        section.set, mesh.cells[b].ids[static_cast<std::size_t>(cell)]),
            "Let the sets of sections not overlap, or leave one of the two out");
      owner = index;
      ++covered;
    }
  }
  if (covered == 0)
    throw InputError(section.place,
                     fmt::format("set '{}' holds no {}", section.set, cells_of_dimension(dimension_of(section))),
                     "Give shells to surfaces and beam sections to lines");
}

/// Sets to ignore must be there, and hold cells that no section names.
void check_ignored(const Mesh& mesh, const FeSource& fe, const Cover& cover) {
  for (const SceneSet& set : fe.ignore) {
    if (set.name == "everywhere" || mesh.point_sets.contains(set.name)) continue;
    const auto found = mesh.cell_sets.find(set.name);
    if (found == mesh.cell_sets.end()) refuse_unknown(mesh, set.name, set.place);
    bool empty = true, covered = true;
    for (std::size_t b = 0; b < found->second.size(); ++b)
      for (const int cell : found->second[b]) {
        empty = false;
        covered = covered && cover[b][static_cast<std::size_t>(cell)] >= 0;
      }
    if (!empty && covered)
      throw InputError(set.place,
                       fmt::format("all cells of the set '{}' have a section, so none can be ignored", set.name),
                       "Take it out of `ignore` or out of `sections`");
  }
}

/// Marks the cells of the named sets.
std::vector<std::vector<bool>> cells_of_sets(const Mesh& mesh, const std::set<std::string>& sets) {
  std::vector<std::vector<bool>> marks;
  for (const CellBlock& block : mesh.cells) marks.emplace_back(static_cast<std::size_t>(block.size()), false);
  for (const std::string& set : sets)
    if (const auto found = mesh.cell_sets.find(set); found != mesh.cell_sets.end())
      for (std::size_t b = 0; b < found->second.size(); ++b)
        for (const int cell : found->second[b]) marks[b][static_cast<std::size_t>(cell)] = true;
  return marks;
}

/// The set names of one cell, for a message.
std::string sets_of_cell(const Mesh& mesh, std::size_t block, int cell) {
  std::vector<std::string> names;
  for (const auto& [name, cells] : mesh.cell_sets)
    if (block < cells.size() && std::find(cells[block].begin(), cells[block].end(), cell) != cells[block].end())
      names.push_back(fmt::format("'{}'", name));
  return fmt::format("{}", fmt::join(names, ", "));
}

/// Body, number of the cells and the first of them, for a message.
std::string cells_in_words(const Mesh& mesh, const SceneBody& body, const std::vector<bool>& marks, std::size_t block) {
  const auto first = std::ranges::find(marks, true) - marks.begin();
  const CellBlock& cells = mesh.cells[block];
  const std::string sets = sets_of_cell(mesh, block, static_cast<int>(first));
  return fmt::format("body '{}': {} {} cells of {}, the first is {}{},", body.name, std::ranges::count(marks, true),
                     fem::name(cells.type), mesh.source, cells.ids[static_cast<std::size_t>(first)],
                     sets.empty() ? " (in no set)" : fmt::format(" of set {}", sets));
}

[[noreturn]] void refuse_uncovered(const Mesh& mesh, const SceneBody& body, const std::vector<bool>& marks,
                                   std::size_t block) {
  const bool in_a_set =
      !sets_of_cell(mesh, block, static_cast<int>(std::ranges::find(marks, true) - marks.begin())).empty();
  throw InputError(
      body.place, fmt::format("{} have no section", cells_in_words(mesh, body, marks, block)),
      fem::dimension(mesh.cells[block].type) == 3
          ? "Solids are no elements of this program: give the K and M that the program that owns the part makes of it "
            "(`matrices:` in place of `fe:`), or mesh it with shells and beams"
      : in_a_set ? "Add the set under `sections`, or under `ignore` if it carries no structure"
                 : "Add `everywhere: {...}` under sections, `ignore: [everywhere]` if what no section names carries no "
                   "structure, or save only physical groups in the mesh");
}

[[noreturn]] void refuse_doubtful(const Mesh& mesh, const SceneBody& body, const std::vector<bool>& marks,
                                  std::size_t block) {
  throw InputError(body.place,
                   fmt::format("{} are named to hold, join or load the body, so whether `everywhere` means them too "
                               "cannot be told",
                               cells_in_words(mesh, body, marks, block)),
                   "Add the set under `sections` as well, or under `ignore` if it carries no structure");
}

/// Any direction that is not along the beam will do for a round section.
Vec3 across(const Vec3& along) {
  Eigen::Index least = 0;
  along.cwiseAbs().minCoeff(&least);
  return Vec3::Unit(least);
}

/// `nodes`: of a first-order cell.
fem::Element make_element(CellType type, const std::array<int, 4>& nodes, long id, const SceneSection& section,
                          int shape, int material, const fem::Model& model, fem::BeamMass beam_mass) {
  const Vec3 axis = section.orientation.value_or(Vec3::Zero());
  if (type == CellType::triangle)
    return fem::Tria3{.nodes = {nodes[0], nodes[1], nodes[2]},
                      .section = shape,
                      .material = material,
                      .id = id,
                      .offset = section.normal_offset,
                      .material_axis = axis};
  if (type == CellType::quad)
    return fem::Quad4{.nodes = {nodes[0], nodes[1], nodes[2], nodes[3]},
                      .section = shape,
                      .material = material,
                      .id = id,
                      .offset = section.normal_offset,
                      .material_axis = axis};
  if (section.rod)
    return fem::Rod{.nodes = {nodes[0], nodes[1]}, .section = shape, .material = material, .mass = beam_mass, .id = id};
  const Vec3 along = model.nodes[static_cast<std::size_t>(nodes[1])] - model.nodes[static_cast<std::size_t>(nodes[0])];
  return fem::Beam{.nodes = {nodes[0], nodes[1]},
                   .section = shape,
                   .material = material,
                   .orientation = section.orientation.value_or(across(along)),
                   .offsets = {section.offset, section.offset},
                   .mass = beam_mass,
                   .rotary_inertia = section.rotary_inertia,
                   .id = id};
}

/// Sections at the nodes of tapered beams, one for each place along the way.
class TaperedSections {
 public:
  TaperedSections(const SceneSection& section, fem::Model& model) : section_(section), model_(model) {
    if (section.taper && !section.along)
      throw InputError(section.place, fmt::format("section '{}' has a `tip` and no way to it", section.set),
                       "Add `along: [[x, y, z], [x, y, z]]`: where its sizes hold and where those of `tip` do");
  }

  /// Makes the beam vary from its first node to its second.
  void taper(fem::Beam& beam) {
    const fem::Station root{0.0, section_at(beam.nodes[0])}, tip{1.0, section_at(beam.nodes[1])};
    beam.section = root.section;
    beam.taper = static_cast<int>(model_.tapers.size());
    model_.tapers.push_back({root, tip});
  }

 private:
  int section_at(int node) {
    const auto& [from, to] = *section_.along;
    const Vec3 way = to - from;
    const double t = (model_.nodes[static_cast<std::size_t>(node)] - from).dot(way) / way.squaredNorm();
    if (!(t >= -1e-9 && t <= 1.0 + 1e-9))
      throw InputError(section_.place,
                       fmt::format("node {} of section '{}' lies beyond `along`, at {:.4g} of the way",
                                   model_.node_ids[static_cast<std::size_t>(node)], section_.set, t),
                       "Let `along` span the whole set");
    const auto [known, added] =
        known_.try_emplace(std::clamp(t, 0.0, 1.0), static_cast<int>(model_.beam_sections.size()));
    if (added) model_.beam_sections.push_back(section_.taper(known->first));
    return known->second;
  }

  const SceneSection& section_;
  fem::Model& model_;
  std::map<double, int> known_;
};

/// The node in the middle of a quad8, made anew.
int make_centre(const int* nodes, fem::Model& model) {
  Vec3 centre = Vec3::Zero();
  for (int i = 0; i < 8; ++i) centre += (i < 4 ? -0.25 : 0.5) * model.nodes[static_cast<std::size_t>(nodes[i])];
  const long last = model.node_ids.empty() ? 0 : std::min(model.node_ids.back(), 0L);  // made ones are −1, −2, …
  model.nodes.push_back(centre);
  model.node_ids.push_back(last - 1);
  return static_cast<int>(model.nodes.size()) - 1;
}

/// Appends the elements of a cell, several for one of second order.
void add_elements(const CellBlock& block, int cell, const SceneSection& section, int shape, int material,
                  fem::BeamMass beam_mass, TaperedSections& tapered, fem::Model& model) {
  const int* nodes = &block.nodes[static_cast<std::size_t>(cell * fem::node_count(block.type))];
  const int centre = block.type == CellType::quad8 ? make_centre(nodes, model) : -1;
  for (const Piece& piece : pieces_of(block.type)) {
    std::array<int, 4> corners{};
    for (std::size_t i = 0; i < static_cast<std::size_t>(fem::node_count(piece.type)); ++i)
      corners[i] = centre >= 0 && piece.at[i] == quad8_centre ? centre : nodes[piece.at[i]];
    model.elements.push_back(make_element(piece.type, corners, block.ids[static_cast<std::size_t>(cell)], section,
                                          shape, material, model, beam_mass));
    if (section.taper) tapered.taper(std::get<fem::Beam>(model.elements.back()));
  }
}

/// Second-order cells stand in the losses.
void note_split(const CellBlock& block, long count, fem::Model& model) {
  const std::size_t pieces = pieces_of(block.type).size();
  if (count == 0 || pieces < 2) return;
  model.losses.push_back(
      {.name = fmt::format("{} cells", fem::name(block.type)),
       .count = count,
       .note = fmt::format("each is split into {} first-order {}{}", pieces, fem::name(pieces_of(block.type)[0].type),
                           block.type == CellType::quad8 ? "s, with a node made in its middle" : "s")});
}

Cover cover_cells(const Mesh& mesh, const SceneBody& body, const FeSource& fe) {
  Cover cover;
  for (const CellBlock& block : mesh.cells) cover.emplace_back(static_cast<std::size_t>(block.size()), -1);
  for (std::size_t k = 0; k < fe.sections.size(); ++k)
    if (fe.sections[k].set != "everywhere") cover_set(mesh, fe, static_cast<int>(k), cover);

  check_ignored(mesh, fe, cover);
  const std::set<std::string> ignored = ignored_sets(fe);
  const auto used = cells_of_sets(mesh, used_sets(body, fe)), left_out = cells_of_sets(mesh, ignored);
  for (std::size_t b = 0; b < mesh.cells.size(); ++b) {
    const int dimension = fem::dimension(mesh.cells[b].type);
    if (dimension == 0) continue;
    const auto everywhere = std::ranges::find_if(fe.sections, [&](const SceneSection& section) {
      return section.set == "everywhere" && dimension_of(section) == dimension;
    });
    const bool any = everywhere != fe.sections.end();
    std::vector<bool> uncovered(cover[b].size(), false), doubtful(cover[b].size(), false);
    for (std::size_t k = 0; k < cover[b].size(); ++k) {
      if (cover[b][k] >= 0 || left_out[b][k]) continue;
      if (any) cover[b][k] = static_cast<int>(everywhere - fe.sections.begin());
      doubtful[k] = any && used[b][k];
      uncovered[k] = !any && !used[b][k] && (dimension == 3 || !ignored.contains("everywhere"));
    }
    if (std::ranges::count(doubtful, true) > 0) refuse_doubtful(mesh, body, doubtful, b);
    if (std::ranges::count(uncovered, true) > 0) refuse_uncovered(mesh, body, uncovered, b);
  }
  return cover;
}

}  // namespace

fem::Model elements_of(const Mesh& mesh, const SceneBody& body, const FeSource& fe) {
  const Cover cover = cover_cells(mesh, body, fe);
  fem::Model model;
  model.source = mesh.source;
  model.node_ids = mesh.point_ids;
  model.losses = mesh.losses;
  const Factor length = fe.units.to_si(dimension::length);
  for (const Vec3& point : mesh.points) model.nodes.push_back(length * point);

  std::vector<int> shape;  // of each section: index among the model's beam or shell sections
  for (const SceneSection& section : fe.sections) {
    model.materials.push_back(section.material);
    if (const auto* beam = std::get_if<fem::BeamSection>(&section.shape)) {
      shape.push_back(static_cast<int>(model.beam_sections.size()));
      model.beam_sections.push_back(*beam);
    } else {
      shape.push_back(static_cast<int>(model.shell_sections.size()));
      model.shell_sections.push_back(std::get<fem::ShellSection>(section.shape));
    }
  }
  std::vector<TaperedSections> tapered;
  for (const SceneSection& section : fe.sections) tapered.emplace_back(section, model);
  const fem::BeamMass beam_mass = fe.beam_mass.value_or(fem::BeamMass::high_order);
  for (std::size_t b = 0; b < mesh.cells.size(); ++b) {
    long count = 0;
    for (std::size_t k = 0; k < cover[b].size(); ++k) {
      if (cover[b][k] < 0) continue;
      const auto s = static_cast<std::size_t>(cover[b][k]);
      add_elements(mesh.cells[b], static_cast<int>(k), fe.sections[s], shape[s], static_cast<int>(s), beam_mass,
                   tapered[s], model);
      ++count;
    }
    note_split(mesh.cells[b], count, model);
  }
  return model;
}

}  // namespace tenon::assembly
