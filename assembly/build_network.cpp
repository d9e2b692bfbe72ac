#include <fmt/format.h>

#include <algorithm>
#include <map>

#include "assembly/build.hpp"
#include "assembly/build_beam.hpp"
#include "assembly/close_angles.hpp"
#include "assembly/matrix_body.hpp"
#include "assembly/modal_run.hpp"
#include "assembly/same_body.hpp"
#include "fem/model_check.hpp"
#include "reduction/body_file.hpp"
#include "reduction/large_motion.hpp"

namespace tenon::assembly {
namespace {

/// Ports with the parent port first.
std::vector<reduction::BodyPort> ordered(std::vector<reduction::BodyPort> ports, const std::string& parent) {
  std::stable_partition(ports.begin(), ports.end(), [&](const auto& port) { return port.name == parent; });
  return ports;
}

ReducedBody make_rigid(const SceneBody& body, const RigidSource& rigid) {
  std::vector<reduction::BodyPort> ports;
  for (const ScenePort& port : body.ports) ports.push_back({port.name, port.where.point, port.axes, {}});
  return reduction::rigid_body(body.name, rigid.mass, rigid.centre, rigid.inertia, ordered(ports, body.parent_port));
}

ReducedBody reduce_fe(const SceneBody& body, const FeSource& fe, const BodyPlan& plan,
                      const reduction::Progress& progress) {
  if (body.ports.empty())
    throw InputError(body.place, fmt::format("body '{}' has no port to hang by", body.name),
                     "Add `ports: {root: {set: ...}}`, or solve it as it is with `tenon modes`, alone in a scene");
  if (!fe.supports.empty())
    throw InputError(
        body.place, fmt::format("body '{}' is held to the inertial frame by `fix` and cannot be reduced", body.name),
        "Take `fix` out and ground one of its ports, or solve it as it is with `tenon modes`, alone in a scene");
  const fem::Model model = build_model(body);
  const fem::Structure structure = fem::assemble(model);
  ReducedBody reduced;
  if (plan.rigid) {
    const fem::MassProperties mass = fem::mass_properties(structure);
    std::vector<reduction::BodyPort> ports;
    for (const fem::Port& port : structure.ports)
      ports.push_back({port.name, structure.nodes[static_cast<std::size_t>(port.node)], port.axes, {}});
    reduced = reduction::rigid_body(body.name, mass.mass, mass.centre, mass.inertia, ordered(ports, body.parent_port));
    reduced.certificate.left_out.emplace_back("all flexibility: the scene takes the body as rigid");
  } else {
    reduction::ReduceOptions options = plan.options;
    options.progress = progress;
    reduced = reduction::reduce(structure, body.parent_port, options);
    if (options.nonlinear) reduction::add_large_motion(model, structure, reduced);
    for (const fem::Finding& coarse : fem::check_curvature(model))
      reduced.certificate.left_out.push_back(fmt::format("bending that the mesh does not resolve: {} {} ({}, ...)",
                                                         coarse.count, coarse.what, coarse.where.front()));
  }
  reduced.name = body.name;
  reduced.certificate.source.clear();
  reduced.certificate.source_hash.clear();
  for (const auto& file : fe.matrices ? files_read(*fe.matrices) : std::vector{fe.file}) {
    const char* const comma = reduced.certificate.source.empty() ? "" : ", ";
    reduced.certificate.source += fmt::format("{}{}", comma, file.filename().string());
    reduced.certificate.source_hash += fmt::format("{}{}", comma, reduction::file_hash(file));
  }
  reduced.certificate.nodes = static_cast<int>(model.nodes.size());
  reduced.certificate.elements = static_cast<int>(model.elements.size());
  reduced.certificate.dofs = structure.n();
  return reduced;
}

ReducedBody read_reduced(const SceneBody& body, const ReducedSource& source) {
  const bool printed = source.file.extension() == ".f06";
  ReducedBody reduced = printed ? read_modal_run(source.file, source.units) : reduction::read_body(source.file);
  reduced.name = body.name;
  if (body.parent_port.empty()) return reduced;
  const int port = reduction::port_index(reduced, body.parent_port);
  return port == reduced.parent ? reduced : reduction::rebase(reduced, port);
}

/// Names of the scene to indices of the network.
class Resolver {
 public:
  Resolver(const Scene& scene, Network& network) : scene_(scene), network_(network) {}

