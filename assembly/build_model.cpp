#include <fmt/format.h>

#include <algorithm>

#include "assembly/build.hpp"
#include "assembly/build_beam.hpp"
#include "assembly/matrix_body.hpp"
#include "assembly/scene/mesh_nodes.hpp"
#include "assembly/scene/mesh_sections.hpp"
#include "fem/formats/deck.hpp"
#include "fem/formats/read_mesh.hpp"

namespace tenon::assembly {
namespace {

/// Mass or stiffness that was read past must be allowed by name.
void check_losses(const std::vector<fem::Loss>& losses, const SceneBody& body, const FeSource& fe) {
  for (const fem::Loss& loss : losses)
    if (loss.changes_physics && std::find(fe.allow.begin(), fe.allow.end(), loss.name) == fe.allow.end())
      throw InputError(body.place,
                       fmt::format("body '{}': {} of {} would be read past, and it carries stiffness or mass ({})",
                                   body.name, loss.name, fe.file.filename().string(), loss.note),
                       fmt::format("Take it out of the file, or accept the loss with `allow: [{}]`", loss.name));
}

int add_own_node(fem::Model& model, const Vec3& point) {
  const long id = -1 - static_cast<long>(std::count_if(model.node_ids.begin(), model.node_ids.end(),
                                                       [](long existing) { return existing < 0; }));
  model.nodes.push_back(point);
  model.node_ids.push_back(id);
  return static_cast<int>(model.nodes.size()) - 1;
}

/// The node of a port; a set of several nodes gets one of its own, at its centroid unless the scene says where, which
/// the set follows rigidly or on average.
int port_node(const ScenePort& port, const MeshNodes& nodes, fem::Model& model) {
  const auto placed = [&](int node) {
    try {
      fem::position(model, node);
    } catch (const ModelError& fault) {
      throw InputError(port.where.place, fmt::format("port '{}': {}", port.name, fault.what()),
                       "In the label file a row is `NODE DIRECTION X Y Z`");
    }
    return node;
  };
  if (port.where.kind != NodeSelector::Kind::set) return placed(nodes.single(port.where));
  const std::vector<int> set = nodes.of_set(port.where.name, port.where.place);
  std::for_each(set.begin(), set.end(), placed);
  Vec3 centre = Vec3::Zero();
  for (const int node : set) centre += model.nodes[static_cast<std::size_t>(node)] / static_cast<double>(set.size());
  if (set.size() == 1 && (!port.where.centre || (*port.where.centre - centre).norm() == 0.0)) return set.front();
  const int made = add_own_node(model, port.where.centre.value_or(centre));
  if (port.average) {
    fem::AverageLink link{.reference = made, .nodes = {}, .id = model.node_ids.back()};
    for (const int node : set) link.nodes.push_back({.node = node});
    model.average_links.push_back(std::move(link));
  } else {
    model.rigid_links.push_back({.independent = made, .dependents = set, .id = model.node_ids.back()});
  }
  return made;
}

void add_supports(const FeSource& fe, const MeshNodes& nodes, fem::Model& model) {
  for (const SceneSupport& support : fe.supports)
    for (const int node : nodes.of_set(support.set, support.place))
      for (int k = 0; k < 6; ++k)
        if (support.directions >> k & 1) model.supports.push_back({{node, k}});
}

/// The node that a mass or a spring names; `what`: "mass 'tank' sits".
int selected_node(const NodeSelector& where, const std::string& what, const MeshNodes& nodes, const fem::Model& model) {
  if (where.kind != NodeSelector::Kind::port) return nodes.single(where);
  std::vector<std::string> names;
  for (const fem::Port& port : model.ports) {
    if (port.name == where.name) return port.node;
    names.push_back(port.name);
  }
  const std::string near = fem::near_miss(where.name, names);
  throw InputError(
      where.place, fmt::format("{} on the unknown port '{}'", what, where.name),
      near.empty() ? fmt::format("Ports are: {}", fmt::join(names, ", ")) : fmt::format("Did you mean '{}'?", near));
}

void add_masses(const FeSource& fe, const MeshNodes& nodes, fem::Model& model) {
  for (const SceneNodeMass& mass : fe.masses)
    model.elements.push_back(
        fem::PointMass{.node = selected_node(mass.where, fmt::format("mass '{}' sits", mass.name), nodes, model),
                       .mass = mass.mass,
                       .inertia = mass.inertia,
                       .offset = mass.offset});
}

void add_springs(const FeSource& fe, const MeshNodes& nodes, fem::Model& model) {
  for (const SceneSpring& spring : fe.springs) {
    const std::string what = fmt::format("spring '{}' ends", spring.name);
    fem::Bush bush{.node_a = selected_node(spring.from, what, nodes, model), .k = spring.k, .axes = spring.axes};
    if (spring.to) bush.node_b = selected_node(*spring.to, what, nodes, model);
    if (bush.node_a == bush.node_b)
      throw InputError(spring.to->place, fmt::format("spring '{}' joins a node to itself", spring.name),
                       "Name another node, or leave `to` out for a spring to ground");
    const Vec3& a = fem::position(model, bush.node_a);
    const Vec3& b = bush.node_b < 0 ? a : fem::position(model, bush.node_b);
    bush.offset = spring.at.value_or(0.5 * (a + b)) - a;
    model.elements.push_back(bush);
  }
}

fem::Model read_deck(const FeSource& fe, fem::Mesh& mesh) {
  fem::Deck deck = fem::read_deck(fe.file, !fe.allow.empty());
  if (fe.units.force != 0.0 && deck.mass_factor != 1.0)
    throw InputError({fe.file.string()},
                     fmt::format("PARAM WTMASS {:g} takes the deck's masses to force · time² / length, but its units "
                                 "declare {}",
                                 deck.mass_factor, fe.units.name),
                     "Declare consistent units, e.g. `units: inch-lbf`, or take WTMASS out of the deck");
  mesh = std::move(deck.mesh);
  fem::Model model = to_si(std::move(deck.model), fe.units);
  if (fe.beam_mass)
    for (fem::Element& element : model.elements) {
      if (auto* beam = std::get_if<fem::Beam>(&element)) beam->mass = *fe.beam_mass;
      if (auto* rod = std::get_if<fem::Rod>(&element)) rod->mass = *fe.beam_mass;
    }
  return model;
}

}  // namespace

fem::Model build_model(const SceneBody& body) {
  if (const auto* beam = std::get_if<BeamSource>(&body.source)) return beam_model(body, *beam);
  const auto* fe = std::get_if<FeSource>(&body.source);
  if (!fe)
    throw InputError(body.place, fmt::format("body '{}' has no mesh", body.name),
                     "Only a body with `fe` or `beam` has a model");
  fem::Mesh mesh;
  fem::Model model;
  if (fe->matrices) {
    fem::MatrixModel matrices = read_matrix_body(*fe->matrices, fe->units);
    mesh = std::move(matrices.mesh);
    model = std::move(matrices.model);
  } else if (fem::is_deck(fe->file)) {
    model = read_deck(*fe, mesh);
  } else {
    mesh = fem::read_mesh(fe->file);
    model = elements_of(mesh, body, *fe);
  }
  check_losses(model.losses, body, *fe);

  const fem::Model structure = model;  // ports look nodes up in the structure as read, while the model grows
  const MeshNodes nodes(mesh, structure);
  for (const ScenePort& port : body.ports) model.ports.push_back({port.name, port_node(port, nodes, model), port.axes});
  add_supports(*fe, nodes, model);
  add_masses(*fe, nodes, model);
  add_springs(*fe, nodes, model);
  return model;
}

FullModel full_model(const Scene& scene, const Network& network) {
  std::vector<fem::Model> models(scene.bodies.size());
  std::vector<const fem::Model*> pointers(scene.bodies.size(), nullptr);
  for (std::size_t k = 0; k < scene.bodies.size(); ++k) {
    const SceneBody& body = scene.bodies[k];
    if (!body.has_model()) continue;
    const auto* beam = std::get_if<BeamSource>(&body.source);
    models[k] = beam ? full_beam_model(body, *beam) : build_model(body);
    pointers[k] = &models[k];
  }
  return full_model(network, pointers);
}

}  // namespace tenon::assembly
