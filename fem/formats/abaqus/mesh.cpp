#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <set>

#include "fem/formats/abaqus/draft.hpp"

namespace tenon::fem::abaqus {
namespace {

struct Family {
  const char* prefix;
  Formulation formulation;
  CellType cell;
};

// The longest prefix that fits decides; what follows it is reduced integration, hybrid form and the like.
constexpr std::array families{Family{"B31", Formulation::beam, CellType::line},
                              Family{"B33", Formulation::other, CellType::line},
                              Family{"B32", Formulation::beam, CellType::line3},
                              Family{"S3", Formulation::shell, CellType::triangle},
                              Family{"STRI3", Formulation::shell, CellType::triangle},
                              Family{"S4", Formulation::shell, CellType::quad},
                              Family{"S6", Formulation::shell, CellType::triangle6},
                              Family{"STRI65", Formulation::shell, CellType::triangle6},
                              Family{"S8", Formulation::shell, CellType::quad8},
                              Family{"S9", Formulation::shell, CellType::quad9},
                              Family{"MASS", Formulation::mass, CellType::vertex},
                              Family{"ROTARYI", Formulation::rotary_inertia, CellType::vertex},
                              Family{"T2D2", Formulation::other, CellType::line},
                              Family{"T3D2", Formulation::truss, CellType::line},
                              Family{"T3D3", Formulation::truss, CellType::line3},
                              Family{"B21", Formulation::other, CellType::line},
                              Family{"B22", Formulation::other, CellType::line3},
                              Family{"B23", Formulation::other, CellType::line},
                              Family{"M3D3", Formulation::other, CellType::triangle},
                              Family{"M3D4", Formulation::other, CellType::quad},
                              Family{"M3D6", Formulation::other, CellType::triangle6},
                              Family{"M3D8", Formulation::other, CellType::quad8},
                              Family{"SFM3D3", Formulation::other, CellType::triangle},
                              Family{"SFM3D4", Formulation::other, CellType::quad},
                              Family{"R3D3", Formulation::other, CellType::triangle},
                              Family{"R3D4", Formulation::other, CellType::quad},
                              Family{"CPS3", Formulation::other, CellType::triangle},
                              Family{"CPE3", Formulation::other, CellType::triangle},
                              Family{"CAX3", Formulation::other, CellType::triangle},
                              Family{"CPS4", Formulation::other, CellType::quad},
                              Family{"CPE4", Formulation::other, CellType::quad},
                              Family{"CAX4", Formulation::other, CellType::quad},
                              Family{"CPS6", Formulation::other, CellType::triangle6},
                              Family{"CPE6", Formulation::other, CellType::triangle6},
                              Family{"CAX6", Formulation::other, CellType::triangle6},
                              Family{"CPS8", Formulation::other, CellType::quad8},
                              Family{"CPE8", Formulation::other, CellType::quad8},
                              Family{"CAX8", Formulation::other, CellType::quad8},
                              Family{"C3D4", Formulation::other, CellType::tetra},
                              Family{"C3D5", Formulation::other, CellType::pyramid},
                              Family{"C3D6", Formulation::other, CellType::wedge},
                              Family{"C3D8", Formulation::other, CellType::hexahedron},
                              Family{"C3D10", Formulation::other, CellType::tetra10},
                              Family{"C3D15", Formulation::other, CellType::wedge15},
                              Family{"C3D20", Formulation::other, CellType::hexahedron20},
                              Family{"F3D4", Formulation::other, CellType::tetra},
                              Family{"F3D6", Formulation::other, CellType::wedge},
                              Family{"F3D8", Formulation::other, CellType::hexahedron},
                              Family{"DC3D8", Formulation::other, CellType::hexahedron},
                              Family{"DC3D20", Formulation::other, CellType::hexahedron20}};

bool letters(std::string_view rest) {
  return std::ranges::all_of(rest, [](char c) { return (c >= 'A' && c <= 'Z') || c == '5'; });  // S4R5, S8R5
}

/// Adds them to the set that the block names by `parameter`.
void add_to_set(const Draft& draft, auto& sets, const Block& block, const char* parameter,
                const std::vector<int>& members) {
  const std::string name = block.value(parameter);
  if (name.empty())
    block.refuse(fmt::format("*{} gives {} without a name", block.keyword, parameter),
                 fmt::format("Write {}=name, or leave it out", parameter));
  auto& set =
      sets.try_emplace(draft.key(name, block), draft.full_name(name, block), std::vector<int>{}).first->second.second;
  set.insert(set.end(), members.begin(), members.end());
}

}  // namespace

ElementType element_type(const std::string& name) {
  if (name == "SPRING1") return {Formulation::spring_to_ground, {}, 1};
  if (name == "SPRING2") return {Formulation::spring, {}, 2};
  if (name == "SPRINGA") return {Formulation::axial_spring, {}, 2};
  if (name == "DASHPOTA" || name == "DASHPOT2") return {Formulation::other, {}, 2};
  if (name == "DASHPOT1" || name == "DCOUP3D") return {Formulation::other, {}, 1};
  if (name.starts_with("B3") && name.find("OS") != name.npos)  // open sections: warping is a seventh dof
    return {Formulation::other, name.starts_with("B32") ? CellType::line3 : CellType::line,
            name.starts_with("B32") ? 3 : 2};
  const Family* best = nullptr;
  for (const Family& family : families)
    if (name.starts_with(family.prefix) &&
        letters(std::string_view(name).substr(std::string_view(family.prefix).size())))
      if (!best || std::string_view(family.prefix).size() > std::string_view(best->prefix).size()) best = &family;
  if (!best) return {};
  return {best->formulation, best->cell, node_count(best->cell)};
}

void read_nodes(Draft& draft) {
  Mesh& mesh = draft.deck.mesh;
  for (const Block& block : draft.text.blocks) {
    if (block.keyword != "NODE") continue;
    if (block.has("SYSTEM") && block.upper_value("SYSTEM") != "R")
      block.refuse("*NODE in cylindrical or spherical coordinates is not read", "Give the nodes in rectangular ones");
    std::vector<int> members;
    DataLines line(block);
    while (line.next()) {
      const long given = line.integer(0, "the node's number");
      if (given <= 0) line.fail(0, "a node number above zero");
      const long id = draft.number(block, given);
      const auto [entry, added] = draft.node_of.try_emplace(id, static_cast<int>(mesh.points.size()));
      const Vec3 at = draft.place(block, Vec3(line.real(1, "x", 0.0), line.real(2, "y", 0.0), line.real(3, "z", 0.0)));
      members.push_back(entry->second);
      if (!added) {
        if (mesh.points[static_cast<std::size_t>(entry->second)] != at)
          line.refuse(0, fmt::format("node {} is defined a second time, at another place", id),
                      "Give every node its own number");
        draft.losses.add("*NODE", "repeated, identical node");
        continue;
      }
      mesh.points.push_back(at);
      mesh.point_ids.push_back(id);
    }
    if (block.has("NSET")) add_to_set(draft, draft.node_sets, block, "NSET", members);
  }
  draft.deck.model.nodes = mesh.points;
  draft.deck.model.node_ids = mesh.point_ids;
}

void read_elements(Draft& draft) {
  Mesh& mesh = draft.deck.mesh;
  std::map<std::string, int> type_index;
  std::map<CellType, int> block_of;
  for (const Block& block : draft.text.blocks) {
    if (block.keyword != "ELEMENT") continue;
    const std::string name = block.upper_value("TYPE");
    if (name.empty()) block.refuse("*ELEMENT has no TYPE", "Write *ELEMENT, TYPE=S4 or the like");
    const auto [known, added] = type_index.try_emplace(name, static_cast<int>(draft.types.size()));
    if (added) draft.types.push_back({name, element_type(name), block.place});
    const ElementType type = draft.types[static_cast<std::size_t>(known->second)].type;
    std::vector<int> members, nodes;
    DataLines line(block);
    while (line.next()) {
      ListedElement e{.id = line.integer(0, "the element's number"), .type = known->second};
      if (e.id <= 0) line.fail(0, "an element number above zero");
      e.id = draft.number(block, e.id);
      nodes.clear();
      for (std::size_t field = 1;;) {  // a record runs on until it has its nodes
        for (; field < line.size(); ++field) nodes.push_back(draft.node(line, field, "a node of the element"));
        if (type.nodes > 0 ? static_cast<int>(nodes.size()) >= type.nodes : !line.open()) break;
        if (!line.next())
          line.refuse(
              0, fmt::format("element {} of type {} has {} nodes, expected {}", e.id, name, nodes.size(), type.nodes),
              "The block may be cut off; complete its last line");
        field = 0;
      }
      if (type.nodes > 0 && static_cast<int>(nodes.size()) != type.nodes)
        line.refuse(
            0, fmt::format("element {} of type {} has {} nodes, expected {}", e.id, name, nodes.size(), type.nodes),
            "Correct its line or its type");
      if (!draft.element_of.try_emplace(e.id, static_cast<int>(draft.elements.size())).second)
        line.refuse(0, fmt::format("element {} is defined a second time", e.id), "Give every element its own number");
      e.first_node = static_cast<int>(draft.element_nodes.size());
      e.nodes = static_cast<int>(nodes.size());
      draft.element_nodes.insert(draft.element_nodes.end(), nodes.begin(), nodes.end());
      if (type.cell) {
        const auto [slot, fresh] = block_of.try_emplace(*type.cell, static_cast<int>(mesh.cells.size()));
        if (fresh) mesh.cells.push_back({*type.cell, {}, {}});
        CellBlock& cells = mesh.cells[static_cast<std::size_t>(slot->second)];
        e.block = slot->second;
        e.cell = cells.size();
        cells.nodes.insert(cells.nodes.end(), nodes.begin(), nodes.end());
        cells.ids.push_back(e.id);
      }
      members.push_back(static_cast<int>(draft.elements.size()));
      draft.elements.push_back(e);
    }
    if (block.has("ELSET")) add_to_set(draft, draft.element_sets, block, "ELSET", members);
  }
}

namespace {

/// *NSET or *ELSET: numbers, ranges (GENERATE) and names of other sets of its kind.
void read_set(Draft& draft, const Block& block, bool of_nodes) {
  static const std::set<std::string> known{"NSET", "ELSET", "GENERATE", "INSTANCE", "INTERNAL", "UNSORTED", "NAME"};
  for (const auto& [parameter, value] : block.parameters)
    if (!known.contains(parameter))
      block.refuse(fmt::format("*{} has a parameter {}, which is not read", block.keyword, parameter),
                   "Write GENERATE in full, or take the parameter out");
  const char* const kind = of_nodes ? "NSET" : "ELSET";
  const std::string name = block.value(kind);
  if (name.empty()) block.refuse(fmt::format("*{} has no name", kind), fmt::format("Write *{0}, {0}=name", kind));
  const auto& index = of_nodes ? draft.node_of : draft.element_of;
  Block within = block;  // members are those of the part that INSTANCE names
  if (block.has("INSTANCE")) within.scope = draft.instance(block);
  const auto number = [&](long given) { return draft.number(within, given); };
  std::vector<int> members;
  DataLines line(block);
  while (line.next()) {
    if (block.has("GENERATE")) {
      const long first = line.integer(0, "the first number");
      long last = line.integer(1, "the last number");
      const long step = line.at(2).empty() ? 1 : line.integer(2, "the step");
      if (first <= 0) line.fail(0, "a first number above zero");
      if (step <= 0 || last < first) line.fail(1, "a rising range with a step above zero");
      last = std::min(last, draft.scope(within).room - 1);
      const std::size_t before = members.size();
      // a range may be longer than the mesh: walk over whichever is shorter
      if (const long steps = (last - first) / step; steps < static_cast<long>(index.size())) {
        for (long i = 0; i <= steps; ++i)  // a number past the last one might not exist
          if (const auto found = index.find(number(first + i * step)); found != index.end())
            members.push_back(found->second);
      } else {
        for (const auto& [id, place] : index)
          if (id >= number(first) && id <= number(last) && (id - number(first)) % step == 0) members.push_back(place);
      }
      if (members.size() == before)
        line.refuse(0,
                    fmt::format("the range {} to {} of set '{}' holds no {}", first, line.at(1), name,
                                of_nodes ? "node" : "element"),
                    "Correct the numbers");
      continue;
    }
    for (std::size_t i = 0; i < line.size(); ++i) {
      if (line.at(i).empty()) continue;
      if (const auto id = parse_integer(line.at(i))) {
        const auto found = index.find(number(*id));
        if (found == index.end())
          line.refuse(i,
                      fmt::format("{} set '{}' names {} {}, which is not defined", of_nodes ? "node" : "element", name,
                                  of_nodes ? "node" : "element", *id),
                      "Define it or take it out of the set");
        members.push_back(found->second);
      } else {
        const std::string other(line.at(i));
        const auto& set =
            of_nodes ? draft.node_set(other, within, line.place(i)) : draft.element_set(other, within, line.place(i));
        members.insert(members.end(), set.begin(), set.end());
      }
    }
  }
  if (of_nodes && block.has("ELSET"))  // the nodes of an element set
    for (const int e : draft.element_set(block.value("ELSET"), within, block.place))
      for (const int node : draft.nodes_of(e)) members.push_back(node);
  add_to_set(draft, of_nodes ? draft.node_sets : draft.element_sets, block, kind, members);
}

}  // namespace

void read_sets(Draft& draft) {
  for (const Block& block : draft.text.blocks) {
    if (block.keyword == "NSET") read_set(draft, block, true);
    if (block.keyword == "ELSET") read_set(draft, block, false);
  }
  const auto sort_unique = [](std::vector<int>& v) {
    std::ranges::sort(v);
    v.erase(std::unique(v.begin(), v.end()), v.end());
  };
  Mesh& mesh = draft.deck.mesh;
  for (auto& [key, set] : draft.node_sets) {
    sort_unique(set.second);
    mesh.point_sets[set.first] = set.second;
  }
  for (auto& [key, set] : draft.element_sets) {
    sort_unique(set.second);
    auto& blocks = mesh.cell_sets[set.first];
    blocks.resize(mesh.cells.size());
    for (const int e : set.second)
      if (const ListedElement& listed = draft.elements[static_cast<std::size_t>(e)]; listed.cell >= 0)
        blocks[static_cast<std::size_t>(listed.block)].push_back(listed.cell);
  }
}

}  // namespace tenon::fem::abaqus
