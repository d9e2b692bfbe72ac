#include <fmt/format.h>

#include <array>
#include <functional>
#include <map>
#include <set>
#include <span>

#include "fem/formats/abaqus/beam_sections.hpp"
#include "fem/formats/abaqus/shell_sections.hpp"

namespace tenon::fem::abaqus {
namespace {

/// What a section's keyword may say without changing the linear K and M in a way that is not read here.
const std::map<std::string, std::set<std::string>> section_parameters{
    {"BEAM SECTION", {"ELSET", "MATERIAL", "SECTION", "POISSON", "TEMPERATURE"}},
    {"BEAM GENERAL SECTION", {"ELSET", "MATERIAL", "SECTION", "DENSITY", "POISSON", "ZERO"}},
    {"SHELL SECTION",
     {"ELSET", "MATERIAL", "COMPOSITE", "OFFSET", "NODAL THICKNESS", "ORIENTATION", "CONTROLS", "POISSON",
      "SECTION INTEGRATION", "TEMPERATURE", "THICKNESS MODULUS", "LAYUP", "SYMMETRIC"}},
    {"MASS", {"ELSET", "ALPHA", "COMPOSITE"}},
    {"SPRING", {"ELSET", "NONLINEAR", "COMPLEX STIFFNESS", "ORIENTATION", "DEPENDENCIES", "RTOL"}}};

struct SectionReader {
  Draft& draft;
  std::vector<Place> section_of = std::vector<Place>(draft.elements.size());  ///< file "" while an element has none
  std::map<std::string, int> material_index = {};

  Model& model() { return draft.deck.model; }
  NamedType& type_of(const ListedElement& e) { return draft.types[static_cast<std::size_t>(e.type)]; }

  /// Runs over the elements of a section's set, each of which may have one section only.
  void each(const Block& block, const std::function<void(const ListedElement&)>& visit) {
    const std::string set = block.value("ELSET");
    if (set.empty()) block.refuse(fmt::format("*{} has no ELSET", block.keyword), "Name the elements it is for");
    draft.deck.has_sections = true;
    if (const auto known = section_parameters.find(block.keyword); known != section_parameters.end())
      for (const auto& [name, value] : block.parameters)
        if (!known->second.contains(name))
          draft.losses.add_physical(fmt::format("*{}, {}", block.keyword, name),
                                    "this parameter of the section is not read", block.place);
    for (const int e : draft.element_set(set, block, block.place)) {
      Place& owner = section_of[static_cast<std::size_t>(e)];
      const ListedElement& element = draft.elements[static_cast<std::size_t>(e)];
      if (!owner.file.empty())
        block.refuse(fmt::format("element {} has a section already, by {}", element.id, to_string(owner)),
                     "Let the sets of sections not overlap");
      owner = block.place;
      type_of(element).sectioned = true;
      visit(element);
    }
  }

  int add(const Material& m) {
    const auto [entry, added] = material_index.try_emplace(m.name, static_cast<int>(model().materials.size()));
    if (added) model().materials.push_back(m);
    return entry->second;
  }

  void wrong_type(const Block& block, const ListedElement& e) {
    block.refuse(fmt::format("element {} is a {}, which takes no *{}", e.id, type_of(e).name, block.keyword),
                 "Correct the section's set or the element's type");
  }

