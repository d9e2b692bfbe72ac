#include <fmt/format.h>

#include <algorithm>
#include <set>

#include "fem/formats/abaqus/draft.hpp"
#include "fem/formats/abaqus/surfaces.hpp"

namespace tenon::fem::abaqus {
namespace {

std::vector<int> sorted_unique(std::vector<int> nodes) {
  std::ranges::sort(nodes);
  nodes.erase(std::unique(nodes.begin(), nodes.end()), nodes.end());
  return nodes;
}

struct LinkReader {
  Draft& draft;
  long next_id = 1;  ///< rigid bodies and the like have no numbers: they are counted

  Model& model() { return draft.deck.model; }
  int reference(const Block& block, const char* parameter) const;
  void rigid(int reference, std::vector<int> dependents, Directions directions);
  void equate(int a, int direction_a, int b, int direction_b);

  void rigid_body(const Block& block);
  void coupling(const Block& block, const Block* kind);
  void mpc(const Block& block);
  void equation(const Block& block);
};

int LinkReader::reference(const Block& block, const char* parameter) const {
  const std::string text = block.value(parameter);
  if (const auto id = parse_integer(text)) {
    const auto found = draft.node_of.find(draft.number(block, *id));
    if (found != draft.node_of.end()) return found->second;
    block.refuse(fmt::format("*{}: node {} is not defined", block.keyword, *id), "Add it to a *NODE block");
  }
  if (text.empty()) block.refuse(fmt::format("*{} has no {}", block.keyword, parameter), "Name its reference node");
  const std::vector<int>& set = draft.node_set(text, block, block.place);
  if (set.size() != 1)
    block.refuse(fmt::format("node set '{}' has {} nodes, expected one reference node", text, set.size()),
                 "Name a single node");
  return set.front();
}

void LinkReader::rigid(int reference, std::vector<int> dependents, Directions directions) {
  std::erase(dependents, reference);
  if (dependents.empty()) return;
  model().rigid_links.push_back(
      {.independent = reference, .dependents = std::move(dependents), .directions = directions, .id = next_id++});
}

void LinkReader::equate(int a, int direction_a, int b, int direction_b) {
  model().constraints.push_back({.terms = {{{a, direction_a}, 1.0}, {{b, direction_b}, -1.0}}, .id = next_id++});
}

// All six directions of the nodes follow REF NODE; of PIN NSET, and of NSET, which CalculiX alone has, the translations
// only (run: a shell's edge may turn about itself). In CalculiX the translations of ROT NODE are the body's rotations.
void LinkReader::rigid_body(const Block& block) {
  static const std::set<std::string> known{"REF NODE", "NSET",     "TIE NSET",           "PIN NSET",
                                           "ELSET",    "ROT NODE", "ANALYTICAL SURFACE", "ISOTHERMAL"};
  for (const auto& [parameter, value] : block.parameters)
    if (!known.contains(parameter))
      draft.losses.add_physical(fmt::format("*RIGID BODY, {}", parameter), "this parameter is not read", block.place);
  const int ref = reference(block, "REF NODE");
  std::vector<int> nodes, pinned;
  const auto add_set = [&](const char* parameter, std::vector<int>& to) {
    if (!block.has(parameter)) return;
    for (const int node : draft.node_set(block.value(parameter), block, block.place)) to.push_back(node);
  };
  add_set("TIE NSET", nodes);
  add_set("PIN NSET", pinned);
  add_set("NSET", pinned);
  if (block.has("ELSET"))
    for (const int e : draft.element_set(block.value("ELSET"), block, block.place))
      for (const int node : draft.nodes_of(e)) nodes.push_back(node);
  if (block.has("ANALYTICAL SURFACE")) draft.losses.add("*RIGID BODY", "ANALYTICAL SURFACE: a surface for contact");
  const auto others = [&](const std::vector<int>& set) { return std::ssize(set) - std::ranges::count(set, ref); };
  if (others(nodes) + others(pinned) == 0)
    block.refuse("*RIGID BODY has no nodes besides its reference", "Name them by NSET, ELSET, TIE NSET or PIN NSET");
  rigid(ref, sorted_unique(std::move(nodes)), all_six);
  rigid(ref, sorted_unique(std::move(pinned)), 0b000111);
  if (block.has("ROT NODE"))
    for (int d = 0; d < 3; ++d) equate(reference(block, "ROT NODE"), d, ref, 3 + d);
}

/// First to last dof on a data line as bits; both blank: all six.
Directions directions(const DataLines& line, std::size_t first_field) {
  if (line.at(first_field).empty()) return all_six;
  const long first = line.integer(first_field, "the first dof");
  const long last = line.at(first_field + 1).empty() ? first : line.integer(first_field + 1, "the last dof");
  if (first < 1 || last < first || last > 6) line.fail(first_field, "dofs from 1 to 6");
  unsigned bits = 0;
  for (long d = first; d <= last; ++d) bits |= 1U << (d - 1);
  return static_cast<Directions>(bits);
}

void LinkReader::coupling(const Block& block, const Block* kind) {
  const int ref = reference(block, "REF NODE");
  if (block.has("ORIENTATION")) {
    draft.losses.add_physical("*COUPLING", "own axes (ORIENTATION) are not read", block.place);
    return;
  }
  const std::string name = block.value("SURFACE");
  Surface nodes = read_surface(draft, block, name);
  nodes.weights.erase(ref);
  if (nodes.weights.empty())
    block.refuse(fmt::format("surface '{}' holds no other node than the reference", name), "Correct it");
  if (!kind)
    block.refuse("*COUPLING is followed by neither *KINEMATIC nor *DISTRIBUTING", "Say which of the two it is");
  Directions bits = 0;
  DataLines line(*kind);
  while (line.next()) bits = static_cast<Directions>(bits | directions(line, 0));
  const bool unsaid = bits == 0;
  if (unsaid) bits = all_six;
  for (const auto& [node, weight] : nodes.weights)
    if (draft.node_axes.contains(node))
      draft.losses.add_physical("*COUPLING", "nodes with *TRANSFORM are not read in it", block.place);
  if (block.has("INFLUENCE RADIUS"))
    draft.losses.add_physical("*COUPLING, INFLUENCE RADIUS", "this parameter is not read", block.place);
  if (kind->keyword == "KINEMATIC") {
    if (unsaid)
      draft.losses.add("*KINEMATIC",
                       "without directions all six are tied, as Abaqus does; CalculiX ties translations alone");
    std::vector<int> dependents;
    for (const auto& [node, weight] : nodes.weights) dependents.push_back(node);
    rigid(ref, std::move(dependents), bits);
    return;
  }
  if (kind->has("COUPLING"))
    draft.losses.add_physical("*DISTRIBUTING, COUPLING", "this parameter is not read", kind->place);
  if (!nodes.weighed)
    draft.losses.add_physical("*DISTRIBUTING", "the area that nodes of second-order elements bear is not known",
                              kind->place);
  if (kind->has("WEIGHTING METHOD") && kind->upper_value("WEIGHTING METHOD") != "UNIFORM")
    draft.losses.add_physical("*DISTRIBUTING", "weights that vary are read as uniform", kind->place);
  AverageLink link{.reference = ref, .directions = bits, .nodes = {}, .id = next_id++};
  for (const auto& [node, weight] : nodes.weights) link.nodes.push_back({.node = node, .weight = weight});
  model().average_links.push_back(std::move(link));
}

// BEAM a, b: b follows... the first node named is eliminated: a follows b
void LinkReader::mpc(const Block& block) {
  DataLines line(block);
  while (line.next()) {
    const std::string type = upper(line.at(0));
    if (type != "BEAM" && type != "TIE" && type != "PIN") {
      draft.losses.add_physical(fmt::format("*MPC {}", type), "it ties nodes together", line.place(0));
      continue;
    }
    const std::vector<int> a = draft.nodes(line, 1, "a node or a node set"),
                           b = draft.nodes(line, 2, "a node or a node set");
    if (a.size() != b.size() && b.size() != 1)
      line.refuse(1, fmt::format("*MPC {} pairs {} nodes with {}", type, a.size(), b.size()),
                  "Give sets of the same size, or one node for all");
    for (std::size_t i = 0; i < a.size(); ++i) {
      const int other = b.size() == 1 ? b.front() : b[i];
      if (a[i] == other) continue;
      if (draft.node_axes.contains(a[i]) || draft.node_axes.contains(other))
        draft.losses.add_physical("*MPC", "nodes with *TRANSFORM are not read in it", line.place(1));
      if (type == "BEAM")
        rigid(other, {a[i]}, all_six);
      else
        for (int d = 0; d < (type == "TIE" ? 6 : 3); ++d) equate(a[i], d, other, d);
    }
  }
}

// the number of terms, then node (or set), dof, coefficient, up to four of them a line
void LinkReader::equation(const Block& block) {
  DataLines line(block);
  while (line.next()) {
    const long count = line.integer(0, "the number of terms");
    if (count < 1) line.fail(0, "at least one term");
    struct Term {
      std::vector<int> nodes;
      int direction;
      double coefficient;
    };
    std::vector<Term> terms;
    std::size_t field = 0;
    while (static_cast<long>(terms.size()) < count) {
      if (field + 2 >= line.size()) {
        if (!line.next())
          block.refuse(fmt::format("*EQUATION ends after {} of {} terms", terms.size(), count), "Complete it");
        field = 0;
      }
      const long dof = line.integer(field + 1, "a dof");
      if (dof < 1 || dof > 6) line.fail(field + 1, "a dof from 1 to 6");
      terms.push_back({draft.nodes(line, field, "a node or a node set"), static_cast<int>(dof) - 1,
                       line.real(field + 2, "a coefficient")});
      field += 3;
    }
    const std::size_t copies = terms.front().nodes.size();
    for (std::size_t i = 0; i < copies; ++i) {
      LinearConstraint constraint{.terms = {}, .id = next_id++};
      for (const Term& t : terms) {
        if (t.nodes.size() != copies && t.nodes.size() != 1)
          line.refuse(0, fmt::format("*EQUATION joins sets of {} and {} nodes", copies, t.nodes.size()),
                      "Give sets of one size");
        const int node = t.nodes.size() == 1 ? t.nodes.front() : t.nodes[i];
        const Vec3 axis = draft.axes(node).col(t.direction % 3);
        for (int d = 0; d < 3; ++d)
          if (axis[d] != 0.0)
            constraint.terms.push_back({{node, t.direction - t.direction % 3 + d}, t.coefficient * axis[d]});
      }
      model().constraints.push_back(std::move(constraint));
    }
  }
}

/// What a word in the place of a dof holds.
std::optional<Directions> named_support(const std::string& word) {
  static const std::map<std::string, Directions> words{
      {"ENCASTRE", all_six}, {"PINNED", 0b000111}, {"XSYMM", 0b110001},  {"YSYMM", 0b101010},
      {"ZSYMM", 0b011100},   {"XASYMM", 0b001110}, {"YASYMM", 0b010101}, {"ZASYMM", 0b100011}};
  const auto found = words.find(word);
  return found == words.end() ? std::nullopt : std::optional(found->second);
}

}  // namespace

void read_transforms(Draft& draft) {
  for (const Block& block : draft.text.blocks) {
    if (block.keyword != "TRANSFORM") continue;
    const std::string set = block.value("NSET"), type = block.upper_value("TYPE");
    DataLines line(block);
    if (!line.next()) block.refuse("*TRANSFORM has no data line", "Give its two points");
    const Vec3 a(line.real(0, "a"), line.real(1, "a"), line.real(2, "a"));
    const Vec3 b(line.real(3, "b"), line.real(4, "b"), line.real(5, "b"));
    const Vec3 origin = draft.scope(block).shift;
    for (const int node : draft.node_set(set, block, block.place)) {
      Mat3 axes;
      if (type == "C") {  // a, b on the axis: radial, around, along
        if (a == b) line.refuse(0, "the two points on the axis of *TRANSFORM are one", "Correct them");
        const Vec3 axial = (b - a).normalized(),
                   arm = draft.deck.model.nodes[static_cast<std::size_t>(node)] - origin - a;
        const Vec3 radial = arm - axial.dot(arm) * axial;
        if (!(radial.norm() > 1e-12 * (1.0 + arm.norm())))
          line.refuse(0, "a node lies on the axis of *TRANSFORM", "Leave it out");
        axes << radial.normalized(), axial.cross(radial.normalized()), axial;
      } else if (type.empty() || type == "R") {  // a on x, b in the x–y plane
        const Vec3 z = a.cross(b);
        if (!(z.norm() > 1e-12 * a.norm() * b.norm())) line.refuse(0, "the two points lie on one line", "Correct them");
        axes << a.normalized(), z.cross(a).normalized(), z.normalized();
      } else {
        block.refuse(fmt::format("*TRANSFORM of type {} is not read", type), "Give a rectangular or cylindrical one");
      }
      draft.node_axes[node] = axes;
    }
  }
}

void read_links(Draft& draft) {
  LinkReader reader{draft};
  const std::vector<Block>& blocks = draft.text.blocks;
  for (std::size_t i = 0; i < blocks.size(); ++i) {
    const std::string& keyword = blocks[i].keyword;
    if (keyword == "RIGID BODY") reader.rigid_body(blocks[i]);
    if (keyword == "COUPLING") {
      const bool kind =
          i + 1 < blocks.size() && (blocks[i + 1].keyword == "KINEMATIC" || blocks[i + 1].keyword == "DISTRIBUTING");
      reader.coupling(blocks[i], kind ? &blocks[i + 1] : nullptr);
    }
    if ((keyword == "KINEMATIC" || keyword == "DISTRIBUTING") && (i == 0 || blocks[i - 1].keyword != "COUPLING"))
      blocks[i].refuse(fmt::format("*{} does not stand behind a *COUPLING", keyword),
                       "Put it behind the one it belongs to");
    if (keyword == "MPC") reader.mpc(blocks[i]);
    if (keyword == "EQUATION") reader.equation(blocks[i]);
  }
}

namespace {

/// The *BOUNDARY blocks in force in the first *FREQUENCY step, in the last step where there is none: those of the model
/// and of the steps up to it. OP=NEW takes away all before its step, in both programs.
std::vector<const Block*> supports_in_force(Draft& draft) {
  const std::vector<Block>& blocks = draft.text.blocks;
  const auto frequency = std::ranges::find(blocks, "FREQUENCY", &Block::keyword);
  const auto end = std::find_if(frequency, blocks.end(), [](const Block& b) { return b.keyword == "END STEP"; });
  std::vector<const Block*> in_force;
  bool renewed = false;  // in this step
  for (auto block = blocks.begin(); block != blocks.end(); ++block) {
    if (block->keyword == "STEP") renewed = false;
    if (block->keyword != "BOUNDARY") continue;
    if (block >= end) {
      draft.losses.add("*BOUNDARY of later steps", "modes are those of the first *FREQUENCY step");
      continue;
    }
    if (block->upper_value("OP") == "NEW" && !renewed) {
      in_force.clear();
      renewed = true;
    }
    in_force.push_back(&*block);
  }
  return in_force;
}

/// Frequencies about a loaded state have its stress in K: CalculiX's *STEP, PERTURBATION behind a *STATIC step,
/// Abaqus's steps behind one with NLGEOM.
void refuse_prestress(Draft& draft) {
  bool loaded = false, nonlinear = false, in_frequency = false;
  const Block* step = nullptr;
  for (const Block& block : draft.text.blocks) {
    if (block.keyword == "STEP") {
      step = &block;
      nonlinear = nonlinear || (block.has("NLGEOM") && block.upper_value("NLGEOM") != "NO");
    }
    const bool load = block.keyword == "CLOAD" || block.keyword == "DLOAD" || block.keyword == "DSLOAD";
    if (load && in_frequency)
      draft.losses.add_physical("*" + block.keyword + " in a *FREQUENCY step",
                                "its stress or softening is part of the stiffness", block.place);
    if (block.keyword == "STATIC" && step && !step->has("PERTURBATION")) loaded = true;
    if (block.keyword == "END STEP" && in_frequency) return;
    if (block.keyword != "FREQUENCY" || !step) continue;
    if (loaded && (nonlinear || step->has("PERTURBATION")))
      draft.losses.add_physical("*STATIC before *FREQUENCY", "the stress that it leaves stiffens the structure",
                                step->place);
    in_frequency = true;
  }
}

}  // namespace

// node or set, first dof, last dof, value; one that is not zero is a load.
void read_supports(Draft& draft) {
  Model& model = draft.deck.model;
  const auto hold = [&](int node, Directions bits) {
    for (int d = 0; d < 6; ++d) {
      if ((bits >> d & 1) == 0) continue;
      const Vec3 axis = draft.axes(node).col(d % 3);
      LinearConstraint constraint;
      for (int k = 0; k < 3; ++k)
        if (axis[k] != 0.0) constraint.terms.push_back({{node, d - d % 3 + k}, axis[k]});
      if (constraint.terms.size() == 1)
        model.supports.push_back({constraint.terms.front().dof});
      else
        model.constraints.push_back(std::move(constraint));
    }
  };
  refuse_prestress(draft);
  for (const Block* const block : supports_in_force(draft)) {
    DataLines line(*block);
    while (line.next()) {
      const std::vector<int> nodes = draft.nodes(line, 0, "a node or a node set");
      Directions bits = 0;
      if (const auto named = named_support(upper(line.at(1)))) {
        bits = *named;
      } else {
        const long first = line.integer(1, "the first dof");
        const long last = line.at(2).empty() ? first : line.integer(2, "the last dof");
        if (first > 6) {
          draft.losses.add("*BOUNDARY", "of temperatures and other dofs than the six");
          continue;
        }
        if (first < 1 || last < first) line.fail(1, "dofs from 1 to 6");
        for (long d = first; d <= std::min(last, 6L); ++d) bits = static_cast<Directions>(bits | 1U << (d - 1));
      }
      if (line.real(3, "the value", 0.0) != 0.0)
        draft.losses.add("*BOUNDARY value", "a prescribed motion: the dof is held at zero");
      for (const int node : nodes) hold(node, bits);
    }
  }
}

}  // namespace tenon::fem::abaqus
