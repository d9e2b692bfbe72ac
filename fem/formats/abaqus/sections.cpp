#include <fmt/format.h>

#include <array>
#include <functional>

#include "fem/formats/abaqus/beam_sections.hpp"

namespace tenon::fem::abaqus {
namespace {

constexpr const char* own_matrices =
    "no element of this program carries it; the K and M that the other program makes of the part can be used instead "
    "(`matrices:` in a scene)";

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
    for (const int e : draft.element_set(set, block.place)) {
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

  const DraftMaterial& material(const Block& block) const {
    const std::string name = block.value("MATERIAL");
    const auto found = draft.materials.find(upper(name));
    if (found == draft.materials.end()) {
      std::vector<std::string> names;
      for (const auto& [key, m] : draft.materials) names.push_back(key);
      const std::string near = near_miss(upper(name), names);
      block.refuse(name.empty() ? fmt::format("*{} names no material", block.keyword)
                                : fmt::format("there is no material '{}'", name),
                   near.empty() ? "Define it by *MATERIAL" : fmt::format("Did you mean '{}'?", near));
    }
    if (!(found->second.material.E > 0.0) && found->second.isotropic)
      block.refuse(fmt::format("material '{}' has no *ELASTIC", name), "Give its E and ν");
    return found->second;
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
  void unread(const Block& block);
};

void SectionReader::beams(const Block& block) {
  const bool general = block.keyword == "BEAM GENERAL SECTION";
  const DraftMaterial* named = general ? nullptr : &material(block);
  DraftBeamSection s = beam_section(block, named ? named->material.nu : 0.0);
  if (named && !named->isotropic) s.unread = fmt::format("material '{}' that is not isotropic", named->material.name);
  if (!s.unread.empty()) {
    draft.losses.add_physical("*BEAM SECTION", fmt::format("{} is not read", s.unread), block.place);
    each(block, [](const ListedElement&) {});
    return;
  }
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
  const DraftMaterial& named = material(block);
  std::string unread;
  if (block.has("COMPOSITE")) unread = "COMPOSITE";
  if (!named.isotropic) unread = fmt::format("material '{}' that is not isotropic", named.material.name);
  if (const std::string offset = block.upper_value("OFFSET"); !offset.empty() && parse_real(offset) != 0.0)
    unread = fmt::format("OFFSET={}", offset);
  if (block.has("NODAL THICKNESS")) unread = "NODAL THICKNESS";
  if (!unread.empty()) {
    draft.losses.add_physical("*SHELL SECTION", fmt::format("{} is not read", unread), block.place);
    each(block, [](const ListedElement&) {});
    return;
  }
  DataLines line(block);
  if (!line.next()) block.refuse("*SHELL SECTION has no data line", "Give the thickness");
  const int section = static_cast<int>(model().shell_sections.size());
  model().shell_sections.push_back({.name = block.value("ELSET"), .thickness = line.positive(0, "the thickness")});
  const int material_index = add(named.material);
  each(block, [&](const ListedElement& e) {
    if (type_of(e).type.formulation != Formulation::shell) wrong_type(block, e);
    const int* const n = &draft.element_nodes[static_cast<std::size_t>(e.first_node)];
    const auto quad = [&](int a, int b, int c, int d) {
      model().elements.emplace_back(Quad4{{a, b, c, d}, section, material_index, e.id});
    };
    const auto triangle = [&](int a, int b, int c) {
      model().elements.emplace_back(Tria3{{a, b, c}, section, material_index, e.id});
    };
    // corners first, then the middles of the edges behind them, then the centre
    switch (e.nodes) {
      case 3:
        triangle(n[0], n[1], n[2]);
        break;
      case 4:
        quad(n[0], n[1], n[2], n[3]);
        break;
      case 6:
        triangle(n[0], n[3], n[5]);
        triangle(n[3], n[1], n[4]);
        triangle(n[5], n[4], n[2]);
        triangle(n[3], n[4], n[5]);
        draft.losses.add(type_of(e).name, "split into four triangles of three nodes");
        break;
      case 8:
        triangle(n[0], n[4], n[7]);
        triangle(n[1], n[5], n[4]);
        triangle(n[2], n[6], n[5]);
        triangle(n[3], n[7], n[6]);
        quad(n[4], n[5], n[6], n[7]);
        draft.losses.add(type_of(e).name, "split into four triangles at its corners and a quadrilateral between them");
        break;
      default:
        quad(n[0], n[4], n[8], n[7]);
        quad(n[4], n[1], n[5], n[8]);
        quad(n[8], n[5], n[2], n[6]);
        quad(n[7], n[8], n[6], n[3]);
        draft.losses.add(type_of(e).name, "split into four quadrilaterals of four nodes");
    }
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

// dofs on the first line, the stiffness on the second
void SectionReader::springs(const Block& block) {
  DataLines line(block);
  std::array<long, 2> dofs{};
  const bool has_dofs = line.next();
  for (std::size_t i = 0; i < 2; ++i) dofs[i] = line.size() > i && !line.at(i).empty() ? line.integer(i, "a dof") : 0;
  const bool plain = !block.has("NONLINEAR") && !block.has("ORIENTATION") && !block.has("COMPLEX STIFFNESS");
  if (!has_dofs || !line.next()) block.refuse("*SPRING needs a line of dofs and a line with the stiffness", "Add it");
  const double k = line.real(0, "the stiffness");
  if (!plain) draft.losses.add_physical("*SPRING", "nonlinear springs and own axes are not read", block.place);
  each(block, [&](const ListedElement& e) {
    const Formulation f = type_of(e).type.formulation;
    if (f == Formulation::other) return;  // named with the elements without a counterpart
    const std::size_t ends = f == Formulation::spring ? 2 : 1;
    if (f != Formulation::spring && f != Formulation::spring_to_ground) wrong_type(block, e);
    for (std::size_t i = 0; i < ends; ++i)
      if (dofs[i] < 1 || dofs[i] > 6)
        block.refuse(fmt::format("the spring's dof is {}, expected 1 to 6", dofs[i]), "Correct its first data line");
    const int* const n = &draft.element_nodes[static_cast<std::size_t>(e.first_node)];
    Spring spring{.node_a = n[0], .dof_a = static_cast<int>(dofs[0]) - 1, .k = k, .id = e.id};
    if (ends == 2) {
      spring.node_b = n[1];
      spring.dof_b = static_cast<int>(dofs[1]) - 1;
    }
    for (std::size_t i = 0; i < ends; ++i)
      if (draft.node_axes.contains(n[i]))
        draft.losses.add_physical("*SPRING", "springs at nodes with *TRANSFORM are not read", block.place);
    model().elements.emplace_back(spring);
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
      {"SOLID SECTION", &SectionReader::unread},
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
