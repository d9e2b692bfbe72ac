#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "assembly/build.hpp"
#include "assembly/second_order.hpp"
#include "fem/structure.hpp"
#include "interfaces/cli/check_mesh.hpp"
#include "interfaces/cli/findings.hpp"
#include "interfaces/cli/input.hpp"
#include "interfaces/cli/output.hpp"

namespace tenon::cli {
namespace {

struct BodyCheck {
  std::string name, kind;
  int nodes = 0, elements = 0, dofs = 0;
  bool sound = true;  ///< no element that the assembler would refuse
  bool held = false;  ///< by `fix`: cannot be reduced
  fem::MassProperties mass;
  std::vector<std::string> losses;
};

BodyCheck check_fe(const assembly::Scene& scene, const assembly::SceneBody& body, std::vector<Subjected>& findings) {
  const fem::Model model = assembly::build_model(body);
  fem::Structure structure;
  for (fem::Finding& finding : fem::check_model(model, {}, &structure))
    findings.push_back({body.name, std::move(finding)});
  const bool sound = structure.n() > 0;
  fem::MassProperties mass;
  if (!sound)
    mass = fem::geometric_mass_properties(model);
  else if (std::all_of(model.nodes.begin(), model.nodes.end(), [](const fem::Vec3& x) { return x.allFinite(); }))
    mass = fem::mass_properties(structure);
  if (!model.supports.empty()) {
    findings.push_back(remark(
        body.name,
        fmt::format("{} dofs are held to the inertial frame by `fix`{}", model.supports.size(),
                    scene.joints.empty() ? ": solve with `tenon modes`" : ", so it cannot be reduced and joined"),
        scene.joints.empty()));
    if (sound) structure = fem::assemble(model);
  }
  return {.name = body.name,
          .kind = model.matrix_parts.empty() ? "fe" : "matrices",
          .nodes = static_cast<int>(model.nodes.size()),
          .elements = static_cast<int>(model.elements.size()),
          .dofs = structure.n(),
          .sound = sound,
          .held = !model.supports.empty(),
          .mass = mass,
          .losses = loss_lines(model.losses)};
}

/// The scene with every body taken as rigid: joints, grounding and mass, without an eigen-solve.
assembly::Network rigid_network(const assembly::Scene& scene, const assembly::Plan& plan) {
  std::vector<reduction::ReducedBody> bodies;
  for (std::size_t k = 0; k < scene.bodies.size(); ++k) {
    assembly::BodyPlan rigid = plan.bodies[k];
    rigid.rigid = true;
    bodies.push_back(assembly::build_body(scene.bodies[k], rigid));
  }
  return assembly::connect(scene, std::move(bodies));
}

BodyCheck check_reduced(const reduction::ReducedBody& body, const char* kind) {
  BodyCheck check{.name = body.name, .kind = kind, .mass = {}, .losses = {}};
  check.mass.mass = body.D(0, 0);
  if (body.D(0, 0) > 0.0) {  // D = [m, −m c̃; m c̃, J]
    const fem::Mat3 s = body.D.bottomLeftCorner<3, 3>() / body.D(0, 0);
    check.mass.centre = body.reference + fem::Vec3(s(2, 1), s(0, 2), s(1, 0));
  }
  return check;
}

struct Report {
  assembly::Plan plan;
  std::vector<BodyCheck> bodies;
  std::vector<Subjected> findings;
  int rigid_motions = 0, loops = 0;
};

Report examine(const assembly::Scene& scene) {
  Report report{.plan = assembly::plan(scene), .bodies = {}, .findings = {}};
  bool joinable = true, assembled = true, held = false;
  for (const assembly::SceneBody& body : scene.bodies)
    if (body.has_model()) {
      report.bodies.push_back(check_fe(scene, body, report.findings));
      joinable = joinable && !body.ports.empty();
      held = held || report.bodies.back().held;
      assembled = assembled && report.bodies.back().sound;
    } else {
      report.bodies.push_back({.name = body.name, .kind = "", .mass = {}, .losses = {}});
    }
  if (!assembled || held) return report;
  if (!joinable && scene.bodies.size() == 1) {
    report.findings.push_back(remark(scene.bodies.front().name, "has no port: it can be solved alone, not joined"));
    return report;
  }
  const assembly::Network network = rigid_network(scene, report.plan);
  for (std::size_t k = 0; k < scene.bodies.size(); ++k)
    if (!scene.bodies[k].has_model())
      report.bodies[k] =
          check_reduced(network.bodies[k],
                        std::holds_alternative<assembly::RigidSource>(scene.bodies[k].source) ? "rigid" : "reduced");
  const assembly::SecondOrderSystem system = assembly::second_order(network);
  report.rigid_motions = assembly::modes(system).rigid;
  report.loops = static_cast<int>(system.placement.closing_joints.size());
  const auto roots = std::count(system.placement.tree_joint.begin(), system.placement.tree_joint.end(), -1);
  report.findings.push_back(
      remark("scene", fmt::format("{} rigid motion{}", report.rigid_motions, report.rigid_motions == 1 ? "" : "s")));
  if (roots > 1 && scene.ground.empty())
    report.findings.push_back(remark("scene", fmt::format("falls into {} parts that no joint connects", roots), false));
  if (report.loops > 0)
    report.findings.push_back(remark("scene", fmt::format("{} joint{} close{} loops", report.loops,
                                                          report.loops == 1 ? "" : "s", report.loops == 1 ? "s" : "")));
  return report;
}

Json to_json(const assembly::Scene& scene, const Report& report) {
  Json object{{"source", scene.file.string()}, {"units", scene.units.name}, {"bodies", Json::array()}};
  for (std::size_t k = 0; k < report.bodies.size(); ++k) {
    const BodyCheck& body = report.bodies[k];
    const assembly::BodyPlan& plan = report.plan.bodies[k];
    object["bodies"].push_back({{"name", body.name},
                                {"kind", body.kind},
                                {"mass_kg", body.mass.mass},
                                {"centre_m", {body.mass.centre.x(), body.mass.centre.y(), body.mass.centre.z()}},
                                {"nodes", body.nodes},
                                {"elements", body.elements},
                                {"dofs", body.dofs},
                                {"read_past", body.losses},
                                {"plan", {{"kept", plan.kept}, {"dropped", plan.dropped}, {"why", plan.why}}}});
  }
  object["rigid_motions"] = report.rigid_motions;
  object["loops"] = report.loops;
  object["notes"] = report.plan.notes;
  object["checks"] = to_json(report.findings);
  object["good"] = good(report.findings);
  return object;
}

void print_people(const assembly::Scene& scene, const Report& report) {
  print(fmt::format("{}: units {}, {} bodies, {} joints", scene.file.string(), scene.units.name, scene.bodies.size(),
                    scene.joints.size()));
  Table bodies({"<body", "<kind", "mass [kg]", "centre in body frame [m]", "nodes", "elements", "dofs"});
  for (const BodyCheck& body : report.bodies)
    bodies.row(
        {body.name, body.kind, fmt::format("{:.6g}", body.mass.mass),
         fmt::format("({:.4g}, {:.4g}, {:.4g})", body.mass.centre.x(), body.mass.centre.y(), body.mass.centre.z()),
         body.nodes ? std::to_string(body.nodes) : "", body.elements ? std::to_string(body.elements) : "",
         body.dofs ? std::to_string(body.dofs) : ""});
  print(bodies);
  print("\n  Plan");
  for (const assembly::BodyPlan& plan : report.plan.bodies)
    print(wrapped(fmt::format("{}: keeps {}; drops {}; because {}.", plan.body, plan.kept, plan.dropped, plan.why), 4));
  for (const std::string& note : report.plan.notes) print(wrapped(note, 4));
  print("\n  Checks");
  print_people(report.findings);
  for (const BodyCheck& body : report.bodies)
    for (const std::string& line : body.losses) print(wrapped(fmt::format("read past in {}: {}", body.name, line), 4));
}

}  // namespace

int run(const CheckOptions& options) {
  if (const InputKind kind = kind_of(options.input); kind != InputKind::scene)
    return check_mesh(options, kind == InputKind::deck);
  const assembly::Scene scene = assembly::read_scene(options.input);
  const Report report = examine(scene);
  if (options.json)
    print(to_json(scene, report));
  else
    print_people(scene, report);
  return good(report.findings) ? done : check_failed;
}

}  // namespace tenon::cli