  int body(const SceneTarget& target) const {
    const auto at = std::find_if(scene_.bodies.begin(), scene_.bodies.end(),
                                 [&](const SceneBody& b) { return b.name == target.body; });
    return static_cast<int>(at - scene_.bodies.begin());
  }
  int joint(const SceneTarget& target) const {
    const auto at = std::find_if(scene_.joints.begin(), scene_.joints.end(),
                                 [&](const SceneJoint& j) { return j.joint.name == target.body; });
    return static_cast<int>(at - scene_.joints.begin());
  }
  PortRef port(const SceneTarget& target) const {
    const int k = body(target);
    try {
      return {k, reduction::port_index(network_.bodies[static_cast<std::size_t>(k)], target.port)};
    } catch (const ModelError& fault) {
      throw InputError(target.place, fault.what(), "The ports of a reduced body stand in its file");
    }
  }
  /// A port, or a body alone: a rigid one at its centre of mass, another at its parent port.
  PortRef port_or_body(const SceneTarget& target) {
    if (!target.port.empty()) return port(target);
    const int k = body(target);
    ReducedBody& reduced = network_.bodies[static_cast<std::size_t>(k)];
    const auto* rigid = std::get_if<RigidSource>(&scene_.bodies[static_cast<std::size_t>(k)].source);
    if (!rigid) return {k, std::max(reduced.parent, 0)};
    const std::string centre = "centre of mass";
    for (std::size_t p = 0; p < reduced.ports.size(); ++p)
      if (reduced.ports[p].name == centre) return {k, static_cast<int>(p)};
    reduced.ports.push_back({centre, rigid->centre, Mat3::Identity(), Mat6X::Zero(6, 0)});
    return {k, static_cast<int>(reduced.ports.size()) - 1};
  }

 private:
  using Mat6X = fem::Mat6X;
  const Scene& scene_;
  Network& network_;
};

}  // namespace

ReducedBody build_body(const SceneBody& body, const BodyPlan& plan, const reduction::Progress& progress) {
  if (const auto* rigid = std::get_if<RigidSource>(&body.source)) return make_rigid(body, *rigid);
  if (const auto* fe = std::get_if<FeSource>(&body.source)) return reduce_fe(body, *fe, plan, progress);
  if (const auto* beam = std::get_if<BeamSource>(&body.source)) return make_beam(body, *beam, plan, progress);
  return read_reduced(body, std::get<ReducedSource>(body.source));
}

Network connect(const Scene& scene, std::vector<ReducedBody> bodies) {
  Network network;
  network.bodies = std::move(bodies);
  Resolver resolve(scene, network);
  for (const SceneJoint& scene_joint : scene.joints) {
    Joint joint = scene_joint.joint;
    joint.parent = resolve.port(scene_joint.parent);
    joint.child = resolve.port(scene_joint.child);
    network.joints.push_back(std::move(joint));
  }
  for (const SceneMass& mass : scene.masses)
    network.masses.push_back({mass.name, resolve.port(mass.at), mass.mass, mass.inertia});
  for (const SceneTarget& ground : scene.ground) network.ground.push_back(resolve.port(ground));
  for (const SceneInput& input : scene.inputs) {
    Input made{.name = input.name, .at = {}, .direction = input.direction, .joint = {}};
    if (input.joint)
      made.joint = resolve.joint(input.at);
    else
      made.at = resolve.port_or_body(input.at);
    network.inputs.push_back(std::move(made));
  }
  for (const SceneOutput& output : scene.outputs) {
    Output made{.name = output.name, .quantity = output.quantity, .at = {}, .direction = output.direction, .joint = {}};
    if (output.joint)
      made.joint = resolve.joint(output.at);
    else
      made.at = resolve.port_or_body(output.at);
    network.outputs.push_back(std::move(made));
  }
  return close_angles(std::move(network));
}

Network build_network(const Scene& scene, const Plan& plan, const reduction::Progress& progress) {
  std::vector<ReducedBody> bodies;
  const double all = static_cast<double>(scene.bodies.size());
  std::map<std::string, std::size_t> made;  // by fingerprint
  for (std::size_t k = 0; k < scene.bodies.size(); ++k) {
    const auto part = [&](double done, const char* step) {
      if (progress) progress((static_cast<double>(k) + done) / all, step);
    };
    const std::string kind = fingerprint(scene.bodies[k], plan.bodies[k]);
    const auto [same, first] = made.try_emplace(kind, k);
    if (first || kind.empty()) {
      bodies.push_back(build_body(scene.bodies[k], plan.bodies[k], part));
    } else {
      bodies.push_back(bodies[same->second]);
      bodies.back().name = scene.bodies[k].name;
      part(1.0, "the same as before");
    }
  }
  return connect(scene, std::move(bodies));
}

}  // namespace tenon::assembly