  void beams(const Block& block);
  void shells(const Block& block);
  void masses(const Block& block);
  void rotary_inertia(const Block& block);
  void springs(const Block& block);
  void solids(const Block& block);
  void unread(const Block& block);
};

void SectionReader::beams(const Block& block) {
  const bool general = block.keyword == "BEAM GENERAL SECTION";
  const DraftMaterial* named = general ? nullptr : &draft.material(block, block.value("MATERIAL"));
  DraftBeamSection s = beam_section(block, named ? named->material.nu : 0.0);
  if (named && !named->isotropic) s.unread = fmt::format("material '{}' that is not isotropic", named->material.name);
  if (!s.unread.empty()) {
    draft.losses.add_physical("*BEAM SECTION", fmt::format("{} is not read", s.unread), block.place);
    each(block, [](const ListedElement&) {});
    return;
  }
  s.n1 = draft.scope(block).rotation * s.n1;
  if (s.one_number)
    draft.losses.add("*BEAM SECTION, SECTION=CIRC",
                     "its one number is the radius, as in Abaqus; CalculiX takes it for the diameter");
  s.section.name = block.value("ELSET");
  const int material_index = add(s.material ? *s.material : named->material);
  const int section = static_cast<int>(model().beam_sections.size());
  model().beam_sections.push_back(s.section);
  each(block, [&](const ListedElement& e) {
    if (type_of(e).type.formulation != Formulation::beam) wrong_type(block, e);
    const int* const n = &draft.element_nodes[static_cast<std::size_t>(e.first_node)];
    const auto put = [&](int a, int b) {
      const auto at = [&](int node) { return model().nodes[static_cast<std::size_t>(node)]; };
      const Vec3 t = at(b) - at(a), n2 = t.cross(s.n1);
      if (!(n2.norm() > 1e-9 * t.norm() * s.n1.norm()))
        block.refuse(fmt::format("element {} has no length, or n1 = ({:g}, {:g}, {:g}) lies along it", e.id, s.n1.x(),
                                 s.n1.y(), s.n1.z()),
                     "Give a direction n1 across the beam in the section's second data line");
      const Vec3 offset = s.offset_2 * n2.normalized();
      model().elements.emplace_back(Beam{.nodes = {a, b},
                                         .section = section,
                                         .material = material_index,
                                         .orientation = s.n1,
                                         .offsets = {offset, offset},
                                         .id = e.id});
    };
    if (e.nodes == 2) {
      put(n[0], n[1]);
    } else {  // ends first and last, the middle between them
      put(n[0], n[1]);
      put(n[1], n[2]);
      draft.losses.add(type_of(e).name, "split into two straight beams of two nodes");
    }
  });
}

void SectionReader::shells(const Block& block) {
  DraftShellSection s = shell_section(draft, block);
  if (!s.unread.empty()) {
    draft.losses.add_physical("*SHELL SECTION", fmt::format("{} is not read", s.unread), block.place);
    each(block, [](const ListedElement&) {});
    return;
  }
  const Quad4 like{.section = static_cast<int>(model().shell_sections.size()),
                   .material = add(s.material),
                   .material_axis = s.material_axis};
  model().shell_sections.push_back(std::move(s.section));
  each(block, [&](const ListedElement& e) {
    if (type_of(e).type.formulation != Formulation::shell) wrong_type(block, e);
    const std::span nodes(&draft.element_nodes[static_cast<std::size_t>(e.first_node)],
                          static_cast<std::size_t>(e.nodes));
    if (s.normal) check_normal(model(), nodes, *s.normal, block, e.id);
    Quad4 shell = like;
    shell.id = e.id;
    if (const std::string split = add_shell(model(), nodes, shell); !split.empty())
      draft.losses.add(type_of(e).name, split);
  });
}

void SectionReader::masses(const Block& block) {
  DataLines line(block);
  if (!line.next()) block.refuse("*MASS has no data line", "Give the mass");
  const double mass = line.real(0, "the mass");
  if (!(mass >= 0.0)) line.fail(0, "a mass that is not negative");
  each(block, [&](const ListedElement& e) {
    if (type_of(e).type.formulation != Formulation::mass) wrong_type(block, e);
    model().elements.emplace_back(
        PointMass{.node = draft.element_nodes[static_cast<std::size_t>(e.first_node)], .mass = mass, .id = e.id});
  });
}

void SectionReader::rotary_inertia(const Block& block) {
  DataLines line(block);
  if (!line.next()) block.refuse("*ROTARY INERTIA has no data line", "Give I11, I22, I33");
  const Vec3 inertia(line.real(0, "I11"), line.real(1, "I22"), line.real(2, "I33"));
  bool plain = !block.has("ORIENTATION");
  for (const std::size_t i : {3U, 4U, 5U}) plain = plain && line.real(i, "a product of inertia", 0.0) == 0.0;
  if (!plain)
    draft.losses.add_physical("*ROTARY INERTIA", "products of inertia and own axes are not read", block.place);
  each(block, [&](const ListedElement& e) {
    if (type_of(e).type.formulation != Formulation::rotary_inertia) wrong_type(block, e);
    model().elements.emplace_back(PointMass{.node = draft.element_nodes[static_cast<std::size_t>(e.first_node)],
                                            .inertia = inertia.asDiagonal(),
                                            .id = e.id});
  });
}

/// What *SPRING says: dofs (0 where the line has none), stiffness, axes of an *ORIENTATION.
struct SpringBlock {
  std::array<long, 2> dofs{};
  double k = 0.0;
  std::optional<Mat3> axes = {};
};

// A line of dofs, which SPRINGA leaves blank, then one with the stiffness; more lines are of other temperatures.
SpringBlock spring_block(Draft& draft, const Block& block, bool axial) {
  SpringBlock spring;
  DataLines line(block), ahead(block);
  const bool has_line = line.next();
  const bool one_line = ahead.next() && !ahead.next();
  if (!(axial && has_line && (one_line || !parse_integer(line.at(0))))) {
    for (std::size_t i = 0; i < 2; ++i)
      spring.dofs[i] = line.size() > i && !line.at(i).empty() ? line.integer(i, "a dof") : 0;
    if (!has_line || !line.next()) block.refuse("*SPRING needs a line of dofs and a line with the stiffness", "Add it");
  }
  spring.k = line.real(0, "the stiffness");
  if (!(spring.k >= 0.0)) line.fail(0, "a stiffness that is not negative");
  bool plain = !block.has("NONLINEAR") && !block.has("COMPLEX STIFFNESS");
  while (line.next()) plain = plain && line.real(0, "the stiffness") == spring.k;
  if (!plain)
    draft.losses.add_physical("*SPRING", "stiffness over elongation, temperature or frequency is not read",
                              block.place);
  if (block.has("ORIENTATION")) {
    spring.axes = orientation(draft, block, block.value("ORIENTATION"));
    if (!spring.axes)
      draft.losses.add_physical("*SPRING", "axes that turn from point to point are not read", block.place);
  }
  return spring;
}

void SectionReader::springs(const Block& block) {
  const auto is_axial = [&](const ListedElement& e) {
    return type_of(e).type.formulation == Formulation::axial_spring;
  };
  const std::vector<int>& set = draft.element_set(block.value("ELSET"), block, block.place);
  const bool axial = !set.empty() && is_axial(draft.elements[static_cast<std::size_t>(set.front())]);
  const SpringBlock read = spring_block(draft, block, axial);
  each(block, [&](const ListedElement& e) {
    const Formulation f = type_of(e).type.formulation;
    if (f == Formulation::other) return;  // named with the elements without a counterpart
    const int* const n = &draft.element_nodes[static_cast<std::size_t>(e.first_node)];
    if (is_axial(e) != axial || (!axial && f != Formulation::spring && f != Formulation::spring_to_ground))
      wrong_type(block, e);
    if (axial) {
      const Vec3 along = model().nodes[static_cast<std::size_t>(n[1])] - model().nodes[static_cast<std::size_t>(n[0])];
      if (!(along.norm() > 0.0))
        block.refuse(fmt::format("element {} has no length: its two nodes lie at one place", e.id),
                     "A SPRINGA acts along the line of its nodes; take SPRING2 between coincident ones");
      Bush bush{.node_a = n[0], .node_b = n[1], .k = {read.k}, .id = e.id};
      const Vec3 x = along.normalized(), y = x.unitOrthogonal();
      bush.axes << x, y, x.cross(y);
      model().elements.emplace_back(bush);
      return;
    }
    const std::size_t ends = f == Formulation::spring ? 2 : 1;
    for (std::size_t i = 0; i < ends; ++i) {
      if (read.dofs[i] < 1 || read.dofs[i] > 6)
        block.refuse(fmt::format("the spring's dof is {}, expected 1 to 6", read.dofs[i]),
                     "Correct its first data line");
      if (!read.axes && draft.node_axes.contains(n[i]))
        draft.losses.add_physical("*SPRING", "springs at nodes with *TRANSFORM are not read", block.place);
    }
    Spring spring{.node_a = n[0], .dof_a = static_cast<int>(read.dofs[0]) - 1, .k = read.k, .id = e.id};
    if (read.axes) spring.axis_a = read.axes->col(spring.dof_a % 3);
    if (ends == 2) {
      spring.node_b = n[1];
      spring.dof_b = static_cast<int>(read.dofs[1]) - 1;
      if (read.axes) spring.axis_b = read.axes->col(spring.dof_b % 3);
    }
    model().elements.emplace_back(spring);
  });
}

/// A straight bar across its middle node: that node stays on the line of the ends, which no axial force would tell it.
void follow_ends(Model& model, const std::array<int, 3>& n, long id) {
  const auto at = [&](int node) { return model.nodes[static_cast<std::size_t>(node)]; };
  const Vec3 line = at(n[2]) - at(n[0]), x = line.normalized(), y = x.unitOrthogonal();
  const double s = (at(n[1]) - at(n[0])).dot(x) / line.norm();
  for (const Vec3& across : {y, Vec3(x.cross(y))}) {
    LinearConstraint row{{}, id};
    int first = 0;
    across.cwiseAbs().maxCoeff(&first);
    for (const int k : {0, 1, 2})
      if (const int d = (first + k) % 3; across[d] != 0.0) row.terms.push_back({{n[1], d}, across[d]});
    for (int d = 0; d < 3; ++d)
      if (across[d] != 0.0) {
        row.terms.push_back({{n[0], d}, -(1.0 - s) * across[d]});
        row.terms.push_back({{n[2], d}, -s * across[d]});
      }
    model.constraints.push_back(std::move(row));
  }
}

// *SOLID SECTION of trusses: the area, 1 where it is blank
void SectionReader::solids(const Block& block) {
  int section = -1, material_index = -1;
  const auto prepare = [&] {
    if (section >= 0) return;
    DataLines line(block);
    BeamSection s{.name = block.value("ELSET"), .A = 1.0};
    if (line.next() && !line.at(0).empty()) s.A = line.positive(0, "the area");
    const DraftMaterial& named = draft.material(block, block.value("MATERIAL"));
    if (!named.isotropic)
      draft.losses.add_physical("*SOLID SECTION",
                                fmt::format("material '{}' that is not isotropic", named.material.name), block.place);
    section = static_cast<int>(model().beam_sections.size());
    model().beam_sections.push_back(s);
    material_index = add(named.material);
  };
  each(block, [&](const ListedElement& e) {
    if (type_of(e).type.formulation == Formulation::other) return;  // named with the elements without a counterpart
    if (type_of(e).type.formulation != Formulation::truss) wrong_type(block, e);
    prepare();
    const int* const n = &draft.element_nodes[static_cast<std::size_t>(e.first_node)];
    const auto put = [&](int a, int b) {
      if (model().nodes[static_cast<std::size_t>(a)] == model().nodes[static_cast<std::size_t>(b)])
        block.refuse(fmt::format("element {} has no length: two of its nodes lie at one place", e.id),
                     "Correct its nodes");
      model().elements.emplace_back(Rod{.nodes = {a, b}, .section = section, .material = material_index, .id = e.id});
    };
    put(n[0], n[1]);
    if (e.nodes == 2) return;
    put(n[1], n[2]);
    const bool alone = std::ranges::count(draft.element_nodes, n[1]) == 1;
    if (alone) follow_ends(model(), {n[0], n[1], n[2]}, e.id);
    draft.losses.add(type_of(e).name, "split into two bars of two nodes");
  });
}

void SectionReader::unread(const Block& block) {
  each(block, [&](const ListedElement& e) {
    if (type_of(e).type.formulation != Formulation::other) wrong_type(block, e);
  });
}

}  // namespace

void read_sections(Draft& draft) {
  SectionReader reader{draft};
  const std::map<std::string, void (SectionReader::*)(const Block&)> readers{
      {"BEAM SECTION", &SectionReader::beams},
      {"BEAM GENERAL SECTION", &SectionReader::beams},
      {"SHELL SECTION", &SectionReader::shells},
      {"MASS", &SectionReader::masses},
      {"ROTARY INERTIA", &SectionReader::rotary_inertia},
      {"SPRING", &SectionReader::springs},
      {"SOLID SECTION", &SectionReader::solids},
      {"MEMBRANE SECTION", &SectionReader::unread},
      {"GASKET SECTION", &SectionReader::unread},
      {"SURFACE SECTION", &SectionReader::unread},
      {"FLUID SECTION", &SectionReader::unread}};
  for (const Block& block : draft.text.blocks)
    if (const auto found = readers.find(block.keyword); found != readers.end()) (reader.*found->second)(block);
  if (!draft.deck.has_sections) return;

  for (std::size_t i = 0; i < draft.elements.size(); ++i) {
    const ListedElement& e = draft.elements[i];
    const NamedType& type = draft.types[static_cast<std::size_t>(e.type)];
    const bool has = !reader.section_of[i].file.empty();
    const bool damper = type.name.starts_with("DASHPOT");
    if (damper)
      draft.losses.add(type.name, "dampers are no part of K and M");
    else if (type.type.formulation == Formulation::other && (has || !type.type.cell))
      draft.losses.add_physical(type.name, own_matrices, has ? reader.section_of[i] : type.place);
    else if (!has && !type.name.starts_with("R3D"))
      draft.losses.add_physical(fmt::format("{} without a section", type.name),
                                fmt::format("the first is element {}", e.id), type.place);
  }
}

}  // namespace tenon::fem::abaqus
