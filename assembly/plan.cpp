#include "assembly/plan.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <numbers>

#include "fem/formats/deck.hpp"

namespace tenon::assembly {
namespace {

double hertz(double omega) { return omega / (2.0 * std::numbers::pi); }

/// Fixed-interface modes up to twice the band's top: the rule of thumb of component mode synthesis (Craig & Kurdila).
constexpr double band_factor = 2.0;

void plan_automatic(const Requirement& requirement, BodyPlan& body) {
  const std::string statics = "static shapes of all ports and of rigid inertia";
  if (requirement.band) {
    const double top = (*requirement.band)[1];
    body.options.band = band_factor * top;
    body.kept = fmt::format("{}, fixed-interface modes below {:.4g} Hz", statics, hertz(band_factor * top));
    body.dropped = fmt::format("fixed-interface modes above {:.4g} Hz", hertz(band_factor * top));
    body.why = fmt::format("the scene requires {:.4g} Hz; twice that keeps the error of the cut small", hertz(top));
  } else {
    body.options.modes = default_modes;
    body.kept = fmt::format("{}, the lowest {} fixed-interface modes", statics, default_modes);
    body.dropped = "all higher fixed-interface modes";
    body.why = "the scene states no band (requires: {band: ...}), so the default count is kept";
  }
}

// which modes a basis keeps, and which static shapes beside them
struct Contents {
  const char *modes, *statics;
};

Contents contents(reduction::Basis basis) {
  using enum reduction::Basis;
  switch (basis) {
    case craig_bampton:
      return {"fixed-interface modes", "static shapes of all ports"};
    case craig_bampton_inertia_relief:
      return {"fixed-interface modes", "static shapes of all ports and of rigid inertia"};
    case clamped_free:
      return {"modes clamped at the parent port", ""};
    case clamped_free_static:
      return {"modes clamped at the parent port", "static shapes of the child ports"};
    case rubin:
      break;
  }
  return {"free-free modes", "static shapes of all ports"};
}

void plan_chosen(const SceneReduction& chosen, BodyPlan& body) {
  const auto [modes, statics] = contents(chosen.basis);
  const bool without = chosen.basis == reduction::Basis::clamped_free;
  body.options.basis = chosen.basis;
  body.options.band = chosen.band;
  body.options.all_modes = chosen.all;
  if (chosen.modes) body.options.modes = *chosen.modes;
  body.kept = chosen.all    ? fmt::format("all {}", modes)
              : chosen.band ? fmt::format("{} below {:.4g} Hz", modes, hertz(*chosen.band))
                            : fmt::format("the lowest {} {}", *chosen.modes, modes);
  if (!without) body.kept = fmt::format("{}, {}", statics, body.kept);
  body.dropped = chosen.all ? "nothing" : without ? "higher modes, and static shapes of the ports" : "higher modes";
  body.why = "the scene says so";
}

BodyPlan plan_body(const SceneBody& scene_body, const Requirement& requirement) {
  BodyPlan body;
  body.body = scene_body.name;
  body.options.zeta = scene_body.damping;
  if (std::holds_alternative<RigidSource>(scene_body.source)) {
    body.rigid = true;
    body.kept = "mass and inertia";
    body.dropped = "nothing";
    body.why = "a rigid body has no more";
  } else if (std::holds_alternative<ReducedSource>(scene_body.source)) {
    body.kept = "every mode of its file";
    body.dropped = "nothing";
    body.why = "it is reduced already";
  } else if (scene_body.reduction.kind == SceneReduction::Kind::rigid) {
    body.rigid = true;
    body.kept = "mass, centre and inertia of the mesh";
    body.dropped = "all flexibility";
    body.why = "the scene says so";
  } else if (scene_body.reduction.kind == SceneReduction::Kind::automatic) {
    plan_automatic(requirement, body);
  } else {
    plan_chosen(scene_body.reduction, body);
  }
  return body;
}

/// What a body holds by itself, the scene need not.
std::string note_without_ground(const Scene& scene) {
  bool decks = false;
  for (const SceneBody& body : scene.bodies) {
    const auto* fe = std::get_if<FeSource>(&body.source);
    if (!fe) continue;
    decks = decks || fem::is_deck(fe->file);
    if (!fe->supports.empty() || std::ranges::any_of(fe->springs, [](const SceneSpring& s) { return !s.to; }))
      return fmt::format("The scene grounds nothing; body '{}' holds itself, and is solved alone.", body.name);
  }
  return decks ? "The scene grounds nothing: the system floats free with six rigid motions, unless its decks hold it."
               : "Nothing is grounded: the system floats free with six rigid motions.";
}

}  // namespace

Plan plan(const Scene& scene) {
  Plan plan;
  for (const SceneBody& body : scene.bodies) plan.bodies.push_back(plan_body(body, scene.requirement));
  if (scene.ground.empty()) plan.notes.push_back(note_without_ground(scene));
  if (scene.inputs.empty()) plan.notes.push_back("The scene names no inputs: it has modes, but no responses.");
  if (scene.outputs.empty()) plan.notes.push_back("The scene names no outputs: it has modes, but no responses.");
  return plan;
}

}  // namespace tenon::assembly
